//! Whether a curve crosses itself.
//!
//! Two edges that meet have ends at most one edge length apart, so only edges at close vertices are
//! compared. Long edges are first cut to the mean length, so that "close" is small everywhere.

use glam::DVec3;

use crate::curve::Curve;
use crate::error::{Error, Result};
use crate::neighbours::{Separation, for_each_close_pair};
use crate::segments::distance;

/// Two edges count as meeting when they come closer than this share of the curve's mean edge.
const TOUCHING: f64 = 1e-9;

/// Refuses a curve two of whose edges meet other than in the vertex they share.
///
/// # Errors
/// [`Error::SelfCrossing`] names the vertices at which the two edges start.
pub fn check_embedded(curve: &Curve) -> Result<()> {
    let mean = curve.length() / curve.n() as f64;
    let (cut, origin) = cut_long_edges(curve, mean);
    let separation = Separation::by_index(&cut, &vec![1; cut.components()]);
    let reach = 2.01 * mean;
    let mut crossing = None;
    for_each_close_pair(&cut, &separation, reach, |i, j, _| {
        if edges_meet(&cut, i, j, TOUCHING * mean) {
            crossing = Some((origin[i], origin[j]));
            return 0.;
        }
        reach
    });
    crossing.map_or(Ok(()), |(i, j)| {
        let place = |i| {
            let component = curve.component_of(i);
            (component, i - curve.range(component).start)
        };
        let ((component, vertex), (other_component, other_vertex)) = (place(i), place(j));
        Err(Error::SelfCrossing { component, vertex, other_component, other_vertex })
    })
}

/// The same curve with edges of at most `longest`, and for each vertex the one before it that the
/// original has.
fn cut_long_edges(curve: &Curve, longest: f64) -> (Curve, Vec<usize>) {
    let mut origin = Vec::new();
    let mut components = Vec::new();
    for range in curve.ranges() {
        let v = &curve.vertices()[range.clone()];
        let mut cut = Vec::new();
        for (k, &from) in v.iter().enumerate() {
            let edge = v[(k + 1) % v.len()] - from;
            let parts = (edge.length() / longest).ceil().max(1.);
            cut.extend((0..parts as usize).map(|part| from + edge * (part as f64 / parts)));
            origin.resize(origin.len() + parts as usize, range.start + k);
        }
        components.push(cut);
    }
    (Curve::from_components(components), origin)
}

/// Whether the edges after vertices `i` and `j` meet outside a vertex that they share.
fn edges_meet(curve: &Curve, i: usize, j: usize, touching: f64) -> bool {
    let (a, b) = (edge(curve, i), edge(curve, j));
    match curve.index_distance(i, j) {
        // Neighbours share a vertex; they meet elsewhere only if one is folded back onto the other.
        Some(1) => {
            let (a, b) = if a[1] == b[0] { (a, b) } else { (b, a) };
            let (back, onward) = (a[0] - a[1], b[1] - b[0]);
            let across = back.cross(onward).length();
            back.dot(onward) > 0. && across <= touching * back.length().max(onward.length())
        }
        _ => distance(a, b) <= touching,
    }
}

fn edge(curve: &Curve, i: usize) -> [DVec3; 2] {
    [curve.vertices()[i], curve.vertices()[curve.next(i)]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: &[[f64; 3]]) -> Curve {
        Curve::new(vec![points.iter().map(|&p| DVec3::from(p)).collect()]).unwrap()
    }

    #[test]
    fn figure_eight_crosses_and_is_told_where() {
        let flat = [[0., 0., 0.], [2., 2., 0.], [2., 0., 0.], [0., 2., 0.]];
        let Err(Error::SelfCrossing { vertex, other_vertex, .. }) = check_embedded(&curve(&flat))
        else {
            panic!("not seen")
        };
        assert_eq!((vertex.min(other_vertex), vertex.max(other_vertex)), (0, 2));
        let lifted = [[0., 0., 0.], [2., 2., 0.], [2., 0., 1.], [0., 2., 1.]];
        assert_eq!(check_embedded(&curve(&lifted)), Ok(()));
    }

    #[test]
    fn folded_edges_cross_straight_ones_do_not() {
        let folded = [[0., 0., 0.], [3., 0., 0.], [1., 0., 0.], [1., 1., 0.]];
        assert!(check_embedded(&curve(&folded)).is_err());
        let straight = [[0., 0., 0.], [1., 0., 0.], [3., 0., 0.], [1., 1., 0.]];
        assert_eq!(check_embedded(&curve(&straight)), Ok(()));
    }

    #[test]
    fn a_vertex_on_another_edge_crosses() {
        let touching = [[0., 0., 0.], [4., 0., 0.], [4., 3., 0.], [2., 0., 0.], [0., 3., 0.]];
        assert!(check_embedded(&curve(&touching)).is_err());
    }
}
