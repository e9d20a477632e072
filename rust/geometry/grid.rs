//! A spatial hash: which points are in the same or in touching cells.

use glam::{DVec3, IVec3};

const NONE: u32 = u32::MAX;

/// Spatial hash of points: buckets chained through `next`, latest entry first.
pub struct Grid {
    cells: Vec<IVec3>,
    heads: Vec<u32>,
    next: Vec<u32>,
}

impl Grid {
    /// The points in cells of this `side`.
    pub fn new(points: &[DVec3], side: f64) -> Self {
        // Cells count from the corner of the points' box, so that a far origin costs no digits.
        let corner = points.iter().fold(DVec3::INFINITY, |low, p| low.min(*p));
        let cells = points.iter().map(|p| ((p - corner) / side).floor().as_ivec3()).collect();
        let mut grid = Self {
            heads: vec![NONE; (2 * points.len()).next_power_of_two()],
            next: vec![NONE; points.len()],
            cells,
        };
        for k in 0..points.len() {
            let bucket = grid.bucket(grid.cells[k]);
            grid.next[k] = grid.heads[bucket];
            grid.heads[bucket] = k as u32;
        }
        grid
    }

    fn bucket(&self, cell: IVec3) -> usize {
        let hash = (cell.x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
            ^ (cell.y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f)
            ^ (cell.z as u64).wrapping_mul(0x1656_67b1_9e37_79f9);
        (hash >> 20) as usize & (self.heads.len() - 1)
    }

    /// Calls `visit` for point `k` itself and each later one in the 27 cells around it.
    pub fn for_each_near(&self, k: usize, mut visit: impl FnMut(usize)) {
        for offset in 0..27 {
            let step = IVec3::new(offset % 3 - 1, offset / 3 % 3 - 1, offset / 9 - 1);
            let cell = self.cells[k] + step;
            let mut l = self.heads[self.bucket(cell)];
            // Entries are chained latest first, so the rest of a chain is earlier than k.
            while l != NONE && l as usize >= k {
                if self.cells[l as usize] == cell {
                    visit(l as usize);
                }
                l = self.next[l as usize];
            }
        }
    }
}
