//! One constraint of a rope, R = 1: g = s |y|^2 + h(l) >= 0, y being a combination of two or three
//! vertices and l the edge length of a component.
//!
//! - edge: `l^2 - |v_(i+1) - v_i|^2 >= 0`: the rope's tension pulls all edges to length l;
//! - bend: `l^4 - |v_(i-1) - 2 v_i + v_(i+1)|^2 >= 0`: with edges l the second difference is
//!   2 l sin(theta/2) long, so this is ControlCurvature's theta <= 2 arcsin(l/2); on coarse ropes
//!   1.235^2 l^2 takes the place of l^4 ([`crate::beads::most_bend`]);
//! - contact: `|v_i - v_j|^2 - 4 >= 0`, for beads at least K apart along the rope
//!   ([`crate::beads::least_index_distance`]).
//!
//! Edges and bends are convex (s = -1), so that their multipliers only stiffen the problem.

use glam::DVec3;

use super::direction::Direction;
use super::system::{Symmetric, symmetric};
use crate::beads::{COARSE, most_bend};
use crate::geometry::neighbours::Pair;

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
    /// The edge from bead `i` to bead `j`, of a component whose edge length is `l`.
    pub fn edge(v: &[DVec3], [i, j]: [usize; 2], component: usize, l: f64) -> Self {
        let y = v[j] - v[i];
        let g = l * l - y.length_squared();
        let h = [2. * l, 1.];
        Self { beads: [i, j, i], coefficients: [-1., 1., 0.], component, sign: -1., y, g, h }
    }

    /// The bend at the second of three `beads`.
    pub fn bend(v: &[DVec3], beads: [usize; 3], component: usize, l: f64) -> Self {
        let [i, j, k] = beads;
        let y = (v[i] - v[j]) + (v[k] - v[j]);
        let most = most_bend(l);
        let g = most * most - y.length_squared();
        let square = COARSE * COARSE;
        let h = if l < COARSE { [4. * l.powi(3), 6. * l * l] } else { [2. * square * l, square] };
        Self { beads, coefficients: [1., -2., 1.], component, sign: -1., y, g, h }
    }

    /// The contact of beads `i` and `j`.
    pub fn contact(v: &[DVec3], (i, j): Pair) -> Self {
        let (i, j) = (i as usize, j as usize);
        let y = v[i] - v[j];
        let g = y.length_squared() - 4.;
        let coefficients = [1., -1., 0.];
        Self { beads: [i, j, i], coefficients, component: 0, sign: 1., y, g, h: [0.; 2] }
    }

    /// The two beads of an edge or a contact.
    pub fn pair(&self) -> Pair {
        (self.beads[0] as u32, self.beads[1] as u32)
    }

    /// The derivative of g with respect to each of its beads.
    pub fn gradient(&self) -> impl Iterator<Item = (usize, DVec3)> {
        let y = 2. * self.sign * self.y;
        self.beads.into_iter().zip(self.coefficients.map(|c| c * y))
    }

    /// Adds `force` grad g to a direction.
    pub fn push(&self, force: f64, direction: &mut Direction) {
        self.gradient().for_each(|(i, gradient)| direction.beads[i] += force * gradient);
        direction.lengths[self.component] += force * self.h[0];
    }

    /// Adds `force` times the change of grad g on a step to a direction.
    pub fn turn(&self, force: f64, step: &Direction, direction: &mut Direction) {
        let [i, j, k] = self.beads.map(|bead| step.beads[bead]);
        let [a, b, c] = self.coefficients;
        let turn = 2. * self.sign * force * (a * i + b * j + c * k);
        let ends = self.beads.into_iter().zip(self.coefficients);
        ends.for_each(|(bead, coefficient)| direction.beads[bead] += coefficient * turn);
        let delta = step.lengths[self.component];
        direction.lengths[self.component] += 2. * force * self.h[1] * delta;
    }

    /// `stiffness` grad g grad g^T - `z` Hess g on the beads: each 3x3 block of it is this one, times
    /// the product of two coefficients.
    pub fn block(&self, stiffness: f64, z: f64) -> Symmetric {
        symmetric(self.y, 4. * stiffness, -2. * self.sign * z)
    }

    /// Coefficients b and c of g + b a + c a^2 after the step a `step`.
    pub fn course(&self, step: &Direction) -> [f64; 2] {
        let [i, j, k] = self.beads.map(|bead| step.beads[bead]);
        let [a, b, c] = self.coefficients;
        let dy = a * i + b * j + c * k;
        let delta = step.lengths[self.component];
        [
            2. * self.sign * self.y.dot(dy) + self.h[0] * delta,
            self.sign * dy.length_squared() + self.h[1] * delta * delta,
        ]
    }
}
