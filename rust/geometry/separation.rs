//! Which pairs of vertices count, by how far apart they are along the curve.

use crate::geometry::curve::Curve;

/// How far apart along the curve two vertices must be to count as a pair: by arclength (the
/// measures) or by index distance (the engines). Vertices of different components always count.
#[derive(Debug, Clone)]
pub struct Separation {
    /// Position of each vertex along its component.
    position: Vec<f64>,
    /// Once around each component, in the same unit.
    around: Vec<f64>,
    /// Smallest separation that counts, for each component.
    least: Vec<f64>,
}

impl Separation {
    /// Pairs at least `least[c]` apart by arclength along component `c`.
    pub fn by_arclength(curve: &Curve, least: Vec<f64>) -> Self {
        let position = curve.arclengths();
        let around = (0..curve.components()).map(|c| curve.component_length(c)).collect();
        Self { position, around, least }
    }

    /// Pairs with an index distance of at least `least[c]`.
    pub fn by_index(curve: &Curve, least: &[usize]) -> Self {
        Self {
            position: curve.ranges().flat_map(|r| (0..r.len()).map(|i| i as f64)).collect(),
            around: curve.ranges().map(|r| r.len() as f64).collect(),
            least: least.iter().map(|&k| k as f64).collect(),
        }
    }

    /// Whether `i` < `j` count as a pair.
    pub fn counts(&self, curve: &Curve, i: usize, j: usize) -> bool {
        let c = curve.component_of(i);
        c != curve.component_of(j) || self.counts_within(c, i, j)
    }

    /// The same for two vertices of component `c`.
    pub fn counts_within(&self, c: usize, i: usize, j: usize) -> bool {
        let forth = self.position[j] - self.position[i];
        forth.min(self.around[c] - forth) >= self.least[c]
    }

    /// Whether no pair of an earlier arc `a` and a later (or the same) arc `b` counts.
    pub fn none_counts(&self, a: &Arc, b: &Arc) -> bool {
        let longest_forth = self.position[b.last] - self.position[a.first];
        let longest_back =
            self.around[a.component] - (self.position[b.first] - self.position[a.last]);
        longest_forth.min(longest_back) < self.least[a.component]
    }
}

/// Vertices `first..=last` of one component; does not wrap around its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// Whose vertices they are.
    pub component: usize,
    /// The first of them.
    pub first: usize,
    /// The last.
    pub last: usize,
}

impl Arc {
    /// Both halves of an arc of two vertices or more.
    pub fn halves(self) -> (Self, Self) {
        let middle = (self.first + self.last) / 2;
        (Self { last: middle, ..self }, Self { first: middle + 1, ..self })
    }

    /// Number of vertices.
    pub fn n(&self) -> usize {
        self.last - self.first + 1
    }
}

/// The whole curve in arcs of at most `longest`, or of one vertex; `arclength` is that of each vertex.
pub fn cut_into_arcs(curve: &Curve, arclength: &[f64], longest: f64) -> Vec<Arc> {
    let mut arcs = Vec::new();
    for (component, range) in curve.ranges().enumerate() {
        let mut first = range.start;
        for i in range.clone() {
            if i + 1 == range.end || arclength[i + 1] - arclength[first] > longest {
                arcs.push(Arc { component, first, last: i });
                first = i + 1;
            }
        }
    }
    arcs
}
