//! Determinants of sparse matrices modulo a prime.

use std::collections::BTreeMap;

/// The largest prime below 2^31 modulo which there are roots of unity of the orders 2, 3 and 5.
pub const PRIME: u64 = 2_147_482_951;

/// The determinant of an n x n matrix of `entries` (row, column, value) modulo [`PRIME`]; entries in
/// one place add up. Gaussian elimination, each time with the shortest row that is left.
///
/// ```
/// use sono::invariants::modular::determinant;
/// assert_eq!(determinant(2, &[(0, 0, 2), (0, 1, 1), (1, 0, 5), (1, 1, 3)]), 1);
/// ```
pub fn determinant(n: usize, entries: &[(usize, usize, u64)]) -> u64 {
    let mut elimination = Elimination::new(n, entries);
    let mut left: Vec<_> = (0..n).collect();
    let mut pivots = vec![0; n];
    let mut product = 1;
    while let Some(at) = (0..left.len()).min_by_key(|&k| elimination.rows[left[k]].len()) {
        let i = left.swap_remove(at);
        let Some((pivot, value)) = elimination.eliminate(i) else { return 0 };
        pivots[i] = pivot;
        product = product * value % PRIME;
    }
    if is_odd(&pivots) { (PRIME - product) % PRIME } else { product }
}

/// A matrix by its rows.
struct Elimination {
    /// The values that are not 0, by their columns.
    rows: Vec<BTreeMap<usize, u64>>,
    /// In which rows there may be one.
    columns: Vec<Vec<usize>>,
}

impl Elimination {
    fn new(n: usize, entries: &[(usize, usize, u64)]) -> Self {
        let mut rows: Vec<BTreeMap<usize, u64>> = vec![BTreeMap::new(); n];
        for &(row, column, value) in entries {
            let sum = rows[row].entry(column).or_insert(0);
            *sum = (*sum + value % PRIME) % PRIME;
        }
        rows.iter_mut().for_each(|row| row.retain(|_, value| *value != 0));
        let mut columns = vec![vec![]; n];
        for (i, row) in rows.iter().enumerate() {
            row.keys().for_each(|&column| columns[column].push(i));
        }
        Self { rows, columns }
    }

    /// Takes out a row, and the column in which it has a value and there are fewest. Returns that
    /// column and the value, if there is one.
    fn eliminate(&mut self, i: usize) -> Option<(usize, u64)> {
        let row = std::mem::take(&mut self.rows[i]);
        let (&pivot, &value) = row.iter().min_by_key(|(column, _)| self.columns[**column].len())?;
        let inverse = power(value, PRIME - 2);
        for j in std::mem::take(&mut self.columns[pivot]) {
            if let Some(other) = self.rows[j].remove(&pivot) {
                let others = row.iter().filter(|(column, _)| **column != pivot);
                self.subtract(j, other * inverse % PRIME, others);
            }
        }
        Some((pivot, value))
    }

    /// Subtracts `factor` times the values of another row from row `j`.
    fn subtract<'a>(
        &mut self,
        j: usize,
        factor: u64,
        other: impl Iterator<Item = (&'a usize, &'a u64)>,
    ) {
        for (&column, &value) in other {
            let changed = self.rows[j].entry(column).or_insert_with(|| {
                self.columns[column].push(j);
                0
            });
            *changed = (*changed + PRIME - factor * value % PRIME) % PRIME;
            if *changed == 0 {
                self.rows[j].remove(&column);
            }
        }
    }
}

/// `base` to a power modulo [`PRIME`].
pub fn power(base: u64, mut exponent: u64) -> u64 {
    let (mut base, mut result) = (base % PRIME, 1);
    while exponent > 0 {
        if exponent % 2 == 1 {
            result = result * base % PRIME;
        }
        base = base * base % PRIME;
        exponent /= 2;
    }
    result
}

/// Whether a permutation is odd.
fn is_odd(permutation: &[usize]) -> bool {
    let mut seen = vec![false; permutation.len()];
    let mut odd = false;
    for start in 0..permutation.len() {
        let mut k = start;
        while !seen[k] {
            seen[k] = true;
            k = permutation[k];
            odd ^= k != start;
        }
    }
    odd
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// By expansion along the first row.
    fn expanded(matrix: &[Vec<u64>]) -> u64 {
        let Some(first) = matrix.first() else { return 1 };
        let minor = |column: usize| -> Vec<Vec<u64>> {
            let others = |row: &Vec<u64>| {
                let mut row = row.clone();
                row.remove(column);
                row
            };
            matrix[1..].iter().map(others).collect()
        };
        (0..first.len()).fold(0, |sum, column| {
            let term = first[column] * expanded(&minor(column)) % PRIME;
            (sum + if column % 2 == 0 { term } else { PRIME - term }) % PRIME
        })
    }

    proptest! {
        #[test]
        fn elimination_and_expansion_agree(
            matrix in prop::collection::vec(prop::collection::vec(
                prop_oneof![3 => Just(0), 1 => 0..PRIME], 6), 6)
        ) {
            let entries: Vec<_> = (0..6)
                .flat_map(|i| (0..6).map(move |j| (i, j)))
                .map(|(i, j)| (i, j, matrix[i][j]))
                .collect();
            prop_assert_eq!(determinant(6, &entries), expanded(&matrix));
        }
    }
}
