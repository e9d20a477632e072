//! What a diagram is.

/// An end of an edge: 4 times its crossing, and its place there, counter-clockwise. The lower strand
/// ends in the places 0 and 2, the upper one in 1 and 3.
pub type Slot = usize;

/// A diagram of an oriented link on the sphere.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagram {
    /// The slot at the other end of the edge in each slot.
    pub(super) far: Vec<Slot>,
    /// Whether the strand enters its crossing in this slot.
    pub(super) inward: Vec<bool>,
    /// The component that each slot belongs to.
    pub(super) component: Vec<usize>,
    /// The components without crossings.
    pub(super) circles: Vec<usize>,
}

/// The slot across the crossing, where the strand goes on.
pub(super) fn opposite(slot: Slot) -> Slot {
    slot ^ 2
}

/// The slot so many places on, counter-clockwise.
pub(super) fn turned(slot: Slot, places: usize) -> Slot {
    (slot & !3) | ((slot + places) & 3)
}

/// Whether the strand in this slot is the upper one.
pub(super) fn is_over(slot: Slot) -> bool {
    slot & 1 == 1
}

impl Diagram {
    /// The number of crossings.
    pub fn crossings(&self) -> usize {
        self.far.len() / 4
    }

    /// The number of components.
    pub fn components(&self) -> usize {
        let mut found: Vec<_> = self.component.iter().chain(&self.circles).collect();
        found.sort_unstable();
        found.dedup();
        found.len()
    }

    /// The components without crossings.
    pub fn circles(&self) -> &[usize] {
        &self.circles
    }

    /// Whether upper and lower crossings follow each other along all strands.
    pub fn is_alternating(&self) -> bool {
        self.far.iter().enumerate().all(|(slot, &far)| is_over(slot) != is_over(far))
    }

    /// Whether a crossing is right-handed.
    pub fn is_right(&self, crossing: usize) -> bool {
        // There the upper strand enters to the right of the lower one that enters.
        let under = if self.inward[4 * crossing] { 0 } else { 2 };
        self.inward[turned(4 * crossing + under, 3)]
    }

    /// The slots by which strands enter crossings.
    pub(super) fn entries(&self) -> impl Iterator<Item = Slot> {
        (0..self.far.len()).filter(|&slot| self.inward[slot])
    }

    /// Numbers the components from 0; returns how many there are.
    pub fn renumber(&mut self) -> usize {
        self.component.fill(usize::MAX);
        let mut count = 0;
        for start in 0..self.far.len() {
            if self.component[start] != usize::MAX {
                continue;
            }
            let mut slot = start;
            while self.component[slot] == usize::MAX {
                self.component[slot] = count;
                self.component[opposite(slot)] = count;
                slot = self.far[opposite(slot)];
            }
            count += 1;
        }
        self.circles = (count..count + self.circles.len()).collect();
        count + self.circles.len()
    }

    pub(super) fn join(&mut self, one: Slot, other: Slot) {
        self.far[one] = other;
        self.far[other] = one;
    }

    /// The diagram without the crossings that are `gone`, to which no edge leads any more.
    pub(super) fn without(&self, gone: impl Fn(usize) -> bool) -> Self {
        let kept: Vec<_> = (0..self.crossings()).filter(|&crossing| !gone(crossing)).collect();
        let mut place = vec![usize::MAX; self.crossings()];
        kept.iter().enumerate().for_each(|(new, &old)| place[old] = new);
        let slots = || kept.iter().flat_map(|&crossing| 4 * crossing..4 * crossing + 4);
        let moved = |slot: Slot| 4 * place[slot / 4] + slot % 4;
        Self {
            far: slots().map(|slot| moved(self.far[slot])).collect(),
            inward: slots().map(|slot| self.inward[slot]).collect(),
            component: slots().map(|slot| self.component[slot]).collect(),
            circles: self.circles.clone(),
        }
    }

    /// The diagram with its strands exchanged at a crossing.
    pub(super) fn switched(&self, crossing: usize) -> Self {
        // Each slot gets one place on, and what was said of it with it.
        let moved = |slot: Slot| if slot / 4 == crossing { turned(slot, 1) } else { slot };
        let mut switched = self.clone();
        for slot in 0..self.far.len() {
            switched.far[moved(slot)] = moved(self.far[slot]);
            switched.inward[moved(slot)] = self.inward[slot];
            switched.component[moved(slot)] = self.component[slot];
        }
        switched
    }

    /// The mirror image, in the plane of the diagram.
    pub fn mirrored(&self) -> Self {
        (0..self.crossings()).fold(self.clone(), |diagram, crossing| diagram.switched(crossing))
    }
}
