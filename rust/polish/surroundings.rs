//! What is near what: the contacts, and the pairs that may become some.

use super::Polish;
use super::problem::Surroundings;
use crate::beads::least_index_distance;
use crate::geometry::neighbours::{Pair, close_pairs};
use crate::geometry::separation::Separation;

impl Polish {
    /// Brings the contacts up to date; one that is new gets the multiplier that the barrier asks for.
    pub(super) fn look_around(&mut self) -> Surroundings {
        let barrier = self.barrier();
        let (bystanders, contacts): (Vec<_>, Vec<_>) = self
            .near(2. + (2.5 * self.way).max(0.4 * barrier.hat))
            .into_iter()
            .partition(|&pair| self.rope.contact(pair).g >= barrier.hat);
        let terms = self.rope.terms(&contacts);
        let multiplier = |(pair, t)| match self.contacts.binary_search(pair) {
            Ok(known) => self.z.contacts[known],
            Err(_) => barrier.force(t),
        };
        self.z.contacts = contacts.iter().zip(&terms.contacts).map(multiplier).collect();
        self.contacts = contacts;
        Surroundings { terms, bystanders }
    }

    /// The pairs of beads closer than `reach` that are not neighbours along the rope, sorted.
    fn near(&mut self, reach: f64) -> Vec<Pair> {
        for (least, &l) in self.least.iter_mut().zip(&self.rope.l) {
            *least = least_index_distance(l).max(*least);
        }
        let separation = Separation::by_index(&self.rope.curve, &self.least);
        close_pairs(&self.rope.curve, &separation, reach)
    }
}
