//! The KMT reduction: vertices are removed by triangle moves, those of the smallest triangles first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::geometry::sticks::Sticks;

/// Way of a shaken vertex as a share of the distance to what it might meet.
const SHAKE: f64 = 0.01;

/// Where a vertex gets by a random step so small that no edges meet on the way; then no four vertices
/// are left in one plane, where what touches could not be told from what passes.
pub fn shaken(sticks: &Sticks, i: usize, rng: &mut Pcg64Mcg) -> DVec3 {
    let most = SHAKE / 3f64.sqrt() * sticks.clearance(i).min(sticks.clearance(sticks.prev(i)));
    sticks.point(i) + most * DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1. ..1.)))
}

/// Vertices to be removed.
pub struct Reduction {
    /// The triangles at them, the smallest first; some of an area that they no longer have.
    triangles: BinaryHeap<Reverse<(u64, usize)>>,
    /// How many vertices there were when all were listed.
    before: usize,
}

impl Reduction {
    /// Lists all triangles.
    pub fn new(sticks: &Sticks) -> Self {
        let triangles = sticks.slots().filter_map(|i| triangle(sticks, i)).collect();
        Self { triangles, before: sticks.n() }
    }

    /// Removes the next vertex if it can be; returns false when none can.
    pub fn step(&mut self, sticks: &mut Sticks) -> bool {
        if let Some(Reverse((bits, i))) = self.triangles.pop() {
            if area(sticks, i) == Some(bits) {
                self.remove(i, sticks);
            }
        } else if sticks.n() < self.before {
            *self = Self::new(sticks);
        } else {
            return false;
        }
        true
    }

    fn remove(&mut self, i: usize, sticks: &mut Sticks) {
        let beside = [sticks.prev(i), sticks.next(i)];
        if sticks.remove(i) {
            self.triangles.extend(beside.iter().filter_map(|&j| triangle(sticks, j)));
        }
    }
}

fn triangle(sticks: &Sticks, i: usize) -> Option<Reverse<(u64, usize)>> {
    Some(Reverse((area(sticks, i)?, i)))
}

/// The square of the triangle's area at a vertex that is there; bits of positive numbers are in their order.
fn area(sticks: &Sticks, i: usize) -> Option<u64> {
    sticks.is_there(i).then(|| {
        let [a, b] = [sticks.prev(i), sticks.next(i)].map(|j| sticks.point(j) - sticks.point(i));
        a.cross(b).length_squared().to_bits()
    })
}
