//! How a polish begins: with a rope made of any curve, or anew with more room.

use super::newton::Newton;
use super::problem::{Grouped, Unknowns};
use super::settings::Settings;
use super::{Attempt, Best, Polish};
use crate::beads::{LONGEST_EDGE, SHORTEST_EDGE, least_index_distance, most_bend};
use crate::error::Result;
use crate::geometry::curve::Curve;
use crate::geometry::neighbours::for_each_close_pair;
use crate::geometry::separation::Separation;
use crate::measures::measure;
use crate::outcome::Outcome;
use crate::passage::Passages;
use crate::resample::{MOST_BEADS, on_chords, resampled, rope_curve};

/// Dispersion from which on a curve is not taken as a rope that is to be refined.
const UNEQUAL: f64 = 0.04;
/// Share by which a bend's condition may be violated by a rope that is taken as it is.
const TOO_BENT: f64 = 1e-3;

impl Polish {
    /// Polishes any embedded curve, of any unit, on `n` vertices in all. Ends with a tight rope, or, if
    /// it is only `passing` this n, with one that is good enough to be refined.
    ///
    /// # Errors
    /// [`crate::Error::Setting`], [`crate::Error::SelfCrossing`], [`crate::Error::TooThin`], and those of
    /// [`resampled`].
    pub fn new(
        curve: &Curve,
        n: usize,
        passing: bool,
        seed: u64,
        settings: Settings,
    ) -> Result<Self> {
        settings.check()?;
        let Settings { first_mu, passing_mu, last_mu, longest_way, .. } = settings;
        let best = Best::new(rope_on(curve, n, seed)?);
        let dl = best.curve.length() / n as f64;
        let rope = Unknowns::new(best.curve.clone());
        let last_mu = if passing { last_mu.max(passing_mu * dl.powi(3)) } else { last_mu };
        let mut polish = Self {
            settings,
            least: first_least(&rope),
            rope,
            contacts: vec![],
            z: Grouped::default(),
            mu: 0.,
            last_mu,
            way: (2. * dl * dl).min(longest_way),
            newton: Newton::default(),
            iterations: 0,
            passages: Passages::default(),
            residual: f64::MAX,
            excess: f64::MAX,
            attempt: Attempt { first_mu: 0., iterations: 0, l_p: 0. },
            restarts: 0,
            outcome: Outcome::Running,
            best,
        };
        polish.begin(last_mu.max(first_mu * dl.powi(3)));
        Ok(polish)
    }

    /// Begins at the best state so far with barrier parameter `mu`, or the largest that edges have room for.
    pub(super) fn begin(&mut self, mu: f64) {
        let mut rope = Unknowns::new(self.best());
        let room = rope.l.iter().enumerate().map(|(c, longest)| {
            let shortest = rope.curve.edge_lengths(c).fold(f64::MAX, f64::min);
            0.5 * (shortest / SHORTEST_EDGE - longest)
        });
        let mu = room.fold(mu, f64::min);
        // Room for the barrier: an edge of tension 1 has the slack 2 l mu, contacts get some too.
        rope.curve.scale(1. + 0.02 * mu * rope.curve.n() as f64 / rope.curve.length());
        rope = Unknowns::new(rope.curve);
        rope.l.iter_mut().for_each(|l| *l += mu);
        self.contacts.clear();
        self.z = rope.terms(&[]).map(|t| mu / t.g);
        (self.rope, self.mu) = (rope, mu);
        self.attempt = Attempt { first_mu: mu, iterations: self.iterations, l_p: self.best.l_p };
    }

    /// Whether a restored state is one that can go on.
    pub fn is_sound(&self) -> bool {
        let Unknowns { curve, l } = &self.rope;
        let (n, components) = (curve.n(), curve.components());
        let positive = |x: &f64| x.is_finite() && *x > 0.;
        let numbers = [self.mu, self.last_mu, self.attempt.first_mu, self.way];
        let (z, contacts) = (&self.z, &self.contacts);
        self.settings.check().is_ok()
            && curve.is_sound()
            && self.best.curve.is_sound()
            && (self.best.curve.n(), self.best.curve.components()) == (n, components)
            && (l.len(), self.least.len()) == (components, components)
            && (z.edges.len(), z.bends.len(), z.contacts.len()) == (n, n, contacts.len())
            && l.iter().all(positive)
            && z.iter().all(|z| z.is_finite())
            && contacts.is_sorted_by(|a, b| a < b)
            && contacts.iter().all(|&(i, j)| i < j && (j as usize) < n)
            && numbers.iter().chain([&self.best.r_s, &self.attempt.l_p]).all(positive)
            && self.newton.is_sound(n)
    }
}

/// A rope on `n` beads, its R_s = 1, made of any embedded curve.
fn rope_on(curve: &Curve, n: usize, seed: u64) -> Result<Curve> {
    let given = measure(curve);
    let coarse = curve.n() == n && given.l_p < LONGEST_EDGE * n as f64;
    let is_rope = (given.r_c.is_some() || coarse) && given.dispersion < UNEQUAL;
    let made = if is_rope { None } else { Some(rope_curve(curve, MOST_BEADS)?) };
    let mut rope = Unknowns::new(resampled(made.as_ref().unwrap_or(curve), n, seed)?);
    let most = |l: f64| TOO_BENT * (l * most_bend(l)).powi(2);
    if rope.bends().any(|t| t.g < -most(rope.l[t.component])) {
        // Edges too unequal for its own bends; equal ones lie on K_P.
        rope.curve = on_chords(&rope.curve, &measure(&rope.curve), n, 0.)?.0;
        rope.curve.scale(1. / measure(&rope.curve).r_s);
    }
    rope.curve.centre();
    Ok(rope.curve)
}

/// Least index distances of contacts: those of the rule, or more where beads of a coarse rope that the
/// measures let overlap (theirs is pi MinRad, not pi R_c) would break it.
fn first_least(rope: &Unknowns) -> Vec<usize> {
    let mut least: Vec<_> = rope.l.iter().map(|&l| least_index_distance(l)).collect();
    let (curve, touching) = (&rope.curve, 2. - 1e-12);
    let separation = Separation::by_index(curve, &least);
    for_each_close_pair(curve, &separation, touching, |i, j, _| {
        if let Some(distance) = curve.index_distance(i, j) {
            let least = &mut least[curve.component_of(i)];
            *least = (distance + 1).max(*least);
        }
        touching
    });
    least
}
