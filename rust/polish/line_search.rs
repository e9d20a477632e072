//! How far along a Newton step constraints, the barrier function and the strands allow to go.
//!
//! A step, on its arc too, moves all beads straight, from where the rope is to where it shall be. **No strand passes another**
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
use super::direction::Direction;
use super::newton::{Change, Step};
use super::problem::{Multipliers, Surroundings, Unknowns};
use super::settings::Settings;
use super::term::Term;
use super::{Best, Polish};
use crate::passage::margin;

/// Rounding errors of the barrier function, as a share of it.
const NOISE: f64 = 1e-14;
const MOST_HALVINGS: usize = 40;
/// Arcs so short are not looked for.
const LEAST_ARC: f64 = 1e-3;

/// The share `a` of a step, straight or on its arc, and where it leads.
struct Way {
    a: f64,
    to: Direction,
    dz: Multipliers,
    rope: Unknowns,
    merit: f64,
    margin: f64,
}

impl Polish {
    /// Goes as far along a step as possible, on its arc where that lowers the barrier function more than a
    /// part of the straight way; returns whether that is anywhere.
    pub(super) fn take(&mut self, step: &Step, around: &Surroundings) -> bool {
        let straight = self.search(step, None, around);
        let on_arc = match straight {
            Some(Way { a: 1., .. }) => None,
            _ => self.search_arc(step, around),
        };
        let ways = [straight, on_arc].into_iter().flatten();
        let lowest = ways.min_by(|a, b| a.merit.total_cmp(&b.merit));
        let Some(Way { a, to, dz, rope, margin, .. }) = lowest else {
            return false;
        };
        self.passages.may(Some(margin));
        self.z = self.multipliers(&to, &dz, around);
        self.rope = rope;
        self.newton.learn(a);
        let thinnest = 0.01 * self.rope.l.iter().copied().fold(f64::MAX, f64::min).powi(2);
        let longest_way = self.settings.longest_way;
        self.way = (4. * to.longest_way()).clamp(thinnest.min(longest_way), longest_way);
        let now = Best::new(self.rope.curve.clone());
        if now.l_p < self.best.l_p {
            self.best = now;
        }
        true
    }

    fn search_arc(&mut self, step: &Step, around: &Surroundings) -> Option<Way> {
        let arc = self.newton.arc(step, &around.terms, &self.z, self.barrier())?;
        self.search(step, Some(&arc), around)
    }

    /// The largest share of the step that lowers the barrier function.
    fn search(&mut self, step: &Step, arc: Option<&Change>, around: &Surroundings) -> Option<Way> {
        let Surroundings { terms, bystanders } = around;
        let barrier = self.barrier();
        let pairs = self.contacts.iter().chain(bystanders).copied();
        let merit = |rope: &Unknowns| barrier.merit(rope, pairs.clone());
        let others = bystanders.iter().map(|&pair| self.rope.contact(pair));
        let mut a = self.longest_share(step, arc, terms.iter().copied().chain(others));
        let highest = merit(&self.rope);
        for _ in 0..MOST_HALVINGS {
            let to = step.to(a, arc);
            let rope = self.rope.moved(1., &to);
            let least_descent = self.settings.least_descent * a * step.slope;
            // NaN where a bend's course, cubic in l, has led out after all.
            let merit = merit(&rope);
            if merit <= highest + least_descent + NOISE * highest.abs() {
                let before = self.rope.curve.vertices();
                match margin(before, &rope.curve, &self.least, pairs.clone(), 2.) {
                    Some(margin) => {
                        return Some(Way { a, to, dz: step.dz(a, arc), rope, merit, margin });
                    }
                    None => self.passages.refused += 1,
                }
            }
            a *= 0.5;
        }
        None
    }

    /// The largest share of the step on which no bead goes too far and no term is used up. On an arc it is a
    /// little less than that.
    fn longest_share(
        &self,
        step: &Step,
        arc: Option<&Change>,
        terms: impl Iterator<Item = Term> + Clone,
    ) -> f64 {
        let most_used = self.settings.most_used;
        let mut a = 1.;
        loop {
            let to = step.to(a, arc);
            let most = (self.way / to.longest_way()).min(1.);
            let share = terms.clone().fold(most, |a, t| a.min(longest_step(&t, &to, most_used)));
            if share == 1. || arc.is_none() || a < LEAST_ARC {
                return a * share;
            }
            a *= share.sqrt().clamp(0.5, 0.95);
        }
    }

    /// The multipliers after a way and their change on it. Each one goes by itself: were the step as short as
    /// suits all, the first to reach 0 among thousands would hold up the others for dozens of steps.
    fn multipliers(&self, to: &Direction, dz: &Multipliers, around: &Surroundings) -> Multipliers {
        let (barrier, Settings { most_used, multiplier_range, .. }) =
            (self.barrier(), self.settings);
        let moved = self.z.map_with(dz, |z, dz| (z + dz).max((1. - most_used) * z));
        around.terms.map_with(&moved, |t, z| {
            let [b, c] = t.course(to);
            let force = barrier.force(&Term { g: t.g + b + c, ..*t });
            z.clamp(force / multiplier_range, force * multiplier_range)
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::DVec3;

    use super::*;
    use crate::geometry::curve::Curve;

    fn circle() -> Polish {
        let angle = |i| TAU * f64::from(i) / 40.;
        let vertex = |i| DVec3::new(angle(i).cos(), angle(i).sin(), 0.);
        let circle = Curve::new(vec![(0..40).map(vertex).collect()]).unwrap();
        Polish::new(&circle, 40, false, 0, Settings::default()).unwrap()
    }

    /// A step along `to` instead of Newton's.
    fn straight(polish: &mut Polish, around: &Surroundings, to: Direction) -> Step {
        let barrier = polish.barrier();
        let step = polish.newton.step(&polish.rope, around, &polish.z, barrier).unwrap();
        let dz = polish.z.map(|_| 0.);
        Step { straight: Change { to, dz }, slope: 0., ..step }
    }

    #[test]
    fn a_step_on_which_edges_vanish_is_not_taken() {
        // All beads go through the centre to the other side, where all constraints are as they were.
        let mut polish = circle();
        let around = Surroundings { terms: polish.rope.terms(&[]), bystanders: vec![] };
        let mut to = Direction::lengthening(&polish.rope.curve, 0.);
        to.beads = polish.rope.curve.vertices().iter().map(|v| -2. * *v).collect();
        let step = straight(&mut polish, &around, to);
        polish.way = f64::MAX;
        let share = polish.search(&step, None, &around).unwrap().a;
        assert!(share < 0.06, "edges of {} of their length are too short", 1. - 2. * share);
        assert!(polish.passages.refused > 0 && polish.take(&step, &around));
        assert_eq!(polish.passages.shown, 1);
    }

    #[test]
    fn a_multiplier_that_would_reach_0_does_not_hold_up_the_others() {
        let mut polish = circle();
        let around = polish.look_around();
        let mut dz = polish.z.map(|z| 0.25 * z);
        dz.edges[0] = -1e9;
        let nowhere = Direction::lengthening(&polish.rope.curve, 0.);
        let after = polish.multipliers(&nowhere, &dz, &around);
        for (k, (before, after)) in polish.z.iter().zip(after.iter()).enumerate() {
            let share = if k == 0 { 1. - polish.settings.most_used } else { 1.25 };
            assert!((after - share * before).abs() < 1e-12 * before, "{k}: {before} {after}");
        }
    }
}
