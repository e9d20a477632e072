//! Curves: lists of (n_i, 3) arrays, one for each component.

use glam::DVec3;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::errors::{to_python, tried};
use crate::{Curve, Result, check_embedded};

/// A curve that comes from Python.
pub type Given<'py> = Vec<PyReadonlyArray2<'py, f64>>;
/// A curve that goes there.
pub type Arrays<'py> = Vec<Bound<'py, PyArray2<f64>>>;

/// The curve of these components.
pub fn curve(components: Given<'_>) -> PyResult<Curve> {
    let component = |array: PyReadonlyArray2<'_, f64>| {
        let array = array.as_array();
        if array.ncols() != 3 {
            return Err(PyValueError::new_err("a component must have the shape (n, 3)"));
        }
        Ok(array.rows().into_iter().map(|row| DVec3::new(row[0], row[1], row[2])).collect())
    };
    let components = components.into_iter().map(component).collect::<PyResult<_>>()?;
    Curve::new(components).map_err(to_python)
}

/// The components of a curve.
pub fn arrays<'py>(py: Python<'py>, curve: &Curve) -> PyResult<Arrays<'py>> {
    (0..curve.components())
        .map(|c| {
            let v = curve.component(c);
            let flat = v.iter().flat_map(DVec3::to_array).collect();
            PyArray1::from_vec(py, flat).reshape([v.len(), 3])
        })
        .collect()
}

/// K_P with `n` vertices in all at equal chords.
#[pyfunction]
pub fn refine<'py>(py: Python<'py>, components: Given<'py>, n: usize) -> PyResult<Arrays<'py>> {
    changed(py, components, |curve| {
        check_embedded(curve)?;
        crate::refine(curve, n, 0.25)
    })
}

/// The same curve with as few vertices as triangle moves leave, by exact isotopy.
#[pyfunction]
pub fn simplify<'py>(py: Python<'py>, components: Given<'py>) -> PyResult<Arrays<'py>> {
    changed(py, components, crate::simplified)
}

/// A curve of the same type that holds a thick rope, by exact isotopy.
#[pyfunction]
pub fn loosen<'py>(py: Python<'py>, components: Given<'py>) -> PyResult<Arrays<'py>> {
    changed(py, components, crate::loosened)
}

fn changed<'py>(
    py: Python<'py>,
    components: Given<'py>,
    change: impl FnOnce(&Curve) -> Result<Curve> + Send,
) -> PyResult<Arrays<'py>> {
    let curve = curve(components)?;
    let changed = tried(py, || change(&curve))?;
    arrays(py, &changed)
}
