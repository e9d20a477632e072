//! Which vertices come close to which: a spatial hash of arcs, halved down to single vertices.
//!
//! A fine rope has hundreds of vertices within one radius, so hashing vertices would cost their
//! square. Instead the curve is cut into arcs about as long as the reach, the arcs are hashed, and
//! pairs of arcs that may come close are halved until single vertices are left. No pair is missed:
//!
//! - An arc of length S lies in the ball of radius S/2 about the midpoint m of its ends, because
//!   for each of its points |p - m| <= (|p - a| + |p - b|)/2 <= S/2.
//! - It also lies within sqrt(S^2 - c^2)/2 of its chord of length c. For a smooth arc that is
//!   second order in S, so along a line of contact few pairs of arcs are left at each halving.
//! - Two arcs that come closer than `reach` therefore have midpoints closer than
//!   reach + (S + S')/2 <= reach + longest arc =: side of a cell, so they are found in the same or
//!   in touching cells.
//!
//! ```text
//!   cell    cell    cell
//! +-------+-------+-------+      x  midpoint of an arc
//! |       |   o   |       |      o  midpoints of arcs it is compared with
//! |   o   | x     |   o   |
//! +-------+-------+-------+
//! ```
//!
//! Vertices near each other along the curve are always close; which of them count is what
//! [`Separation`] says.

use glam::{DVec3, IVec3};

use crate::geometry::curve::Curve;
use crate::geometry::segments;

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
        let position = arclengths(curve);
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
    fn counts(&self, curve: &Curve, i: usize, j: usize) -> bool {
        let c = curve.component_of(i);
        c != curve.component_of(j) || self.counts_within(c, i, j)
    }

    fn counts_within(&self, c: usize, i: usize, j: usize) -> bool {
        let forth = self.position[j] - self.position[i];
        forth.min(self.around[c] - forth) >= self.least[c]
    }

    /// Whether no pair of an earlier arc `a` and a later (or the same) arc `b` counts.
    fn none_counts(&self, a: &Arc, b: &Arc) -> bool {
        let longest_forth = self.position[b.last] - self.position[a.first];
        let longest_back =
            self.around[a.component] - (self.position[b.first] - self.position[a.last]);
        longest_forth.min(longest_back) < self.least[a.component]
    }
}

/// Vertices `first..=last` of one component; does not wrap around its end.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Arc {
    component: usize,
    first: usize,
    last: usize,
}

impl Arc {
    fn halves(self) -> (Self, Self) {
        let middle = (self.first + self.last) / 2;
        (Self { last: middle, ..self }, Self { first: middle + 1, ..self })
    }

    fn len(&self) -> usize {
        self.last - self.first + 1
    }
}

/// Calls `visit(i, j, distance squared)` for each pair `i < j` that counts and is closer than
/// `reach`; what `visit` returns is the reach from there on (at most the one before).
pub fn for_each_close_pair(
    curve: &Curve,
    separation: &Separation,
    reach: f64,
    visit: impl FnMut(usize, usize, f64) -> f64,
) {
    let arclength = arclengths(curve);
    let arcs = cut_into_arcs(curve, &arclength, 0.5 * reach);
    let mut search = Search { vertices: curve.vertices(), arclength, separation, reach, visit };
    let grid = Grid::new(&arcs, &search, 1.5 * reach);
    for (k, &a) in arcs.iter().enumerate() {
        grid.for_each_near(k, |l| search.compare(a, arcs[l]));
    }
}

/// Two vertices, the first before the second.
pub type Pair = (u32, u32);

/// All pairs that count and are closer than `reach`, sorted.
pub fn close_pairs(curve: &Curve, separation: &Separation, reach: f64) -> Vec<Pair> {
    let mut pairs = vec![];
    for_each_close_pair(curve, separation, reach, |i, j, _| {
        pairs.push((i as u32, j as u32));
        reach
    });
    pairs.sort_unstable();
    pairs
}

/// The least distance of a pair that counts; `None` where no pair counts.
pub fn closest_distance(curve: &Curve, separation: &Separation) -> Option<f64> {
    let mut closest = None;
    // A little more than the distance of some pair, so that pair itself is found if it is closest;
    // and not so little that cells could no longer be counted.
    let reach = (1.01 * some_distance(curve, separation)).max(1e-9 * curve.length());
    for_each_close_pair(curve, separation, reach, |_, _, squared| {
        let distance = squared.sqrt();
        closest = Some(distance);
        distance
    });
    closest
}

/// The least distance among pairs of about a hundred vertices; where none counts, the curve's length.
fn some_distance(curve: &Curve, separation: &Separation) -> f64 {
    let few: Vec<_> = (0..curve.n()).step_by(curve.n().div_ceil(100)).collect();
    let mut least = curve.length();
    for (k, &i) in few.iter().enumerate() {
        for &j in &few[k + 1..] {
            let distance = curve.vertices()[i].distance(curve.vertices()[j]);
            if distance < least && separation.counts(curve, i, j) {
                least = distance;
            }
        }
    }
    least
}

struct Search<'a, F> {
    vertices: &'a [DVec3],
    arclength: Vec<f64>,
    separation: &'a Separation,
    reach: f64,
    visit: F,
}

impl<F: FnMut(usize, usize, f64) -> f64> Search<'_, F> {
    fn ends(&self, arc: &Arc) -> [DVec3; 2] {
        [self.vertices[arc.first], self.vertices[arc.last]]
    }

    fn arclength(&self, arc: &Arc) -> f64 {
        self.arclength[arc.last] - self.arclength[arc.first]
    }

    fn middle(&self, arc: &Arc) -> DVec3 {
        let [from, to] = self.ends(arc);
        0.5 * (from + to)
    }

    /// How far an arc gets from its chord at most: half the small axis of the ellipsoid of points
    /// whose distances to its ends add up to its length.
    fn bulge(&self, arc: &Arc) -> f64 {
        let [from, to] = self.ends(arc);
        let squared = self.arclength(arc).powi(2) - from.distance_squared(to);
        0.5 * squared.max(0.).sqrt()
    }

    fn may_come_close(&self, a: &Arc, b: &Arc) -> bool {
        let balls = self.reach + 0.5 * (self.arclength(a) + self.arclength(b));
        self.middle(a).distance_squared(self.middle(b)) < balls * balls
            && segments::distance(self.ends(a), self.ends(b))
                < self.reach + self.bulge(a) + self.bulge(b)
    }

    /// Visits the close pairs of two arcs, `a` not after `b`.
    fn compare(&mut self, a: Arc, b: Arc) {
        if a.component == b.component && self.separation.none_counts(&a, &b) {
            return;
        }
        if a == b {
            if a.len() > 1 {
                let (left, right) = a.halves();
                self.compare(left, left);
                self.compare(left, right);
                self.compare(right, right);
            }
        } else if a.len().max(b.len()) <= 4 {
            self.compare_vertices(&a, &b);
        } else if self.may_come_close(&a, &b) {
            if a.len() >= b.len() {
                let (left, right) = a.halves();
                self.compare(left, b);
                self.compare(right, b);
            } else {
                let (left, right) = b.halves();
                self.compare(a, left);
                self.compare(a, right);
            }
        }
    }

    fn compare_vertices(&mut self, a: &Arc, b: &Arc) {
        for i in a.first..=a.last {
            for j in b.first..=b.last {
                let squared = self.vertices[i].distance_squared(self.vertices[j]);
                let counts =
                    a.component != b.component || self.separation.counts_within(a.component, i, j);
                if squared < self.reach * self.reach && counts {
                    self.reach = self.reach.min((self.visit)(i, j, squared));
                }
            }
        }
    }
}

/// Arclength of each vertex from the start of its component.
fn arclengths(curve: &Curve) -> Vec<f64> {
    let mut arclengths = Vec::with_capacity(curve.n());
    for c in 0..curve.components() {
        let mut at = 0.;
        arclengths.extend(curve.edge_lengths(c).map(|s| {
            at += s;
            at - s
        }));
    }
    arclengths
}

fn cut_into_arcs(curve: &Curve, arclength: &[f64], longest: f64) -> Vec<Arc> {
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

/// Spatial hash of points: buckets chained through `next`, latest entry first.
struct Grid {
    cells: Vec<IVec3>,
    heads: Vec<u32>,
    next: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl Grid {
    fn new<F: FnMut(usize, usize, f64) -> f64>(
        arcs: &[Arc],
        search: &Search<F>,
        side: f64,
    ) -> Self {
        let middles: Vec<_> = arcs.iter().map(|a| search.middle(a)).collect();
        // Cells count from the corner of the curve's box, so that a far origin costs no digits.
        let corner = middles.iter().fold(DVec3::INFINITY, |low, m| low.min(*m));
        let cells = middles.iter().map(|m| ((m - corner) / side).floor().as_ivec3()).collect();
        let mut grid = Self {
            heads: vec![NONE; (2 * arcs.len()).next_power_of_two()],
            next: vec![NONE; arcs.len()],
            cells,
        };
        for k in 0..arcs.len() {
            let bucket = grid.bucket(grid.cells[k]);
            grid.next[k] = grid.heads[bucket];
            grid.heads[bucket] = k as u32;
        }
        grid
    }

    fn bucket(&self, cell: IVec3) -> usize {
        let hash = (cell.x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
            ^ (cell.y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f)
            ^ (cell.z as u64).wrapping_mul(0x1656_67b1_9e37_79f9);
        (hash >> 20) as usize & (self.heads.len() - 1)
    }

    /// Calls `visit` for entry `k` itself and each later one in the 27 cells around it.
    fn for_each_near(&self, k: usize, mut visit: impl FnMut(usize)) {
        for offset in 0..27 {
            let step = IVec3::new(offset % 3 - 1, offset / 3 % 3 - 1, offset / 9 - 1);
            let cell = self.cells[k] + step;
            let mut l = self.heads[self.bucket(cell)];
            // Entries are chained latest first, so the rest of a chain is earlier than k.
            while l != NONE && l as usize >= k {
                if self.cells[l as usize] == cell {
                    visit(l as usize);
                }
                l = self.next[l as usize];
            }
        }
    }
}
