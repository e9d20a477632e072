//! From any embedded polygon, however thin, to a loose one of the same type that holds a thick rope.
//! Imports `geometry` and `invariants`.
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
//! `reduction` does 1, `repulsion` 2, and the loop is here.
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

mod reduction;
mod repulsion;

use std::time::{Duration, Instant};

use glam::DVec3;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use crate::error::{Error, Result};
use crate::geometry::curve::Curve;
use crate::geometry::embedded::check_embedded;
use crate::geometry::sticks::{Moves, Sticks};
use crate::invariants::projection::fewest_crossings;
use reduction::{Reduction, shaken};
use repulsion::Repulsion;

/// Sweeps between two attempts to remove vertices, and to see how far the repulsion has fallen.
const SWEEPS: usize = 10;
/// The end of a level: it falls by less than this share, or after so many attempts.
const SETTLED: f64 = 0.01;
const ATTEMPTS: usize = 40;
/// How often edges are halved.
const HALVINGS: usize = 2;
/// Clearance of an edge that is halved, in units of rounding.
const MUCH: f64 = 100.;
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
    while matches!(loosening.work, Work::Shake(_) | Work::Reduce(_)) {
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
    repulsion: Repulsion,
    /// The repulsion at the last attempt.
    before: f64,
}

/// What is done next.
enum Work {
    /// Shake the next vertex; the places of those before.
    Shake(Vec<DVec3>),
    Reduce(Reduction),
    /// So many sweeps.
    Repel(usize),
    Done,
}

impl Loosening {
    /// Begins with any embedded curve, in any unit.
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
            repulsion: Repulsion::default(),
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

    /// How many moves it took so far.
    pub fn moves(&self) -> Moves {
        self.sticks.moves()
    }

    /// A small part of the work.
    fn step(&mut self) -> Result<()> {
        let Self { sticks, rng, .. } = self;
        match &mut self.work {
            Work::Shake(places) if places.len() < sticks.n() => {
                places.push(shaken(sticks, places.len(), rng));
            }
            Work::Shake(places) => {
                sticks.set_points(std::mem::take(places));
                self.work = Work::Reduce(Reduction::new(sticks));
            }
            Work::Reduce(reduction) => {
                if !reduction.step(sticks) {
                    self.work = self.plan()?;
                }
            }
            Work::Repel(0) if self.halvings == 0 => {
                self.work = Work::Reduce(Reduction::new(sticks));
            }
            Work::Repel(0) => self.work = self.plan()?,
            Work::Repel(sweeps) => {
                *sweeps -= 1;
                self.repulsion.sweep(sticks, rng);
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
        let now = self.repulsion.goal(self.sticks.length());
        let settled = self.attempts > 1 && now > (1. - SETTLED) * self.before;
        self.before = now;
        self.attempts += 1;
        if settled || self.attempts == ATTEMPTS {
            if self.halvings == HALVINGS {
                return Ok(Work::Done);
            }
            self.halvings += 1;
            self.attempts = 0;
            self.sticks = Sticks::after(&self.sticks, &halved(&self.sticks));
        }
        Ok(Work::Repel(SWEEPS))
    }
}

/// The same polygon with a vertex amid each edge that is longer than the mean. Rounding puts it beside the
/// edge, by far less than what is left between that and the others, or it is left out.
fn halved(sticks: &Sticks) -> Curve {
    let curve = sticks.curve();
    let mean = curve.length() / curve.n() as f64;
    let mut slots = sticks.slots();
    let mut component = |c: usize| {
        let mut halved = Vec::with_capacity(2 * curve.component(c).len());
        for i in slots.by_ref().take(curve.component(c).len()) {
            let [from, to] = sticks.edge(i);
            let rounding = f64::EPSILON * from.abs().max(to.abs()).max_element();
            halved.push(from);
            if from.distance(to) > mean && sticks.clearance(i) > MUCH * rounding {
                halved.push(0.5 * (from + to));
            }
        }
        halved
    };
    Curve::from_components((0..curve.components()).map(&mut component).collect())
}
