//! Forces in a rope.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

use super::curve::{Given, curve};
use super::errors::tried;
use crate::check_embedded;
use crate::polish::Forces;

type Array<'py, T> = Bound<'py, PyArray1<T>>;
/// Tension, couple, the contacts' beads and forces, the residual.
pub type ForceArrays<'py> =
    (Array<'py, f64>, Array<'py, f64>, Bound<'py, PyArray2<i64>>, Array<'py, f64>, f64);

/// Forces as arrays.
pub fn force_arrays(py: Python<'_>, forces: Forces) -> PyResult<ForceArrays<'_>> {
    let Forces { tension, couple, contacts, residual } = forces;
    let beads = contacts.iter().flat_map(|c| [c.0 as i64, c.1 as i64]).collect();
    let pressing = contacts.iter().map(|c| c.2).collect();
    Ok((
        PyArray1::from_vec(py, tension),
        PyArray1::from_vec(py, couple),
        PyArray1::from_vec(py, beads).reshape([contacts.len(), 2])?,
        PyArray1::from_vec(py, pressing),
        residual,
    ))
}

/// The forces that come nearest to balance on a curve.
#[pyfunction]
pub fn balance<'py>(py: Python<'py>, components: Given<'py>) -> PyResult<ForceArrays<'py>> {
    let curve = curve(components)?;
    let forces = tried(py, || check_embedded(&curve).map(|()| crate::polish::balance(&curve)))?;
    force_arrays(py, forces)
}
