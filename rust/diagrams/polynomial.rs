//! Laurent polynomials in two variables.

use std::collections::BTreeMap;

/// Coefficients that are not 0, by the powers of alpha and z.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Polynomial(pub BTreeMap<(i32, i32), i64>);

impl Polynomial {
    /// The polynomial 1.
    pub fn one() -> Self {
        Self(BTreeMap::from([((0, 0), 1)]))
    }

    /// What another circle apart from the rest multiplies HOMFLY polynomials by: (alpha - 1/alpha)/z.
    pub fn circle() -> Self {
        Self(BTreeMap::from([((1, -1), 1), ((-1, -1), -1)]))
    }

    /// Adds a multiple, by a number and by powers of alpha and z, of another one.
    pub fn add(&mut self, other: &Self, factor: i64, (alpha, z): (i32, i32)) {
        for (&(a, b), &value) in &other.0 {
            let place = (a + alpha, b + z);
            let sum = self.0.get(&place).copied().unwrap_or(0) + factor * value;
            if sum == 0 {
                self.0.remove(&place);
            } else {
                self.0.insert(place, sum);
            }
        }
    }

    /// The product.
    pub fn times(&self, other: &Self) -> Self {
        let mut product = Self::default();
        self.0.iter().for_each(|(&place, &factor)| product.add(other, factor, place));
        product
    }
}
