//! The Newton matrix of a rope: 3x3 blocks on the graph of chain and contacts, factored by faer.
//!
//! Every constraint acts on two or three beads by one vector, so that all its blocks are multiples
//! of one symmetric 3x3 matrix. Beads are ordered by approximate minimum degree, and the symbolic
//! factorisation is reused as long as the pattern stands.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::{LltParams, LltRegularization};
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
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

/// A sparse symmetric matrix of 3x3 blocks and its Cholesky factor.
pub struct System {
    /// Which block column a bead has.
    column: Vec<usize>,
    /// Block column and place in it of each block.
    places: Vec<(usize, usize)>,
    symbolic_matrix: SymbolicSparseColMat<usize>,
    values: Vec<f64>,
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    memory: MemBuffer,
}

impl System {
    /// Analyses the pattern of a matrix on `n` beads: its diagonal blocks and those between `pairs`.
    pub fn new(n: usize, pairs: &[[usize; 2]]) -> Self {
        let column = minimum_degree(n, pairs);
        let mut rows: Vec<Vec<usize>> = (0..n).map(|p| vec![p]).collect();
        let ends = |[a, b]: [usize; 2]| {
            let (p, q) = (column[a], column[b]);
            (p.min(q), p.max(q))
        };
        for &pair in pairs {
            let (p, q) = ends(pair);
            rows[q].push(p);
        }
        for rows in &mut rows {
            rows.sort_unstable();
            rows.dedup();
        }
        let places = (0..n)
            .map(|i| [i, i])
            .chain(pairs.iter().copied())
            .map(|pair| {
                let (p, q) = ends(pair);
                (q, rows[q].binary_search(&p).expect("listed above"))
            })
            .collect();
        let mut starts = vec![0];
        let mut scalar_rows = Vec::new();
        for (p, rows) in rows.iter().enumerate() {
            for c in 0..3 {
                let above = &rows[..rows.len() - 1];
                scalar_rows.extend(above.iter().flat_map(|q| 3 * q..3 * q + 3));
                scalar_rows.extend(3 * p..=3 * p + c);
                starts.push(scalar_rows.len());
            }
        }
        let values = vec![0.; scalar_rows.len()];
        let symbolic_matrix =
            SymbolicSparseColMat::new_checked(3 * n, 3 * n, starts, None, scalar_rows);
        let symbolic = factorize_symbolic_cholesky(
            symbolic_matrix.as_ref(),
            Side::Upper,
            SymmetricOrdering::Identity,
            CholeskySymbolicParams::default(),
        )
        .expect("memory for the symbolic factorisation");
        let factor = vec![0.; symbolic.len_val()];
        let memory = MemBuffer::new(StackReq::any_of(&[
            symbolic
                .factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::<LltParams, f64>::default()),
            symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        ]));
        Self { column, places, symbolic_matrix, values, symbolic, factor, memory }
    }

    /// Factors the matrix whose block `k` is `blocks[k]`, first the diagonal ones and then those of
    /// the pairs, plus `shift` I. Returns whether it is positive definite.
    pub fn factor(&mut self, blocks: &[Symmetric], shift: f64) -> bool {
        let n = self.column.len();
        self.values.fill(0.);
        let starts = self.symbolic_matrix.col_ptr();
        for (k, (&(p, place), m)) in self.places.iter().zip(blocks).enumerate() {
            let [x, y, z] = [0, 1, 2].map(|c| starts[3 * p + c] + 3 * place);
            let v = &mut self.values;
            if k < n {
                for (to, value) in [x, y, z, y + 1, z + 1, z + 2].into_iter().zip(m) {
                    v[to] += value;
                }
                for to in [x, y + 1, z + 2] {
                    v[to] += shift;
                }
            } else {
                let square = [m[0], m[1], m[2], m[1], m[3], m[4], m[2], m[4], m[5]];
                for (to, values) in [x, y, z].into_iter().zip(square.chunks(3)) {
                    for (r, value) in values.iter().enumerate() {
                        v[to + r] += value;
                    }
                }
            }
        }
        let matrix = SparseColMatRef::new(self.symbolic_matrix.as_ref(), &self.values);
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                matrix,
                Side::Upper,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut self.memory),
                Spec::default(),
            )
            .is_ok()
    }

    /// Solves with the last factor.
    pub fn solve(&mut self, rhs: &[DVec3]) -> Vec<DVec3> {
        let n = rhs.len();
        let mut permuted = vec![0.; 3 * n];
        for (v, &p) in rhs.iter().zip(&self.column) {
            permuted[3 * p..3 * p + 3].copy_from_slice(&v.to_array());
        }
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut permuted, 3 * n, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
        self.column.iter().map(|&p| DVec3::from_slice(&permuted[3 * p..3 * p + 3])).collect()
    }
}

/// The elimination order of beads: where each comes in it.
fn minimum_degree(n: usize, pairs: &[[usize; 2]]) -> Vec<usize> {
    let mut rows: Vec<Vec<usize>> = vec![vec![]; n];
    for &[a, b] in pairs {
        rows[a.min(b)].push(a.max(b));
    }
    let mut starts = vec![0];
    let mut flat = Vec::new();
    for rows in &mut rows {
        rows.sort_unstable();
        rows.dedup();
        flat.extend_from_slice(rows);
        starts.push(flat.len());
    }
    let nnz = flat.len();
    let graph = SymbolicSparseColMat::new_checked(n, n, starts, None, flat);
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
