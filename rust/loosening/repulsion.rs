//! Edges and bends that repel each other, each by its distance to the power -4.

use glam::DVec3;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::geometry::curve::turning_angle;
use crate::geometry::segments::closest;
use crate::geometry::sticks::Sticks;

/// Edges repel each other up to this multiple of the distance of the nearest.
const REACH: f64 = 8.;
/// Lengths of the steps that a vertex tries along the force, in units of that distance; then of those
/// in a random direction; and the shares of the way to the middle of its neighbours, for long edges.
const ALONG: [f64; 4] = [2., 0.8, 0.32, 0.13];
const RANDOM: [f64; 2] = [0.2, 0.08];
const INWARDS: [f64; 2] = [0.9, 0.5];

/// Lowers the repulsion of a polygon, (sum of all)^(1/4) times the length.
#[derive(Default)]
pub struct Repulsion {
    /// That of all edges and bends.
    sum: f64,
}

impl Repulsion {
    /// What is to be lowered, of a polygon of this length.
    pub fn goal(&self, length: f64) -> f64 {
        goal(self.sum, length)
    }

    /// Moves each vertex to where there is less repulsion, or the polygon is shorter.
    pub fn sweep(&mut self, sticks: &mut Sticks, rng: &mut Pcg64Mcg) {
        let slots: Vec<_> = sticks.slots().collect();
        // Each pair of edges and each bend is felt by several vertices.
        self.sum = slots.iter().map(|&i| Around::new(sticks, i).own(sticks)).sum();
        let mut length = sticks.length();
        for i in slots {
            self.shift(i, sticks, &mut length, rng);
        }
    }

    /// Moves a vertex of a polygon whose `length` this is.
    fn shift(&mut self, i: usize, sticks: &mut Sticks, length: &mut f64, rng: &mut Pcg64Mcg) {
        let around = Around::new(sticks, i);
        let [place, a, b] = [i, around.a, around.b].map(|j| sticks.point(j));
        let arms = |p: DVec3| p.distance(a) + p.distance(b);
        let (repulsion, force) = around.felt(sticks, place);
        let shortening = (a - place).normalize_or_zero() + (b - place).normalize_or_zero();
        let along = (force / (4. * self.sum) + shortening / *length).normalize_or_zero();
        let before = self.goal(*length);
        let inwards = INWARDS.map(|share| share * (0.5 * (a + b) - place));
        let inwards = inwards.into_iter().filter(|_| arms(place) > 2. * REACH * around.nearest);
        let random = RANDOM.map(|step| step * around.nearest * direction(rng));
        let steps = ALONG.map(|step| step * around.nearest * along).into_iter().chain(random);
        for step in inwards.chain(steps) {
            let to = place + step;
            let sum = self.sum - repulsion + around.felt(sticks, to).0;
            let then = *length - arms(place) + arms(to);
            if goal(sum, then) < before && sticks.shift(i, to) {
                (self.sum, *length) = (sum, then);
                break;
            }
        }
    }
}

fn goal(sum: f64, length: f64) -> f64 {
    sum.powf(0.25) * length
}

fn direction(rng: &mut Pcg64Mcg) -> DVec3 {
    let mut coordinate = || rng.random_range(-1. ..1.);
    DVec3::new(coordinate(), coordinate(), coordinate())
}

/// A vertex, its neighbours, and what repels its edges.
struct Around {
    i: usize,
    a: usize,
    b: usize,
    /// Distance of its edges from what they might meet.
    nearest: f64,
    /// Edges within reach.
    near: Vec<usize>,
}

impl Around {
    fn new(sticks: &Sticks, i: usize) -> Self {
        let (a, b) = (sticks.prev(i), sticks.next(i));
        let nearest = sticks.clearance(a).min(sticks.clearance(i));
        let near = sticks.near([a, i, b], REACH * nearest);
        Self { i, a, b, nearest, near }
    }

    /// Repulsion that the vertex feels at a place, and the force.
    fn felt(&self, sticks: &Sticks, place: DVec3) -> (f64, DVec3) {
        let Self { i, a, b, .. } = *self;
        let (before, after) = (sticks.prev(a), sticks.next(b));
        let [p, q, r, s] = [before, a, b, after].map(|j| sticks.point(j));
        let mut sum = bend(p, q, place) + bend(q, place, r) + bend(place, r, s);
        let mut force = DVec3::ZERO;
        for &j in &self.near {
            let other = sticks.edge(j);
            let edges = [(q, j != before && j != a && j != i), (r, j != a && j != i && j != b)];
            for (end, _) in edges.into_iter().filter(|(_, counts)| *counts) {
                let (repulsion, apart, share) = repulsion([end, place], other);
                sum += repulsion;
                force += share * repulsion * 4. / apart.length_squared() * apart;
            }
        }
        (sum, force)
    }

    /// The share of the sum that belongs to this vertex: its bend, and half of what its edge feels.
    fn own(&self, sticks: &Sticks) -> f64 {
        let Self { i, a, b, .. } = *self;
        let others = self.near.iter().filter(|&&j| j != a && j != i && j != b);
        let felt = others.map(|&j| repulsion(sticks.edge(i), sticks.edge(j)).0).sum::<f64>();
        0.5 * felt + bend(sticks.point(a), sticks.point(i), sticks.point(b))
    }
}

/// d^-4 for the distance d of two edges, the vector of that distance, and the share in it of the
/// first edge's second end.
fn repulsion(edge: [DVec3; 2], other: [DVec3; 2]) -> (f64, DVec3, f64) {
    let [s, t] = closest(edge, other);
    let apart = edge[0].lerp(edge[1], s) - other[0].lerp(other[1], t);
    (apart.length_squared().powi(-2), apart, s)
}

/// (2 R)^-4 for the radius R of the arc that fits into the corner at v.
fn bend(a: DVec3, v: DVec3, b: DVec3) -> f64 {
    let (before, after) = (v - a, b - v);
    let tangent = 0.5 * before.length().min(after.length());
    (0.5 * (0.5 * turning_angle(before, after)).tan() / tangent).powi(4)
}
