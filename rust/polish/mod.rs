//! The polish: a primal-dual interior-point method on the bead rope.
//!
//! SONO converges linearly; a tight rope solves a sparse smooth optimisation problem
//! ([`problem`]), and Newton's method reaches the exact state in some tens of factorisations. Every
//! iterate is a valid rope: constraints hold strictly along each step, so that no strand passes
//! another (see [`crate::sono::passage`]), and stopping early loses nothing.
//!
//! With multipliers z the perturbed conditions are grad f = sum z grad g and z g = mu w(g), w = 1
//! for the logarithmic barrier and w = (1 - g/hat)^2 for the contacts' clamped one. An iteration is
//! one Newton step on both ([`newton`]); when their error has fallen below 10 mu, mu falls, in the
//! end to 1e-11. Lengths then exceed the local minimum by about (number of constraints) mu.
//!
//! The multipliers are forces: with f the rope's length, its tension is 1 on average.
//!
//! Methods of this kind: J. Nocedal, S. Wright, "Numerical Optimization", chapter 19.

mod forces;
mod newton;
mod problem;
mod system;

use std::time::{Duration, Instant};

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::beads::{LONGEST_EDGE, SHORTEST_EDGE, least_index_distance, most_bend};
use crate::error::Result;
use crate::geometry::curve::Curve;
use crate::geometry::neighbours::{Separation, for_each_close_pair};
use crate::measures::{Measures, measure};
use crate::outcome::Outcome;
use crate::resample::{refine, resampled, rope_curve, scaled};
pub use forces::{Forces, balance};
use newton::{Newton, Step};
use problem::{Term, chain_terms, clamped_logarithm, longest_step};

/// The last barrier parameter.
const LAST_MU: f64 = 1e-11;
/// The largest imbalance of forces in a tight rope, tension being 1.
const TIGHT: f64 = 1e-8;
/// The first one, and the last on a level that only leads to the next, in units of dl^3: a rope's
/// length is then off by as much as its discretisation, or by a little less.
const FIRST_MU: f64 = 0.01;
const PASSING_MU: f64 = 3e-3;
/// mu falls to this share of it or to this power, whichever is less.
const FALL: f64 = 0.2;
const FALL_POWER: f64 = 1.2;
/// The error at which it falls, in units of mu.
const CENTRED: f64 = 10.;
/// The contacts' barrier has the range 3 sqrt mu in g = r^2 - 4, but at least 0.1 l^2 and at most
/// l^2, which is as far as a contact moves when the beads slide by half an edge: pairs beyond would
/// only cost time.
const RANGE_MU: f64 = 3.;
const SHORTEST_RANGE: f64 = 0.1;
/// Share of a constraint that a step may use up.
const TO_THE_BOUNDARY: f64 = 0.99;
/// Multipliers stay within this factor of mu w/g.
const KEEP: f64 = 100.;
/// Longest way of a bead in one step, in radii.
const LONGEST_WAY: f64 = 0.1;
/// Dispersion from which on a curve is not taken as a rope that is to be refined.
const UNEQUAL: f64 = 0.04;
/// Beads of a rope that is made of a curve which is none.
const MOST_BEADS: usize = 20_000;
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
#[derive(Serialize, Deserialize)]
pub struct Polish {
    curve: Curve,
    /// Edge length of each component.
    l: Vec<f64>,
    /// Least index distance of contacts, for each component.
    least: Vec<usize>,
    /// Multipliers of [`chain_terms`].
    chain: Vec<f64>,
    contacts: Vec<Contact>,
    mu: f64,
    last_mu: f64,
    first_mu: f64,
    /// Longest way of a bead in the next step.
    way: f64,
    newton: Newton,
    iterations: u64,
    /// How many of them there were when it began, perhaps anew, and its L_p then.
    begun: u64,
    length_then: f64,
    residual: f64,
    excess: f64,
    restarts: u32,
    outcome: Outcome,
    best: Curve,
    /// Its thickness R_s and L_p.
    thickness: f64,
    shortest: f64,
}

/// Two beads within the range of the barrier, and the multiplier.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Contact {
    i: u32,
    j: u32,
    z: f64,
}

impl Polish {
    /// Polishes any embedded curve on `n` vertices in all. Ends with a tight rope, or, if it is only
    /// `passing` this n, with one that is good enough to be refined.
    ///
    /// # Errors
    /// [`crate::Error::SelfCrossing`], [`crate::Error::TooThin`], and those of [`resampled`].
    pub fn new(curve: &Curve, n: usize, passing: bool, seed: u64) -> Result<Self> {
        let given = measure(curve);
        let coarse = curve.n() == n && given.l_p < LONGEST_EDGE * n as f64;
        let is_rope = (given.r_c.is_some() || coarse) && given.dispersion < UNEQUAL;
        let made = if is_rope { None } else { Some(rope_curve(curve, MOST_BEADS)?) };
        let mut curve = resampled(made.as_ref().unwrap_or(curve), n, seed)?;
        let bound = |t: &Term, l: &[f64]| {
            let l = l[t.component];
            1e-3 * (l * most_bend(l)).powi(2)
        };
        let l = longest(&curve);
        if chain_terms(&curve, &l).any(|t| t.g < -bound(&t, &l)) {
            // Edges too unequal for its own bends; equal ones lie on K_P.
            curve = refine(&curve, n, 0.)?;
            curve.scale(1. / measure(&curve).r_s);
        }
        curve.centre();
        let dl = curve.length() / n as f64;
        let measured = measure(&curve);
        let last_mu = if passing { LAST_MU.max(PASSING_MU * dl.powi(3)) } else { LAST_MU };
        let mut polish = Self {
            least: first_least(&curve, &longest(&curve)),
            l: vec![],
            chain: vec![],
            contacts: vec![],
            mu: 0.,
            last_mu,
            first_mu: 0.,
            way: (2. * dl * dl).min(LONGEST_WAY),
            newton: Newton::default(),
            iterations: 0,
            begun: 0,
            length_then: measured.l_p,
            residual: f64::MAX,
            excess: f64::MAX,
            restarts: 0,
            outcome: Outcome::Running,
            thickness: measured.r_s,
            shortest: measured.l_p,
            best: curve.clone(),
            curve,
        };
        polish.begin(last_mu.max(FIRST_MU * dl.powi(3)));
        Ok(polish)
    }

    /// Begins at the best state so far with barrier parameter `mu`, or the largest that edges have room for.
    fn begin(&mut self, mu: f64) {
        let mut curve = self.best();
        let room = longest(&curve).into_iter().enumerate().map(|(c, longest)| {
            let shortest = curve.edge_lengths(c).fold(f64::MAX, f64::min);
            0.5 * (shortest / SHORTEST_EDGE - longest)
        });
        let mu = room.fold(mu, f64::min);
        // Room for the barrier: an edge of tension 1 has the slack 2 l mu, contacts get some too.
        curve.scale(1. + 0.02 * mu * curve.n() as f64 / curve.length());
        self.l = longest(&curve).into_iter().map(|l| l + mu).collect();
        self.chain = chain_terms(&curve, &self.l).map(|t| mu / t.g).collect();
        self.contacts.clear();
        (self.curve, self.mu, self.first_mu) = (curve, mu, mu);
        (self.begun, self.length_then) = (self.iterations, self.shortest);
    }

    /// Whether a restored state is one that can go on.
    pub fn is_sound(&self) -> bool {
        let (n, components) = (self.curve.n(), self.curve.components());
        let positive = |x: &f64| x.is_finite() && *x > 0.;
        let contacts = self.contacts.iter().map(|c| (c.i, c.j));
        self.curve.is_sound()
            && self.best.is_sound()
            && (self.best.n(), self.best.components()) == (n, components)
            && (self.l.len(), self.least.len(), self.chain.len()) == (components, components, 2 * n)
            && self.l.iter().all(positive)
            && self.chain.iter().chain(self.contacts.iter().map(|c| &c.z)).all(|z| z.is_finite())
            && contacts.clone().is_sorted_by(|a, b| a < b)
            && contacts.clone().all(|(i, j)| i < j && (j as usize) < n)
            && [self.mu, self.last_mu, self.first_mu, self.way, self.thickness, self.length_then]
                .iter()
                .all(positive)
            && self.newton.is_sound(n)
    }

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
        if self.outcome != Outcome::Running {
            return self.outcome;
        }
        let (terms, bystanders) = self.look_around();
        let z = self.multipliers();
        while self.is_centred(&terms, &z) {
            if self.mu <= self.last_mu {
                self.end();
                return self.outcome;
            }
            self.mu = (FALL * self.mu).min(self.mu.powf(FALL_POWER)).max(self.last_mu);
        }
        let (curve, l) = (&self.curve, &self.l);
        let step = self.newton.step(curve, l, &terms, &z, (self.mu, self.range()), &bystanders);
        let moved = step.is_some_and(|step| self.take(step, &terms, &z, &bystanders));
        self.iterations += 1;
        let mut gliding = self.mu == self.first_mu && self.iterations == self.begun + PATIENCE;
        if gliding && self.shortest < FAST * self.length_then {
            (self.begun, self.length_then, gliding) = (self.iterations, self.shortest, false);
        }
        if !moved && self.residual <= TIGHT && self.mu <= self.last_mu {
            // As far as the digits go.
            self.end();
        } else if self.iterations == MOST_ITERATIONS || (!moved && self.restarts == MOST_RESTARTS) {
            self.outcome = Outcome::Stuck;
        } else if !moved || (gliding && self.restarts + 1 < MOST_RESTARTS) {
            // With so little room for its rearrangement the rope has run into a corner.
            self.restarts += 1;
            self.begin(MORE_ROOM * self.first_mu);
        }
        self.outcome
    }

    /// Ends with the rope as it is, though one before may have been shorter in the last digit.
    fn end(&mut self) {
        self.best.clone_from(&self.curve);
        self.thickness = measure(&self.best).r_s;
        self.outcome = Outcome::Tight;
    }

    fn multipliers(&self) -> Vec<f64> {
        self.chain.iter().copied().chain(self.contacts.iter().map(|c| c.z)).collect()
    }

    /// Range of the contacts' barrier.
    fn range(&self) -> f64 {
        let l = self.l.iter().copied().fold(0., f64::max);
        (RANGE_MU * self.mu.sqrt()).clamp(SHORTEST_RANGE * l * l, l * l)
    }

    /// Brings the contacts up to date. Returns all terms, and the pairs beyond the range of the
    /// barrier that a step might yet bring together.
    fn look_around(&mut self) -> (Vec<Term>, Vec<(u32, u32)>) {
        let hat = self.range();
        for (least, &l) in self.least.iter_mut().zip(&self.l) {
            *least = least_index_distance(l).max(*least);
        }
        let reach = 2. + (2.5 * self.way).max(0.4 * hat);
        let mut near = vec![];
        let separation = Separation::by_index(&self.curve, &self.least);
        for_each_close_pair(&self.curve, &separation, reach, |i, j, _| {
            near.push((i as u32, j as u32));
            reach
        });
        near.sort_unstable();
        let mut terms: Vec<_> = chain_terms(&self.curve, &self.l).collect();
        let mut known = std::mem::take(&mut self.contacts).into_iter().peekable();
        near.retain(|&(i, j)| {
            let term = Term::contact(self.curve.vertices(), i, j);
            if term.g >= hat {
                return true;
            }
            while known.next_if(|c| (c.i, c.j) < (i, j)).is_some() {}
            let z = match known.peek() {
                Some(c) if (c.i, c.j) == (i, j) => c.z,
                _ => self.mu * term.weight(hat).0 / term.g,
            };
            self.contacts.push(Contact { i, j, z });
            terms.push(term);
            false
        });
        (terms, near)
    }

    /// Whether the perturbed conditions hold as well as this mu is worth.
    fn is_centred(&mut self, terms: &[Term], z: &[f64]) -> bool {
        let hat = self.range();
        self.residual = imbalance(&self.curve, terms, z);
        self.excess = terms.iter().zip(z).map(|(t, z)| z * t.g).sum();
        self.residual < CENTRED * self.mu
            && terms
                .iter()
                .zip(z)
                .all(|(t, z)| (z * t.g - self.mu * t.weight(hat).0).abs() < CENTRED * self.mu)
    }

    /// Goes as far along a step as constraints and the barrier function allow.
    fn take(&mut self, step: Step, terms: &[Term], z: &[f64], bystanders: &[(u32, u32)]) -> bool {
        let Step { d, delta, dz, slope } = step;
        let (hat, mu) = (self.range(), self.mu);
        let v = self.curve.vertices();
        let longest = d.iter().fold(0f64, |longest, d| longest.max(d.length()));
        let others = bystanders.iter().map(|&(i, j)| Term::contact(v, i, j));
        let mut a =
            terms.iter().copied().chain(others).fold((self.way / longest).min(1.), |a, t| {
                a.min(longest_step(t.g, t.course(&d, &delta), TO_THE_BOUNDARY))
            });
        let near = || {
            let contacts = self.contacts.iter().map(|c| (c.i, c.j));
            contacts.chain(bystanders.iter().copied())
        };
        let merit = |curve: &Curve, l: &[f64]| {
            let v = curve.vertices();
            // Edges too short, too, are out of bounds: the rope might turn back between them.
            let least_edge = |k: usize, t: &Term| {
                k >= v.len() || t.g < (1. - SHORTEST_EDGE * SHORTEST_EDGE) * l[t.component].powi(2)
            };
            let chain = chain_terms(curve, l)
                .enumerate()
                .map(|(k, t)| if t.g > 0. && least_edge(k, &t) { t.g.ln() } else { f64::NAN });
            let contacts = near().map(|(i, j)| clamped_logarithm(Term::contact(v, i, j).g, hat));
            length(curve, l) - mu * chain.chain(contacts).sum::<f64>()
        };
        let before = merit(&self.curve, &self.l);
        let noise = 1e-14 * before.abs();
        let mut found = None;
        for _ in 0..40 {
            let mut curve = self.curve.clone();
            curve.vertices_mut().iter_mut().zip(&d).for_each(|(v, d)| *v += a * *d);
            let l: Vec<_> = self.l.iter().zip(&delta).map(|(l, d)| l + a * d).collect();
            // False where a bend's course, cubic in l, has led out after all: the merit is NaN.
            if merit(&curve, &l) <= before + 1e-4 * a * slope + noise {
                found = Some((curve, l));
                break;
            }
            a *= 0.5;
        }
        let Some((curve, l)) = found else { return false };
        let a_z = z
            .iter()
            .zip(&dz)
            .fold(1f64, |a, (z, dz)| if *dz < 0. { a.min(TO_THE_BOUNDARY * z / -dz) } else { a });
        let mut moved = terms.iter().zip(z).zip(&dz).map(|((t, z), dz)| {
            let [b, c] = t.course(&d, &delta);
            let t = Term { g: t.g + a * (b + a * c), ..*t };
            let centred = mu * t.weight(hat).0 / t.g;
            (z + a_z * dz).clamp(centred / KEEP, centred * KEEP)
        });
        self.chain.iter_mut().zip(&mut moved).for_each(|(z, moved)| *z = moved);
        self.contacts.iter_mut().zip(&mut moved).for_each(|(c, moved)| c.z = moved);
        (self.curve, self.l) = (curve, l);
        self.newton.learn(a);
        let thinnest = 0.01 * self.l.iter().copied().fold(f64::MAX, f64::min).powi(2);
        self.way = (4. * a * longest).clamp(thinnest.min(LONGEST_WAY), LONGEST_WAY);
        let Measures { l_p, r_s, .. } = measure(&self.curve);
        if l_p < self.shortest {
            (self.shortest, self.thickness) = (l_p, r_s);
            self.best.clone_from(&self.curve);
        }
        true
    }

    /// The best state so far, its R_s = 1, its centre at the origin.
    pub fn best(&self) -> Curve {
        scaled(&self.best, self.thickness)
    }

    /// The forces in the rope as it is.
    pub fn forces(&self) -> Forces {
        let contacts = self.contacts.iter().map(|c| Term::contact(self.curve.vertices(), c.i, c.j));
        let terms: Vec<_> = chain_terms(&self.curve, &self.l).chain(contacts).collect();
        Forces::new(&self.curve, &terms, &self.multipliers())
    }

    /// Where it stands.
    pub fn status(&self) -> Status {
        let fallen = (self.first_mu / self.mu).ln() / (self.first_mu / self.last_mu).ln();
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

/// Least index distances of contacts: those of the rule, or more where beads of a coarse rope that the
/// measures let overlap (theirs is pi MinRad, not pi R_c) would break it.
fn first_least(curve: &Curve, l: &[f64]) -> Vec<usize> {
    let mut least: Vec<_> = l.iter().map(|&l| least_index_distance(l)).collect();
    let separation = Separation::by_index(curve, &least);
    for_each_close_pair(curve, &separation, 2. - 1e-12, |i, j, _| {
        if let Some(distance) = curve.index_distance(i, j) {
            let least = &mut least[curve.component_of(i)];
            *least = (distance + 1).max(*least);
        }
        2. - 1e-12
    });
    least
}

/// The longest edge of each component.
fn longest(curve: &Curve) -> Vec<f64> {
    (0..curve.components()).map(|c| curve.edge_lengths(c).fold(0., f64::max)).collect()
}

fn length(curve: &Curve, l: &[f64]) -> f64 {
    curve.ranges().zip(l).map(|(range, l)| range.len() as f64 * l).sum()
}

/// Largest coordinate of grad f - sum z grad g, that of an edge length shared out to the edges.
fn imbalance(curve: &Curve, terms: &[Term], z: &[f64]) -> f64 {
    let mut forces = vec![DVec3::ZERO; curve.n()];
    let mut pull: Vec<_> = curve.ranges().map(|range| range.len() as f64).collect();
    for (t, z) in terms.iter().zip(z) {
        t.gradient().for_each(|(i, gradient)| forces[i] -= *z * gradient);
        pull[t.component] -= z * t.h[0];
    }
    let on_beads = forces.iter().map(|f| f.abs().max_element());
    let on_edges = pull.iter().zip(curve.ranges()).map(|(p, range)| p.abs() / range.len() as f64);
    // One that is not a number is the largest.
    on_beads.chain(on_edges).fold(0., |most, f| if f <= most { most } else { f })
}
