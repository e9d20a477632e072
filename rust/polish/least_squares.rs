//! Least squares for sum z grad g = grad f over z >= 0, by an interior-point method.
//!
//! Solved in the space of the rope: x = M^-1 (grad f - G z), what is left over, is the point of the
//! cone G^T x <= 0 nearest to grad f, and z are that problem's multipliers. M is 1 on beads and n on
//! edge lengths. With slacks s = -G^T x and z s = mu a step needs the matrix M + G (Z/S) G^T, which
//! has the rope's own pattern, and is factored once for the two halves of the step: the first one
//! aims at mu = 0, the second where that leads to (S. Mehrotra, SIAM J. Optim. 2, 575, 1992).

use super::barrier::longest_positive;
use super::direction::Direction;
use super::matrix::Matrix;
use super::problem::{Grouped, Multipliers, Terms};
use crate::geometry::curve::Curve;

/// By how much a step lowers mu at most, since a faster one loses digits, and where that ends.
const CENTRING: f64 = 0.1;
const LAST_MU: f64 = 1e-20;
const MOST_ITERATIONS: usize = 200;
/// Share of a multiplier or a slack that a step may use up.
const MOST_USED: f64 = 0.99;

/// The multipliers of `terms` that come nearest to balance.
pub fn least_squares(curve: &Curve, terms: &Terms) -> Multipliers {
    let mut fit = Fit::new(curve, terms);
    for _ in 0..MOST_ITERATIONS {
        if fit.mean_product() < LAST_MU || fit.step().is_none() {
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
        mean(self.products.iter().map(|p| p.z * p.s))
    }

    /// A step towards z s = mu, the lower the farther the first half goes; `None` as far as the digits go.
    fn step(&mut self) -> Option<()> {
        let ratio = self.products.map(|p| p.z / p.s);
        let none = ratio.map(|_| 0.);
        let bordered = self.matrix.assemble(self.curve, self.terms, &ratio, &none);
        let (of_lengths, rest) = (self.of_lengths(), self.rest(&none));
        let straight = self.matrix.solve(&bordered, 1., &of_lengths, &rest)?;
        let ahead = self.changes(&none, &straight);
        let a = self.longest(&ahead);
        let pairs = self.products.iter().zip(ahead.iter());
        let left = mean(pairs.map(|(p, d)| (p.z + a * d.z) * (p.s + a * d.s)));
        let now = self.mean_product();
        let mu = now * (left / now).powi(3).max(CENTRING);
        let aims = ahead.map(|d| mu - d.z * d.s);
        let step = self.matrix.solve_again(&bordered, &self.rest(&aims))?;
        let changes = self.changes(&aims, &step);
        let a = self.longest(&changes);
        self.x.add(a, &step);
        for (p, change) in self.products.iter_mut().zip(changes.iter()) {
            p.z += a * change.z;
            p.s += a * change.s;
        }
        Some(())
    }

    /// The changes that a step of x towards these products z s brings.
    fn changes(&self, aims: &Multipliers, step: &Direction) -> Grouped<Product> {
        let aimed = self.products.map_with(aims, |p, aim| (*p, *aim));
        self.terms
            .map_with(&aimed, |t, (p, aim)| p.change(*aim, t.course(&self.x)[0], t.course(step)[0]))
    }

    /// The share of changes that leaves all multipliers and slacks above 0.
    fn longest(&self, changes: &Grouped<Product>) -> f64 {
        let pairs = self.products.iter().zip(changes.iter());
        longest_positive(MOST_USED, pairs.flat_map(|(p, d)| [(p.z, d.z), (p.s, d.s)]))
    }

    /// grad f - M x - G (aim/s + (Z/S)(s + G^T x))
    fn rest(&self, aims: &Multipliers) -> Direction {
        let Direction { beads, lengths } = &self.x;
        let mut rest = Direction {
            beads: beads.iter().map(|d| -*d).collect(),
            lengths: self.of_lengths().iter().zip(lengths).map(|(n, x)| n * (1. - x)).collect(),
        };
        for ((t, p), aim) in self.terms.iter().zip(self.products.iter()).zip(aims.iter()) {
            let force = aim / p.s + p.z / p.s * (p.s + t.course(&self.x)[0]);
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
    /// The change towards z s = aim where x is `along` the term's gradient, and its step `further`.
    fn change(&self, aim: f64, along: f64, further: f64) -> Self {
        let s = -(self.s + along) - further;
        Self { z: aim / self.s - self.z - self.z / self.s * s, s }
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0., 0), |(sum, count), value| (sum + value, count + 1));
    sum / f64::from(count)
}
