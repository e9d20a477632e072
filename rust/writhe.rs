//! The writhe and the average crossing number: of the crossings that a curve shows from all sides, the
//! mean sum of signs, and the mean number.
//!
//! Two edges are seen to cross from the directions of the vectors between their points. These fill a
//! parallelogram, whose solid angle Omega, of both directions, is their share: with the sign of the
//! crossing, the sum over all pairs of edges, over 2 pi, is the writhe, without it the average crossing
//! number (Banchoff, "Self linking numbers of space polygons", 1976; Klenin and Langowski, "Computation
//! of writhe in modeling of supercoiled DNA", 2000). Here tan(Omega/2) is that of two triangles (Van
//! Oosterom and Strackee, 1983), whose complex numbers are multiplied, so that a pair takes one atan2.
//!
//! All pairs are summed: time grows with n^2. Each edge's sum is made by one thread, and these are added
//! in order: the threads change no bit.

use std::f64::consts::PI;
use std::ops::Add;
use std::thread;

use glam::DVec3;

use crate::geometry::curve::Curve;

/// Means over all directions of what is seen in a projection.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Writhe {
    /// Sum of the signs of the crossings of components with themselves.
    pub own: f64,
    /// Sum of the signs of the crossings of components with each other: twice all linking numbers.
    pub between: f64,
    /// Number of all crossings.
    pub crossings: f64,
}

impl Add for Writhe {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            own: self.own + other.own,
            between: self.between + other.between,
            crossings: self.crossings + other.crossings,
        }
    }
}

/// The writhe of an embedded curve.
///
/// ```
/// // A planar curve shows crossings from no side.
/// use glam::DVec3;
/// let square = [(1., 1.), (-1., 1.), (-1., -1.), (1., -1.)].map(|(x, y)| DVec3::new(x, y, 0.));
/// let writhe = sono::writhe(&sono::Curve::new(vec![square.to_vec()])?);
/// assert_eq!((writhe.own, writhe.crossings), (0., 0.));
/// # Ok::<(), sono::Error>(())
/// ```
pub fn writhe(curve: &Curve) -> Writhe {
    let edges = edges(curve);
    let workers = thread::available_parallelism().map_or(1, usize::from).min(edges.len());
    let rows: Vec<Vec<Writhe>> = thread::scope(|scope| {
        let work = |k| {
            let edges = &edges;
            move || (k..edges.len()).step_by(workers).map(|i| row(edges, i)).collect()
        };
        let threads: Vec<_> = (0..workers).map(|k| scope.spawn(work(k))).collect();
        threads.into_iter().map(|thread| thread.join().expect("sums do not panic")).collect()
    });
    (0..edges.len()).map(|i| rows[i % workers][i / workers]).fold(Writhe::default(), Writhe::add)
}

/// An edge, and the component that it is of.
struct Edge {
    from: DVec3,
    to: DVec3,
    component: usize,
}

/// All edges, of a curve of size 1: powers of coordinates must not overflow.
fn edges(curve: &Curve) -> Vec<Edge> {
    let size = curve.vertices().iter().map(|v| v.abs().max_element()).fold(0., f64::max);
    let edge = |i: usize| Edge {
        from: curve.vertices()[i] / size,
        to: curve.vertices()[curve.next(i)] / size,
        component: curve.component_of(i),
    };
    (0..curve.n()).map(edge).collect()
}

/// The shares of edge `i` with all that follow.
fn row(edges: &[Edge], i: usize) -> Writhe {
    let mut sum = Writhe::default();
    for other in &edges[i + 1..] {
        let share = half_solid_angle(&edges[i], other) / PI;
        if edges[i].component == other.component {
            sum.own += share;
        } else {
            sum.between += share;
        }
        sum.crossings += share.abs();
    }
    sum
}

/// Half the solid angle of directions from which two edges are seen to cross, with the sign of the
/// crossing; 0 for edges that meet, which lie in a plane.
fn half_solid_angle(one: &Edge, other: &Edge) -> f64 {
    if one.to == other.from || one.from == other.to {
        return 0.;
    }
    let (a, b) = (other.from - one.from, other.to - one.from);
    let (c, d) = (other.to - one.to, other.from - one.to);
    let volume = a.dot((other.to - other.from).cross(one.to - one.from));
    let (first, second) = (below(a, b, c), below(a, c, d));
    (volume * (first + second)).atan2(first * second - volume * volume)
}

/// What the volume of three vectors is divided by for the tangent of half their solid angle.
fn below(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la
}
