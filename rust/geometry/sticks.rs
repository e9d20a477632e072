//! A polygon of few long edges, moved without letting one edge pass another.
//!
//! A vertex v between a and b may go straight to another place, or be removed, where no other edge
//! meets the triangles that its two edges sweep: a v v' and v b v', or a v b. That is decided
//! exactly, by the signs of volumes in adaptive arithmetic (J. Shewchuk, "Adaptive precision
//! floating-point arithmetic and fast robust geometric predicates", Discrete Comput. Geom. 18 (1997)
//! 305), and what only touches counts as met, so each move is an isotopy, however close the strands
//! and however different the scales. The edges are kept in a tree of boxes along the curve.

use glam::DVec3;
use robust::{Coord3D, orient3d};
use serde::{Deserialize, Serialize};

use crate::geometry::boxes::{Span, Tree};
use crate::geometry::curve::Curve;
use crate::geometry::segments;

/// Vertices in slots, linked to rings; what is removed leaves its slot empty.
///
/// ```
/// use glam::DVec3;
/// use sono::geometry::sticks::Sticks;
/// let square = [(0., 0.), (1., 0.), (1., 1.), (0., 1.)].map(|(x, y)| DVec3::new(x, y, x * y));
/// let mut sticks = Sticks::new(&sono::Curve::new(vec![square.to_vec()])?);
/// assert!(sticks.remove(0));
/// assert!(!sticks.remove(1), "a triangle is as simple as a component gets");
/// # Ok::<(), sono::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Sticks {
    points: Vec<DVec3>,
    next: Vec<usize>,
    prev: Vec<usize>,
    /// Where each component begins among the slots, and the end of the last.
    bounds: Vec<usize>,
    /// How many vertices each component has.
    left: Vec<usize>,
    tree: Tree,
    moves: Moves,
}

/// How many vertices were moved, one after the other, and removed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Moves {
    /// Moves of a vertex.
    pub moved: u64,
    /// Vertices removed.
    pub removed: u64,
}

impl Sticks {
    /// The polygon as it is.
    pub fn new(curve: &Curve) -> Self {
        let n = curve.n();
        let points = curve.vertices().to_vec();
        let next: Vec<_> = (0..n).map(|i| curve.next(i)).collect();
        let prev = (0..n).map(|i| curve.prev(i)).collect();
        let bounds = (0..curve.components()).map(|c| curve.range(c).start).chain([n]).collect();
        let left = curve.ranges().map(|range| range.len()).collect();
        let tree =
            Tree::new(next.iter().enumerate().map(|(i, &j)| Span::of(&[points[i], points[j]])));
        Self { points, next, prev, bounds, left, tree, moves: Moves::default() }
    }

    /// The same on another curve, its moves being added to those of `earlier` sticks.
    pub fn after(earlier: &Self, curve: &Curve) -> Self {
        Self { moves: earlier.moves, ..Self::new(curve) }
    }

    /// How many moves there were.
    pub fn moves(&self) -> Moves {
        self.moves
    }

    /// The polygon as a curve.
    pub fn curve(&self) -> Curve {
        let component = |bounds: &[usize]| {
            (bounds[0]..bounds[1]).filter(|&i| self.is_there(i)).map(|i| self.points[i]).collect()
        };
        Curve::from_components(self.bounds.windows(2).map(component).collect())
    }

    /// The vertices, component after component.
    pub fn slots(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.points.len()).filter(|&i| self.is_there(i))
    }

    /// Number of vertices.
    pub fn n(&self) -> usize {
        self.left.iter().sum()
    }

    /// Length of all edges.
    pub fn length(&self) -> f64 {
        self.slots().map(|i| self.points[i].distance(self.points[self.next[i]])).sum()
    }

    /// Whether vertex `i` has not been removed.
    pub fn is_there(&self, i: usize) -> bool {
        self.next[i] != REMOVED
    }

    /// Puts all vertices elsewhere, which must be known to be an isotopy.
    pub fn set_points(&mut self, points: Vec<DVec3>) {
        self.moves.moved += points.len() as u64;
        self.points = points;
        self.tree = Tree::new((0..self.points.len()).map(|i| Span::of(&self.edge(i))));
    }

    /// The edges, named by the vertex before each, that come within `reach` of the path through the vertices.
    pub fn near(&self, path: [usize; 3], reach: f64) -> Vec<usize> {
        let mut near = vec![];
        self.tree.any(&Span::of(&path.map(|i| self.points[i])).grown(reach), |i| {
            near.push(i);
            false
        });
        near
    }

    /// Where vertex `i` is.
    pub fn point(&self, i: usize) -> DVec3 {
        self.points[i]
    }

    /// The ends of the edge after vertex `i`.
    pub fn edge(&self, i: usize) -> [DVec3; 2] {
        [self.points[i], self.points[self.next[i]]]
    }

    /// The vertex after `i`.
    pub fn next(&self, i: usize) -> usize {
        self.next[i]
    }

    /// The vertex before `i`.
    pub fn prev(&self, i: usize) -> usize {
        self.prev[i]
    }

    /// Removes vertex `i` if that is an isotopy; a triangle is as simple as a component gets.
    pub fn remove(&mut self, i: usize) -> bool {
        let (a, b) = (self.prev[i], self.next[i]);
        let c = self.bounds.partition_point(|&bound| bound <= i) - 1;
        if self.left[c] == 3
            || self.meets([a, i, b].map(|i| self.points[i]), [Some(a), None, Some(b)], i)
        {
            return false;
        }
        self.left[c] -= 1;
        self.moves.removed += 1;
        (self.next[a], self.prev[b]) = (b, a);
        (self.next[i], self.prev[i]) = (REMOVED, REMOVED);
        self.tree.set(i, Span::EMPTY);
        self.tree.set(a, Span::of(&self.edge(a)));
        true
    }

    /// Moves vertex `i` to a `place` if that is an isotopy.
    pub fn shift(&mut self, i: usize, place: DVec3) -> bool {
        let (a, b) = (self.prev[i], self.next[i]);
        let [from, p, q] = [i, a, b].map(|i| self.points[i]);
        // In one plane the two edges might come to lie on each other.
        if volume(p, q, from, place) == 0.
            || self.meets([p, from, place], [Some(a), None, None], i)
            || self.meets([q, from, place], [Some(b), None, None], i)
        {
            return false;
        }
        self.points[i] = place;
        self.moves.moved += 1;
        self.tree.set(a, Span::of(&self.edge(a)));
        self.tree.set(i, Span::of(&self.edge(i)));
        true
    }

    /// Distance of the edge after vertex `i` from all others; from its neighbours, that of the ends
    /// which they do not share.
    pub fn clearance(&self, i: usize) -> f64 {
        let [from, to] = self.edge(i);
        let apart = |edge: [DVec3; 2], other: [DVec3; 2]| {
            segments::to_point(edge, other[1]).min(segments::to_point(other, edge[0]))
        };
        let near = apart(self.edge(self.prev[i]), [from, to])
            .min(apart([from, to], self.edge(self.next[i])));
        let own = [self.prev[i], i, self.next[i]];
        self.tree.nearest(&Span::of(&[from, to]), near, |j| {
            if own.contains(&j) { f64::MAX } else { segments::distance([from, to], self.edge(j)) }
        })
    }

    /// Distance of vertex `i` from the edges that do not end there.
    pub fn room(&self, i: usize) -> f64 {
        let point = self.points[i];
        self.tree.nearest(&Span::of(&[point]), f64::MAX, |j| {
            if j == i || j == self.prev[i] {
                f64::MAX
            } else {
                segments::to_point(self.edge(j), point)
            }
        })
    }

    /// Whether an edge other than the two at `moving` meets a triangle, whose `corners` that are
    /// vertices it may share.
    fn meets(&self, triangle: [DVec3; 3], corners: [Option<usize>; 3], moving: usize) -> bool {
        let [a, b, c] = triangle;
        let before = self.prev[moving];
        self.tree.any(&Span::of(&triangle), |i| {
            let j = self.next[i];
            if i == moving || i == before {
                return false;
            }
            let [p, q] = [self.points[i], self.points[j]];
            if corners.contains(&Some(i)) {
                return volume(a, b, c, q) == 0.;
            }
            if corners.contains(&Some(j)) {
                return volume(a, b, c, p) == 0.;
            }
            pierces([p, q], triangle)
        })
    }
}

const REMOVED: usize = usize::MAX;

/// Six times the volume of a tetrahedron; its sign is exact.
pub(crate) fn volume(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let [a, b, c, d] = [a, b, c, d].map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    orient3d(a, b, c, d)
}

/// Whether a segment meets a triangle, or may do so: a segment in its plane counts.
fn pierces([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> bool {
    let both_sides =
        |volumes: &[f64]| volumes.iter().any(|&v| v > 0.) && volumes.iter().any(|&v| v < 0.);
    let ends = [volume(a, b, c, p), volume(a, b, c, q)];
    if !ends.contains(&0.) && !both_sides(&ends) {
        return false;
    }
    !both_sides(&[volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sticks(components: &[&[[f64; 3]]]) -> Sticks {
        let component = |points: &&[[f64; 3]]| points.iter().map(|&p| DVec3::from(p)).collect();
        Sticks::new(&Curve::new(components.iter().map(component).collect()).unwrap())
    }

    /// A square whose corner at (0, 0) is cut off by removing it; a strand passes the plane at x, y.
    fn beside_a_strand(x: f64, y: f64) -> Sticks {
        let square = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.3], [0., 1., 0.]];
        let strand = [[x, y, -1.], [x, y, 1.], [9., 9., 1.], [9., 9., -1.]];
        sticks(&[&square, &strand])
    }

    #[test]
    fn a_vertex_is_removed_unless_a_strand_is_in_the_way() {
        // The long side of the triangle is x + y = 1; the strand is beyond it by one bit, on it, inside.
        let bit = f64::EPSILON;
        for (y, removed) in [(0.5 + bit, true), (0.5, false), (0.5 - bit, false), (-1e-300, true)] {
            let mut sticks = beside_a_strand(0.5, y);
            assert_eq!(sticks.remove(0), removed, "{y}");
            assert_eq!(sticks.n(), if removed { 7 } else { 8 });
        }
    }

    #[test]
    fn a_triangle_keeps_its_vertices() {
        let mut sticks = sticks(&[&[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]]);
        assert!((0..3).all(|i| !sticks.remove(i)));
    }

    #[test]
    fn a_vertex_moves_as_far_as_no_edge_is_in_the_way() {
        let bit = f64::EPSILON;
        // Beyond the strand, to where it would touch, and one bit less far.
        let places =
            [([0.9, 0.5, 0.1], false), ([0.5, 0.5, 0.1], false), ([0.5, 0.5 - bit, 0.1], true)];
        for (place, moved) in places {
            let mut sticks = beside_a_strand(0.5, 0.5);
            assert_eq!(sticks.shift(0, DVec3::from(place)), moved, "{place:?}");
            assert_eq!(sticks.point(0) == DVec3::from(place), moved);
        }
    }

    #[test]
    fn edges_do_not_fold_onto_each_other() {
        let mut sticks = sticks(&[&[[0., 0., 0.], [2., 0., 0.], [2., 1., 0.], [0., 1., 0.5]]]);
        assert!(!sticks.shift(1, DVec3::new(-1., 1., 0.)), "in the plane of its edges");
    }

    #[test]
    fn removed_edges_are_in_nobodys_way() {
        let square = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.3], [0., 1., 0.]];
        let spike = [[0.2, 0.3, -1.], [0.3, 0.3, 1.], [0.4, 0.3, -1.], [0.3, 5., -2.]];
        let mut sticks = sticks(&[&square, &spike]);
        assert!(!sticks.remove(0), "the spike goes through the corner");
        assert!(sticks.remove(5));
        assert!(sticks.remove(0));
        assert_eq!(sticks.curve().component(1).len(), 3);
    }

    #[test]
    fn clearances_are_distances() {
        let sticks = beside_a_strand(0.5, -0.25);
        assert_eq!((sticks.clearance(0), sticks.room(0)), (0.25, 0.25f64.hypot(0.5)));
    }
}
