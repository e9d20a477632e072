//! The forces in a rope: from the multipliers of a polish, or fitted to any curve.

use glam::DVec3;

use super::least_squares::least_squares;
use super::problem::{Multipliers, Terms, Unknowns, left_over};
use super::term::Term;
use crate::beads::{least_index_distance, most_bend};
use crate::geometry::curve::Curve;
use crate::geometry::neighbours::{Pair, close_pairs};
use crate::geometry::separation::Separation;
use crate::measures::measure;

/// Two beads may press against each other when at most so far out of touch, R = 1; a bead may
/// withstand bending when its radius, and an edge be in tension when its length is within this share
/// of the bound, which for edges is the longest.
const TOUCHING: f64 = 1e-4;
const BENT: f64 = 1e-3;
const SLACK: f64 = 1e-2;

/// The forces in a rope of radius 1, in units of its mean tension.
#[derive(Debug, Clone, PartialEq)]
pub struct Forces {
    /// Tension of the edge after each bead.
    pub tension: Vec<f64>,
    /// Couple with which each bead withstands bending beyond the radius of the rope: force times R.
    pub couple: Vec<f64>,
    /// Pairs of beads and the force with which they press against each other.
    pub contacts: Vec<(usize, usize, f64)>,
    /// Largest coordinate of the force that is left over on a bead.
    pub residual: f64,
}

impl Forces {
    /// The forces that the multipliers `z` of `terms` are.
    pub(super) fn new(curve: &Curve, terms: &Terms, z: &Multipliers) -> Self {
        let force = terms.map_with(z, |t, z| 2. * z * t.y.length());
        // At the neighbours, a tension's arm of one edge away, which is no shorter where that is slack.
        let arms = (0..curve.components()).flat_map(|c| curve.edge_lengths(c));
        let couple = force.bends.iter().zip(arms).map(|(force, arm)| force * arm).collect();
        let ends = terms.contacts.iter().map(|t| (t.beads[0], t.beads[1]));
        let contacts = ends.zip(force.contacts).map(|((i, j), force)| (i, j, force)).collect();
        let left = left_over(curve, terms, z).beads;
        let residual = left.iter().map(|f| f.abs().max_element()).fold(0., f64::max);
        Self { tension: force.edges, couple, contacts, residual }
    }
}

/// The forces that come nearest to balance on a curve as it is, scaled to R_s = 1: tensions,
/// couples and contact forces are sought by non-negative least squares.
///
/// Beads at most 2.0001 apart may press against each other, those whose radius is within 0.1 % of R
/// may withstand bending, and edges within 1 % of the longest may be in tension (a bead rope's edges
/// are equal), so a rope that is tight to fewer digits has a large residual. That is the
/// largest coordinate of what is left over on a bead, in units of the tension: 0 for a critical point
/// of length.
///
/// ```
/// // A polygon of edges that pull on each other with nothing to press against is out of balance.
/// use glam::DVec3;
/// let corners = [(0., 0.), (9., 0.), (9., 5.), (0., 5.)].map(|(x, y)| DVec3::new(x, y, 0.));
/// let forces = sono::polish::balance(&sono::Curve::new(vec![corners.to_vec()])?);
/// assert!(forces.residual > 0.1);
/// # Ok::<(), sono::Error>(())
/// ```
pub fn balance(curve: &Curve) -> Forces {
    let mut curve = curve.clone();
    curve.scale(1. / measure(&curve).r_s);
    let rope = Unknowns::new(curve);
    let mut terms = rope.terms(&touching(&rope));
    for t in &mut terms.edges {
        relax(t, (1. - SLACK) * rope.l[t.component]);
    }
    for t in &mut terms.bends {
        relax(t, (1. - BENT) * most_bend(rope.l[t.component]));
    }
    let z = least_squares(&rope.curve, &terms);
    Forces::new(&rope.curve, &terms, &z)
}

/// The pairs of beads that may press against each other.
fn touching(rope: &Unknowns) -> Vec<Pair> {
    // By arclength, since curves that are no ropes may have thousands of vertices in a little place.
    let least = rope.l.iter().map(|&l| (least_index_distance(l) as f64 - 0.5) * l).collect();
    close_pairs(&rope.curve, &Separation::by_arclength(&rope.curve, least), 2. + TOUCHING)
}

/// Takes the force from a term whose |y| is less: without a gradient its multiplier has no effect.
fn relax(t: &mut Term, least: f64) {
    if t.y.length() < least {
        (t.y, t.h) = (DVec3::ZERO, [0.; 2]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_couple_beside_a_slack_edge_has_the_same_arm() {
        let v = [[0., 0., 0.], [3., 0., 0.], [3., 2., 0.], [0., 2., 1.]].map(DVec3::from);
        let rope = Unknowns::new(Curve::new(vec![v.to_vec()]).unwrap());
        let mut terms = rope.terms(&[]);
        let z = terms.map(|_| 1.);
        let taut = Forces::new(&rope.curve, &terms, &z);
        relax(&mut terms.edges[1], 3.);
        let slack = Forces::new(&rope.curve, &terms, &z);
        assert_eq!((taut.tension[1], slack.tension[1]), (4., 0.));
        assert_eq!(slack.couple, taut.couple);
        assert!(taut.couple.iter().all(|&couple| couple > 1.));
    }
}
