//! From diagram to diagram, by passes and flypes.

use std::collections::{BTreeMap, HashSet};

use super::canonical::Code;
use super::diagram::Diagram;

/// Crossings of a diagram that is explored.
const MOST_CROSSINGS: usize = 60;

/// Crossings that a detour may have more than the smallest diagram so far.
const DETOUR: usize = 2;

/// Diagrams that a search for a meeting looks at before it begins on the other side.
const FIRST_STEPS: usize = 200;

/// The diagrams that are reached from a connected one.
struct Explorer {
    seen: HashSet<Code>,
    /// Whose neighbours were not looked at: by the number of crossings, and of diagrams seen before.
    todo: BTreeMap<(usize, usize), Diagram>,
    fewest: usize,
}

impl Explorer {
    fn new(diagram: &Diagram) -> Self {
        let fewest = diagram.crossings();
        let todo = BTreeMap::from([((fewest, 0), diagram.clone())]);
        Self { seen: HashSet::from([diagram.code()]), todo, fewest }
    }

    /// Looks at so many neighbours and some more, first at those of the smallest diagrams, until
    /// `is_goal` of one; then returns that. One that falls apart has an empty code.
    fn explore(
        &mut self,
        most: usize,
        mut is_goal: impl FnMut(&Code, &Diagram) -> bool,
    ) -> Option<Diagram> {
        let mut looked = 0;
        while looked < most {
            let ((crossings, _), diagram) = self.todo.pop_first()?;
            for next in diagram.neighbours((self.fewest + DETOUR).saturating_sub(crossings)) {
                looked += 1;
                let code = if next.is_connected() { next.code() } else { Code::new() };
                if is_goal(&code, &next) {
                    return Some(next);
                }
                self.fewest = self.fewest.min(next.crossings());
                if !code.is_empty() && self.seen.insert(code) {
                    self.todo.insert((next.crossings(), self.seen.len()), next);
                }
            }
        }
        None
    }
}

/// A part of a link that is apart from the rest.
pub struct Piece {
    components: HashSet<usize>,
    /// The prime links it is the sum of; an unknot is the sum of none.
    pub primes: Vec<Diagram>,
}

/// The pieces and the summands that a link is seen to be made of, when up to `most` diagrams of each, of
/// the same size, are looked through for one that can be made smaller.
pub fn pieces(diagram: &Diagram, most: usize) -> Vec<Piece> {
    let diagram = diagram.clone().shortened();
    let circle = |&circle| Piece { components: HashSet::from([circle]), primes: vec![] };
    let mut found: Vec<_> = diagram.circles.iter().map(circle).collect();
    for piece in diagram.apart() {
        let summands = piece.summands();
        if summands.len() > 1 {
            found.extend(joined(summands.iter().flat_map(|summand| pieces(summand, most))));
        } else if let Some(simpler) = piece.simpler(most) {
            found.extend(pieces(&simpler, most));
        } else {
            let components = piece.component.iter().copied().collect();
            found.push(Piece { components, primes: vec![piece] });
        }
    }
    found
}

/// Joins pieces of summands that have a component in common.
fn joined(pieces: impl Iterator<Item = Piece>) -> Vec<Piece> {
    pieces.fold(vec![], |found, mut piece| {
        let (apart, shared): (Vec<_>, Vec<_>) = found
            .into_iter()
            .partition(|other: &Piece| other.components.is_disjoint(&piece.components));
        for other in shared {
            piece.components.extend(other.components);
            piece.primes.extend(other.primes);
        }
        apart.into_iter().chain([piece]).collect()
    })
}

impl Diagram {
    /// The diagrams after one move, with at most so many `more` crossings.
    fn neighbours(&self, more: usize) -> Vec<Self> {
        // Of a reduced alternating diagram flypes make all others.
        let passed = self.passed(if self.is_alternating() { 0 } else { more });
        self.flyped().into_iter().chain(passed).collect()
    }

    fn is_connected(&self) -> bool {
        self.circles.is_empty() && self.pieces().len() == 1
    }

    /// A diagram with fewer crossings, or one that falls apart into summands, if there is one near.
    fn simpler(&self, most: usize) -> Option<Self> {
        if self.is_alternating() || self.crossings() > MOST_CROSSINGS {
            return None;
        }
        Explorer::new(self).explore(most, |_, next| {
            next.crossings() < self.crossings()
                || next.crossings() == self.crossings() && next.summands().len() > 1
        })
    }
}

/// Which of `others` moves make of a connected diagram of at most 60 crossings, if this is seen among
/// some `most` diagrams on either side.
pub fn meeting(diagram: &Diagram, others: &[Diagram], most: usize) -> Option<usize> {
    if diagram.crossings() > MOST_CROSSINGS {
        return None;
    }
    let mut here = Explorer::new(diagram);
    let mut there: Vec<_> = others.iter().map(Explorer::new).collect();
    let mut found = there.iter().position(|side| side.seen == here.seen);
    // Now from this side, now from the other ones, each time farther.
    let mut steps = FIRST_STEPS;
    while found.is_none() && steps <= most {
        here.explore(steps, |code, _| {
            found = there.iter().position(|side| side.seen.contains(code));
            found.is_some()
        });
        found = found.or_else(|| {
            let meets = |side: &mut Explorer| {
                side.explore(steps, |code, _| here.seen.contains(code)).is_some()
            };
            there.iter_mut().position(meets)
        });
        steps *= 2;
    }
    found
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;
    use crate::diagrams::gauss::tests::{SOME, diagram};
    use crate::diagrams::homfly::homfly;

    /// A diagram of the same link after random moves.
    fn entangled(diagram: &Diagram, seed: u64) -> Diagram {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        (0..5).fold(diagram.clone(), |diagram, _| {
            let more = if diagram.crossings() > 16 { 0 } else { 2 };
            let mut next: Vec<_> =
                diagram.flyped().into_iter().chain(diagram.passed(more)).collect();
            next.retain(Diagram::is_connected);
            if next.is_empty() {
                diagram
            } else {
                next.swap_remove(rng.random_range(0..next.len()))
            }
        })
    }

    #[test]
    fn moves_keep_the_polynomial_and_the_components() {
        for (passages, right) in SOME {
            let one = diagram(passages, right);
            for seed in 0..20 {
                let other = entangled(&one, seed);
                assert_eq!(homfly(&other, 9999), homfly(&one, 9999), "{other:?}");
                assert_eq!(other.components(), passages.len());
                let again = other.gauss(passages.len()).diagram().expect("a diagram on the sphere");
                assert_eq!(again.code(), other.code());
            }
        }
    }

    #[test]
    fn diagrams_of_one_link_meet_and_those_of_mirror_images_do_not() {
        for (passages, right) in SOME {
            let one = diagram(passages, right);
            let mirror_image = one.mirrored();
            let is_chiral = homfly(&one, 9999) != homfly(&mirror_image, 9999);
            for seed in 0..5 {
                let parts = pieces(&entangled(&one, seed), 1000);
                assert_eq!((parts.len(), parts[0].primes.len()), (1, 1));
                let other = &parts[0].primes[0];
                assert_eq!(other.crossings(), one.crossings());
                let sides = [mirror_image.clone(), one.clone()];
                assert_eq!(
                    meeting(other, &sides[usize::from(!is_chiral)..], 1000),
                    Some(is_chiral.into())
                );
            }
        }
    }

    #[test]
    fn sums_and_pieces_come_apart() {
        // A trefoil, a kink, a figure-eight knot on one strand; and a circle that lies below it all.
        let along = [-1, 2, -3, 1, -2, 3, 4, -4, -5, 7, -6, 8, -7, 5, -8, 6, 9, 10];
        let sum = diagram(&[&along, &[-9, -10], &[]], "rrrrrlrlrl");
        let parts = pieces(&sum, 100);
        let mut sizes: Vec<Vec<_>> =
            parts.iter().map(|p| p.primes.iter().map(Diagram::crossings).collect()).collect();
        sizes.iter_mut().for_each(|sizes| sizes.sort_unstable());
        sizes.sort_unstable();
        assert_eq!(sizes, [vec![], vec![], vec![3, 4]]);
    }
}
