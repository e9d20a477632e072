//! One stage of SONO.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::curve::{Arrays, Given, arrays, curve};
use super::dict::{Dict, dict};
use super::engine::{budget, name_of, restored, settings_from_json, state};
use super::errors::{released, tried};
use super::measures::measures;
use crate::{Curve, Settings, Stage, Status};

/// Where SONO stands; `overlap` and `dispersion` are those the last sweep met, R = 1.
pub fn status<'py>(py: Python<'py>, of: &Status) -> PyResult<Dict<'py>> {
    Ok(dict!(
        py, of: outcome = name_of(of.outcome), stage = stage(of.stage), progress, sweeps, lost,
        moves = of.passages.shown, undone = of.passages.refused, margin = of.passages.margin,
        epsilon, overlap = of.met.overlap, dispersion = of.met.dispersion,
        best = measures(py, &of.best)?,
    ))
}

fn stage(stage: Stage) -> &'static str {
    match stage {
        Stage::Loosen => "loosen",
        Stage::Collapse => "collapse",
        Stage::Anneal => "anneal",
        Stage::Reanneal => "reanneal",
        Stage::Settle => "settle",
    }
}

/// One stage of SONO on n vertices in all; `settings` is JSON.
#[pyclass(module = "sono._core")]
pub struct Tightener(crate::Tightener);

#[pymethods]
impl Tightener {
    #[new]
    fn new(
        py: Python<'_>,
        components: Given<'_>,
        stage: &str,
        n: usize,
        settings: &str,
    ) -> PyResult<Self> {
        let curve = curve(components)?;
        let settings = settings_from_json(settings)?;
        let begin: fn(&Curve, usize, Settings) -> crate::Result<_> = match stage {
            "anneal" => crate::Tightener::anneal,
            "reanneal" => crate::Tightener::reanneal,
            "settle" => crate::Tightener::settle,
            _ => {
                let known = "anneal, reanneal, settle";
                let message = format!("unknown stage '{stage}'; the stages are: {known}");
                return Err(PyValueError::new_err(message));
            }
        };
        tried(py, || begin(&curve, n, settings)).map(Self)
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
        arrays(py, self.0.best())
    }

    /// All that is needed to go on later, as JSON.
    fn state(&self, py: Python<'_>) -> PyResult<String> {
        state(py, &self.0)
    }

    /// Goes on from what `state` returned.
    #[staticmethod]
    fn restore(py: Python<'_>, state: &str) -> PyResult<Self> {
        restored(py, state, crate::Tightener::is_sound).map(Self)
    }
}
