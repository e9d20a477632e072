//! HOMFLY polynomials by the skein relation, on ever smaller diagrams.
//!
//! alpha P(right-handed) - P(left-handed)/alpha = z P(smoothed), and P = 1 for the unknot. A diagram is
//! shortened, and taken apart into pieces and summands. In each of them crossings that are first met
//! below are switched one after the other, until it can be shortened; at the latest where the strands
//! descend, and there is an unlink. What is smoothed has a crossing less, so all ends.

use std::collections::HashMap;

use super::canonical::Code;
use super::diagram::{Diagram, Slot, is_over, opposite};
use super::polynomial::Polynomial;

/// Crossings of a shortened piece up to which its polynomial is sought: below, no coefficient can be
/// too large.
const MOST_CROSSINGS: usize = 36;

/// The HOMFLY polynomial, unless that takes more than so many diagrams.
pub fn homfly(diagram: &Diagram, most: usize) -> Option<Polynomial> {
    Skein { known: HashMap::new(), most }.whole(diagram.clone())
}

struct Skein {
    known: HashMap<Code, Polynomial>,
    most: usize,
}

impl Skein {
    /// That of any diagram.
    fn whole(&mut self, diagram: Diagram) -> Option<Polynomial> {
        let diagram = diagram.shortened();
        let pieces = diagram.apart();
        let mut product = power_of_circles(pieces.len() + diagram.circles.len());
        for piece in pieces {
            for summand in piece.summands() {
                // A summand of what cannot be shortened may still be.
                let is_all = summand.crossings() == piece.crossings();
                let factor = if is_all { self.prime(summand) } else { self.whole(summand) };
                product = product.times(&factor?);
            }
        }
        Some(product)
    }

    /// That of a connected diagram that cannot be shortened.
    fn prime(&mut self, diagram: Diagram) -> Option<Polynomial> {
        if diagram.crossings() > MOST_CROSSINGS {
            return None;
        }
        let code = diagram.code();
        if let Some(known) = self.known.get(&code) {
            return Some(known.clone());
        }
        if self.known.len() >= self.most {
            return None;
        }
        let found = self.descended(diagram)?;
        self.known.insert(code, found.clone());
        Some(found)
    }

    fn descended(&mut self, mut diagram: Diagram) -> Option<Polynomial> {
        let mut sum = Polynomial::default();
        let mut alpha = 0;
        for crossing in diagram.first_met_below() {
            let sign = if diagram.is_right(crossing) { 1 } else { -1 };
            let smoothed = self.whole(diagram.smoothed(crossing))?;
            sum.add(&smoothed, sign.into(), (alpha - sign, 1));
            alpha -= 2 * sign;
            diagram = diagram.switched(crossing);
            if let Some(shorter) = diagram.shorter() {
                sum.add(&self.whole(shorter)?, 1, (alpha, 0));
                return Some(sum);
            }
        }
        sum.add(&power_of_circles(diagram.components()), 1, (alpha, 0));
        Some(sum)
    }
}

/// That of so many circles.
fn power_of_circles(circles: usize) -> Polynomial {
    (1..circles).fold(Polynomial::one(), |power, _| power.times(&Polynomial::circle()))
}

impl Diagram {
    /// The crossings that are met first from below, on a walk that begins where there is most to gain.
    fn first_met_below(&self) -> Vec<usize> {
        let mut met = vec![false; self.crossings()];
        let mut passed = vec![false; self.far.len()];
        let mut below = vec![];
        let begin =
            self.entries().filter(|&slot| !is_over(slot)).max_by_key(|&slot| self.gain(slot));
        for start in begin.into_iter().chain(self.entries()) {
            let mut slot = start;
            while !std::mem::replace(&mut passed[slot], true) {
                if !std::mem::replace(&mut met[slot / 4], true) && !is_over(slot) {
                    below.push(slot / 4);
                }
                slot = self.far[opposite(slot)];
            }
        }
        below
    }

    /// What is gained by switching and smoothing the crossing of this slot: where it has two edges in
    /// common with another one, switching removes both, and if the strands between them run against
    /// each other so does smoothing.
    fn gain(&self, slot: Slot) -> usize {
        let edges = (0..4).map(|place| (4 * (slot / 4) + place, 4 * (slot / 4) + (place + 1) % 4));
        let gain = |(one, other): (Slot, Slot)| {
            let (far_one, far_other) = (self.far[one], self.far[other]);
            let common = far_one / 4 == far_other / 4 && far_one / 4 != slot / 4;
            usize::from(common) * (1 + usize::from(self.inward[one] != self.inward[other]))
        };
        edges.map(gain).max().unwrap_or(0)
    }

    /// The diagram with a crossing smoothed along the orientations.
    fn smoothed(&self, crossing: usize) -> Self {
        let mut smoothed = self.clone();
        for (entry, exit) in self.smoothing(crossing) {
            let (one, other) = (smoothed.far[entry], smoothed.far[exit]);
            if one == exit {
                smoothed.circles.push(self.component[entry]);
            } else {
                smoothed.join(one, other);
            }
        }
        let mut smoothed = smoothed.without(|c| c == crossing);
        smoothed.renumber();
        smoothed
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::diagrams::gauss::tests::{SOME, diagram};

    #[test]
    fn the_right_handed_trefoil() {
        let (passages, right) = SOME[0];
        let expected = BTreeMap::from([((-4, 0), -1), ((-2, 0), 2), ((-2, 2), 1)]);
        assert_eq!(homfly(&diagram(passages, right), 9), Some(Polynomial(expected)));
    }

    #[test]
    fn mirror_images_exchange_alpha_and_its_inverse() {
        for (passages, right) in SOME {
            let one = diagram(passages, right);
            let mirrored = homfly(&one.mirrored(), 999).unwrap().0;
            let expected =
                homfly(&one, 999).unwrap().0.into_iter().map(|((alpha, z), value)| {
                    ((-alpha, z), if z % 2 == 0 { value } else { -value })
                });
            assert_eq!(mirrored, expected.collect());
        }
    }

    #[test]
    fn too_large_ones_are_not_waited_for() {
        let (passages, right) = SOME[3];
        assert_eq!(homfly(&diagram(passages, right), 1), None);
    }
}
