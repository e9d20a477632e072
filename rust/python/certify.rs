//! What is proven of a curve.

use pyo3::prelude::*;

use super::curve::{Given, curve};
use super::dict::{Dict, dict};
use super::errors::tried;
use crate::certify::bound::Decider;

/// Bounds the ropelength of a curve's type from above, however numbers are rounded.
#[pyfunction]
pub fn certify<'py>(py: Python<'py>, components: Given<'py>) -> PyResult<Dict<'py>> {
    let curve = curve(components)?;
    let bound = tried(py, || crate::certify(&curve))?;
    let (condition, vertices) = match bound.decided_by {
        Decider::Bend(i) => ("bend", vec![i]),
        Decider::Pair(i, j) => ("pair", vec![i, j]),
    };
    let place = |i: usize| {
        let component = curve.component_of(i);
        (component, i - curve.range(component).start)
    };
    let vertices: Vec<_> = vertices.into_iter().map(place).collect();
    Ok(dict!(
        py, bound: longest_edge, min_rad, r, r_c, inscribed_length, l_c, condition = condition,
        vertices = vertices,
    ))
}
