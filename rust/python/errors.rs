//! What Python raises.

use std::panic::{AssertUnwindSafe, catch_unwind};

use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use crate::Error;

create_exception!(
    sono,
    CurveError,
    PyValueError,
    "A curve that cannot be used; `places` lists what is wrong with it as (component, vertex), both\n\
     counted from 0, the vertex None where a whole component is meant. `needed` is the least n that\n\
     will do, None where no n will."
);

create_exception!(
    sono,
    PanicError,
    PyRuntimeError,
    "The core came upon a bug of its own. What it worked on is lost, and nothing else."
);

/// Works with the interpreter released. A panic becomes an exception that handlers of errors catch.
pub fn released<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| catch_unwind(AssertUnwindSafe(work))).map_err(|panic| {
        let text = panic.downcast_ref::<&str>().map(|text| (*text).to_string());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        PanicError::new_err(text.unwrap_or_default())
    })
}

/// The same where the core may refuse what it is given.
pub fn tried<T: Send>(
    py: Python<'_>,
    work: impl FnOnce() -> crate::Result<T> + Send,
) -> PyResult<T> {
    released(py, work)?.map_err(to_python)
}

/// The exception that an error of the core becomes.
pub fn to_python(error: Error) -> PyErr {
    if let Error::Setting { .. } = error {
        return PyValueError::new_err(error.to_string());
    }
    let (places, needed) = (places(&error), needed(&error));
    let raised = CurveError::new_err(error.to_string());
    let explained = |py: Python<'_>| {
        raised.value(py).setattr("places", places)?;
        raised.value(py).setattr("needed", needed)
    };
    Python::attach(explained).map_or_else(|e| e, |()| raised)
}

/// The least n that will do.
fn needed(error: &Error) -> Option<usize> {
    match *error {
        Error::TooFew { needed, .. }
        | Error::TooCoarse { needed, .. }
        | Error::Pierced { needed, .. } => Some(needed),
        _ => None,
    }
}

/// Component and vertex of what is wrong.
fn places(error: &Error) -> Vec<(usize, Option<usize>)> {
    match *error {
        Error::TooFewVertices { component, .. } => vec![(component, None)],
        Error::NotFinite { component, vertex } | Error::SharpBend { component, vertex, .. } => {
            vec![(component, Some(vertex))]
        }
        Error::Coincident { component, vertex, next } => {
            vec![(component, Some(vertex)), (component, Some(next))]
        }
        Error::SelfCrossing { component, vertex, other_component, other_vertex }
        | Error::ClosePair { component, vertex, other_component, other_vertex, .. } => {
            vec![(component, Some(vertex)), (other_component, Some(other_vertex))]
        }
        _ => vec![],
    }
}
