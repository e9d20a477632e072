//! Whether a curve crosses itself.
//!
//! The box round the curve is halved again and again, and each half gets the edges that pass through
//! it, until so few are left that all of them are compared. Long edges come in many boxes, but only
//! with what is close: n random edges cost about n^1.5, a smooth curve n log n.

use glam::DVec3;

use crate::error::{Error, Result};
use crate::geometry::curve::Curve;
use crate::geometry::segments::distance;

/// Two edges count as meeting when they come closer than this share of the curve's mean edge.
const TOUCHING: f64 = 1e-9;

/// So few edges are compared at once.
const FEW: usize = 16;

/// Halving a box may make so many times as many pairs as there were before, and no more: in a bundle
/// of edges that are closer together than the box is large, all of them are in both halves.
const ALLOWANCE: f64 = 4.;

/// Refuses a curve two of whose edges meet other than in the vertex they share.
///
/// # Errors
/// [`Error::SelfCrossing`] names the vertices at which the two edges start; those of the first such
/// pair along the curve.
pub fn check_embedded(curve: &Curve) -> Result<()> {
    let edges: Vec<_> = (0..curve.n()).map(|i| edge(curve, i)).collect();
    let low = curve.vertices().iter().fold(DVec3::INFINITY, |low, v| low.min(*v));
    let high = curve.vertices().iter().fold(DVec3::NEG_INFINITY, |high, v| high.max(*v));
    let touching = TOUCHING * curve.length() / curve.n() as f64;
    // What rounding may do to places along an edge is far below that.
    let margin = touching + 1e-14 * (high - low).length();
    let whole = (0..edges.len()).map(|edge| Piece { edge, from: 0., to: 1. }).collect();
    let mut search = Search { curve, edges, touching, margin, met: None };
    search.compare(whole, [low, high], ALLOWANCE);
    let Some((i, j)) = search.met else { return Ok(()) };
    let place = |i| {
        let component = curve.component_of(i);
        (component, i - curve.range(component).start)
    };
    let ((component, vertex), (other_component, other_vertex)) = (place(i), place(j));
    Err(Error::SelfCrossing { component, vertex, other_component, other_vertex })
}

/// The part of an edge that is in a box, as places from 0 to 1 along the edge.
#[derive(Clone, Copy)]
struct Piece {
    edge: usize,
    from: f64,
    to: f64,
}

struct Search<'a> {
    curve: &'a Curve,
    edges: Vec<[DVec3; 2]>,
    touching: f64,
    margin: f64,
    met: Option<(usize, usize)>,
}

impl Search<'_> {
    /// Compares the pieces in a box; its halves may have up to `allowance` times as many pairs.
    fn compare(&mut self, pieces: Vec<Piece>, [low, high]: [DVec3; 2], allowance: f64) {
        if pieces.len() <= FEW {
            return self.compare_all(&pieces);
        }
        let (middle, sides) = (0.5 * (low + high), high - low);
        let pairs = self.pairs_in_halves(&pieces, middle);
        // What is thinner than the margin cannot be cut.
        let axes = (0..3).filter(|&axis| sides[axis] > 4. * self.margin);
        let Some(axis) = axes.min_by(|&a, &b| pairs[a].total_cmp(&pairs[b])) else {
            return self.compare_all(&pieces);
        };
        let allowance = ALLOWANCE.min(allowance * (pieces.len() as f64).powi(2) / pairs[axis]);
        if allowance < 1. {
            return self.compare_all(&pieces);
        }
        let half = |side: f64| {
            let plane = middle[axis] - side * self.margin;
            pieces.iter().filter_map(|piece| self.cut(piece, axis, plane, side)).collect()
        };
        let (left, right): (Vec<_>, Vec<_>) = (half(-1.), half(1.));
        drop(pieces);
        let mut boundary = high;
        boundary[axis] = middle[axis];
        self.compare(left, [low, boundary], allowance);
        boundary = low;
        boundary[axis] = middle[axis];
        self.compare(right, [boundary, high], allowance);
    }

    /// How many pairs of pieces, each counted twice, are in both halves of a box cut along each axis.
    fn pairs_in_halves(&self, pieces: &[Piece], middle: DVec3) -> [f64; 3] {
        let (mut low, mut high) = (DVec3::ZERO, DVec3::ZERO);
        for piece in pieces {
            let [from, to] = self.edges[piece.edge].map(|end| end - middle);
            let (one, other) = (from.lerp(to, piece.from), from.lerp(to, piece.to));
            let count = |within| DVec3::select(within, DVec3::ONE, DVec3::ZERO);
            low += count(one.min(other).cmple(DVec3::splat(self.margin)));
            high += count(one.max(other).cmpge(DVec3::splat(-self.margin)));
        }
        (low * low + high * high).to_array()
    }

    /// What is on this side of a plane, 1 being above it, if anything.
    fn cut(&self, piece: &Piece, axis: usize, plane: f64, side: f64) -> Option<Piece> {
        let [from, to] = self.edges[piece.edge].map(|end| side * (end[axis] - plane));
        let at = |t: f64| from + t * (to - from);
        let crossing = from / (from - to);
        match (at(piece.from) >= 0., at(piece.to) >= 0.) {
            (false, false) => None,
            (true, true) => Some(*piece),
            (true, false) => Some(Piece { to: crossing.clamp(piece.from, piece.to), ..*piece }),
            (false, true) => Some(Piece { from: crossing.clamp(piece.from, piece.to), ..*piece }),
        }
    }

    /// Compares all pieces, which are in the order of their edges, unless an earlier pair is known.
    fn compare_all(&mut self, pieces: &[Piece]) {
        for (k, &Piece { edge: i, .. }) in pieces.iter().enumerate() {
            for &Piece { edge: j, .. } in &pieces[k + 1..] {
                if self.met.is_some_and(|met| met <= (i, j)) {
                    break;
                }
                if distance(self.edges[i], self.edges[j]) <= self.touching
                    && edges_meet(self.curve, i, j, self.touching)
                {
                    self.met = Some((i, j));
                }
            }
        }
    }
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
    use rand::{RngExt, SeedableRng};

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

    /// The first pair of edges that meet, all being compared with all.
    fn first_of_all(curve: &Curve) -> Option<(usize, usize)> {
        let touching = TOUCHING * curve.length() / curve.n() as f64;
        let pairs = (0..curve.n()).flat_map(|i| (i + 1..curve.n()).map(move |j| (i, j)));
        let meet = |&(i, j): &(usize, usize)| {
            distance(edge(curve, i), edge(curve, j)) <= touching
                && edges_meet(curve, i, j, touching)
        };
        pairs.into_iter().find(meet)
    }

    fn found(curve: &Curve) -> Option<(usize, usize)> {
        let Err(Error::SelfCrossing { component, vertex, other_component, other_vertex }) =
            check_embedded(curve)
        else {
            return None;
        };
        let index = |component, vertex| curve.range(component).start + vertex;
        Some((index(component, vertex), index(other_component, other_vertex)))
    }

    #[test]
    fn the_first_crossing_of_any_curve_is_found() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        let mut crossing = 0;
        for trial in 0..400 {
            // Few places, so that edges meet, coincide, or are parallel; or long thin bundles.
            let places = [2., 4., 9., 60.][trial % 4];
            let bundle = if trial % 3 == 0 { 1e4 } else { 1. };
            let mut place = |_| {
                let [x, y, z] = [(); 3].map(|()| (places * random.random::<f64>()).floor());
                DVec3::new(x, y + bundle * x, z + bundle * x)
            };
            let sizes = [5, 40, 150];
            let components = sizes.map(|n| {
                let mut vertices: Vec<_> = (0..n).map(&mut place).collect();
                vertices.dedup();
                vertices
            });
            let Ok(curve) = Curve::new(components[trial % 3..].to_vec()) else { continue };
            let expected = first_of_all(&curve);
            assert_eq!(found(&curve), expected, "{trial}");
            crossing += usize::from(expected.is_some());
        }
        assert!((100..390).contains(&crossing), "{crossing}");
    }

    #[test]
    fn a_near_miss_far_from_the_others_is_seen() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(2);
        let mut vertices: Vec<_> =
            (0..3000).map(|_| DVec3::from([(); 3].map(|()| random.random::<f64>()))).collect();
        assert_eq!(found(&Curve::new(vec![vertices.clone()]).unwrap()), None);
        // Edge 10 is led through the middle of edge 2000, but for a share of an edge.
        let through = 0.5 * (vertices[2000] + vertices[2001]);
        for (miss, meets) in [(1e-10, true), (1e-8, false)] {
            let across = DVec3::new(0.3, 0.4, miss);
            vertices[10] = through - across;
            vertices[11] = through + across + DVec3::Z * 2. * miss;
            let along = vertices[2001] - vertices[2000];
            let normal = along.cross(across).normalize();
            vertices[10] += normal * miss;
            vertices[11] += normal * miss;
            let curve = Curve::new(vec![vertices.clone()]).unwrap();
            assert_eq!(found(&curve).is_some(), meets);
        }
    }
}
