//! A direction in which vertices and edge lengths may go, or a force on them.

use glam::DVec3;

use crate::geometry::curve::Curve;

/// A vector for each bead and a number for the edge length of each component.
#[derive(Debug, Clone)]
pub struct Direction {
    pub beads: Vec<DVec3>,
    pub lengths: Vec<f64>,
}

impl Direction {
    /// `factor` times the gradient of a rope's length, the sum of n l.
    pub fn lengthening(curve: &Curve, factor: f64) -> Self {
        let lengths = curve.ranges().map(|range| factor * range.len() as f64).collect();
        Self { beads: vec![DVec3::ZERO; curve.n()], lengths }
    }

    /// Adds `factor` times another direction.
    pub fn add(&mut self, factor: f64, other: &Self) {
        self.beads.iter_mut().zip(&other.beads).for_each(|(v, d)| *v += factor * *d);
        self.lengths.iter_mut().zip(&other.lengths).for_each(|(l, d)| *l += factor * d);
    }

    /// Multiplies it by `factor`.
    pub fn scale(&mut self, factor: f64) {
        self.beads.iter_mut().for_each(|v| *v *= factor);
        self.lengths.iter_mut().for_each(|l| *l *= factor);
    }

    /// The scalar product.
    pub fn dot(&self, other: &Self) -> f64 {
        dot(&self.beads, &other.beads)
            + self.lengths.iter().zip(&other.lengths).map(|(a, b)| a * b).sum::<f64>()
    }

    /// The largest coordinate on a bead, or share of an edge in what is on edge lengths. One that is
    /// not a number is the largest.
    pub fn largest(&self, curve: &Curve) -> f64 {
        let on_beads = self.beads.iter().map(|f| f.abs().max_element());
        let shares = self.lengths.iter().zip(curve.ranges());
        let on_edges = shares.map(|(f, range)| f.abs() / range.len() as f64);
        on_beads.chain(on_edges).fold(0., |most, f| if f <= most { most } else { f })
    }

    /// The longest way of a bead.
    pub fn longest_way(&self) -> f64 {
        self.beads.iter().fold(0f64, |longest, d| longest.max(d.length()))
    }
}

/// The scalar product of what two directions have on the beads.
pub fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}
