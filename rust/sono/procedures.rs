//! EqualizeEdges, RemoveOverlaps and ControlCurvature: the three procedures of a SONO sweep.
//!
//! Baranska, Pieranski, Rawdon, "Ropelength of tight polygonal knots", section 3.1, with R = SR = 1.
//! Each procedure visits its pairs one after the other and moves both vertices at once along the
//! line between them, symmetrically (a Gauss-Seidel sweep), and returns the largest violation it
//! met. RO's factor is printed as c_1 in the paper where c_2 is meant.

use glam::DVec3;

use crate::beads::most_bend;

/// EE: brings each edge of one component closer to `dl`, by the share `c_1` at either end.
/// Returns the largest |dl/s_i - 1| met.
///
/// Every other edge first, then the ones between: these do not wait for each other, which is
/// three times as fast as walking along the chain and converges alike.
pub fn equalize_edges(v: &mut [DVec3], dl: f64, c_1: f64, odd_first: bool) -> f64 {
    let per_square = 1. / (dl * dl);
    let mut worst = 0f64;
    let mut equalize = |from: &mut DVec3, to: &mut DVec3| {
        let edge = *to - *from;
        // Two beads in one place stay there: there is no direction to move them in.
        let squared = edge.length_squared().max(f64::MIN_POSITIVE);
        let lack = inverse_root(squared * per_square - 1.);
        let shift = (c_1 * lack) * edge;
        *from -= shift;
        *to += shift;
        if lack.abs() > worst {
            worst = lack.abs();
        }
    };
    for parity in [odd_first as usize, 1 - odd_first as usize] {
        for pair in v[parity..].chunks_exact_mut(2) {
            let [from, to] = pair else { unreachable!() };
            equalize(from, to);
        }
    }
    // Last the edge that closes the component.
    if let [first, .., last] = v {
        equalize(last, first);
    }
    worst
}

/// 1/sqrt(1 + x) - 1; near 0, where nearly all calls are, by its series, at a third of the cost.
fn inverse_root(x: f64) -> f64 {
    if x.abs() < 1e-2 {
        x * (-1. / 2. + x * (3. / 8. + x * (-5. / 16. + x * (35. / 128. - x * (63. / 256.)))))
    } else {
        1. / (1. + x).sqrt() - 1.
    }
}

/// RO: pushes overlapping beads apart to a distance of 2 + epsilon, by the share `c_2` each.
/// Returns the largest overlap 2 - r_ij met.
pub fn remove_overlaps(v: &mut [DVec3], pairs: &[(u32, u32)], c_2: f64, epsilon: f64) -> f64 {
    let mut closest = 4f64;
    let spread = 1. + 0.5 * epsilon;
    for &(i, j) in pairs {
        let (i, j) = (i as usize, j as usize);
        let apart = v[j] - v[i];
        let squared = apart.length_squared().max(f64::MIN_POSITIVE);
        if squared < 4. {
            closest = closest.min(squared);
            // (2 + epsilon)/r - 1
            let lack = spread * inverse_root(0.25 * squared - 1.) + 0.5 * epsilon;
            let shift = (c_2 * lack) * apart;
            v[i] -= shift;
            v[j] += shift;
        }
    }
    2. - closest.sqrt()
}

/// CC: opens each corner of one component whose second difference is longer than [`most_bend`],
/// moving its vertex inwards and the two beside it outwards, across the edges, so that these keep
/// their lengths; a difference of the two edges enters it only squared. Returns the largest excess
/// met, 1 - R_i where edges are not coarse.
pub fn control_curvature(v: &mut [DVec3], dl: f64) -> f64 {
    let n = v.len();
    let most = most_bend(dl);
    let mut worst = 0f64;
    let mut open = |i: usize, j: usize, k: usize| {
        let bend = (v[i] - v[j]) + (v[k] - v[j]);
        let squared = bend.length_squared();
        if squared > most * most {
            let excess = 1. - most / squared.sqrt();
            let shift = (excess / 6.) * bend;
            v[i] -= shift;
            v[j] += 2. * shift;
            v[k] -= shift;
            worst = worst.max(excess);
        }
    };
    for j in 1..n - 1 {
        open(j - 1, j, j + 1);
    }
    open(n - 2, n - 1, 0);
    open(n - 1, 0, 1);
    worst
}
