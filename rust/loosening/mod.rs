//! From any embedded polygon, however thin, to a loose one of the same type that holds a thick rope.
//!
//! 1. Vertices are removed as long as triangle moves allow it (the KMT reduction: K. Koniaris and
//!    M. Muthukumar, Phys. Rev. Lett. 66 (1991) 2211), the smallest triangles first, so that the
//!    rough shape is left until last. A few sticks are left, whose strands may all but touch.
//! 2. Edges repel each other. Each vertex in turn moves to where (sum of d^-4)^(1/4) times the
//!    length is less, d being the distances of edges and the diameters 2 R_i at bends; with a larger
//!    power this would be the ropelength. What has room then is removed, too.
//! 3. Long edges are halved, and the repulsion goes on.
//!
//! Every move is an isotopy, proved exactly ([`crate::geometry::sticks`]); steps are as long as the distance
//! of strands, so that a gap of 1e-6 of the size opens in some tens of sweeps.
//!
//! ```
//! // A square on a stalk of length 1,000,000.
//! use glam::DVec3;
//! let points = [(0., 0.), (1e6, 0.), (1e6, -1.), (1e6 + 1., 0.5), (1e6, 1.), (0., 0.1)];
//! let square = points.map(|(x, y)| DVec3::new(x, y, 0.));
//! let loose = sono::loosened(&sono::Curve::new(vec![square.to_vec()])?)?;
//! assert!(sono::measure(&loose).l_p < 20.);
//! # Ok::<(), sono::Error>(())
//! ```

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::time::{Duration, Instant};

use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::error::{Error, Result};
use crate::geometry::curve::{Curve, turning_angle};
use crate::geometry::embedded::check_embedded;
use crate::geometry::segments::closest;
use crate::geometry::sticks::Sticks;
use crate::invariants::projection::fewest_crossings;

/// Way of a shaken vertex as a share of the distance to what it might meet.
const SHAKE: f64 = 0.01;
/// Sweeps between two attempts to remove vertices, and to see how far the repulsion has fallen.
const SWEEPS: usize = 10;
/// The end of a level: it falls by less than this share, or after so many attempts.
const SETTLED: f64 = 0.01;
const ATTEMPTS: usize = 40;
/// How often edges are halved.
const HALVINGS: usize = 2;
/// Edges repel each other up to this multiple of the distance of the nearest.
const REACH: f64 = 8.;
/// Lengths of the steps that a vertex tries along the force, in units of that distance; then of those
/// in a random direction; and the shares of the way to the middle of its neighbours, for long edges.
const ALONG: [f64; 4] = [2., 0.8, 0.32, 0.13];
const RANDOM: [f64; 2] = [0.2, 0.08];
const INWARDS: [f64; 2] = [0.9, 0.5];
/// Crossings that are left at most of what can be loosened.
const MOST_CROSSINGS: usize = 20_000;

/// The same curve with as few vertices as triangle moves leave; its strands may all but touch.
///
/// ```
/// use glam::DVec3;
/// let circle = (0..100).map(|i| DVec3::new((0.0628 * i as f64).cos(), (0.0628 * i as f64).sin(), 0.));
/// let simple = sono::simplified(&sono::Curve::new(vec![circle.collect()])?)?;
/// assert_eq!(simple.n(), 3);
/// # Ok::<(), sono::Error>(())
/// ```
///
/// # Errors
/// [`Error::SelfCrossing`].
pub fn simplified(curve: &Curve) -> Result<Curve> {
    let mut loosening = Loosening::new(curve)?;
    while matches!(loosening.work, Work::Shake(_) | Work::Reduce(..)) {
        loosening.step()?;
    }
    Ok(loosening.curve())
}

/// The curve as a [`Loosening`] leaves it.
///
/// # Errors
/// [`Error::SelfCrossing`], [`Error::TooEntangled`].
pub fn loosened(curve: &Curve) -> Result<Curve> {
    let mut loosening = Loosening::new(curve)?;
    while !loosening.advance(Duration::MAX)? {}
    Ok(loosening.curve())
}

/// A polygon on its way to be loose.
pub struct Loosening {
    sticks: Sticks,
    work: Work,
    rng: Pcg64Mcg,
    /// How often edges have been halved, and attempts since.
    halvings: usize,
    attempts: usize,
    /// Sum of the repulsion of all edges and bends, and (..)^(1/4) times the length at the last attempt.
    sum: f64,
    before: f64,
}

/// What is done next.
enum Work {
    /// Shake the next vertex; the places of those before.
    Shake(Vec<DVec3>),
    /// Remove vertices, those of the smallest triangles first; how many there were.
    Reduce(BinaryHeap<Reverse<(u64, usize)>>, usize),
    /// So many sweeps.
    Repel(usize),
    Done,
}

impl Loosening {
    /// Begins with any embedded curve.
    ///
    /// # Errors
    /// [`Error::SelfCrossing`].
    pub fn new(curve: &Curve) -> Result<Self> {
        check_embedded(curve)?;
        Ok(Self {
            sticks: Sticks::new(curve),
            work: Work::Shake(vec![]),
            rng: Pcg64Mcg::seed_from_u64(0),
            halvings: 0,
            attempts: 0,
            sum: 0.,
            before: f64::MAX,
        })
    }

    /// Works for about `budget`, unless done before; returns whether it is.
    ///
    /// # Errors
    /// [`Error::TooEntangled`].
    pub fn advance(&mut self, budget: Duration) -> Result<bool> {
        let start = Instant::now();
        while !self.is_done() && start.elapsed() < budget {
            self.step()?;
        }
        Ok(self.is_done())
    }

    fn is_done(&self) -> bool {
        matches!(self.work, Work::Done)
    }

    /// The polygon as it is; all the time it has the type of the given one.
    pub fn curve(&self) -> Curve {
        self.sticks.curve()
    }

    /// A small part of the work.
    fn step(&mut self) -> Result<()> {
        match &mut self.work {
            Work::Shake(places) => {
                places.push(shaken(&self.sticks, places.len(), &mut self.rng));
                if places.len() == self.sticks.n() {
                    self.sticks.set_points(std::mem::take(places));
                    self.work = triangles(&self.sticks);
                }
            }
            Work::Reduce(heap, before) => {
                if let Some(Reverse((bits, i))) = heap.pop() {
                    if area(&self.sticks, i) == Some(bits) {
                        let beside = [self.sticks.prev(i), self.sticks.next(i)];
                        if self.sticks.remove(i) {
                            heap.extend(beside.iter().filter_map(|&j| entry(&self.sticks, j)));
                        }
                    }
                } else if self.sticks.n() < *before {
                    self.work = triangles(&self.sticks);
                } else {
                    self.work = self.plan()?;
                }
            }
            Work::Repel(0) if self.halvings == 0 => self.work = triangles(&self.sticks),
            Work::Repel(0) => self.work = self.plan()?,
            Work::Repel(sweeps) => {
                *sweeps -= 1;
                self.sweep();
            }
            Work::Done => {}
        }
        Ok(())
    }

    /// Goes on as long as it is worth it, then with halved edges.
    fn plan(&mut self) -> Result<Work> {
        if self.attempts + self.halvings == 0 {
            let limit = MOST_CROSSINGS;
            if fewest_crossings(&self.sticks.curve(), limit) > limit {
                return Err(Error::TooEntangled { limit });
            }
        }
        let now = self.goal(self.sum, self.sticks.length());
        let settled = self.attempts > 1 && now > (1. - SETTLED) * self.before;
        self.before = now;
        self.attempts += 1;
        if settled || self.attempts == ATTEMPTS {
            if self.halvings == HALVINGS {
                return Ok(Work::Done);
            }
            self.halvings += 1;
            self.attempts = 0;
            self.sticks = Sticks::new(&halved(&self.sticks.curve()));
        }
        Ok(Work::Repel(SWEEPS))
    }

    /// What is to be lowered.
    fn goal(&self, sum: f64, length: f64) -> f64 {
        sum.powf(0.25) * length
    }

    /// Moves each vertex to where there is less repulsion, or the polygon is shorter.
    fn sweep(&mut self) {
        let slots: Vec<_> = self.sticks.slots().collect();
        // Each pair of edges and each bend is felt by several vertices.
        self.sum = slots.iter().map(|&i| Around::new(&self.sticks, i).own(&self.sticks)).sum();
        let mut length = self.sticks.length();
        for i in slots {
            let around = Around::new(&self.sticks, i);
            let [place, a, b] = [i, around.a, around.b].map(|j| self.sticks.point(j));
            let arms = |p: DVec3| p.distance(a) + p.distance(b);
            let (repulsion, force) = around.felt(&self.sticks, place);
            let shortening = (a - place).normalize_or_zero() + (b - place).normalize_or_zero();
            let along = (force / (4. * self.sum) + shortening / length).normalize_or_zero();
            let goal = self.goal(self.sum, length);
            let inwards = INWARDS.map(|share| share * (0.5 * (a + b) - place));
            let inwards = inwards.into_iter().filter(|_| arms(place) > 2. * REACH * around.nearest);
            let random = RANDOM.map(|step| step * around.nearest * self.direction());
            let steps = ALONG.map(|step| step * around.nearest * along).into_iter().chain(random);
            for step in inwards.chain(steps) {
                let to = place + step;
                let sum = self.sum - repulsion + around.felt(&self.sticks, to).0;
                let longer = length - arms(place) + arms(to);
                if self.goal(sum, longer) < goal && self.sticks.shift(i, to) {
                    (self.sum, length) = (sum, longer);
                    break;
                }
            }
        }
    }

    fn direction(&mut self) -> DVec3 {
        let mut coordinate = || self.rng.random_range(-1. ..1.);
        DVec3::new(coordinate(), coordinate(), coordinate())
    }
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

/// Where a vertex gets by a random step so small that no edges meet on the way; then no four vertices
/// are left in one plane, where what touches could not be told from what passes.
fn shaken(sticks: &Sticks, i: usize, rng: &mut Pcg64Mcg) -> DVec3 {
    let most = SHAKE / 3f64.sqrt() * sticks.clearance(i).min(sticks.clearance(sticks.prev(i)));
    sticks.point(i) + most * DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1. ..1.)))
}

/// All triangles, the smallest first.
fn triangles(sticks: &Sticks) -> Work {
    Work::Reduce(sticks.slots().filter_map(|i| entry(sticks, i)).collect(), sticks.n())
}

fn entry(sticks: &Sticks, i: usize) -> Option<Reverse<(u64, usize)>> {
    Some(Reverse((area(sticks, i)?, i)))
}

/// The square of the triangle's area at a vertex that is there; bits of positive numbers are in their order.
fn area(sticks: &Sticks, i: usize) -> Option<u64> {
    sticks.is_there(i).then(|| {
        let [a, b] = [sticks.prev(i), sticks.next(i)].map(|j| sticks.point(j) - sticks.point(i));
        a.cross(b).length_squared().to_bits()
    })
}

/// The same polygon with a vertex amid each edge that is longer than the mean.
fn halved(curve: &Curve) -> Curve {
    let mean = curve.length() / curve.n() as f64;
    let component = |c: usize| {
        let v = curve.component(c);
        let mut halved = Vec::with_capacity(2 * v.len());
        for (i, &from) in v.iter().enumerate() {
            let to = v[(i + 1) % v.len()];
            halved.push(from);
            if from.distance(to) > mean {
                halved.push(0.5 * (from + to));
            }
        }
        halved
    };
    Curve::from_components((0..curve.components()).map(component).collect())
}
