//! Passes: a strand that runs above all others, or below them, is laid anew.
//!
//! A run of a strand that is the upper one at all its crossings may be lifted off, and laid down anywhere
//! between its ends. Pieces of the rest that are no longer connected may be moved apart before, since
//! nothing of the run is between them. So each pass is an isotopy; all three Reidemeister moves are such
//! passes, of up to two crossings. What crosses least are the shortest paths from face to face.

use std::collections::VecDeque;

use super::diagram::{Diagram, Slot, is_over, opposite, turned};
use super::faces::Faces;

/// How many paths between two faces are looked at.
const MOST_PATHS: usize = 24;

/// A diagram without one run of a strand, whose two ends are slots of their own.
struct Lifted {
    /// Crossings of the run have no edges any more.
    rest: Diagram,
    faces: Faces,
    /// The slots whose edges have each face to their left.
    around: Vec<Vec<Slot>>,
    begin: Slot,
    end: Slot,
    over: bool,
}

impl Diagram {
    /// The diagram after passes to fewer crossings, until there are none.
    pub fn shortened(mut self) -> Self {
        let mut begin = 0;
        while let Some((at, shorter)) = self.shorter_from(begin) {
            begin = at;
            self = shorter;
        }
        self
    }

    /// The diagram after a pass to fewer crossings, if there is one.
    pub fn shorter(&self) -> Option<Self> {
        Some(self.shorter_from(0)?.1)
    }

    /// The same, runs of this number and more first, and the number of the run.
    fn shorter_from(&self, begin: usize) -> Option<(usize, Self)> {
        if let Some(apart) = self.without_layers() {
            return Some((begin, apart));
        }
        let runs = self.runs();
        let begin = begin.min(runs.len());
        (begin..runs.len()).chain(0..begin).find_map(|at| {
            let lifted = self.lifted(&runs[at]);
            lifted.shortest(runs[at].len()).map(|path| (at, lifted.laid(&path)))
        })
    }

    /// Diagrams after a pass to at most so many `more` crossings.
    pub(super) fn passed(&self, more: usize) -> Vec<Self> {
        let of_run = |run: &Vec<Slot>| {
            let lifted = self.lifted(run);
            let paths = lifted.paths(&lifted.distances(), run.len() + more, MOST_PATHS);
            paths.iter().map(|path| lifted.laid(path)).collect::<Vec<_>>()
        };
        self.runs().iter().flat_map(of_run).collect()
    }

    /// The longest runs of strands above others or below them, by the slots where they enter crossings.
    fn runs(&self) -> Vec<Vec<Slot>> {
        let begins = self.entries().filter(|&slot| is_over(slot) != is_over(self.far[slot]));
        let run = |begin: Slot| {
            let mut run = vec![begin];
            let mut next = self.far[opposite(begin)];
            while is_over(next) == is_over(begin) {
                run.push(next);
                next = self.far[opposite(next)];
            }
            run
        };
        begins.map(run).collect()
    }

    /// The diagram with a component taken away to where it is a circle, if there is one that runs above
    /// all others, or below them.
    fn without_layers(&self) -> Option<Self> {
        let mut crossing = vec![];
        let layer = self.entries().find(|&begin| {
            crossing.clear();
            let mut slot = begin;
            loop {
                crossing.push(slot);
                slot = self.far[opposite(slot)];
                if is_over(slot) != is_over(begin) {
                    return false;
                }
                if slot == begin {
                    return true;
                }
            }
        })?;
        let mut rest = self.clone();
        rest.circles.push(self.component[layer]);
        crossing.iter().for_each(|&slot| rest.heal(turned(slot, 1)));
        Some(rest.without(|c| crossing.iter().any(|slot| slot / 4 == c)))
    }

    /// Joins what the strand in this slot comes from to where it goes, past the crossing.
    fn heal(&mut self, slot: Slot) {
        let (one, other) = (self.far[slot], self.far[opposite(slot)]);
        if one == opposite(slot) {
            self.circles.push(self.component[slot]);
        } else {
            self.join(one, other);
        }
    }

    fn lifted(&self, run: &[Slot]) -> Lifted {
        let mut rest = self.clone();
        let (begin, end) = (self.far.len(), self.far.len() + 1);
        let (first, last) = (run[0], opposite(run[run.len() - 1]));
        rest.far.extend([0; 2]);
        rest.inward.extend([false, true]);
        rest.component.extend([self.component[first]; 2]);
        rest.join(begin, self.far[first]);
        rest.join(end, self.far[last]);
        run.iter().for_each(|&slot| rest.heal(turned(slot, 1)));
        for slot in run.iter().flat_map(|&slot| (0..4).map(move |places| turned(slot, places))) {
            rest.far[slot] = slot;
        }
        let is_end = |slot: Slot| slot >= begin;
        let next = |slot: Slot| if is_end(slot) { slot } else { turned(slot, 3) };
        let faces = Faces::by(&rest.far, next);
        let around = faces.around(&rest.far);
        Lifted { rest, faces, around, begin, end, over: is_over(first) }
    }
}

impl Lifted {
    /// How many edges have to be crossed from each face to the end, at least. From none of another piece
    /// can it be reached.
    fn distances(&self) -> Vec<usize> {
        let (left, far) = (&self.faces.left, &self.rest.far);
        let mut distances = vec![usize::MAX; self.faces.count];
        distances[left[self.end]] = 0;
        let mut todo = VecDeque::from([left[self.end]]);
        while let Some(face) = todo.pop_front() {
            for &edge in &self.around[face] {
                let next = left[far[edge]];
                if distances[next] == usize::MAX {
                    distances[next] = distances[face] + 1;
                    todo.push_back(next);
                }
            }
        }
        distances
    }

    /// A shortest path from end to end, if it crosses less than so many edges. A path is given by slots
    /// whose edges it crosses from left to right.
    fn shortest(&self, less_than: usize) -> Option<Vec<Slot>> {
        let distances = self.distances();
        // Where the strand joins two pieces there is nothing between.
        match distances[self.faces.left[self.begin]] {
            usize::MAX => Some(vec![]),
            distance if distance < less_than => self.paths(&distances, distance, 1).pop(),
            _ => None,
        }
    }

    /// Up to `most` paths that enter no face twice and cross at most `longest` edges.
    fn paths(&self, distances: &[usize], longest: usize, most: usize) -> Vec<Vec<Slot>> {
        let (left, far) = (&self.faces.left, &self.rest.far);
        let mut found = vec![];
        let mut todo: Vec<Vec<Slot>> = vec![vec![]];
        while let Some(path) = todo.pop() {
            let begin = left[self.begin];
            let face = path.last().map_or(begin, |&slot| left[far[slot]]);
            if distances[face] == 0 {
                found.push(path);
                if found.len() == most {
                    break;
                }
                continue;
            }
            for &edge in &self.around[face] {
                let next = left[far[edge]];
                let entered = next == begin || path.iter().any(|&slot| left[far[slot]] == next);
                if !entered && distances[next].saturating_add(path.len() + 1) <= longest {
                    todo.push(path.iter().copied().chain([edge]).collect());
                }
            }
        }
        found
    }

    /// The diagram with the strand laid along a path.
    fn laid(&self, path: &[Slot]) -> Diagram {
        let mut laid = self.rest.clone();
        let mut strand = laid.far[self.begin];
        let goal = laid.far[self.end];
        laid.far.truncate(self.begin);
        laid.inward.truncate(self.begin);
        laid.component.truncate(self.begin);
        let own = self.rest.component[self.begin];
        if strand == self.end {
            laid.circles.push(own);
            return laid.without(|crossing| self.rest.far[4 * crossing] == 4 * crossing);
        }
        for &edge in path {
            let (one, other) = (laid.far[edge], edge);
            // The edge runs from south to north, and the strand from west to east.
            let (south, east, north, west) = corners(laid.far.len(), self.over);
            let inward = laid.inward[one];
            laid.far.extend([0; 4]);
            laid.inward.extend([false; 4]);
            laid.component.extend([own; 4]);
            laid.join(south, other);
            laid.join(north, one);
            laid.join(west, strand);
            laid.inward[west] = true;
            laid.inward[if inward { south } else { north }] = true;
            let crossed = laid.component[one];
            laid.component[south] = crossed;
            laid.component[north] = crossed;
            strand = east;
        }
        laid.join(strand, goal);
        laid.without(|crossing| {
            4 * crossing < self.begin && self.rest.far[4 * crossing] == 4 * crossing
        })
    }
}

/// The slots of a new crossing by the directions they lead to, of which west and east are the upper
/// strand's, if it is `over`.
fn corners(first: Slot, over: bool) -> (Slot, Slot, Slot, Slot) {
    let south = if over { first } else { first + 1 };
    (south, turned(south, 1), turned(south, 2), turned(south, 3))
}
