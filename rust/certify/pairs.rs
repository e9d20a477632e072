//! The closest pair of vertices that counts, for (T2) of the theorem; its distance from below (C7).
//!
//! The vertices are halved, by their order, down to single ones. A part of them is held by a straight
//! piece, from its first vertex to its last, and a radius: none is farther from that piece. Pairs of
//! parts are left where no pair of their vertices counts, which arclengths from above tell, or where
//! all are farther apart than a pair that has been met: for any vector n, with the centres d apart and
//! half axes g and h, vertices are apart in the direction of n by at least
//!
//! ```text
//!   (d.n - |g.n| - |h.n|)/|n| - both radii.
//! ```
//!
//! All this is computed in intervals, so no pair is missed. With n = d, strands that touch have axes
//! across n, and what they bend goes with the square of their length: at each halving the pairs that
//! are left are about as many as the parts.

use glam::DVec3;

use crate::certify::interval::Interval;
use crate::certify::point::{Point, dot, exactly, from_to, length, middle, shifted, squared};

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
    let parts = Vec::with_capacity(2 * vertices.len());
    let mut search = Search { vertices, along, parts, reach, pair: None };
    let all = search.part(0, vertices.len());
    search.compare(all, all, 0.);
    search.pair
}

/// Vertices one after the other.
struct Part {
    first: usize,
    /// Between the first and the last vertex.
    centre: DVec3,
    /// From there to the last one.
    axis: DVec3,
    /// At least how far a vertex is from the straight piece between the two.
    radius: Interval,
    /// Their component, if it is one.
    component: Option<usize>,
    /// Where they lie along it.
    arclength: Interval,
    /// The indices of both halves, the earlier one first and lower, unless it is a single vertex.
    halves: Option<[usize; 2]>,
}

impl Part {
    /// At most how far its straight piece gets from its centre in the direction of `n`, times |n|.
    fn extent(&self, n: Point) -> Interval {
        dot(exactly(self.axis), n).abs()
    }

    /// At least how far a vertex is from the straight piece of `other`, of which this is a half.
    ///
    /// The distance from a convex set is convex, so along a straight piece it is largest at an end.
    fn radius_about(&self, other_centre: DVec3, other_axis: DVec3) -> Interval {
        let from_end = |side: f64| {
            let end = shifted(self.centre, side, self.axis);
            // Any place on the piece will do, and this is about the nearest.
            let place = (self.centre + side * self.axis - other_centre).dot(other_axis);
            let place = (place / other_axis.length_squared()).clamp(-1., 1.);
            let place = if place.is_nan() { 0. } else { place };
            length(from_to(shifted(other_centre, place, other_axis), end))
        };
        from_end(-1.).max(from_end(1.)) + self.radius
    }
}

struct Search<'a> {
    vertices: &'a [Point],
    along: &'a Along,
    parts: Vec<Part>,
    reach: f64,
    pair: Option<Pair>,
}

impl Search<'_> {
    /// Makes the part of the vertices `first..end` and returns its index.
    fn part(&mut self, first: usize, end: usize) -> usize {
        let part = if end - first == 1 { self.single(first) } else { self.several(first, end) };
        self.parts.push(part);
        self.parts.len() - 1
    }

    fn single(&self, i: usize) -> Part {
        let centre = middle(self.vertices[i]);
        Part {
            first: i,
            centre,
            axis: DVec3::ZERO,
            radius: length(from_to(exactly(centre), self.vertices[i])),
            component: Some(self.along.component[i]),
            arclength: self.along.arclength[i],
            halves: None,
        }
    }

    fn several(&mut self, first: usize, end: usize) -> Part {
        let cut = first.midpoint(end);
        let halves = [self.part(first, cut), self.part(cut, end)];
        let [a, b] = halves.map(|half| &self.parts[half]);
        let (from, to) = (middle(self.vertices[first]), middle(self.vertices[end - 1]));
        let (centre, axis) = (0.5 * (from + to), 0.5 * (to - from));
        Part {
            first,
            centre,
            axis,
            radius: a.radius_about(centre, axis).max(b.radius_about(centre, axis)),
            component: a.component.filter(|_| a.component == b.component),
            arclength: a.arclength.hull(b.arclength),
            halves: Some(halves),
        }
    }

    /// Looks through the pairs of two parts, `a` not after `b`, which are at least `apart`, squared.
    fn compare(&mut self, a: usize, b: usize, apart: f64) {
        if apart >= self.reach || (a == b && self.parts[a].halves.is_none()) {
            return;
        }
        if self.are_single(a, b) {
            let (i, j) = (self.parts[a].first, self.parts[b].first);
            self.reach = apart;
            self.pair = Some(Pair { squared: apart, i, j });
            return;
        }
        let (mut pairs, mut n) = ([(f64::INFINITY, 0, 0); 4], 0);
        for x in self.halves(a) {
            for y in self.halves(b).filter(|&y| a != b || x <= y) {
                if self.may_count(x, y) {
                    pairs[n] = (self.apart(x, y), x, y);
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

    fn are_single(&self, a: usize, b: usize) -> bool {
        self.parts[a].halves.is_none() && self.parts[b].halves.is_none()
    }

    /// At most the distance of any two vertices of the parts, squared.
    fn apart(&self, a: usize, b: usize) -> f64 {
        let single = self.are_single(a, b);
        let (a, b) = (&self.parts[a], &self.parts[b]);
        if single {
            return squared(from_to(self.vertices[a.first], self.vertices[b.first])).low();
        }
        let n = exactly(b.centre - a.centre);
        let between = from_to(exactly(a.centre), exactly(b.centre));
        let gap = (dot(between, n) - a.extent(n) - b.extent(n)) / length(n) - (a.radius + b.radius);
        gap.max(Interval::from(0.)).squared().low()
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
