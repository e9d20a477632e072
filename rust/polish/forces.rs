//! The forces in a rope: from the multipliers of a polish, or fitted to any curve.

use glam::DVec3;

use super::newton::Matrix;
use super::problem::{Term, chain_terms};
use crate::beads::{least_index_distance, most_bend};
use crate::geometry::curve::Curve;
use crate::geometry::neighbours::{Separation, for_each_close_pair};
use crate::measures::measure;

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
    /// The forces that the multipliers `z` of `terms` are: edges, then bends, then contacts.
    pub(super) fn new(curve: &Curve, terms: &[Term], z: &[f64]) -> Self {
        let n = curve.n();
        let mut left = vec![DVec3::ZERO; n];
        for (t, z) in terms.iter().zip(z) {
            t.gradient().for_each(|(i, gradient)| left[i] += *z * gradient);
        }
        let force = |k: usize| 2. * z[k] * terms[k].y.length();
        Self {
            tension: (0..n).map(force).collect(),
            // At the neighbours, a tension's arm of one edge away.
            couple: (n..2 * n).map(|k| force(k) * terms[k - n].y.length()).collect(),
            contacts: (2 * n..terms.len())
                .map(|k| (terms[k].beads[0], terms[k].beads[1], force(k)))
                .collect(),
            residual: left.iter().map(|f| f.abs().max_element()).fold(0., f64::max),
        }
    }
}

/// Two beads may press against each other when at most so far out of touch, R = 1; a bead may
/// withstand bending when its radius, and an edge be in tension when its length is within this share
/// of the bound, which for edges is the longest.
const TOUCHING: f64 = 1e-4;
const BENT: f64 = 1e-3;
const SLACK: f64 = 1e-2;
/// Share of the way to the boundary that a step goes, by how much it tries to lower mu, and where
/// that ends.
const TO_THE_BOUNDARY: f64 = 0.99;
const CENTRING: f64 = 0.1;
const LAST_MU: f64 = 1e-20;
const MOST_ITERATIONS: usize = 200;

/// The forces that come nearest to balance on a curve as it is, scaled to R_s = 1: tensions,
/// couples and contact forces are sought by non-negative least squares.
///
/// Beads at most 2.0001 apart may press against each other, those whose radius is within 0.1 % of R
/// may withstand bending, and edges within 1 % of the longest may be in tension (a bead rope's edges
/// are equal), so a rope that is tight to fewer digits has a large residual. That is the
/// largest coordinate of what is left over on a bead, in units of the tension: 0 for a critical point
/// of length.
pub fn balance(curve: &Curve) -> Forces {
    let mut curve = curve.clone();
    curve.scale(1. / measure(&curve).r_s);
    let l: Vec<_> =
        (0..curve.components()).map(|c| curve.edge_lengths(c).fold(0., f64::max)).collect();
    let mut terms: Vec<_> = chain_terms(&curve, &l).collect();
    // By arclength, since curves that are no ropes may have thousands of vertices in a little place.
    let least = l.iter().map(|&l| (least_index_distance(l) as f64 - 0.5) * l).collect();
    let reach = 2. + TOUCHING;
    let mut pairs = vec![];
    for_each_close_pair(&curve, &Separation::by_arclength(&curve, least), reach, |i, j, _| {
        pairs.push((i as u32, j as u32));
        reach
    });
    pairs.sort_unstable();
    terms.extend(pairs.iter().map(|&(i, j)| Term::contact(curve.vertices(), i, j)));
    let n = curve.n();
    for (k, t) in terms[..2 * n].iter_mut().enumerate() {
        let l = l[t.component];
        let least = if k < n { (1. - SLACK) * l } else { (1. - BENT) * most_bend(l) };
        if t.y.length() < least {
            // No force: without a gradient its multiplier has no effect.
            (t.y, t.h) = (DVec3::ZERO, [0.; 2]);
        }
    }
    let z = least_squares(&curve, &terms);
    Forces::new(&curve, &terms, &z)
}

/// Least squares for sum z grad g = grad f over z >= 0, by an interior-point method.
///
/// Solved in the space of the rope: x = M^-1 (grad f - G z), what is left over, is the point of the
/// cone G^T x <= 0 nearest to grad f, and z are that problem's multipliers. M is 1 on beads and n on
/// edge lengths. With slacks s = -G^T x and z s = mu a step needs the matrix M + G (Z/S) G^T, which
/// has the rope's own pattern.
fn least_squares(curve: &Curve, terms: &[Term]) -> Vec<f64> {
    let n: Vec<_> = curve.ranges().map(|range| range.len() as f64).collect();
    let mut matrix = Matrix::default();
    matrix.analyse(curve, &terms[2 * curve.n()..], std::iter::empty());
    let transposed = |d: &[DVec3], delta: &[f64]| -> Vec<f64> {
        terms.iter().map(|t| t.course(d, delta)[0]).collect()
    };
    let (mut d, mut delta) = (vec![DVec3::ZERO; curve.n()], vec![0.; n.len()]);
    let mut z: Vec<_> = terms.iter().map(|t| 0.5 / t.y.length().max(1e-3)).collect();
    let mut s = vec![1.; terms.len()];
    let none = vec![0.; terms.len()];
    for _ in 0..MOST_ITERATIONS {
        let mean = z.iter().zip(&s).map(|(z, s)| z * s).sum::<f64>() / z.len() as f64;
        if mean < LAST_MU {
            break;
        }
        let mu = CENTRING * mean;
        let ratio: Vec<_> = z.iter().zip(&s).map(|(z, s)| z / s).collect();
        let bordered = matrix.assemble(curve, terms, &ratio, &none);
        let corner: Vec<_> = bordered.corner.iter().zip(&n).map(|(c, n)| c + n).collect();
        let along = transposed(&d, &delta);
        // grad f - M x - G (mu/s + (Z/S)(s + G^T x))
        let mut step_d: Vec<_> = d.iter().map(|d| -*d).collect();
        let mut step_delta: Vec<_> = n.iter().zip(&delta).map(|(n, x)| n * (1. - x)).collect();
        for (k, t) in terms.iter().enumerate() {
            let force = mu / s[k] + ratio[k] * (s[k] + along[k]);
            t.gradient().for_each(|(i, gradient)| step_d[i] -= force * gradient);
            step_delta[t.component] -= force * t.h[0];
        }
        if !matrix.factor(&bordered, 1.)
            || !matrix.solve(&bordered.border, &corner, &mut step_d, &mut step_delta)
        {
            break;
        }
        let along_step = transposed(&step_d, &step_delta);
        let ds: Vec<_> = (0..s.len()).map(|k| -(s[k] + along[k]) - along_step[k]).collect();
        let dz: Vec<_> = (0..s.len()).map(|k| mu / s[k] - z[k] - ratio[k] * ds[k]).collect();
        let longest =
            |x: &[f64], dx: &[f64]| {
                x.iter().zip(dx).fold(1f64, |a, (x, dx)| {
                    if *dx < 0. { a.min(TO_THE_BOUNDARY * x / -dx) } else { a }
                })
            };
        let a = longest(&z, &dz).min(longest(&s, &ds));
        d.iter_mut().zip(&step_d).for_each(|(x, dx)| *x += a * *dx);
        delta.iter_mut().zip(&step_delta).for_each(|(x, dx)| *x += a * dx);
        z.iter_mut().zip(&dz).for_each(|(x, dx)| *x += a * dx);
        s.iter_mut().zip(&ds).for_each(|(x, dx)| *x += a * dx);
    }
    z
}
