//! What a curve measures.

use pyo3::prelude::*;

use super::curve::{Given, curve};
use super::dict::{Dict, dict};
use super::errors::tried;
use crate::{Measures, check_embedded};

/// Measures a curve, in its own unit; L_p, L_c and L_a are ropelengths, lengths over the radius.
///
/// n vertices on so many components; dl the mean edge, dispersion the largest |s_i/dl - 1|; MinRad, SR
/// and R_s the thickness by curvature, by distance, and the smaller of both; R_c, L_c and L_a are None
/// where the inscribed curve has no thickness of its own. Baranska, Pieranski, Rawdon, section 2.
#[pyfunction]
pub fn measure<'py>(py: Python<'py>, components: Given<'py>) -> PyResult<Dict<'py>> {
    let curve = curve(components)?;
    measures(py, &tried(py, || check_embedded(&curve).map(|()| crate::measure(&curve)))?)
}

/// The mean over all directions of the signs of crossings, of components with themselves and with each
/// other, and of the number of crossings.
#[pyfunction]
pub fn writhe(py: Python<'_>, components: Given<'_>) -> PyResult<(f64, f64, f64)> {
    let curve = curve(components)?;
    let found = tried(py, || check_embedded(&curve).map(|()| crate::writhe(&curve)))?;
    Ok((found.own, found.between, found.crossings))
}

/// Measures by their names.
pub fn measures<'py>(py: Python<'py>, of: &Measures) -> PyResult<Dict<'py>> {
    Ok(dict!(
        py, of: n, components, dl, dispersion, min_rad, sr, r_s, r_c, length, inscribed_length, l_p,
        l_c, l_a,
    ))
}
