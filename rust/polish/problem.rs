//! The tight rope as an optimisation problem, R = 1.
//!
//! Unknowns are the vertices and one edge length l a component. The length of the rope, the sum of
//! n l, is to be least while
//!
//! - edges `l^2 - |v_(i+1) - v_i|^2 >= 0`: the rope's tension pulls them all to length l;
//! - bends `l^4 - |v_(i-1) - 2 v_i + v_(i+1)|^2 >= 0`: with edges l the second difference is
//!   2 l sin(theta/2) long, so this is ControlCurvature's theta <= 2 arcsin(l/2); on coarse ropes
//!   1.235^2 l^2 takes the place of l^4 ([`crate::beads::most_bend`]);
//! - contacts `|v_i - v_j|^2 - 4 >= 0`, for beads at least K apart along the rope
//!   ([`crate::beads::least_index_distance`]).
//!
//! Each is g = s |y|^2 + h(l) >= 0, y being a combination of two or three vertices: a [`Term`].
//! Edges and bends are convex (s = -1), so that their multipliers only stiffen the problem.

use glam::DVec3;

use crate::beads::{COARSE, most_bend};
use crate::geometry::curve::Curve;

/// One constraint, where the rope is.
#[derive(Debug, Clone, Copy)]
pub struct Term {
    /// The beads that it acts on; where it is only two, the third is the first again.
    pub beads: [usize; 3],
    /// Their coefficients in y, the third 0 where it is only two.
    pub coefficients: [f64; 3],
    /// Whose edge length it contains.
    pub component: usize,
    /// s: 1 for contacts, -1 for edges and bends.
    pub sign: f64,
    /// The combination of vertices.
    pub y: DVec3,
    /// The constraint's value.
    pub g: f64,
    /// Coefficients of delta and delta^2 in h(l + delta).
    pub h: [f64; 2],
}

impl Term {
    fn edge(v: &[DVec3], [i, j]: [usize; 2], component: usize, l: f64) -> Self {
        let y = v[j] - v[i];
        let g = l * l - y.length_squared();
        let h = [2. * l, 1.];
        Self { beads: [i, j, i], coefficients: [-1., 1., 0.], component, sign: -1., y, g, h }
    }

    fn bend(v: &[DVec3], beads: [usize; 3], component: usize, l: f64) -> Self {
        let [i, j, k] = beads;
        let y = (v[i] - v[j]) + (v[k] - v[j]);
        let most = most_bend(l);
        let g = most * most - y.length_squared();
        let square = COARSE * COARSE;
        let h = if l < COARSE { [4. * l.powi(3), 6. * l * l] } else { [2. * square * l, square] };
        Self { beads, coefficients: [1., -2., 1.], component, sign: -1., y, g, h }
    }

    /// The contact of beads `i` and `j`.
    pub fn contact(v: &[DVec3], i: u32, j: u32) -> Self {
        let (i, j) = (i as usize, j as usize);
        let y = v[i] - v[j];
        let g = y.length_squared() - 4.;
        let coefficients = [1., -1., 0.];
        Self { beads: [i, j, i], coefficients, component: 0, sign: 1., y, g, h: [0.; 2] }
    }

    /// The derivative of g with respect to each of its beads.
    pub fn gradient(&self) -> impl Iterator<Item = (usize, DVec3)> {
        let y = 2. * self.sign * self.y;
        self.beads.into_iter().zip(self.coefficients.map(|c| c * y))
    }

    /// Coefficients b and c of g + b a + c a^2 along the step a (d, delta).
    pub fn course(&self, d: &[DVec3], delta: &[f64]) -> [f64; 2] {
        let [i, j, k] = self.beads;
        let [a, b, c] = self.coefficients;
        let dy = a * d[i] + b * d[j] + c * d[k];
        let delta = delta[self.component];
        [
            2. * self.sign * self.y.dot(dy) + self.h[0] * delta,
            self.sign * dy.length_squared() + self.h[1] * delta * delta,
        ]
    }

    /// w and dw/dg of its barrier, for contacts one of range `hat`: see [`clamped_logarithm`].
    pub fn weight(&self, hat: f64) -> (f64, f64) {
        let rest = 1. - self.g / hat;
        if self.sign < 0. {
            (1., 0.)
        } else if rest > 0. {
            (rest * rest, -2. * rest / hat)
        } else {
            (0., 0.)
        }
    }
}

/// The barrier of contacts: B(g) = ln u - 2u + u^2/2 + 3/2 for u = g/hat < 1, else 0.
///
/// It is twice continuously differentiable, so that pairs enter and leave without a jolt;
/// B' = w/g with w = (1 - u)^2. That of edges and bends is the logarithm itself, w = 1.
pub fn clamped_logarithm(g: f64, hat: f64) -> f64 {
    let u = g / hat;
    if u < 1. { u.ln() - 2. * u + 0.5 * u * u + 1.5 } else { 0. }
}

/// All edges, the one after each bead, and then all bends, the one at each bead.
pub fn chain_terms<'a>(curve: &'a Curve, l: &'a [f64]) -> impl Iterator<Item = Term> + 'a {
    let v = curve.vertices();
    let corners = || {
        curve.ranges().enumerate().flat_map(|(c, range)| {
            let (start, n) = (range.start, range.len());
            (0..n).map(move |k| (c, [k + n - 1, k, k + 1].map(|k| start + k % n)))
        })
    };
    corners()
        .map(move |(c, [_, i, j])| Term::edge(v, [i, j], c, l[c]))
        .chain(corners().map(move |(c, beads)| Term::bend(v, beads, c, l[c])))
}

/// The longest step a in [0, 1] along all of which g + b a + c a^2 >= (1 - share) g.
pub fn longest_step(g: f64, [b, c]: [f64; 2], share: f64) -> f64 {
    let left = share * g;
    let discriminant = b * b - 4. * c * left;
    if discriminant <= 0. || (b >= 0. && c >= 0.) {
        return 1.;
    }
    let root = discriminant.sqrt();
    let step = if b < 0. { 2. * left / (root - b) } else { (b + root) / (-2. * c) };
    step.min(1.)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_step_ends_where_the_constraint_does() {
        for (b, c) in [(-3., 0.), (-3., 1.), (-1., -1.), (2., -5.), (0., -4.), (-2.2, 1.)] {
            let step = longest_step(1., [b, c], 0.99);
            let g = |a: f64| 1. + b * a + c * a * a;
            assert!((0..=100).all(|k| g(step * f64::from(k) / 100.) >= 0.01 - 1e-12));
            assert!(step == 1. || (g(step) - 0.01).abs() < 1e-12, "{b} {c} {step}");
        }
        assert_eq!(longest_step(1., [-1.9, 1.], 0.99), 1.);
    }

    #[test]
    fn gradients_are_derivatives() {
        let v: Vec<_> = (0..5).map(|i| DVec3::new(0.3 * i as f64, (i * i) as f64, 1.)).collect();
        let curve = Curve::new(vec![v.clone()]).unwrap();
        let d: Vec<_> = (0..5).map(|i| DVec3::new(1., i as f64, -0.5)).collect();
        let (l, delta, step) = (7., 0.3, 1e-3);
        let there: Vec<_> = v.iter().zip(&d).map(|(v, d)| *v + step * *d).collect();
        let moved = Curve::new(vec![there.clone()]).unwrap();
        let contact = [Term::contact(&v, 0, 3)];
        let contact_there = [Term::contact(&there, 0, 3)];
        let before: Vec<_> = chain_terms(&curve, &[l]).chain(contact).collect();
        let (l, after_l) = ([l], [l + step * delta]);
        let after = chain_terms(&moved, &after_l).chain(contact_there);
        assert_eq!(before.len(), 11);
        for (t, t_after) in before.iter().zip(after) {
            let [b, c] = t.course(&d, &[delta]);
            let slope: f64 = t.gradient().map(|(i, g)| g.dot(d[i])).sum();
            assert!((slope + t.h[0] * delta - b).abs() < 1e-9 * b.abs().max(1.));
            let expected = t.g + step * b + step * step * c;
            assert!((t_after.g - expected).abs() < 1e-6 * step * l[0].powi(4));
        }
    }
}
