//! Diagrams in pieces: those that are apart, and the summands of connected sums.

use super::diagram::{Diagram, Slot};
use super::faces::Faces;

impl Diagram {
    /// The crossings of each connected piece.
    pub(super) fn pieces(&self) -> Vec<Vec<usize>> {
        let mut unseen = vec![true; self.crossings()];
        let mut pieces = vec![];
        for start in 0..self.crossings() {
            let (mut piece, mut todo) = (vec![], vec![start]);
            while let Some(crossing) = todo.pop() {
                if std::mem::replace(&mut unseen[crossing], false) {
                    piece.push(crossing);
                    todo.extend((0..4).map(|place| self.far[4 * crossing + place] / 4));
                }
            }
            if !piece.is_empty() {
                pieces.push(piece);
            }
        }
        pieces
    }

    /// The pieces that are apart, circles without crossings left out.
    pub fn apart(&self) -> Vec<Self> {
        let part = |piece: &Vec<usize>| {
            let mut inside = vec![false; self.crossings()];
            piece.iter().for_each(|&crossing| inside[crossing] = true);
            Self { circles: vec![], ..self.without(|crossing| !inside[crossing]) }
        };
        self.pieces().iter().map(part).collect()
    }

    /// The summands that are seen in a connected diagram: a circle that crosses two edges only, and
    /// runs through two faces, cuts it in two.
    pub fn summands(&self) -> Vec<Self> {
        let mut cut = self.clone();
        while let Some((one, other)) = cut.neck() {
            let (begin, end) = (cut.far[one], cut.far[other]);
            cut.join(one, end);
            cut.join(other, begin);
        }
        cut.apart()
    }

    /// Two slots from which edges leave, between the same faces.
    fn neck(&self) -> Option<(Slot, Slot)> {
        let left = Faces::of(self).left;
        let mut sides: Vec<_> = (0..self.far.len())
            .filter(|&slot| !self.inward[slot])
            .map(|slot| (left[slot], left[self.far[slot]], slot))
            .collect();
        sides.sort_unstable();
        let pair =
            sides.windows(2).find(|pair| (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1))?;
        Some((pair[0].2, pair[1].2))
    }
}
