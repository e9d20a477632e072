//! Gauss codes: what one meets along the components.

use super::diagram::{Diagram, Slot, is_over, opposite, turned};
use super::faces::Faces;

/// A Gauss code with the hands of the crossings, which fixes a diagram on the sphere piece by piece.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Gauss {
    /// For each component the crossings it passes, in order, and whether above.
    pub passages: Vec<Vec<(usize, bool)>>,
    /// Whether each crossing is right-handed.
    pub right: Vec<bool>,
}

impl Gauss {
    /// The diagram, unless a crossing is not met once above and once below, or none can be drawn on a
    /// sphere.
    pub fn diagram(&self) -> Option<Diagram> {
        let slots = 4 * self.right.len();
        let mut diagram = Diagram {
            far: vec![usize::MAX; slots],
            inward: vec![false; slots],
            component: vec![0; slots],
            circles: vec![],
        };
        let met: usize = self.passages.iter().map(Vec::len).sum();
        for (component, passages) in self.passages.iter().enumerate() {
            if passages.is_empty() {
                diagram.circles.push(component);
            }
            for (k, &passage) in passages.iter().enumerate() {
                let next = passages[(k + 1) % passages.len()];
                let (one, other) = (opposite(self.entry(passage)?), self.entry(next)?);
                diagram.join(one, other);
                diagram.inward[other] = true;
                diagram.component[one] = component;
                diagram.component[other] = component;
            }
        }
        let is_whole = 2 * met == slots && !diagram.far.contains(&usize::MAX);
        (is_whole && Faces::of(&diagram).are_of_spheres(&diagram)).then_some(diagram)
    }

    /// The slot by which a strand enters a crossing.
    fn entry(&self, (crossing, over): (usize, bool)) -> Option<Slot> {
        let right = self.right.get(crossing)?;
        Some(
            4 * crossing
                + if !over {
                    0
                } else if *right {
                    3
                } else {
                    1
                },
        )
    }
}

impl Diagram {
    /// The Gauss code, of so many components.
    pub fn gauss(&self, components: usize) -> Gauss {
        let mut passages = vec![vec![]; components];
        let mut seen = vec![false; self.far.len()];
        for start in self.entries() {
            let mut slot = start;
            while !seen[slot] {
                seen[slot] = true;
                passages[self.component[slot]].push((slot / 4, is_over(slot)));
                slot = self.far[opposite(slot)];
            }
        }
        Gauss { passages, right: (0..self.crossings()).map(|c| self.is_right(c)).collect() }
    }

    /// The two slots by which strands leave a crossing without crossing each other, each to be joined
    /// to where the other one is entered.
    pub(super) fn smoothing(&self, crossing: usize) -> [(Slot, Slot); 2] {
        let under = if self.inward[4 * crossing] { 4 * crossing } else { 4 * crossing + 2 };
        let over = if self.inward[turned(under, 1)] { turned(under, 1) } else { turned(under, 3) };
        [(under, opposite(over)), (over, opposite(under))]
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// The knots 3_1, 4_1, 8_19 and 10_132, the links L5a1 and L6n1: Gauss codes and hands.
    pub const SOME: [(&[&[i32]], &str); 6] = [
        (&[&[-1, 2, -3, 1, -2, 3]], "rrr"),
        (&[&[-1, 3, -2, 4, -3, 1, -4, 2]], "rlrl"),
        (&[&[-1, 8, 2, -5, 3, -7, 4, -2, 5, -3, -6, 1, 7, -4, -8, 6]], "rrrrrrrr"),
        (
            &[&[-1, 5, -2, 9, -3, 6, -4, 1, -5, 4, -6, 3, 7, -10, 8, -7, -9, 2, 10, -8]],
            "llllllrrlr",
        ),
        (&[&[-1, 3, -2, 5, -3, 4], &[-4, 1, -5, 2]], "lrllr"),
        (&[&[-1, 3, 2, -4], &[-3, -6, 4, 5], &[-5, 1, 6, -2]], "llrrrr"),
    ];

    fn gauss(passages: &[&[i32]], right: &str) -> Gauss {
        let passage = |&number: &i32| (number.unsigned_abs() as usize - 1, number > 0);
        let passages = passages.iter().map(|along| along.iter().map(passage).collect()).collect();
        Gauss { passages, right: right.chars().map(|hand| hand == 'r').collect() }
    }

    pub fn diagram(passages: &[&[i32]], right: &str) -> Diagram {
        gauss(passages, right).diagram().expect("a diagram on the sphere")
    }

    #[test]
    fn codes_give_the_diagrams_they_are_of() {
        for (passages, right) in SOME {
            let one = diagram(passages, right);
            let code = one.gauss(passages.len());
            assert_eq!(code.right, gauss(passages, right).right);
            assert_eq!(code.diagram().expect("a diagram on the sphere").code(), one.code());
        }
    }

    #[test]
    fn what_is_no_diagram_is_refused() {
        for (passages, right) in [
            (&[1, 2, -1, -2][..], "rr"),
            (&[1, 1], "r"),
            (&[1, -2], "rr"),
            (&[1, -1, 2], "rr"),
            (&[-1, 2, -3, 1, -2, 3], "rrl"),
        ] {
            assert_eq!(gauss(&[passages], right).diagram(), None);
        }
    }
}
