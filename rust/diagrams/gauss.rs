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
