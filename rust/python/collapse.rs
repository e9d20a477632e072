//! From any embedded curve to a jammed rope.

use pyo3::prelude::*;

use super::curve::{Arrays, Given, arrays, curve};
use super::dict::{Dict, dict};
use super::engine::{budget, restored, settings_from_json, state};
use super::errors::{released, tried};
use super::tightener::status;
use crate::passage::Passages;

/// From any embedded curve to a jammed rope; a thin one is loosened first, unless it was before.
#[pyclass(module = "sono._core")]
pub struct Collapse(crate::Collapse);

#[pymethods]
impl Collapse {
    #[new]
    fn new(
        py: Python<'_>,
        components: Given<'_>,
        loosened: bool,
        settings: &str,
    ) -> PyResult<Self> {
        let curve = curve(components)?;
        let settings = settings_from_json(settings)?;
        tried(py, || crate::Collapse::new(&curve, loosened, settings)).map(Self)
    }

    /// Works for about so many seconds, unless done before, with the interpreter released.
    fn advance<'py>(&mut self, py: Python<'py>, seconds: f64) -> PyResult<Dict<'py>> {
        let budget = budget(seconds)?;
        status(py, &tried(py, || self.0.advance(budget))?)
    }

    /// Where it stands.
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Dict<'py>> {
        status(py, &released(py, || self.0.status())?)
    }

    /// The loosened curve, if it was loosened.
    fn loosened<'py>(&self, py: Python<'py>) -> PyResult<Option<Arrays<'py>>> {
        self.0.loosened().map(|curve| arrays(py, curve)).transpose()
    }

    /// What loosening took, if the curve was loosened: vertices moved and removed, and the sweeps that a
    /// rope had jammed in before.
    fn loosening<'py>(&self, py: Python<'py>) -> PyResult<Option<Dict<'py>>> {
        let Some((took, before)) = self.0.loosening() else { return Ok(None) };
        let passages = before.map_or_else(Passages::default, |status| status.passages);
        let [sweeps, lost] = before.map_or([0, 0], |status| [status.sweeps, status.lost]);
        Ok(Some(dict!(
            py, took: moved, removed, sweeps = sweeps, lost = lost, moves = passages.shown,
            undone = passages.refused, margin = passages.margin,
        )))
    }

    /// The best rope so far, its R_s = 1, its centre at the origin.
    fn best<'py>(&self, py: Python<'py>) -> PyResult<Arrays<'py>> {
        arrays(py, &released(py, || self.0.best())?)
    }

    /// All that is needed to go on later, as JSON.
    fn state(&self, py: Python<'_>) -> PyResult<String> {
        state(py, &self.0)
    }

    /// Goes on from what `state` returned.
    #[staticmethod]
    fn restore(py: Python<'_>, state: &str) -> PyResult<Self> {
        restored(py, state, crate::Collapse::is_sound).map(Self)
    }
}
