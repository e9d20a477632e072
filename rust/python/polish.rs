//! The polish.

use pyo3::prelude::*;

use super::curve::{Arrays, Given, arrays, curve};
use super::engine::{budget, name_of, restored, state};
use super::errors::{released, tried};
use super::forces::{ForceArrays, force_arrays};
use super::measures::Measures;

/// Where a `Polish` stands; `residual` is a force, tension being 1.
#[pyclass(frozen, get_all, module = "sono._core")]
pub struct PolishStatus {
    outcome: &'static str,
    progress: f64,
    iterations: u64,
    factorisations: u64,
    residual: f64,
    mu: f64,
    excess: f64,
    best: Py<Measures>,
}

impl PolishStatus {
    fn new(py: Python<'_>, status: &crate::polish::Status) -> PyResult<Self> {
        let &crate::polish::Status {
            outcome,
            progress,
            iterations,
            factorisations,
            residual,
            mu,
            excess,
            best,
        } = status;
        let (outcome, best) = (name_of(outcome), Py::new(py, Measures::from(best))?);
        Ok(Self { outcome, progress, iterations, factorisations, residual, mu, excess, best })
    }
}

/// The polish of a rope on n vertices in all; if only `passing`, it ends when that is worth refining.
#[pyclass(module = "sono._core")]
pub struct Polish(crate::Polish);

#[pymethods]
impl Polish {
    #[new]
    fn new(
        py: Python<'_>,
        components: Given<'_>,
        n: usize,
        passing: bool,
        seed: u64,
    ) -> PyResult<Self> {
        let curve = curve(components)?;
        tried(py, || crate::Polish::new(&curve, n, passing, seed)).map(Self)
    }

    /// Works for about so many seconds, unless done before, with the interpreter released.
    fn advance(&mut self, py: Python<'_>, seconds: f64) -> PyResult<PolishStatus> {
        let budget = budget(seconds)?;
        let status = released(py, || self.0.advance(budget))?;
        PolishStatus::new(py, &status)
    }

    /// Where it stands.
    fn status(&self, py: Python<'_>) -> PyResult<PolishStatus> {
        PolishStatus::new(py, &released(py, || self.0.status())?)
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
