//! The polish: a primal-dual interior-point method on the bead rope. Imports `beads`, `resample` and
//! what these import; nothing of `sono`.
//!
//! `direction, system <- term <- problem <- barrier, matrix <- newton, least_squares <- forces`; on all
//! of them the loop here, how it begins (`start`), what is near (`surroundings`), and how far a step
//! goes (`line_search`).
//!
//! SONO converges linearly; a tight rope solves a sparse smooth optimisation problem
//! (`problem`), and Newton's method reaches the exact state in some tens of factorisations. Every
//! iterate is a valid rope: constraints hold strictly along each step, so that no strand passes
//! another (see [`crate::sono::passage`]), and stopping early loses nothing.
//!
//! With multipliers z the perturbed conditions are grad f = sum z grad g and z g = mu w(g), w = 1
//! for the logarithmic barrier and w = (1 - g/hat)^2 for the contacts' clamped one. An iteration is
//! one Newton step on both (`newton`); when their error has fallen below 10 mu, mu falls, in the
//! end to 1e-11. Lengths then exceed the local minimum by about (number of constraints) mu.
//!
//! The multipliers are forces: with f the rope's length, its tension is 1 on average.
//!
//! Methods of this kind: J. Nocedal, S. Wright, "Numerical Optimization", chapter 19.

mod barrier;
mod direction;
mod forces;
mod least_squares;
mod line_search;
mod matrix;
mod newton;
mod problem;
mod start;
mod surroundings;
mod system;
mod term;

use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::geometry::curve::Curve;
use crate::geometry::neighbours::Pair;
use crate::measures::{Measures, measure};
use crate::outcome::Outcome;
use crate::resample::scaled;
use barrier::Barrier;
pub use forces::{Forces, balance};
use newton::Newton;
use problem::{Multipliers, Surroundings, Terms, Unknowns, left_over};

/// The largest imbalance of forces in a tight rope, tension being 1.
const TIGHT: f64 = 1e-8;
/// mu falls to this share of it or to this power, whichever is less.
const FALL: f64 = 0.2;
const FALL_POWER: f64 = 1.2;
/// The error at which it falls, in units of mu.
const CENTRED: f64 = 10.;
/// Iterations in which a rope gets tight or never does.
const MOST_ITERATIONS: u64 = 2000;
/// A rope that cannot move, or is still gliding at its first mu after so many steps, as one does that
/// beads' grooves held on a coarser level, begins anew with so many times that mu, so often.
const PATIENCE: u64 = 200;
const MORE_ROOM: f64 = 10.;
const MOST_RESTARTS: u32 = 3;
/// One that still falls below this share of its length meanwhile is left to glide.
const FAST: f64 = 0.9;

/// Where a [`Polish`] stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Status {
    /// Whether it is done.
    pub outcome: Outcome,
    /// From 0 to 1 with the logarithm of mu.
    pub progress: f64,
    /// Newton steps.
    pub iterations: u64,
    /// Cholesky factorisations, those of indefinite matrices included.
    pub factorisations: u64,
    /// Largest force left over on a bead or, on average, on an edge; tension is about 1.
    pub residual: f64,
    /// Barrier parameter: each constraint's product of multiplier and slack.
    pub mu: f64,
    /// Sum of all products of multiplier and slack, about (number of constraints) mu: in balance, by
    /// how much the length exceeds the local minimum.
    pub excess: f64,
    /// Measures of the best state so far, R_s = 1.
    pub best: Measures,
}

/// Polishes a rope; everything needed to go on later is serialised with it.
///
/// ```
/// // An ellipse of 40 beads becomes a circle of radius 1: its ropelength is nearly 2 pi.
/// use glam::DVec3;
/// use sono::{Curve, Outcome, Polish};
/// let angle = |i: usize| std::f64::consts::TAU * i as f64 / 40.;
/// let ellipse = (0..40).map(|i| DVec3::new(angle(i).cos(), 1.2 * angle(i).sin(), 0.));
/// let mut polish = Polish::new(&Curve::new(vec![ellipse.collect()])?, 40, false, 0)?;
/// while polish.step() == Outcome::Running {}
/// let status = polish.status();
/// assert_eq!(status.outcome, Outcome::Tight);
/// assert!(status.best.l_p < 6.3);
/// # Ok::<(), sono::Error>(())
/// ```
#[derive(Serialize, Deserialize)]
pub struct Polish {
    rope: Unknowns,
    /// Least index distance of contacts, for each component.
    least: Vec<usize>,
    /// Beads within the range of the barrier, sorted.
    contacts: Vec<Pair>,
    z: Multipliers,
    mu: f64,
    last_mu: f64,
    /// Longest way of a bead in the next step.
    way: f64,
    newton: Newton,
    iterations: u64,
    residual: f64,
    excess: f64,
    attempt: Attempt,
    restarts: u32,
    outcome: Outcome,
    best: Best,
}

/// How it began, perhaps anew.
#[derive(Serialize, Deserialize)]
struct Attempt {
    first_mu: f64,
    /// Iterations before, and L_p then.
    iterations: u64,
    l_p: f64,
}

/// The best state so far.
#[derive(Serialize, Deserialize)]
struct Best {
    curve: Curve,
    r_s: f64,
    l_p: f64,
}

impl Best {
    fn new(curve: Curve) -> Self {
        let Measures { r_s, l_p, .. } = measure(&curve);
        Self { curve, r_s, l_p }
    }
}

impl Polish {
    /// Works for about `budget`, unless done before.
    pub fn advance(&mut self, budget: Duration) -> Status {
        let start = Instant::now();
        while self.outcome == Outcome::Running && start.elapsed() < budget {
            self.step();
        }
        self.status()
    }

    /// One Newton step, or the end.
    pub fn step(&mut self) -> Outcome {
        if self.outcome == Outcome::Running {
            let around = self.look_around();
            self.outcome =
                if self.is_done(&around.terms) { self.end() } else { self.iterate(&around) };
        }
        self.outcome
    }

    fn iterate(&mut self, around: &Surroundings) -> Outcome {
        let step = self.newton.step(&self.rope, around, &self.z, self.barrier());
        let moved = step.is_some_and(|step| self.take(&step, around));
        self.iterations += 1;
        self.judge(moved)
    }

    /// Lets mu fall while the rope is centred; returns whether it is at the last.
    fn is_done(&mut self, terms: &Terms) -> bool {
        while self.is_centred(terms) {
            if self.mu <= self.last_mu {
                return true;
            }
            self.mu = (FALL * self.mu).min(self.mu.powf(FALL_POWER)).max(self.last_mu);
        }
        false
    }

    /// Whether the perturbed conditions hold as well as this mu is worth.
    fn is_centred(&mut self, terms: &Terms) -> bool {
        let (barrier, most) = (self.barrier(), CENTRED * self.mu);
        let mut products = terms.iter().zip(self.z.iter());
        self.residual = left_over(&self.rope.curve, terms, &self.z).largest(&self.rope.curve);
        self.excess = products.clone().map(|(t, z)| z * t.g).sum();
        self.residual < most && products.all(|(t, z)| barrier.excess(t, *z).abs() < most)
    }

    /// What comes after a step, or after none could be made.
    fn judge(&mut self, moved: bool) -> Outcome {
        let gliding = self.is_gliding();
        if !moved && self.residual <= TIGHT && self.mu <= self.last_mu {
            // As far as the digits go.
            return self.end();
        }
        if self.iterations == MOST_ITERATIONS || (!moved && self.restarts == MOST_RESTARTS) {
            return Outcome::Stuck;
        }
        if !moved || (gliding && self.restarts + 1 < MOST_RESTARTS) {
            // With so little room for its rearrangement the rope has run into a corner.
            self.restarts += 1;
            self.begin(MORE_ROOM * self.attempt.first_mu);
        }
        Outcome::Running
    }

    /// Whether it has been on its way for long, and is slow.
    fn is_gliding(&mut self) -> bool {
        let Attempt { first_mu, iterations, l_p } = &mut self.attempt;
        if self.mu != *first_mu || self.iterations != *iterations + PATIENCE {
            return false;
        }
        let fast = self.best.l_p < FAST * *l_p;
        if fast {
            (*iterations, *l_p) = (self.iterations, self.best.l_p);
        }
        !fast
    }

    /// Ends with the rope as it is, though one before may have been shorter in the last digit.
    fn end(&mut self) -> Outcome {
        self.best.curve.clone_from(&self.rope.curve);
        self.best.r_s = measure(&self.best.curve).r_s;
        Outcome::Tight
    }

    /// The barrier of this moment.
    fn barrier(&self) -> Barrier {
        Barrier::new(self.mu, self.rope.longest())
    }

    /// The best state so far, its R_s = 1, its centre at the origin.
    pub fn best(&self) -> Curve {
        scaled(&self.best.curve, self.best.r_s)
    }

    /// The forces in the rope as it is.
    pub fn forces(&self) -> Forces {
        Forces::new(&self.rope.curve, &self.rope.terms(&self.contacts), &self.z)
    }

    /// Where it stands.
    pub fn status(&self) -> Status {
        let first_mu = self.attempt.first_mu;
        let fallen = (first_mu / self.mu).ln() / (first_mu / self.last_mu).ln();
        Status {
            outcome: self.outcome,
            progress: fallen.clamp(0., 1.),
            iterations: self.iterations,
            factorisations: self.newton.factorisations(),
            residual: self.residual,
            mu: self.mu,
            excess: self.excess,
            best: measure(&self.best()),
        }
    }
}
