//! The certified bound: L_c = Length(K_P)/R_c, rounded up, for unequal edges and several components.
//!
//! Names in brackets are those of `docs/explanation/theorem.md`: s_i the edges, S_c the longest of component c,
//! S the longest of all, t_i half the shorter edge at v_i (D1), theta_i the turning angle there (D2), and
//! Rad_i = t_i/tan(theta_i/2) (D3), of which M_c is the least. R is the largest number with
//!
//! - (T1) R^2 <= M_c^2 + S_c^2/4 for each component: both from below;
//! - (T2) 2R <= |v_i - v_j| for each pair that counts: the distances from below, over all pairs that may
//!   count (C7), arclengths from above being compared with pi M_c - S_c from below (C6).
//!
//! If it has (T3) R > S/sqrt 2, S from above, then the knot or link has a representative of ropelength
//! Length(K_P)/sqrt(R^2 - S^2/4) at most, the length from above and the root from below (T4, C8, C9).
//!
//! Only + - * / and roots are needed. With e and f the edges at v_i, u = tan(theta_i/2) is
//! |e x f|/(|e||f| + e.f), which keeps its digits where a fine curve hardly turns (C3).

use crate::certify::interval::Interval;
use crate::certify::pairs::{self, Along, Pair};
use crate::certify::point::{Point, cross, dot, exactly, from_to, length};
use crate::error::{Error, Result};
use crate::geometry::curve::Curve;
use crate::geometry::embedded::check_embedded;

/// What is proven of a curve, in the units of its vertices; L_c has no unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// At least S, the longest edge.
    pub longest_edge: f64,
    /// At most the least M_c, the radii of the inscribed arcs.
    pub min_rad: f64,
    /// At most the largest R that has (T1) and (T2); it has (T3) too.
    pub r: f64,
    /// At most R_c, the thickness of K_P.
    pub r_c: f64,
    /// At least Length(K_P).
    pub inscribed_length: f64,
    /// At least L_c: the ropelength of the curve's type is at most this.
    pub l_c: f64,
    /// What keeps R from being larger.
    pub decided_by: Decider,
}

/// What R is held down by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Decider {
    /// The bend at this vertex, by (T1).
    Bend(usize),
    /// The distance of these two, by (T2).
    Pair(usize, usize),
}

/// Bounds the ropelength of a curve's type, in time near-linear in n.
///
/// ```
/// use glam::DVec3;
/// use std::f64::consts::TAU;
/// let vertex = |i| DVec3::new((TAU / 48. * i as f64).cos(), (TAU / 48. * i as f64).sin(), 0.);
/// let circle = sono::Curve::new(vec![(0..48).map(vertex).collect()])?;
/// let bound = sono::certify(&circle)?;
/// assert!(TAU < bound.l_c && bound.l_c < 1.01 * TAU);
/// # Ok::<(), sono::Error>(())
/// ```
///
/// # Errors
/// [`Error::SharpBend`] and [`Error::ClosePair`] where (T3) fails, [`Error::SelfCrossing`] where it
/// fails for a curve that crosses itself.
pub fn certify(curve: &Curve) -> Result<Bound> {
    let vertices: Vec<_> = curve.vertices().iter().map(|v| exactly(*v)).collect();
    certify_boxes(curve, &vertices)
}

/// The same for all polygons whose vertices lie in boxes; the curve is one of them.
///
/// # Errors
/// As those of [`certify`].
pub fn certify_boxes(curve: &Curve, vertices: &[Point]) -> Result<Bound> {
    let components: Vec<_> =
        curve.ranges().map(|range| Component::new(&vertices[range.clone()], range.start)).collect();
    let s = components.iter().map(|c| c.longest).reduce(Interval::max).ok_or(Error::Empty)?;
    let (mut squared, mut decided_by) = sharpest_bend(&components);
    let mut r = proven(curve, s, squared, decided_by)?;
    // The distances are compared with 2R: all times 4, exactly.
    let closer = pairs::closest(vertices, &along(&components), 4. * squared);
    if let Some(Pair { squared: apart, i, j }) = closer {
        (squared, decided_by) = (0.25 * apart, Decider::Pair(i, j));
        r = proven(curve, s, squared, decided_by)?;
    }
    let r_c = (Interval::from(r).squared() - half(half(s.squared()))).sqrt().low();
    let pieces: Vec<_> = components.iter().flat_map(Component::inscribed).collect();
    let inscribed_length = sum(&pieces).high();
    Ok(Bound {
        longest_edge: s.high(),
        min_rad: components.iter().map(|c| c.min_rad).fold(f64::INFINITY, f64::min),
        r,
        r_c,
        inscribed_length,
        l_c: (Interval::from(inscribed_length) / Interval::from(r_c)).high(),
        decided_by,
    })
}

/// What one component has by itself.
struct Component {
    /// Of each edge, after its vertex.
    edges: Vec<Interval>,
    /// t_i and tan(theta_i/2) of each vertex.
    bends: Vec<(Interval, Interval)>,
    /// The longest edge, S_c.
    longest: Interval,
    /// At most M_c.
    min_rad: f64,
    /// Where that is attained.
    sharpest: usize,
}

impl Component {
    /// That of these vertices, the first of which is the curve's vertex `first`.
    fn new(v: &[Point], first: usize) -> Self {
        let (n, zero) = (v.len(), Interval::from(0.));
        let along: Vec<_> = (0..n).map(|i| from_to(v[i], v[(i + 1) % n])).collect();
        let edges: Vec<_> = along.iter().map(|e| length(*e)).collect();
        let bends: Vec<_> = (0..n)
            .map(|i| {
                let before = (i + n - 1) % n;
                let (e, f) = (along[before], along[i]);
                // Neither the divisor nor the tangent is negative.
                let ahead = (edges[before] * edges[i] + dot(e, f)).max(zero);
                let tan = (length(cross(e, f)) / ahead).max(zero);
                (half(edges[before].min(edges[i])), tan)
            })
            .collect();
        let (mut min_rad, mut sharpest) = (f64::INFINITY, first);
        for (i, (t, tan)) in bends.iter().enumerate() {
            let rad = (*t / *tan).low(); // infinite where the polygon goes straight on
            if rad < min_rad {
                (min_rad, sharpest) = (rad, first + i);
            }
        }
        let min_rad = min_rad.max(0.); // where the edges may fold back, so that tan has no bound
        let longest = edges.iter().copied().fold(zero, Interval::max);
        Self { edges, bends, longest, min_rad, sharpest }
    }

    /// (C5) For each vertex the edge after it, less what the arc is shorter than its two tangents: in all
    /// the length of the inscribed component.
    fn inscribed(&self) -> impl Iterator<Item = Interval> + '_ {
        let one = Interval::from(1.);
        self.edges.iter().zip(&self.bends).map(move |(s, &(t, tan))| {
            let shorter = t * (one - atan_ratio(tan));
            *s - (shorter + shorter)
        })
    }

    /// M_c, for what is compared with it from below.
    fn radius(&self) -> Interval {
        Interval::from(self.min_rad)
    }
}

/// At most the square of the largest R with (T1), and the bend that decides it.
fn sharpest_bend(components: &[Component]) -> (f64, Decider) {
    let bend = |c: &Component| {
        let squared = (c.radius().squared() + half(half(c.longest.squared()))).low();
        (squared, Decider::Bend(c.sharpest))
    };
    let sharper =
        |one: (f64, Decider), other: (f64, Decider)| if other.0 < one.0 { other } else { one };
    components.iter().map(bend).fold((f64::INFINITY, Decider::Bend(0)), sharper)
}

/// R, from below, of which no more than the square is allowed, if it has (T3).
fn proven(curve: &Curve, s: Interval, squared: f64, decided_by: Decider) -> Result<f64> {
    let r = Interval::from(squared).sqrt().low();
    let needed = half(s.squared());
    if Interval::from(r).squared().is_above(needed) {
        return Ok(r);
    }
    check_embedded(curve)?;
    Err(refusal(curve, r, needed.sqrt().high(), decided_by))
}

/// Which pairs count (C1, C6).
fn along(components: &[Component]) -> Along {
    let mut along = Along { component: vec![], arclength: vec![], around: vec![], least: vec![] };
    for (c, component) in components.iter().enumerate() {
        let mut at = Interval::from(0.);
        for s in &component.edges {
            along.component.push(c);
            along.arclength.push(at);
            at = at + *s;
        }
        along.around.push(at);
        along.least.push(Interval::PI * component.radius() - component.longest);
    }
    along
}

/// (C4) atan(u)/u by the series 1 - u^2/3 + u^4/5 - ... for u from 0 to 1, which (P2) says it is.
///
/// Its tail from the term 1/m on is the integral of y^(m-1)/(1 + u^2 y^2) for y from 0 to 1, which is
/// between 0 and 1/m. With w = u/(1 + sqrt(1 + u^2)) atan(u) is 2 atan(w), of which the series needs fewer
/// terms.
fn atan_ratio(u: Interval) -> Interval {
    let one = Interval::from(1.);
    if u.high() > 0.1 {
        let w_to_u = one / (one + (one + u.squared()).sqrt());
        return (w_to_u + w_to_u) * atan_ratio(u * w_to_u);
    }
    let tail = Interval::from(0.).hull(one / Interval::from(17.));
    [15., 13., 11., 9., 7., 5., 3., 1.]
        .into_iter()
        .fold(tail, |tail, m| one / Interval::from(m) - u.squared() * tail)
}

/// The sum of many, by halves, so that rounding grows with the logarithm of how many they are.
fn sum(terms: &[Interval]) -> Interval {
    match terms {
        [] => Interval::from(0.),
        [term] => *term,
        _ => {
            let (first, second) = terms.split_at(terms.len() / 2);
            sum(first) + sum(second)
        }
    }
}

/// Half of a number; exact, since a `Curve` has no edge so short that it would underflow.
fn half(x: Interval) -> Interval {
    Interval::new(0.5 * x.low(), 0.5 * x.high())
}

/// (T3) fails: R is at most `needed`.
fn refusal(curve: &Curve, r: f64, needed: f64, decided_by: Decider) -> Error {
    let place = |i: usize| {
        let component = curve.component_of(i);
        (component, i - curve.range(component).start)
    };
    match decided_by {
        Decider::Bend(i) => {
            let (component, vertex) = place(i);
            Error::SharpBend { component, vertex, r, needed }
        }
        Decider::Pair(i, j) => {
            let ((component, vertex), (other_component, other_vertex)) = (place(i), place(j));
            Error::ClosePair { component, vertex, other_component, other_vertex, r, needed }
        }
    }
}
