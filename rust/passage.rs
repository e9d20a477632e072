//! Whether strands stay apart while all beads of a rope move straight from one place to another: all that
//! SONO's sweeps have done since the last list of neighbours, or a step of the polish.
//!
//! Two beads of different components, or at least k apart along one, are said to *count*. Let those
//! stay at least d apart all the time, let the edges of a component be s_0 to s_1 long, and let theta
//! be the largest angle by which it turns at a bead. **No edge meets another if**
//!
//! 1. **s_1^2 < 2 d^2**, and
//! 2. **theta < pi, and an arc of k + 1 edges does not close**: see [`stays_open`]; or, of a rope that
//!    is too rough for that, **edges at most k apart are further from each other, before or after,
//!    than their ends move**.
//!
//! Proof. Let two edges that are no neighbours meet, for the first time. If all four pairs of their
//! ends count, these are the corners of a convex quadrilateral whose sides are at least d long. One
//! of its angles is not acute, so the diagonal across from it, an edge, has at least the length
//! sqrt 2 d, against 1. If not, two of the ends are less than k apart, and the arc from the one edge
//! to the other has m <= k + 1 edges. Let u be the direction of its middle edge, or for even m that
//! halfway between the two in the middle. Edge r is off u by at most |r - (m - 1)/2| theta, so, if
//! that is at most pi for the outermost, its part along u is at least s_0 cos of this angle, or
//! s_1 cos where the cosine is negative. The arc from meeting point to meeting point consists of the
//! inner edges and parts of the two outer ones; it closes, so its parts along u must not add up to
//! more than 0, which is what 2 excludes for m = k + 1 and m = k. Taking two edges off an arc of
//! m + 2 takes off what is negative, or leaves only what is positive, so 2 holds for the shorter
//! ones as well. Neighbouring edges meet only where theta = pi.
//!
//! On a straight way the shortest distance of two beads is known, |v_(i+1) - v_i| and the second
//! differences are largest at one of its ends, being convex, and |b - a| >= 2 sin(theta/2) min(|a|, |b|)
//! bounds the angle between two edges.
//!
//! So no edges meet at any time of the way, neighbours at their bead only: the polygon is embedded all the
//! time, and the way is an isotopy. Places are numbers of 53 bits, between which the way is meant exactly;
//! what is computed of it is off by some 1e-15 of the lengths that it is made of, 3 radii at most for two
//! beads of a list, and k + 1 edges for an arc. `ROUNDING` of these is kept in hand in each comparison;
//! where an edge gets as short as `VANISHING`, so that digits cancel, nothing is taken as shown.

use std::f64::consts::PI;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::geometry::curve::Curve;
use crate::geometry::neighbours::Pair;
use crate::geometry::segments;

/// What the conditions are to have in hand, as a share of each: far more than rounding, far less than matters.
const ROUNDING: f64 = 1e-9;
/// The least square of an edge, as a share of the largest.
const VANISHING: f64 = 1e-4;

/// What has been shown of the moves of a rope.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Passages {
    /// Moves on which no strand passes another.
    pub shown: u64,
    /// Those of which this was not shown, and which were not made, or undone.
    pub refused: u64,
    /// The least [`margin`] of those shown, if there were any.
    pub margin: Option<f64>,
}

impl Passages {
    /// Counts a move that has this margin; returns whether it may be made.
    pub fn may(&mut self, margin: Option<f64>) -> bool {
        match margin {
            Some(found) => {
                self.shown += 1;
                self.margin = Some(self.margin.map_or(found, |least| least.min(found)));
            }
            None => self.refused += 1,
        }
        margin.is_some()
    }
}

/// By how much beads are further apart than it takes, sqrt 2 d/s_1, while they move straight from `before`
/// to where `curve` has them; `None` if a strand might pass another. Pairs that count are in `pairs`, or stay
/// `unlisted` apart; `least[c]` is k for component c.
pub fn margin(
    before: &[DVec3],
    curve: &Curve,
    least: &[usize],
    pairs: impl Iterator<Item = Pair>,
    unlisted: f64,
) -> Option<f64> {
    let after = curve.vertices();
    if !after.iter().all(|v| v.is_finite()) {
        return None;
    }
    let apart = pairs.fold(unlisted * unlisted, |apart, (i, j)| {
        let way = [before, after].map(|v| v[j as usize] - v[i as usize]);
        apart.min(shortest_squared(way))
    });
    curve.ranges().zip(least).try_fold(f64::MAX, |margin, (range, &k)| {
        let [before, after] = [before, after].map(|v| &v[range.clone()]);
        let edges = Edges::on_the_way(before, after);
        let found = (2. * apart / edges.longest).sqrt();
        let spare = ROUNDING * edges.longest.sqrt();
        let is_shown = found > 1. + ROUNDING
            && edges.shortest > VANISHING * edges.longest
            && edges.angle() < PI
            && (edges.stay_open(k) || near_edges_apart(before, after, k, spare));
        is_shown.then(|| margin.min(found))
    })
}

/// What the edges of a component are like on all of their way.
struct Edges {
    n: usize,
    /// The least and the largest squared length.
    shortest: f64,
    longest: f64,
    /// A bound on the square of 2 sin(theta/2).
    sharpest: f64,
}

impl Edges {
    fn on_the_way(before: &[DVec3], after: &[DVec3]) -> Self {
        let n = before.len();
        let way = |i: usize| [before, after].map(|v| v[if i + 1 == n { 0 } else { i + 1 }] - v[i]);
        let mut last = way(n - 1);
        let mut last_shortest = shortest_squared(last);
        let mut edges = Self { n, shortest: f64::MAX, longest: 0., sharpest: 0. };
        for next in (0..n).map(way) {
            let shortest = shortest_squared(next);
            edges.shortest = edges.shortest.min(shortest);
            edges.longest = next.iter().fold(edges.longest, |most, e| most.max(e.length_squared()));
            let bends = [0, 1].map(|end| (next[end] - last[end]).length_squared());
            let bend = bends[0].max(bends[1]) / shortest.min(last_shortest);
            edges.sharpest = edges.sharpest.max(bend);
            (last, last_shortest) = (next, shortest);
        }
        edges
    }

    /// The largest angle by which the component turns at a bead.
    fn angle(&self) -> f64 {
        2. * (0.5 * (1. + ROUNDING) * self.sharpest.sqrt()).asin()
    }

    /// Whether no arc of up to k + 1 of them closes.
    fn stay_open(&self, k: usize) -> bool {
        let (angle, ratio) = (self.angle(), (self.shortest / self.longest).sqrt());
        let edges = k.min(self.n - 1) + 1;
        stays_open(edges, angle, ratio) && stays_open(edges - 1, angle, ratio)
    }
}

/// Whether edges 2 to k apart on one component are further from each other than their ends move, and `spare`.
fn near_edges_apart(before: &[DVec3], after: &[DVec3], k: usize, spare: f64) -> bool {
    let n = before.len();
    let moved: Vec<_> = before.iter().zip(after).map(|(a, b)| a.distance(*b)).collect();
    let edge = |v: &[DVec3], i: usize| [v[i], v[(i + 1) % n]];
    let way = |i: usize| moved[i].max(moved[(i + 1) % n]);
    (0..n).all(|i| {
        (2..=k.min(n.saturating_sub(2))).all(|ahead| {
            let j = (i + ahead) % n;
            let apart = |v: &[DVec3]| segments::distance(edge(v, i), edge(v, j));
            apart(before).max(apart(after)) > way(i) + way(j) + spare
        })
    })
}

/// Whether an arc of `m` edges that turns by at most `angle` at each bead cannot close, the shortest
/// edge being `ratio` times the longest.
pub fn stays_open(m: usize, angle: f64, ratio: f64) -> bool {
    let middle = 0.5 * (m as f64 - 1.);
    let along = |r: usize| {
        let cosine = ((r as f64 - middle) * angle).cos();
        if cosine < 0. { cosine } else { ratio * cosine }
    };
    let inner: f64 = (1..m.saturating_sub(1)).map(along).sum();
    middle * angle <= PI && (m < 3 || inner + 2. * along(0).min(0.) > ROUNDING * m as f64)
}

/// The least squared length on the straight way from `a` to `b`.
fn shortest_squared([a, b]: [DVec3; 2]) -> f64 {
    let d = b - a;
    let (from, to) = (a.dot(d), b.dot(d));
    if from >= 0. {
        a.length_squared()
    } else if to <= 0. {
        b.length_squared()
    } else {
        a.length_squared() - from * from / d.length_squared()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use proptest::prelude::*;

    use super::*;
    use crate::beads::{SHORTEST_EDGE, least_index_distance, most_bend};

    /// A regular polygon of edges 1 in the plane, its vertices as `at` puts them.
    fn polygon(n: usize, at: impl Fn(DVec3) -> DVec3) -> Vec<DVec3> {
        let radius = 0.5 / (0.5 * TAU / n as f64).sin();
        let angle = |i: usize| TAU * i as f64 / n as f64;
        (0..n).map(|i| at(radius * DVec3::new(angle(i).cos(), angle(i).sin(), 0.))).collect()
    }

    #[test]
    fn arcs_that_close_are_told() {
        // A regular polygon of m edges closes, one that turns by less does not.
        for m in 3..40 {
            let angle = TAU / m as f64;
            assert!(!stays_open(m, 1.001 * angle, 1.), "{m}");
            assert!(stays_open(m, 0.98 * angle * (m - 1) as f64 / m as f64, 1.), "{m}");
            assert!(!stays_open(m, 0.9 * angle, 0.01), "{m}: but with edges so unequal it may");
        }
    }

    #[test]
    fn edges_and_bends_that_the_polish_allows_keep_arcs_open() {
        for step in 1..460 {
            let l = 0.005 * f64::from(step);
            let angle = 2. * (0.5 * most_bend(l) / (SHORTEST_EDGE * l)).asin();
            for k in [0, 1].map(|more| least_index_distance(l) + more) {
                assert!((k..=k + 1).all(|m| stays_open(m, angle, SHORTEST_EDGE)), "{l} {k}");
            }
        }
    }

    #[test]
    fn a_strand_that_passes_is_noticed() {
        // An edge of a square goes through one of another, whose beads are 1.9 away from its own.
        let square = |z: f64| {
            let corners = [(-1.3, -9., 9.), (-1.3, 9., 9.), (1.3, 0., z), (-1.3, 0., z)];
            corners.map(|(x, y, z)| DVec3::new(x, y, z)).to_vec()
        };
        let other = [(0., -1.3, 0.), (0., 1.3, 0.), (0., 9., -9.), (0., -9., -9.)];
        let other = other.map(|(x, y, z)| DVec3::new(x, y, z)).to_vec();
        let at = |z| Curve::from_components(vec![square(z), other.clone()]);
        let pairs: Vec<_> = (0..4).flat_map(|i| (4..8).map(move |j| (i, j))).collect();
        let (above, below) = (at(0.1), at(-0.1));
        assert!(margin(above.vertices(), &below, &[2, 2], pairs.iter().copied(), 2.).is_none());
        assert!(margin(below.vertices(), &above, &[2, 2], pairs.into_iter(), 2.).is_none());
    }

    #[test]
    fn beads_that_come_close_on_the_way_are_noticed() {
        // Two rings change places side by side: at both ends they are 5 apart, half-way they meet.
        let ring = |x: f64, y: f64| polygon(12, |v| v + DVec3::new(x, y, 0.));
        let at = |x: f64| Curve::from_components(vec![ring(x, 0.01), ring(-x, -0.01)]);
        let pairs: Vec<_> = (0..12).flat_map(|i| (12..24).map(move |j| (i, j))).collect();
        let apart = |from: f64, to: f64| {
            let pairs = pairs.iter().copied();
            margin(at(from).vertices(), &at(to), &[6, 6], pairs, f64::MAX).is_some()
        };
        assert!(apart(5., 4.9));
        assert!(!apart(5., -5.));
    }

    #[test]
    fn a_rough_rope_is_looked_at_edge_by_edge() {
        // A zigzag turns by far more than an arc may, but its edges stay away from each other.
        let rough = |z: f64| {
            let mut curve = polygon(24, |v| v);
            curve.iter_mut().step_by(2).for_each(|v| v.z += z);
            Curve::from_components(vec![curve])
        };
        let apart = |from: f64, to: f64| {
            margin(rough(from).vertices(), &rough(to), &[12], std::iter::empty(), 2.).is_some()
        };
        assert!(apart(0.5, 0.55));
        assert!(!apart(0.5, -0.6), "beads move further than edges are apart");
    }

    fn vector() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-1f64..1.).prop_map(DVec3::from)
    }

    proptest! {
        #[test]
        fn edges_that_pass_are_always_noticed(
            directions in prop::array::uniform2(vector()),
            ways in prop::array::uniform4(vector()),
            thirds in prop::array::uniform2(vector()),
            (along, across) in (0f64..1., 0f64..1.),
            when in 0f64..1.,
            (size, speed) in (0f64..3., 0f64..1.),
        ) {
            // Edges of two triangles meet in the origin.
            let [x, y] = directions.map(|direction| size * direction);
            let meeting = [-along * x, (1. - along) * x, -across * y, (1. - across) * y];
            let at = |t: f64| {
                let [a, b, c, d]: [DVec3; 4] =
                    std::array::from_fn(|k| meeting[k] + speed * (t - when) * ways[k]);
                let triangle = |p: DVec3, q: DVec3, third| vec![p, q, 0.5 * (p + q) + size * third];
                Curve::from_components(vec![triangle(a, b, thirds[0]), triangle(c, d, thirds[1])])
            };
            let pairs: Vec<_> = (0..3).flat_map(|i| (3..6).map(move |j| (i, j))).collect();
            prop_assert!(margin(at(0.).vertices(), &at(1.), &[2, 2], pairs.into_iter(), 2.).is_none());
        }
    }
}
