//! The matrix of a Newton step: 3x3 blocks bordered by the edge lengths, which are few and therefore
//! eliminated last.

use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::direction::{Direction, dot};
use super::problem::{Multipliers, Terms};
use super::system::{Blocks, Symmetric, System};
use super::term::Term;
use crate::geometry::curve::Curve;
use crate::geometry::neighbours::Pair;

/// The matrix of a rope, analysed for a set of contacts.
#[derive(Default, Serialize, Deserialize)]
pub struct Matrix {
    /// The pairs of beads it was analysed for, sorted.
    pairs: Vec<Pair>,
    /// Made anew from the pairs after a restart.
    #[serde(skip)]
    system: Option<System>,
    /// The solutions for the border's columns, and what they leave to the edge lengths.
    #[serde(skip)]
    columns: Vec<Vec<DVec3>>,
    #[serde(skip)]
    schur: Option<Llt<f64>>,
}

/// The numbers of a matrix: its blocks, and the rows and the corner of the edge lengths.
pub struct Bordered {
    blocks: Blocks,
    border: Vec<Vec<DVec3>>,
    corner: Vec<f64>,
}

impl Matrix {
    /// Whether what was restored fits a rope of n beads.
    pub fn is_sound(&self, n: usize) -> bool {
        self.pairs.is_sorted_by(|a, b| a < b)
            && self.pairs.iter().all(|&(i, j)| i < j && (j as usize) < n)
    }

    /// Makes room for `contacts`, in the order of their beads, and with them for those to come `soon`.
    pub fn analyse(&mut self, curve: &Curve, contacts: &[Term], soon: impl Iterator<Item = Pair>) {
        let n = curve.n();
        let mut known = self.pairs.iter();
        let idle = self.pairs.len().saturating_sub(contacts.len());
        let fits = contacts.iter().all(|t| known.any(|&known| known == t.pair()));
        if !fits || 3 * idle > self.pairs.len() + 2 * n {
            self.pairs = contacts.iter().map(Term::pair).chain(soon).collect();
            self.pairs.sort_unstable();
            self.system = None;
        }
        self.system.get_or_insert_with(|| {
            let neighbours = (0..n).map(|i| [i, curve.next(i)]);
            let seconds = (0..n).map(|i| [curve.prev(i), curve.next(i)]);
            let contacts = self.pairs.iter().map(|&(i, j)| [i as usize, j as usize]);
            System::new(n, &neighbours.chain(seconds).chain(contacts).collect::<Vec<_>>())
        });
    }

    /// The sum of `stiffness` grad g grad g^T - `z` Hess g over all terms.
    pub fn assemble(
        &self,
        curve: &Curve,
        terms: &Terms,
        stiffness: &Multipliers,
        z: &Multipliers,
    ) -> Bordered {
        let factors = stiffness.map_with(z, |stiffness, z| (*stiffness, *z));
        let mut sum = Bordered::zero(curve, self.pairs.len());
        for (t, (d, z)) in terms.edges.iter().zip(factors.edges) {
            sum.add_edge(t, t.block(d, z));
            sum.add_length(t, d, z);
        }
        for (t, (d, z)) in terms.bends.iter().zip(factors.bends) {
            sum.add_bend(t, t.block(d, z));
            sum.add_length(t, d, z);
        }
        let mut pair = 0;
        for (t, (d, z)) in terms.contacts.iter().zip(factors.contacts) {
            while self.pairs[pair] != t.pair() {
                pair += 1;
            }
            sum.add_contact(t, t.block(d, z), pair);
        }
        sum
    }

    /// Solves for a direction, given the right-hand side, with `shift` added to the blocks' diagonal
    /// and `corner` to that of the edge lengths; `None` unless the matrix is positive definite.
    pub fn solve(
        &mut self,
        matrix: &Bordered,
        shift: f64,
        corner: &[f64],
        rhs: &Direction,
    ) -> Option<Direction> {
        let system = self.system.as_mut().expect("analysed before");
        if !system.factor(&matrix.blocks, shift) {
            return None;
        }
        self.columns = matrix.border.iter().map(|column| system.solve(column)).collect();
        let k = corner.len();
        let schur = Mat::from_fn(k, k, |i, j| {
            (if i == j { matrix.corner[i] + corner[i] } else { 0. })
                - dot(&matrix.border[i], &self.columns[j])
        });
        self.schur = Some(schur.llt(Side::Lower).ok()?);
        self.solve_again(matrix, rhs)
    }

    /// Solves with the last factor.
    pub fn solve_again(&mut self, matrix: &Bordered, rhs: &Direction) -> Option<Direction> {
        let mut beads = self.system.as_mut()?.solve(&rhs.beads);
        let k = rhs.lengths.len();
        let rest = Mat::from_fn(k, 1, |i, _| rhs.lengths[i] - dot(&matrix.border[i], &beads));
        let solved = self.schur.as_ref()?.solve(rest);
        let lengths: Vec<_> = (0..k).map(|i| solved[(i, 0)]).collect();
        for (column, length) in self.columns.iter().zip(&lengths) {
            beads.iter_mut().zip(column).for_each(|(d, column)| *d -= length * *column);
        }
        Some(Direction { beads, lengths })
    }
}

impl Bordered {
    fn zero(curve: &Curve, pairs: usize) -> Self {
        let (n, components) = (curve.n(), curve.components());
        Self {
            blocks: Blocks::zero(n, pairs),
            border: vec![vec![DVec3::ZERO; n]; components],
            corner: vec![0.; components],
        }
    }

    fn add_edge(&mut self, t: &Term, block: Symmetric) {
        let [i, j, _] = t.beads;
        let Blocks { beads, neighbours, .. } = &mut self.blocks;
        for bead in [i, j] {
            add(&mut beads[bead], 1., block);
        }
        add(&mut neighbours[i], -1., block);
    }

    fn add_bend(&mut self, t: &Term, block: Symmetric) {
        let [i, j, k] = t.beads;
        let Blocks { beads, neighbours, seconds, .. } = &mut self.blocks;
        for (bead, factor) in [(i, 1.), (j, 4.), (k, 1.)] {
            add(&mut beads[bead], factor, block);
        }
        for bead in [i, j] {
            add(&mut neighbours[bead], -2., block);
        }
        add(&mut seconds[j], 1., block);
    }

    fn add_contact(&mut self, t: &Term, block: Symmetric, pair: usize) {
        let [i, j, _] = t.beads;
        let Blocks { beads, contacts, .. } = &mut self.blocks;
        for bead in [i, j] {
            add(&mut beads[bead], 1., block);
        }
        add(&mut contacts[pair], -1., block);
    }

    /// What a term has to do with the edge length, which contacts have nothing to do with.
    fn add_length(&mut self, t: &Term, stiffness: f64, z: f64) {
        let (c, h) = (t.component, t.h);
        t.gradient().for_each(|(i, gradient)| self.border[c][i] += stiffness * h[0] * gradient);
        self.corner[c] += stiffness * h[0] * h[0] - 2. * z * h[1];
    }
}

fn add(block: &mut Symmetric, factor: f64, other: Symmetric) {
    block.iter_mut().zip(other).for_each(|(sum, m)| *sum += factor * m);
}
