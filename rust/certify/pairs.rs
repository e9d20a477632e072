//! The closest pair of vertices that counts, for (T2) of the theorem; its distance from below.
//!
//! The vertices are halved, by their order, down to single ones, and each part has a box round it. A
//! pair of parts is left as soon as no pair of their vertices counts, or all of them are farther apart
//! than a pair that has been met: both is told by the boxes, and by the arclengths as intervals. So no
//! pair is missed, whatever is rounded, and single vertices need no rule of their own: a vertex is a box.
//! Of n vertices along a rope some n^1.5 pairs of parts are looked at, with a factor far below 1.

use crate::certify::interval::Interval;
use crate::certify::point::{Point, from_to, hull, squared};

/// What tells which pairs count.
pub struct Along {
    /// The component of each vertex.
    pub component: Vec<usize>,
    /// The arclength from the start of its component to each vertex.
    pub arclength: Vec<Interval>,
    /// Once around each component.
    pub around: Vec<Interval>,
    /// The arclength from which on pairs of each component count: pi M_c - S_c.
    pub least: Vec<Interval>,
}

/// Two vertices that count, or may count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// At most their distance, squared.
    pub squared: f64,
    /// The first one.
    pub i: usize,
    /// The second.
    pub j: usize,
}

/// The closest pair that counts or may count; `None` where all are at least `reach`, squared, apart.
pub fn closest(vertices: &[Point], along: &Along, reach: f64) -> Option<Pair> {
    let mut search =
        Search { along, parts: Vec::with_capacity(2 * vertices.len()), reach, pair: None };
    let all = search.part(vertices, 0, vertices.len());
    search.compare(all, all, 0.);
    search.pair
}

/// Vertices one after the other.
struct Part {
    first: usize,
    /// The box round them.
    space: Point,
    /// Their component, if it is one.
    component: Option<usize>,
    /// Where they lie along it.
    arclength: Interval,
    /// The indices of both halves, the earlier one first and lower, unless it is a single vertex.
    halves: Option<[usize; 2]>,
}

struct Search<'a> {
    along: &'a Along,
    parts: Vec<Part>,
    reach: f64,
    pair: Option<Pair>,
}

impl Search<'_> {
    /// Makes the part of the vertices `first..end` and returns its index.
    fn part(&mut self, vertices: &[Point], first: usize, end: usize) -> usize {
        let part = if end - first == 1 {
            Part {
                first,
                space: vertices[first],
                component: Some(self.along.component[first]),
                arclength: self.along.arclength[first],
                halves: None,
            }
        } else {
            let middle = first.midpoint(end);
            let halves = [self.part(vertices, first, middle), self.part(vertices, middle, end)];
            let [a, b] = halves.map(|half| &self.parts[half]);
            Part {
                first,
                space: hull(a.space, b.space),
                component: a.component.filter(|_| a.component == b.component),
                arclength: a.arclength.hull(b.arclength),
                halves: Some(halves),
            }
        };
        self.parts.push(part);
        self.parts.len() - 1
    }

    /// Looks through the pairs of two parts, `a` not after `b`, which are at least `apart`, squared.
    fn compare(&mut self, a: usize, b: usize, apart: f64) {
        let single = self.parts[a].halves.is_none() && self.parts[b].halves.is_none();
        if apart >= self.reach || (single && a == b) {
            return;
        }
        if single {
            let (i, j) = (self.parts[a].first, self.parts[b].first);
            self.reach = apart;
            self.pair = Some(Pair { squared: apart, i, j });
            return;
        }
        let (mut pairs, mut n) = ([(f64::INFINITY, 0, 0); 4], 0);
        for x in self.halves(a) {
            for y in self.halves(b).filter(|&y| a != b || x <= y) {
                let apart = self.apart(x, y);
                if apart < self.reach && self.may_count(x, y) {
                    pairs[n] = (apart, x, y);
                    n += 1;
                }
            }
        }
        // The nearest first: then the others are soon too far.
        pairs[..n].sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
        for &(apart, x, y) in &pairs[..n] {
            self.compare(x, y, apart);
        }
    }

    /// The halves of a part in their order, or the part itself if it is a single vertex.
    fn halves(&self, part: usize) -> impl Iterator<Item = usize> + use<> {
        let halves = self.parts[part].halves;
        halves.into_iter().flatten().chain(halves.is_none().then_some(part))
    }

    /// At most the distance of any two vertices of the parts, squared.
    fn apart(&self, a: usize, b: usize) -> f64 {
        squared(from_to(self.parts[a].space, self.parts[b].space)).low()
    }

    /// Whether a pair of vertices of the parts may count, `a` not after `b`.
    fn may_count(&self, a: usize, b: usize) -> bool {
        let (a, b) = (&self.parts[a], &self.parts[b]);
        match (a.component, b.component) {
            (Some(c), Some(d)) if c == d => {
                let forth = b.arclength - a.arclength;
                let back = self.along.around[c] - forth;
                !self.along.least[c].is_above(forth.min(back))
            }
            _ => true,
        }
    }
}
