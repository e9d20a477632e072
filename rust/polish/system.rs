//! The Newton matrix of a rope: 3x3 blocks on the graph of chain and contacts, factored by faer.
//!
//! Every constraint acts on two or three beads by one vector, so that all its blocks are multiples
//! of one symmetric 3x3 matrix. Beads are ordered by approximate minimum degree, and the symbolic
//! factorisation is reused as long as the pattern stands.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltParams, LltRegularization};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, amd};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side, Spec};
use glam::DVec3;

/// A symmetric 3x3 matrix: xx, yx, zx, yy, zy, zz.
pub type Symmetric = [f64; 6];

/// `outer` y y^T + `diagonal` I.
pub fn symmetric(y: DVec3, outer: f64, diagonal: f64) -> Symmetric {
    let s = outer * y;
    [
        s.x * y.x + diagonal,
        s.x * y.y,
        s.x * y.z,
        s.y * y.y + diagonal,
        s.y * y.z,
        s.z * y.z + diagonal,
    ]
}

/// The blocks of a rope's matrix; those below the diagonal are these transposed.
pub struct Blocks {
    /// The diagonal.
    pub beads: Vec<Symmetric>,
    /// Between each bead and the next.
    pub neighbours: Vec<Symmetric>,
    /// Between the two beads beside each.
    pub seconds: Vec<Symmetric>,
    /// Between the beads of each pair in contact.
    pub contacts: Vec<Symmetric>,
}

impl Blocks {
    /// Nothing on `n` beads with so many contacts.
    pub fn zero(n: usize, contacts: usize) -> Self {
        let [beads, neighbours, seconds, contacts] =
            [n, n, n, contacts].map(|blocks| vec![[0.; 6]; blocks]);
        Self { beads, neighbours, seconds, contacts }
    }

    fn off_diagonal(&self) -> impl Iterator<Item = &Symmetric> {
        self.neighbours.iter().chain(&self.seconds).chain(&self.contacts)
    }
}

/// A sparse symmetric matrix of 3x3 blocks and its Cholesky factor.
pub struct System {
    /// Which block column a bead has.
    column: Vec<usize>,
    /// Where among the values the three columns of each block begin: the diagonal ones, the others.
    diagonal: Vec<[usize; 3]>,
    off_diagonal: Vec<[usize; 3]>,
    matrix: SymbolicSparseColMat<usize>,
    values: Vec<f64>,
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    memory: MemBuffer,
}

impl System {
    /// Analyses the pattern of a matrix on `n` beads, whose off-diagonal blocks are between `pairs`.
    pub fn new(n: usize, pairs: &[[usize; 2]]) -> Self {
        let column = minimum_degree(n, pairs);
        let ends: Vec<_> = pairs.iter().map(|pair| sorted(pair.map(|i| column[i]))).collect();
        let rows = sorted_rows((0..n).map(|p| [p, p]).chain(ends.iter().copied()), n);
        let matrix = upper_triangle(&rows);
        let starts = matrix.col_ptr();
        let begin = |[p, q]: [usize; 2]| {
            let place = rows[q].binary_search(&p).expect("listed above");
            [0, 1, 2].map(|c| starts[3 * q + c] + 3 * place)
        };
        let diagonal = column.iter().map(|&p| begin([p, p])).collect();
        let off_diagonal = ends.iter().map(|&ends| begin(ends)).collect();
        let symbolic = factorize_symbolic_cholesky(
            matrix.as_ref(),
            Side::Upper,
            SymmetricOrdering::Identity,
            CholeskySymbolicParams {
                // In half the time of the simplicial one, on ropes of two hundred beads already.
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
                ..Default::default()
            },
        )
        .expect("memory for the symbolic factorisation");
        let (values, factor) = (vec![0.; matrix.row_idx().len()], vec![0.; symbolic.len_val()]);
        let spec = Spec::<LltParams, f64>::default();
        let memory = MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, spec));
        Self { column, diagonal, off_diagonal, matrix, values, symbolic, factor, memory }
    }

    /// Factors the matrix of these blocks plus `shift` I. Returns whether it is positive definite.
    pub fn factor(&mut self, blocks: &Blocks, shift: f64) -> bool {
        self.fill(blocks, shift);
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                SparseColMatRef::new(self.matrix.as_ref(), &self.values),
                Side::Upper,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut self.memory),
                Spec::default(),
            )
            .is_ok()
    }

    fn fill(&mut self, blocks: &Blocks, shift: f64) {
        let v = &mut self.values;
        v.fill(0.);
        for (&[x, y, z], m) in self.diagonal.iter().zip(&blocks.beads) {
            let above = [x, y, z, y + 1, z + 1, z + 2];
            above.into_iter().zip(m).for_each(|(to, value)| v[to] += value);
            [x, y + 1, z + 2].into_iter().for_each(|to| v[to] += shift);
        }
        for (columns, m) in self.off_diagonal.iter().zip(blocks.off_diagonal()) {
            let [xx, yx, zx, yy, zy, zz] = *m;
            for (&to, values) in columns.iter().zip([[xx, yx, zx], [yx, yy, zy], [zx, zy, zz]]) {
                v[to..to + 3].iter_mut().zip(values).for_each(|(v, value)| *v += value);
            }
        }
    }

    /// Solves with the last factor.
    pub fn solve(&self, rhs: &[DVec3]) -> Vec<DVec3> {
        self.solve_all(&[rhs]).remove(0)
    }

    /// Solves for several right-hand sides, which takes little more than for one.
    pub fn solve_all(&self, rhs: &[impl AsRef<[DVec3]>]) -> Vec<Vec<DVec3>> {
        let (rows, count) = (3 * self.column.len(), rhs.len());
        let mut permuted = vec![0.; rows * count];
        for (column, v) in permuted.chunks_exact_mut(rows).zip(rhs) {
            for (v, &p) in v.as_ref().iter().zip(&self.column) {
                column[3 * p..3 * p + 3].copy_from_slice(&v.to_array());
            }
        }
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(count, Par::Seq);
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut permuted, rows, count),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
        let back = |column: &[f64]| {
            self.column.iter().map(|&p| DVec3::from_slice(&column[3 * p..3 * p + 3])).collect()
        };
        permuted.chunks_exact(rows).map(back).collect()
    }
}

/// The elimination order of beads: where each comes in it.
fn minimum_degree(n: usize, pairs: &[[usize; 2]]) -> Vec<usize> {
    let below = pairs.iter().map(|&pair| sorted(pair)).map(|[first, last]| [last, first]);
    let graph = pattern(sorted_rows(below, n));
    let nnz = graph.row_idx().len();
    let (mut order, mut inverse) = (vec![0; n], vec![0; n]);
    let mut memory = MemBuffer::new(amd::order_scratch::<usize>(n, nnz));
    amd::order(
        &mut order,
        &mut inverse,
        graph.as_ref(),
        amd::Control::default(),
        MemStack::new(&mut memory),
    )
    .expect("memory for the ordering");
    inverse
}

fn sorted([p, q]: [usize; 2]) -> [usize; 2] {
    [p.min(q), p.max(q)]
}

/// The rows of each column's entries, which are given as row and column, perhaps more than once.
fn sorted_rows(entries: impl Iterator<Item = [usize; 2]>, n: usize) -> Vec<Vec<usize>> {
    let mut rows = vec![vec![]; n];
    entries.for_each(|[row, column]| rows[column].push(row));
    for rows in &mut rows {
        rows.sort_unstable();
        rows.dedup();
    }
    rows
}

/// The scalar pattern of the upper triangle whose blocks are at `rows`, the diagonal ones being last.
fn upper_triangle(rows: &[Vec<usize>]) -> SymbolicSparseColMat<usize> {
    let column = |(p, c): (usize, usize)| -> Vec<usize> {
        let above = &rows[p][..rows[p].len() - 1];
        above.iter().flat_map(|q| 3 * q..3 * q + 3).chain(3 * p..=3 * p + c).collect()
    };
    pattern((0..rows.len()).flat_map(|p| [0, 1, 2].map(|c| (p, c))).map(column).collect())
}

/// The square pattern of these rows in each column.
fn pattern(columns: Vec<Vec<usize>>) -> SymbolicSparseColMat<usize> {
    let (n, mut starts) = (columns.len(), vec![0]);
    for column in &columns {
        starts.push(starts[starts.len() - 1] + column.len());
    }
    SymbolicSparseColMat::new_checked(n, n, starts, None, columns.concat())
}
