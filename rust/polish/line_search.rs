//! How far along a Newton step constraints and the barrier function allow to go.

use super::barrier::longest_step;
use super::newton::Step;
use super::problem::{Multipliers, Surroundings, Unknowns};
use super::settings::Settings;
use super::term::Term;
use super::{Best, Polish};

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
    fn search(&self, step: &Step, around: &Surroundings, most: f64) -> Option<(f64, Unknowns)> {
        let Surroundings { terms, bystanders } = around;
        let Settings { most_used, least_descent, .. } = self.settings;
        let (rope, barrier) = (&self.rope, self.barrier());
        let pairs = self.contacts.iter().chain(bystanders).copied();
        let merit = |rope: &Unknowns| barrier.merit(rope, pairs.clone());
        let others = bystanders.iter().map(|&pair| rope.contact(pair));
        let all = terms.iter().copied().chain(others);
        let mut a = all.fold(most, |a, t| a.min(longest_step(&t, &step.to, most_used)));
        let before = merit(rope);
        for _ in 0..MOST_HALVINGS {
            let moved = rope.moved(a, &step.to);
            // False where a bend's course, cubic in l, has led out after all: the merit is NaN.
            if merit(&moved) <= before + least_descent * a * step.slope + NOISE * before.abs() {
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
