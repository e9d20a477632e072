//! A tree of axis-parallel boxes along a curve: what may come close is found in a few steps.

use glam::DVec3;

/// An axis-parallel box.
#[derive(Debug, Clone, Copy)]
pub struct Span {
    low: DVec3,
    high: DVec3,
}

impl Span {
    /// The box of nothing.
    pub const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    /// The box around some points.
    pub fn of(points: &[DVec3]) -> Self {
        points
            .iter()
            .fold(Self::EMPTY, |span, &p| Self { low: span.low.min(p), high: span.high.max(p) })
    }

    /// A box larger by so much on all sides.
    pub fn grown(self, by: f64) -> Self {
        Self { low: self.low - by, high: self.high + by }
    }

    fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn meets(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    fn distance_squared(&self, other: &Self) -> f64 {
        (other.low - self.high).max(self.low - other.high).max(DVec3::ZERO).length_squared()
    }
}

/// The boxes of edges, and of neighbouring boxes two by two, up to one that holds all.
#[derive(Debug, Clone)]
pub struct Tree {
    /// Node k has the children 2k and 2k + 1; the leaves come last.
    nodes: Vec<Span>,
    first_leaf: usize,
}

impl Tree {
    /// The tree of these boxes, which are numbered from 0.
    pub fn new(leaves: impl ExactSizeIterator<Item = Span>) -> Self {
        let first_leaf = leaves.len().next_power_of_two();
        let mut nodes = vec![Span::EMPTY; 2 * first_leaf];
        nodes[first_leaf..].iter_mut().zip(leaves).for_each(|(node, leaf)| *node = leaf);
        for k in (1..first_leaf).rev() {
            nodes[k] = nodes[2 * k].union(nodes[2 * k + 1]);
        }
        Self { nodes, first_leaf }
    }

    /// Gives a leaf another box.
    pub fn set(&mut self, leaf: usize, span: Span) {
        let mut k = self.first_leaf + leaf;
        self.nodes[k] = span;
        while k > 1 {
            k /= 2;
            self.nodes[k] = self.nodes[2 * k].union(self.nodes[2 * k + 1]);
        }
    }

    /// The least `distance` of a leaf, at most `least`, where that of its box from `span` is a bound.
    pub fn nearest(
        &self,
        span: &Span,
        mut least: f64,
        mut distance: impl FnMut(usize) -> f64,
    ) -> f64 {
        let far = |k: usize| self.nodes[k].distance_squared(span);
        let mut todo = vec![(far(1), 1)];
        while let Some((squared, k)) = todo.pop() {
            if squared >= least * least {
                continue;
            }
            if k < self.first_leaf {
                let (one, other) = ((far(2 * k), 2 * k), (far(2 * k + 1), 2 * k + 1));
                todo.extend(if one.0 < other.0 { [other, one] } else { [one, other] });
            } else {
                least = least.min(distance(k - self.first_leaf));
            }
        }
        least
    }

    /// Whether `test` holds for a leaf whose box meets `span`.
    pub fn any(&self, span: &Span, mut test: impl FnMut(usize) -> bool) -> bool {
        self.any_below(1, span, &mut test)
    }

    fn any_below(&self, k: usize, span: &Span, test: &mut impl FnMut(usize) -> bool) -> bool {
        self.nodes[k].meets(span)
            && if k < self.first_leaf {
                self.any_below(2 * k, span, test) || self.any_below(2 * k + 1, span, test)
            } else {
                test(k - self.first_leaf)
            }
    }
}
