//! The polish: a primal-dual interior-point method on the bead rope. Imports `beads`, `passage`, `resample`
//! and what these import; nothing of `sono`.
//!
//! `direction, system <- term <- problem <- barrier, matrix <- newton, least_squares <- forces`, the
//! barrier with the `settings`; on all of them the loop here, how it begins (`start`), what is near
//! (`surroundings`), and how far a step goes (`line_search`).
//!
//! SONO converges linearly; a tight rope solves a sparse smooth optimisation problem
//! (`problem`), and Newton's method reaches the exact state in some tens of factorisations. Every
//! iterate is a valid rope, and no strand passes another along a step (see `line_search`), so that
//! stopping early loses nothing.
//!
//! With multipliers z the perturbed conditions are grad f = sum z grad g and z g = mu w(g), w = 1
//! for the logarithmic barrier and w = (1 - g/hat)^2 for the contacts' clamped one. An iteration is
//! one Newton step on both (`newton`), or the arc whose tangent it is: where a rope slides along itself,
//! edges bend away from their Newton step by more than they have room for, and only arcs are long. When
//! products are right within 10 mu and forces balance within mu/10, mu falls, in the end to 1e-11, unless
//! the settings say otherwise. Lengths then exceed the local minimum by about (number of constraints) mu.
//! Balance is asked for as sliding is a hundred times slower at a hundredth of mu, and little force drives it.
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
mod settings;
mod start;
mod surroundings;
mod system;
mod term;

use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::beads::COARSE;
use crate::geometry::curve::Curve;
use crate::geometry::neighbours::Pair;
use crate::measures::{Measures, measure};
use crate::outcome::Outcome;
use crate::passage::Passages;
use crate::resample::scaled;
use barrier::Barrier;
pub use forces::{Forces, balance};
use newton::Newton;
use problem::{Multipliers, Surroundings, Terms, Unknowns, left_over};
pub use settings::Settings;

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
    /// The steps of each of which it was looked at whether a strand might pass another.
    pub passages: Passages,
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
/// use sono::{Curve, Outcome, Polish, polish::Settings};
/// let angle = |i: usize| std::f64::consts::TAU * i as f64 / 40.;
/// let ellipse = (0..40).map(|i| DVec3::new(angle(i).cos(), 1.2 * angle(i).sin(), 0.));
/// let ellipse = Curve::new(vec![ellipse.collect()])?;
/// let mut polish = Polish::new(&ellipse, 40, false, 0, Settings::default())?;
/// while polish.step() == Outcome::Running {}
/// let status = polish.status();
/// assert_eq!(status.outcome, Outcome::Tight);
/// assert!(status.best.l_p < 6.3);
/// # Ok::<(), sono::Error>(())
/// ```
#[derive(Serialize, Deserialize)]
pub struct Polish {
    settings: Settings,
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
    passages: Passages,
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
            let fallen =
                (self.settings.mu_factor * self.mu).min(self.mu.powf(self.settings.mu_power));
            self.mu = fallen.max(self.last_mu);
        }
        false
    }

    /// Whether the perturbed conditions hold as well as this mu is worth.
    fn is_centred(&mut self, terms: &Terms) -> bool {
        let Settings { centred, balanced, .. } = self.settings;
        let (barrier, most) = (self.barrier(), centred * self.mu);
        let mut products = terms.iter().zip(self.z.iter());
        self.residual = left_over(&self.rope.curve, terms, &self.z).largest(&self.rope.curve);
        self.excess = products.clone().map(|(t, z)| z * t.g).sum();
        // On edges so coarse that a rope may slide until some of them are slack, it had better not slide far.
        let is_coarse = self.rope.l.iter().any(|&l| l > COARSE);
        let balanced = if is_coarse { centred } else { balanced };
        // At the last mu, and where that is as far as the digits go, balance may be as rough as products.
        let is_balanced = self.residual < (balanced * self.mu).max(centred * self.last_mu);
        is_balanced && products.all(|(t, z)| barrier.excess(t, *z).abs() < most)
    }

    /// What comes after a step, or after none could be made.
    fn judge(&mut self, moved: bool) -> Outcome {
        let gliding = self.is_gliding();
        let Settings { restart_factor, most_restarts, most_iterations, tight_residual, .. } =
            self.settings;
        if !moved && self.residual <= tight_residual && self.mu <= self.last_mu {
            // As far as the digits go.
            return self.end();
        }
        if self.iterations == u64::from(most_iterations)
            || (!moved && self.restarts == most_restarts)
        {
            return Outcome::Stuck;
        }
        if !moved || (gliding && self.restarts + 1 < most_restarts) {
            // With so little room for its rearrangement the rope has run into a corner.
            self.restarts += 1;
            self.begin(restart_factor * self.attempt.first_mu);
        }
        Outcome::Running
    }

    /// Whether it has been on its way for long, and is slow.
    fn is_gliding(&mut self) -> bool {
        let Settings { patience, gliding_share, .. } = self.settings;
        let Attempt { first_mu, iterations, l_p } = &mut self.attempt;
        if self.mu != *first_mu || self.iterations != *iterations + u64::from(patience) {
            return false;
        }
        let fast = self.best.l_p < gliding_share * *l_p;
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
        Barrier::new(self.mu, self.rope.longest(), &self.settings)
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
        let [fallen, whole] = [self.mu, self.last_mu].map(|mu| (first_mu / mu).ln());
        Status {
            outcome: self.outcome,
            progress: if fallen < whole { (fallen / whole).clamp(0., 1.) } else { 1. },
            iterations: self.iterations,
            factorisations: self.newton.factorisations(),
            passages: self.passages,
            residual: self.residual,
            mu: self.mu,
            excess: self.excess,
            best: measure(&self.best()),
        }
    }
}
