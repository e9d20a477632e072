//! Flypes: a tangle turns over, and a crossing beside it passes to its other side.
//!
//! All reduced alternating diagrams of a link are joined by flypes (W. Menasco, M. Thistlethwaite, "The
//! classification of alternating links", Ann. of Math. 138 (1993) 113).

use super::diagram::{Diagram, Slot, turned};
use super::faces::Faces;

impl Diagram {
    /// The diagrams after one flype of a connected diagram.
    ///
    /// A crossing has slots to the south-east and so on; those to the east lead to the tangle. The
    /// tangle is left by an edge to the upper right, beyond which is the face north of the crossing, and
    /// by one to the lower right; between them both is a face.
    pub(super) fn flyped(&self) -> Vec<Self> {
        let faces = Faces::of(self);
        let left = &faces.left;
        let around = faces.around(&self.far);
        let mut found = vec![];
        for south_east in 0..self.far.len() {
            let (north_east, south_west) = (turned(south_east, 1), turned(south_east, 3));
            for &upper in &around[left[north_east]] {
                for &lower in &around[left[self.far[upper]]] {
                    let touched = [upper, lower, self.far[upper], self.far[lower]];
                    let beside = touched.iter().any(|slot| slot / 4 == south_east / 4);
                    if left[self.far[lower]] == left[south_west] && !beside {
                        found.extend(self.turned_over(south_east, upper, lower));
                    }
                }
            }
        }
        found
    }

    /// The diagram after the flype there, if there is more than one crossing in the tangle.
    fn turned_over(&self, south_east: Slot, upper: Slot, lower: Slot) -> Option<Self> {
        let far = &self.far;
        let [north_east, north_west, south_west] =
            [1, 2, 3].map(|places| turned(south_east, places));
        let inside = self.within([far[south_east], far[north_east], upper, lower]);
        if inside.iter().filter(|&&inside| inside).count() < 2 || inside[south_east / 4] {
            return None;
        }
        // As a crossing turns over its lower strand becomes the upper one.
        let over = |slot: Slot| (slot & !3) | (3 - slot % 4);
        let moved = |slot: Slot| if inside[slot / 4] { over(slot) } else { slot };
        let mut turned = self.clone();
        for (slot, &other) in far.iter().enumerate() {
            turned.far[moved(slot)] = moved(other);
            turned.inward[moved(slot)] = self.inward[slot];
            turned.component[moved(slot)] = self.component[slot];
        }
        for (one, other) in [
            (far[north_west], over(far[south_east])),
            (far[south_west], over(far[north_east])),
            (south_east, far[lower]),
            (north_east, far[upper]),
            (north_west, over(lower)),
            (south_west, over(upper)),
        ] {
            turned.join(one, other);
        }
        for slot in [south_east, north_east, north_west, south_west] {
            turned.inward[slot] = !turned.inward[turned.far[slot]];
            turned.component[slot] = turned.component[turned.far[slot]];
        }
        Some(turned)
    }

    /// Whether each crossing is in the tangle that has these ends.
    fn within(&self, ends: [Slot; 4]) -> Vec<bool> {
        let mut inside = vec![false; self.crossings()];
        let mut todo = ends.map(|slot| slot / 4).to_vec();
        while let Some(crossing) = todo.pop() {
            if !std::mem::replace(&mut inside[crossing], true) {
                let slots = (4 * crossing..4 * crossing + 4).filter(|slot| !ends.contains(slot));
                todo.extend(slots.map(|slot| self.far[slot] / 4));
            }
        }
        inside
    }
}
