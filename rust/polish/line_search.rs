//! How far along a Newton step constraints, the barrier function and the strands allow to go.
//!
//! A step moves all beads straight, from where the rope is to where it shall be. **No strand passes another**
//! by the theorem of [`crate::passage`], whose conditions are looked at on each step by themselves. They need
//! not be concluded from the constraints, which do not imply all of them: that edges and contacts keep what
//! they have is known along the whole step, as their courses are quadratic, but of the least length of an
//! edge, and of a bend on a rope whose required edges get shorter, only what it is at the end. The theorem asks
//! for the distances of all beads that count, k or more apart along the rope, k being the `least` of
//! their component. Those that [`Polish::look_around`] lists are looked at one by one. Others were at least
//! 2 + 2.5 `way` apart, and no bead moves further than `way`, so they stay more than 2 apart. As k only grows,
//! a pair that counted and was not listed is none that is forgotten: it is no longer asked for.
//!
//! Between steps nothing moves: a new beginning scales the best rope, which was one of these.

use super::barrier::longest_step;
use super::newton::Step;
use super::problem::{Multipliers, Surroundings, Unknowns};
use super::settings::Settings;
use super::term::Term;
use super::{Best, Polish};
use crate::passage::margin;

/// Rounding errors of the barrier function, as a share of it.
const NOISE: f64 = 1e-14;
const MOST_HALVINGS: usize = 40;

impl Polish {
    /// Goes as far along a step as possible; returns whether that is anywhere.
    pub(super) fn take(&mut self, step: &Step, around: &Surroundings) -> bool {
        let longest = step.to.longest_way();
        let Some((a, rope)) = self.search(step, around, (self.way / longest).min(1.)) else {
            return false;
        };
        self.z = self.multipliers(a, step, around);
        self.rope = rope;
        self.newton.learn(a);
        let thinnest = 0.01 * self.rope.l.iter().copied().fold(f64::MAX, f64::min).powi(2);
        let longest_way = self.settings.longest_way;
        self.way = (4. * a * longest).clamp(thinnest.min(longest_way), longest_way);
        let now = Best::new(self.rope.curve.clone());
        if now.l_p < self.best.l_p {
            self.best = now;
        }
        true
    }

    /// The share of the step, at most `most`, that lowers the barrier function, and where it leads.
    fn search(&mut self, step: &Step, around: &Surroundings, most: f64) -> Option<(f64, Unknowns)> {
        let Surroundings { terms, bystanders } = around;
        let Settings { most_used, least_descent, .. } = self.settings;
        let barrier = self.barrier();
        let Self { rope, contacts, passages, least, .. } = self;
        let before = rope.curve.vertices();
        let pairs = contacts.iter().chain(bystanders).copied();
        let merit = |rope: &Unknowns| barrier.merit(rope, pairs.clone());
        let others = bystanders.iter().map(|&pair| rope.contact(pair));
        let all = terms.iter().copied().chain(others);
        let mut a = all.fold(most, |a, t| a.min(longest_step(&t, &step.to, most_used)));
        let highest = merit(rope);
        for _ in 0..MOST_HALVINGS {
            let moved = rope.moved(a, &step.to);
            // False where a bend's course, cubic in l, has led out after all: the merit is NaN.
            let is_lower =
                merit(&moved) <= highest + least_descent * a * step.slope + NOISE * highest.abs();
            let found = || margin(before, &moved.curve, least, pairs.clone(), 2.);
            if is_lower && passages.may(found()) {
                return Some((a, moved));
            }
            a *= 0.5;
        }
        None
    }

    /// The multipliers after the share `a` of a step. Each one goes by itself: were the step as short as
    /// suits all, the first to reach 0 among thousands would hold up the others for dozens of steps.
    fn multipliers(&self, a: f64, step: &Step, around: &Surroundings) -> Multipliers {
        let (barrier, Settings { most_used, multiplier_range, .. }) =
            (self.barrier(), self.settings);
        let moved = self.z.map_with(&step.dz, |z, dz| (z + a * dz).max((1. - most_used) * z));
        around.terms.map_with(&moved, |t, z| {
            let [b, c] = t.course(&step.to);
            let force = barrier.force(&Term { g: t.g + a * (b + a * c), ..*t });
            z.clamp(force / multiplier_range, force * multiplier_range)
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::DVec3;

    use super::super::direction::Direction;
    use super::*;
    use crate::geometry::curve::Curve;

    fn circle() -> Polish {
        let angle = |i| TAU * f64::from(i) / 40.;
        let vertex = |i| DVec3::new(angle(i).cos(), angle(i).sin(), 0.);
        let circle = Curve::new(vec![(0..40).map(vertex).collect()]).unwrap();
        Polish::new(&circle, 40, false, 0, Settings::default()).unwrap()
    }

    #[test]
    fn a_step_on_which_edges_vanish_is_not_taken() {
        // All beads go through the centre to the other side, where all constraints are as they were.
        let mut polish = circle();
        let around = Surroundings { terms: polish.rope.terms(&[]), bystanders: vec![] };
        let mut to = Direction::lengthening(&polish.rope.curve, 0.);
        to.beads = polish.rope.curve.vertices().iter().map(|v| -2. * *v).collect();
        let step = Step { to, dz: polish.z.map(|_| 0.), slope: 0. };
        let (share, _) = polish.search(&step, &around, 1.).unwrap();
        assert!(share < 0.06, "edges of {} of their length are too short", 1. - 2. * share);
        assert!(polish.passages.refused > 0 && polish.passages.shown == 1);
    }

    #[test]
    fn a_multiplier_that_would_reach_0_does_not_hold_up_the_others() {
        let mut polish = circle();
        let around = polish.look_around();
        let mut dz = polish.z.map(|z| 0.5 * z);
        dz.edges[0] = -1e9;
        let step = Step { to: Direction::lengthening(&polish.rope.curve, 0.), dz, slope: -1. };
        let after = polish.multipliers(0.5, &step, &around);
        for (k, (before, after)) in polish.z.iter().zip(after.iter()).enumerate() {
            let share = if k == 0 { 1. - polish.settings.most_used } else { 1.25 };
            assert!((after - share * before).abs() < 1e-12 * before, "{k}: {before} {after}");
        }
    }
}
