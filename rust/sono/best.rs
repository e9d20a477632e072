//! The best state of a rope so far.

use serde::{Deserialize, Serialize};

use crate::geometry::curve::Curve;
use crate::measures::measure;
use crate::resample::scaled;

/// The best state so far: valid ones before others, then the shorter bound L_c.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Best {
    curve: Curve,
    /// Whether it is not valid, whether it has no L_c, and L_c, or else L_p.
    rank: (bool, bool, f64),
}

impl Best {
    /// A state that any other is better than.
    pub fn new(curve: &Curve) -> Self {
        Self { curve: scaled(curve, measure(curve).r_s), rank: (true, true, f64::MAX) }
    }

    /// Its R_s is 1, its centre the origin.
    pub fn curve(&self) -> &Curve {
        &self.curve
    }

    /// Puts another state in its place, though it may be no better.
    pub fn replace(&mut self, curve: &Curve) {
        self.curve = scaled(curve, measure(curve).r_s);
    }

    /// Remembers a rope of radius 1 if it is better; returns whether it is valid, its dispersion and
    /// overlaps being at most `tolerance`.
    pub fn offer(&mut self, curve: &Curve, tolerance: f64) -> bool {
        let now = measure(curve);
        let overlap = 2. * (1. - now.r_s);
        let valid = now.dispersion.max(overlap) <= tolerance;
        // Without the bound L_c a rope is so coarse or rough that any with one is better.
        let rank = (!valid, now.l_c.is_none(), now.l_c.unwrap_or(now.l_p));
        if rank.2.is_finite() && rank < self.rank {
            *self = Self { curve: scaled(curve, now.r_s), rank };
        }
        valid
    }
}
