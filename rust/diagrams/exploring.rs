//! From diagram to diagram, by passes and flypes that keep the number of crossings.

use std::collections::{HashSet, VecDeque};

use super::canonical::Code;
use super::diagram::Diagram;

/// Crossings of a diagram that is explored.
const MOST_CROSSINGS: usize = 62;

/// The diagrams that are reached from one.
struct Explorer {
    seen: HashSet<Code>,
    todo: VecDeque<Diagram>,
}

impl Explorer {
    fn new(diagram: &Diagram) -> Self {
        Self { seen: HashSet::from([diagram.code()]), todo: VecDeque::from([diagram.clone()]) }
    }

    /// Looks at the neighbours of the diagrams so far, until so many are known or `is_goal` of one; then
    /// returns that.
    fn explore(
        &mut self,
        most: usize,
        mut is_goal: impl FnMut(&Code, &Diagram) -> bool,
    ) -> Option<Diagram> {
        while self.seen.len() < most {
            let diagram = self.todo.pop_front()?;
            for next in diagram.flyped().into_iter().chain(diagram.passed()) {
                let code = next.code();
                if self.seen.insert(code.clone()) {
                    if is_goal(&code, &next) {
                        return Some(next);
                    }
                    self.todo.push_back(next);
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
    /// A diagram with fewer crossings, or one that falls apart into summands, if there is one near.
    fn simpler(&self, most: usize) -> Option<Self> {
        if self.is_alternating() || self.crossings() > MOST_CROSSINGS {
            return None;
        }
        let is_goal = |_: &Code, next: &Diagram| next.shorter().is_some() || next.summands().len() > 1;
        Explorer::new(self).explore(most, is_goal)
    }
}

/// Which of `others` moves make of a connected diagram, if up to so many diagrams on either side are
/// enough to see it.
pub fn meeting(diagram: &Diagram, others: &[Diagram], most: usize) -> Option<usize> {
    let codes: Vec<_> = others.iter().map(Diagram::code).collect();
    let at = |code: &Code| codes.iter().position(|other| other == code);
    let mut found = at(&diagram.code());
    let mut here = Explorer::new(diagram);
    if found.is_none() {
        here.explore(most, |code, _| {
            found = at(code);
            found.is_some()
        });
    }
    found.or_else(|| {
        let meets = |other: &Diagram| {
            Explorer::new(other).explore(most, |code, _| here.seen.contains(code)).is_some()
        };
        others.iter().position(meets)
    })
}
