//! The barrier function: f - mu (sum of the terms' barriers), to be lowered at each step.
//!
//! The barrier of edges and bends is ln g, that of contacts the clamped logarithm
//! B(g) = ln u - 2u + u^2/2 + 3/2 for u = g/hat < 1, else 0. It is twice continuously differentiable,
//! so that pairs enter and leave without a jolt; B' = w/g with w = (1 - u)^2, and else w = 1.

use super::direction::Direction;
use super::problem::Unknowns;
use super::settings::Settings;
use super::term::Term;
use crate::beads::SHORTEST_EDGE;
use crate::geometry::neighbours::Pair;

/// The barrier's parameters.
#[derive(Debug, Clone, Copy)]
pub struct Barrier {
    pub mu: f64,
    /// Range of the contacts' barrier.
    pub hat: f64,
}

impl Barrier {
    /// The barrier of `mu` on a rope whose longest edge is `l`.
    pub fn new(mu: f64, l: f64, settings: &Settings) -> Self {
        let Settings { contact_range, least_contact_range, .. } = settings;
        Self { mu, hat: (contact_range * mu.sqrt()).clamp(least_contact_range * l * l, l * l) }
    }

    /// w and dw/dg of a term's barrier.
    pub fn weight(&self, t: &Term) -> [f64; 2] {
        let rest = 1. - t.g / self.hat;
        if t.sign < 0. {
            [1., 0.]
        } else if rest > 0. {
            [rest * rest, -2. * rest / self.hat]
        } else {
            [0., 0.]
        }
    }

    /// mu w/g, a term's force where it stands; in the end it is its multiplier.
    pub fn force(&self, t: &Term) -> f64 {
        self.mu * self.weight(t)[0] / t.g
    }

    /// D = (z - mu w')/g.
    pub fn stiffness(&self, t: &Term, z: f64) -> f64 {
        (z - self.mu * self.weight(t)[1]) / t.g
    }

    /// By how much (z g - mu w)/g rises to second order where a term takes this course and z stays.
    pub fn rise(&self, t: &Term, z: f64, [b, c]: [f64; 2]) -> f64 {
        let within = t.sign > 0. && t.g < self.hat;
        let turn = if within { (b / self.hat).powi(2) } else { 0. };
        self.stiffness(t, z) * c - self.mu * turn / t.g
    }

    /// z g - mu w, which is 0 in the end.
    pub fn excess(&self, t: &Term, z: f64) -> f64 {
        z * t.g - self.mu * self.weight(t)[0]
    }

    /// The barrier function, the contacts being those of `pairs`; NaN or infinite out of bounds. So it
    /// is, too, where an edge is so short that the rope might turn back between its beads.
    pub fn merit(&self, rope: &Unknowns, pairs: impl Iterator<Item = Pair>) -> f64 {
        let edge = |t: Term| {
            let most = (1. - SHORTEST_EDGE * SHORTEST_EDGE) * rope.l[t.component].powi(2);
            if t.g < most { t.g.ln() } else { f64::NAN }
        };
        let contact = |pair| clamped_logarithm(rope.contact(pair).g, self.hat);
        let edges_and_bends = rope.edges().map(edge).chain(rope.bends().map(|t| t.g.ln()));
        rope.length() - self.mu * edges_and_bends.chain(pairs.map(contact)).sum::<f64>()
    }
}

fn clamped_logarithm(g: f64, hat: f64) -> f64 {
    let u = g / hat;
    if u < 1. { u.ln() - 2. * u + 0.5 * u * u + 1.5 } else { 0. }
}

/// The longest step a in [0, 1] along all of which a term uses up at most the share `most` of what it is.
pub fn longest_step(t: &Term, step: &Direction, most: f64) -> f64 {
    longest_course(most * t.g, t.course(step))
}

/// The same for g + b a + c a^2, `left` being how much of g may be used up.
fn longest_course(left: f64, [b, c]: [f64; 2]) -> f64 {
    let discriminant = b * b - 4. * c * left;
    if discriminant <= 0. || (b >= 0. && c >= 0.) {
        return 1.;
    }
    let root = discriminant.sqrt();
    let step = if b < 0. { 2. * left / (root - b) } else { (b + root) / (-2. * c) };
    step.min(1.)
}

/// The longest step a in [0, 1] along which each `x`, which goes to x + a dx, loses at most the share
/// `most` of it.
pub fn longest_positive(most: f64, changes: impl Iterator<Item = (f64, f64)>) -> f64 {
    changes.fold(1f64, |a, (x, dx)| if dx < 0. { a.min(most * x / -dx) } else { a })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_step_ends_where_the_constraint_does() {
        for (b, c) in [(-3., 0.), (-3., 1.), (-1., -1.), (2., -5.), (0., -4.), (-2.2, 1.)] {
            let step = longest_course(0.99, [b, c]);
            let g = |a: f64| 1. + b * a + c * a * a;
            assert!((0..=100).all(|k| g(step * f64::from(k) / 100.) >= 0.01 - 1e-12));
            assert!(step == 1. || (g(step) - 0.01).abs() < 1e-12, "{b} {c} {step}");
        }
        assert_eq!(longest_course(0.99, [-1.9, 1.]), 1.);
    }
}
