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

use glam::DVec3;

use crate::geometry::curve::Curve;
use crate::geometry::grid::Grid;
use crate::geometry::segments;
use crate::geometry::separation::{Arc, Separation, cut_into_arcs};

/// Calls `visit(i, j, distance squared)` for each pair `i < j` that counts and is closer than
/// `reach`; what `visit` returns is the reach from there on (at most the one before).
pub fn for_each_close_pair(
    curve: &Curve,
    separation: &Separation,
    reach: f64,
    visit: impl FnMut(usize, usize, f64) -> f64,
) {
    let arclength = curve.arclengths();
    let arcs = cut_into_arcs(curve, &arclength, 0.5 * reach);
    let mut search = Search { vertices: curve.vertices(), arclength, separation, reach, visit };
    let middles: Vec<_> = arcs.iter().map(|arc| search.middle(arc)).collect();
    let grid = Grid::new(&middles, 1.5 * reach);
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
            if a.n() > 1 {
                let (left, right) = a.halves();
                self.compare(left, left);
                self.compare(left, right);
                self.compare(right, right);
            }
        } else if a.n().max(b.n()) <= 4 {
            self.compare_vertices(&a, &b);
        } else if self.may_come_close(&a, &b) {
            if a.n() >= b.n() {
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
