//! What the edges, bends and contacts of a bead rope may be, R = 1: the rules that both engines obey.
//!
//! Baranska, Pieranski, Rawdon, "Ropelength of tight polygonal knots", sections 2 and 3.1.

use std::f64::consts::PI;

/// Edges must be shorter: with edges of sqrt 8 R strands fit between beads.
pub const LONGEST_EDGE: f64 = 2.3;
/// Shortest edge that the polish allows, as a share of the longest that there may be: see
/// [`crate::passage`] for why.
pub const SHORTEST_EDGE: f64 = 0.9;
/// From this edge length on the index rule, not the thickness of the rope, limits how sharp it turns.
pub const COARSE: f64 = 1.235;

/// Least index distance at which beads must not overlap: ceil(pi R_c/dl - 1).
///
/// The definition of SR has MinRad in place of R_c. ControlCurvature keeps MinRad >= R_c, so this
/// is the stricter side: a rope that obeys it measures R_s = 1. (The paper's text on the simulation
/// lets index distances up to ceil(pi MinRad/dl) overlap, two more than its definition of SR.)
///
/// Edges of [`COARSE`] or more would have neighbours 2 R apart. There CC keeps MinRad > 2 dl/pi, so
/// that the rule, with MinRad, goes on to exempt them.
pub fn least_index_distance(dl: f64) -> usize {
    (PI * (1. - 0.25 * dl * dl).max(0.).sqrt() / dl - 1.).ceil().max(2.) as usize
}

/// Largest length of a second difference of the vertices, v_(i-1) - 2 v_i + v_(i+1), for edges `dl`.
///
/// It is 2 dl sin(theta_i/2). The paper's R_i = dl/(2 sin(theta_i/2)), the radius at which the disks on
/// both sides of a bead become tangent, is at least 1 where it is at most dl^2. On coarse ropes
/// theta_i must stay below 2 arctan(pi/4), hence it below 1.2353 dl, for MinRad > 2 dl/pi.
pub fn most_bend(dl: f64) -> f64 {
    dl * dl.min(COARSE)
}
