//! What a curve measures.

use pyo3::prelude::*;

use super::curve::{Given, curve};
use super::errors::tried;
use crate::check_embedded;

/// What a curve measures, in its own unit; L_p, L_c and L_a are ropelengths, lengths over the radius.
///
/// n vertices on so many components; dl the mean edge, dispersion the largest |s_i/dl - 1|; MinRad, SR
/// and R_s the thickness by curvature, by distance, and the smaller of both; R_c, L_c and L_a are None
/// where the inscribed curve has no thickness of its own. Baranska, Pieranski, Rawdon, section 2.
#[pyclass(frozen, get_all, module = "sono")]
pub struct Measures {
    n: usize,
    components: usize,
    dl: f64,
    dispersion: f64,
    min_rad: f64,
    sr: f64,
    r_s: f64,
    r_c: Option<f64>,
    length: f64,
    inscribed_length: f64,
    l_p: f64,
    l_c: Option<f64>,
    l_a: Option<f64>,
}

impl From<crate::Measures> for Measures {
    fn from(m: crate::Measures) -> Self {
        let crate::Measures {
            n,
            components,
            dl,
            dispersion,
            min_rad,
            sr,
            r_s,
            r_c,
            length,
            inscribed_length,
            l_p,
            l_c,
            l_a,
        } = m;
        Self {
            n,
            components,
            dl,
            dispersion,
            min_rad,
            sr,
            r_s,
            r_c,
            length,
            inscribed_length,
            l_p,
            l_c,
            l_a,
        }
    }
}

/// Measures a curve, in its own unit.
#[pyfunction]
pub fn measure(py: Python<'_>, components: Given<'_>) -> PyResult<Measures> {
    let curve = curve(components)?;
    tried(py, || check_embedded(&curve).map(|()| crate::measure(&curve).into()))
}
