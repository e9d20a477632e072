//! What all engines have: budgets of time, states to go on from, and outcomes.

use std::time::Duration;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::errors::released;
use crate::{Outcome, Settings, polish};

/// The settings that SONO has unless told otherwise, as JSON.
#[pyfunction]
pub fn default_settings() -> String {
    serde_json::to_string(&Settings::default()).expect("plain numbers")
}

/// The settings that the polish has unless told otherwise, as JSON.
#[pyfunction]
pub fn default_polish_settings() -> String {
    serde_json::to_string(&polish::Settings::default()).expect("plain numbers")
}

/// Settings given as JSON.
pub fn settings_from_json<T: DeserializeOwned>(settings: &str) -> PyResult<T> {
    serde_json::from_str(settings).map_err(|e| PyValueError::new_err(format!("settings: {e}")))
}

/// How long to work.
pub fn budget(seconds: f64) -> PyResult<Duration> {
    Duration::try_from_secs_f64(seconds).map_err(|e| PyValueError::new_err(e.to_string()))
}

/// All that is needed to go on later, as JSON.
pub fn state(py: Python<'_>, engine: &(impl Serialize + Sync)) -> PyResult<String> {
    released(py, || serde_json::to_string(engine))?
        .map_err(|e| PyValueError::new_err(e.to_string()))
}

/// What was saved by `state`, if it is a state that can go on.
pub fn restored<T>(py: Python<'_>, state: &str, is_sound: fn(&T) -> bool) -> PyResult<T>
where
    T: DeserializeOwned + Send,
{
    let parsed = released(py, || match serde_json::from_str(state) {
        Ok(engine) if is_sound(&engine) => Ok(engine),
        Ok(_) => Err("its parts do not fit together".to_string()),
        Err(error) => Err(error.to_string()),
    })?;
    parsed.map_err(|why| PyValueError::new_err(format!("not a state of an engine: {why}")))
}

/// What Python calls an outcome.
pub fn name_of(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Running => "running",
        Outcome::Tight => "tight",
        Outcome::Stuck => "stuck",
    }
}
