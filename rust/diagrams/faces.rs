//! The faces of a diagram.

use super::diagram::{Diagram, Slot, turned};

/// The number of the face to the left of the edge that leaves each slot. Pieces that are apart have
/// faces of their own.
pub(super) struct Faces {
    pub left: Vec<usize>,
    pub count: usize,
}

impl Faces {
    pub fn of(diagram: &Diagram) -> Self {
        Self::by(&diagram.far, |slot| turned(slot, 3))
    }

    /// Those of a graph in which `next` is the slot clockwise from another. What has no edges, its
    /// slots at the other end of themselves, has no faces.
    pub fn by(far: &[Slot], next: impl Fn(Slot) -> Slot) -> Self {
        let mut left = vec![usize::MAX; far.len()];
        let mut count = 0;
        for start in 0..far.len() {
            let mut slot = start;
            if far[slot] == slot || left[slot] != usize::MAX {
                continue;
            }
            while left[slot] == usize::MAX {
                left[slot] = count;
                slot = next(far[slot]);
            }
            count += 1;
        }
        Self { left, count }
    }

    /// The slots whose edges have each face to their left.
    pub fn around(&self, far: &[Slot]) -> Vec<Vec<Slot>> {
        let mut around = vec![vec![]; self.count];
        let edges = (0..far.len()).filter(|&slot| far[slot] != slot);
        edges.for_each(|slot| around[self.left[slot]].push(slot));
        around
    }

    /// Whether each piece has as many faces as on a sphere (Euler).
    pub fn are_of_spheres(&self, diagram: &Diagram) -> bool {
        self.count == diagram.crossings() + 2 * diagram.pieces().len()
    }
}
