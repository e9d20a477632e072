//! Least squares for sum z grad g = grad f over z >= 0, by an interior-point method.
//!
//! Solved in the space of the rope: x = M^-1 (grad f - G z), what is left over, is the point of the
//! cone G^T x <= 0 nearest to grad f, and z are that problem's multipliers. M is 1 on beads and n on
//! edge lengths. With slacks s = -G^T x and z s = mu a step needs the matrix M + G (Z/S) G^T, which
//! has the rope's own pattern.

use super::barrier::longest_positive;
use super::direction::Direction;
use super::matrix::Matrix;
use super::problem::{Grouped, Multipliers, Terms};
use crate::geometry::curve::Curve;

/// By how much a step tries to lower mu, and where that ends.
const CENTRING: f64 = 0.1;
const LAST_MU: f64 = 1e-20;
const MOST_ITERATIONS: usize = 200;
/// Share of a multiplier or a slack that a step may use up.
const MOST_USED: f64 = 0.99;

/// The multipliers of `terms` that come nearest to balance.
pub fn least_squares(curve: &Curve, terms: &Terms) -> Multipliers {
    let mut fit = Fit::new(curve, terms);
    for _ in 0..MOST_ITERATIONS {
        let mean = fit.mean_product();
        if mean < LAST_MU || fit.step(CENTRING * mean).is_none() {
            break;
        }
    }
    fit.products.map(|p| p.z)
}

struct Fit<'a> {
    curve: &'a Curve,
    terms: &'a Terms,
    matrix: Matrix,
    x: Direction,
    products: Grouped<Product>,
}

/// A term's multiplier and slack, or the changes of both.
#[derive(Clone, Copy)]
struct Product {
    z: f64,
    s: f64,
}

impl<'a> Fit<'a> {
    fn new(curve: &'a Curve, terms: &'a Terms) -> Self {
        let mut matrix = Matrix::default();
        matrix.analyse(curve, &terms.contacts, std::iter::empty());
        let products = terms.map(|t| Product { z: 0.5 / t.y.length().max(1e-3), s: 1. });
        Self { curve, terms, matrix, x: Direction::lengthening(curve, 0.), products }
    }

    fn mean_product(&self) -> f64 {
        let products = self.products.iter();
        products.clone().map(|p| p.z * p.s).sum::<f64>() / products.count() as f64
    }

    /// A Newton step towards z s = mu; `None` as far as the digits go.
    fn step(&mut self, mu: f64) -> Option<()> {
        let ratio = self.products.map(|p| p.z / p.s);
        let none = ratio.map(|_| 0.);
        let bordered = self.matrix.assemble(self.curve, self.terms, &ratio, &none);
        let rest = self.rest(mu);
        let step = self.matrix.solve(&bordered, 1., &self.of_lengths(), &rest)?;
        let changes = self.terms.map_with(&self.products, |t, p| {
            p.change(mu, t.course(&self.x)[0], t.course(&step)[0])
        });
        let pairs = self.products.iter().zip(changes.iter());
        let a = longest_positive(MOST_USED, pairs.flat_map(|(p, d)| [(p.z, d.z), (p.s, d.s)]));
        self.x.add(a, &step);
        for (p, change) in self.products.iter_mut().zip(changes.iter()) {
            p.z += a * change.z;
            p.s += a * change.s;
        }
        Some(())
    }

    /// grad f - M x - G (mu/s + (Z/S)(s + G^T x))
    fn rest(&self, mu: f64) -> Direction {
        let Direction { beads, lengths } = &self.x;
        let mut rest = Direction {
            beads: beads.iter().map(|d| -*d).collect(),
            lengths: self.of_lengths().iter().zip(lengths).map(|(n, x)| n * (1. - x)).collect(),
        };
        for (t, p) in self.terms.iter().zip(self.products.iter()) {
            let force = mu / p.s + p.z / p.s * (p.s + t.course(&self.x)[0]);
            t.push(-force, &mut rest);
        }
        rest
    }

    /// The part of M that belongs to the edge lengths.
    fn of_lengths(&self) -> Vec<f64> {
        Direction::lengthening(self.curve, 1.).lengths
    }
}

impl Product {
    /// The change towards z s = mu where x is `along` the term's gradient, and its step `further`.
    fn change(&self, mu: f64, along: f64, further: f64) -> Self {
        let s = -(self.s + along) - further;
        Self { z: mu / self.s - self.z - self.z / self.s * s, s }
    }
}
