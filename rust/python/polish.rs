//! The polish.

use pyo3::prelude::*;

use super::curve::{Arrays, Given, arrays, curve};
use super::dict::{Dict, dict};
use super::engine::{budget, name_of, restored, settings_from_json, state};
use super::errors::{released, tried};
use super::forces::{ForceArrays, force_arrays};
use super::measures::measures;
use crate::polish::Status;

/// Where a `Polish` stands; `residual` is a force, tension being 1.
fn status<'py>(py: Python<'py>, of: &Status) -> PyResult<Dict<'py>> {
    Ok(dict!(
        py, of: outcome = name_of(of.outcome), progress, iterations, factorisations,
        moves = of.passages.shown, undone = of.passages.refused, margin = of.passages.margin,
        residual, mu, excess, best = measures(py, &of.best)?,
    ))
}

/// The polish of a rope on n vertices in all; if only `passing`, it ends when that is worth refining.
/// `settings` is JSON.
#[pyclass(module = "sono._core")]
pub struct Polish(crate::Polish);

#[pymethods]
impl Polish {
    #[new]
    #[pyo3(signature = (components, n, passing, seed, settings="{}"))]
    fn new(
        py: Python<'_>,
        components: Given<'_>,
        n: usize,
        passing: bool,
        seed: u64,
        settings: &str,
    ) -> PyResult<Self> {
        let curve = curve(components)?;
        let settings = settings_from_json(settings)?;
        tried(py, || crate::Polish::new(&curve, n, passing, seed, settings)).map(Self)
    }

    /// Works for about so many seconds, unless done before, with the interpreter released.
    fn advance<'py>(&mut self, py: Python<'py>, seconds: f64) -> PyResult<Dict<'py>> {
        let budget = budget(seconds)?;
        status(py, &released(py, || self.0.advance(budget))?)
    }

    /// Where it stands.
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Dict<'py>> {
        status(py, &released(py, || self.0.status())?)
    }

    /// The best rope so far, its R_s = 1, its centre at the origin.
    fn best<'py>(&self, py: Python<'py>) -> PyResult<Arrays<'py>> {
        arrays(py, &released(py, || self.0.best())?)
    }

    /// The forces in the rope as it is.
    fn forces<'py>(&self, py: Python<'py>) -> PyResult<ForceArrays<'py>> {
        force_arrays(py, released(py, || self.0.forces())?)
    }

    /// All that is needed to go on later, as JSON.
    fn state(&self, py: Python<'_>) -> PyResult<String> {
        state(py, &self.0)
    }

    /// Goes on from what `state` returned.
    #[staticmethod]
    fn restore(py: Python<'_>, state: &str) -> PyResult<Self> {
        restored(py, state, crate::Polish::is_sound).map(Self)
    }
}
