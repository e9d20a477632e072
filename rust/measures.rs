//! The bead rope's measures: MinRad, SR, R_s, R_c and the ropelengths L_p, L_c, L_a.
//!
//! For an equilateral polygon P with edge length dl (Baranska, Pieranski, Rawdon, "Ropelength of
//! tight polygonal knots", section 2):
//!
//! - Rad(v_i) = (dl/2)/tan(theta_i/2), MinRad the least of them;
//! - SR: half the least distance of vertices with index distance >= ceil(pi MinRad/dl - 1);
//! - R_s = min(sqrt(MinRad^2 + (dl/2)^2), SR), the sphere thickness radius;
//! - R_c = sqrt(R_s^2 - (dl/2)^2), radius of a smooth tube around the inscribed knot K_P, the arcs
//!   tangent to the edges at their midpoints;
//! - L_p = Length(P)/R_s, L_c = Length(K_P)/R_c, L_a = (4 L_p + L_c)/5.
//!
//! **Unequal edges.** Edges s_i are seldom equal in files, and then L_c must remain a bound. K_P
//! gets its arcs tangent at t_i = min(s_(i-1), s_i)/2 from v_i, straight pieces between, so
//! Rad(v_i) = t_i/tan(theta_i/2). Let S be a component's longest edge, and
//! R_s = min(sqrt(MinRad^2 + (S/2)^2), SR), R_c^2 = R_s^2 - (S/2)^2 <= MinRad^2.
//! A point of a disk of radius R_c normal to K_P at x lies within sqrt(R_c^2 + d^2) <= R_s of the
//! vertex of x, where d <= S/2 is the distance to it along the tangent (on an arc the worst case is
//! its end, where d = t_i). So disks of vertices at least 2 R_s apart are disjoint. Points of K_P
//! closest to each other with arclength >= pi MinRad between them have vertices at least
//! pi MinRad - S apart along P, half an edge being lost on each side: over these pairs SR is taken.
//! With equal edges all this is the paper's definition. In a link the rule holds for each component
//! with its own MinRad and S; between components all pairs count, and R_c uses the longest edge.
//!
//! L_c is a bound where R_s > dl/sqrt 2 (the paper's condition); elsewhere it is not given.
//!
//! ```
//! // A regular hexagon of edge 1: its inscribed knot is the incircle.
//! use glam::DVec3;
//! let angle = |i: usize| std::f64::consts::FRAC_PI_3 * i as f64;
//! let hexagon = (0..6).map(|i| DVec3::new(angle(i).cos(), angle(i).sin(), 0.)).collect();
//! let measures = sono::measure(&sono::Curve::new(vec![hexagon])?);
//! assert!((measures.min_rad - 0.75f64.sqrt()).abs() < 1e-15);
//! assert!((measures.l_p - 6. / 0.75f64.sqrt()).abs() < 1e-14);
//! # Ok::<(), sono::Error>(())
//! ```

use std::f64::consts::{PI, SQRT_2};

use crate::geometry::curve::Curve;
use crate::geometry::neighbours::closest_distance;
use crate::geometry::separation::Separation;

/// What a curve measures, in the units of its vertices; the ropelengths `l_*` have no unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// Number of vertices.
    pub n: usize,
    /// Number of components.
    pub components: usize,
    /// Mean edge length.
    pub dl: f64,
    /// Largest |s_i/dl - 1|, with dl the mean edge of the component.
    pub dispersion: f64,
    /// Least radius of the inscribed arcs.
    pub min_rad: f64,
    /// Half the least distance between vertices that are not neighbours along the curve.
    pub sr: f64,
    /// Sphere thickness radius.
    pub r_s: f64,
    /// Radius of the smooth tube around the inscribed knot; `None` where R_s <= dl/sqrt 2.
    pub r_c: Option<f64>,
    /// Length of the polygon.
    pub length: f64,
    /// Length of the inscribed knot K_P.
    pub inscribed_length: f64,
    /// Raw polygonal ropelength, Length(P)/R_s.
    pub l_p: f64,
    /// Inscribed ropelength, Length(K_P)/R_c: an upper bound of the knot's ropelength.
    pub l_c: Option<f64>,
    /// Weighted ropelength (4 L_p + L_c)/5, an estimate.
    pub l_a: Option<f64>,
}

/// Measures a curve, in time near-linear in n.
pub fn measure(curve: &Curve) -> Measures {
    let locals: Vec<_> = (0..curve.components()).map(|c| Local::new(curve, c)).collect();
    let least = |f: fn(&Local) -> f64| locals.iter().map(f).fold(f64::INFINITY, f64::min);
    let most = |f: fn(&Local) -> f64| locals.iter().map(f).fold(0., f64::max);
    let total = |f: fn(&Local) -> f64| locals.iter().map(f).sum::<f64>();

    let separation =
        Separation::by_arclength(curve, locals.iter().map(Local::least_separation).collect());
    let sr = closest_distance(curve, &separation).map_or(f64::INFINITY, |d| 0.5 * d);
    let r_s = sr.min(least(Local::bending_radius));

    let length = total(|l| l.length);
    let inscribed_length = total(|l| l.inscribed_length);
    let longest_edge = most(|l| l.longest_edge);
    let r_c = (r_s > longest_edge / SQRT_2)
        .then(|| (r_s * r_s - 0.25 * longest_edge * longest_edge).sqrt());
    let l_p = length / r_s;
    let l_c = r_c.map(|r_c| inscribed_length / r_c);
    Measures {
        n: curve.n(),
        components: curve.components(),
        dl: length / curve.n() as f64,
        dispersion: most(|l| l.dispersion),
        min_rad: least(|l| l.min_rad),
        sr,
        r_s,
        r_c,
        length,
        inscribed_length,
        l_p,
        l_c,
        l_a: l_c.map(|l_c| (4. * l_p + l_c) / 5.),
    }
}

/// The measures of one component that need no distances across the curve.
struct Local {
    length: f64,
    inscribed_length: f64,
    longest_edge: f64,
    dispersion: f64,
    min_rad: f64,
}

impl Local {
    fn new(curve: &Curve, c: usize) -> Self {
        let edges: Vec<_> = curve.edge_lengths(c).collect();
        let length: f64 = edges.iter().sum();
        let dl = length / edges.len() as f64;
        let mut inscribed_length = length;
        let mut min_rad = f64::INFINITY;
        for (i, angle) in curve.turning_angles(c).enumerate() {
            let before = edges[(i + edges.len() - 1) % edges.len()];
            let tangent = 0.5 * before.min(edges[i]);
            let half_tan = (0.5 * angle).tan();
            // An arc of radius t/tan(theta/2) and angle theta replaces two tangents of length t.
            if half_tan > 0. {
                min_rad = min_rad.min(tangent / half_tan);
                inscribed_length += tangent * (angle / half_tan - 2.);
            }
        }
        Self {
            length,
            inscribed_length,
            longest_edge: edges.iter().copied().fold(0., f64::max),
            dispersion: edges.iter().map(|s| (s / dl - 1.).abs()).fold(0., f64::max),
            min_rad,
        }
    }

    /// The radius at which neighbouring disks between beads become tangent.
    fn bending_radius(&self) -> f64 {
        self.min_rad.hypot(0.5 * self.longest_edge)
    }

    /// Arclength from which on two vertices must keep their distance (the paper's index rule).
    fn least_separation(&self) -> f64 {
        PI * self.min_rad - self.longest_edge
    }
}
