//! The same code for the same diagram, however it is turned.

use super::diagram::{Diagram, Slot, is_over, opposite};

/// A code that two connected diagrams share if one is the other on the sphere, maybe seen from behind,
/// maybe with all components reversed.
pub type Code = Vec<u8>;

impl Diagram {
    /// The code of a connected diagram of at most 62 crossings: the least of those that begin anywhere.
    pub fn code(&self) -> Code {
        let right: Vec<_> = (0..self.crossings()).map(|c| self.is_right(c)).collect();
        let mut best = vec![];
        for start in 0..self.far.len() {
            for behind in [false, true] {
                self.improve(&mut best, start, behind, &right);
            }
        }
        best
    }

    /// Replaces the best code by the one that begins by this slot, if that is less. Where a strand is
    /// followed against its orientation all are.
    fn improve(&self, best: &mut Code, start: Slot, behind: bool, right: &[bool]) {
        let mut walk = Walk::new(self, best);
        let mut begin = Some(start);
        while let Some(first) = begin {
            let mut slot = first;
            loop {
                let (number, over) = (walk.number(slot / 4), is_over(slot) != behind);
                if !walk.push(4 * number + 2 * u8::from(over) + u8::from(right[slot / 4])) {
                    return;
                }
                walk.order.push(slot);
                slot = self.far[opposite(slot)];
                if slot == first {
                    break;
                }
            }
            if !walk.push(END) {
                return;
            }
            begin = walk.next(self.inward[start]);
        }
        if walk.is_less {
            *best = walk.code;
        }
    }
}

/// Where a component ends in a code.
const END: u8 = u8::MAX;

/// A walk along all components.
struct Walk<'a> {
    diagram: &'a Diagram,
    /// The code to be beaten, if there is one.
    best: &'a [u8],
    is_less: bool,
    code: Code,
    /// In which order crossings are met.
    numbers: Vec<u8>,
    count: u8,
    /// The slots by which they are entered.
    order: Vec<Slot>,
}

impl<'a> Walk<'a> {
    fn new(diagram: &'a Diagram, best: &'a [u8]) -> Self {
        let numbers = vec![END; diagram.crossings()];
        let (is_less, code, order) = (best.is_empty(), vec![], vec![]);
        Self { diagram, best, is_less, code, numbers, count: 0, order }
    }

    fn number(&mut self, crossing: usize) -> u8 {
        if self.numbers[crossing] == END {
            self.numbers[crossing] = self.count;
            self.count += 1;
        }
        self.numbers[crossing]
    }

    /// Adds a symbol; tells whether the code can still be the least.
    fn push(&mut self, symbol: u8) -> bool {
        let other = self.best.get(self.code.len()).copied().unwrap_or(END);
        self.is_less = self.is_less || symbol < other;
        self.code.push(symbol);
        self.is_less || symbol == other
    }

    /// Where the next component begins: at the first crossing that was passed only once.
    fn next(&self, forward: bool) -> Option<Slot> {
        let other = |&slot: &Slot| {
            let across = slot ^ 1;
            if self.diagram.inward[across] == forward { across } else { opposite(across) }
        };
        self.order.iter().map(other).find(|slot| !self.order.contains(slot))
    }
}
