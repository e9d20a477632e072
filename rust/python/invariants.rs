//! What knot types are told by.

use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::curve::{Given, curve};
use super::errors::released;

type CrossingArrays<'py> =
    (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<bool>>);

/// The crossings seen from above: places of the upper and lower strands, whether right-handed. Of
/// more than `most`, only some.
#[pyfunction]
pub fn crossings<'py>(
    py: Python<'py>,
    components: Given<'py>,
    most: usize,
) -> PyResult<CrossingArrays<'py>> {
    let curve = curve(components)?;
    let found = released(py, || crate::invariants::projection::crossings(&curve, most))?;
    Ok((
        PyArray1::from_iter(py, found.iter().map(|c| c.over)),
        PyArray1::from_iter(py, found.iter().map(|c| c.under)),
        PyArray1::from_iter(py, found.iter().map(|c| c.right)),
    ))
}

/// The determinant of an n x n matrix of entries (row, column, value) modulo `PRIME`.
#[pyfunction]
pub fn determinant(py: Python<'_>, n: usize, entries: Vec<(usize, usize, u64)>) -> PyResult<u64> {
    if entries.iter().any(|&(i, j, _)| i.max(j) >= n) {
        return Err(PyValueError::new_err("an entry lies outside the matrix"));
    }
    released(py, || crate::invariants::modular::determinant(n, &entries))
}
