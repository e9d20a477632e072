//! The Python module `sono._core`: arrays in, arrays out, the interpreter released while Rust works.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;

use glam::DVec3;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use serde::de::DeserializeOwned;

use crate::polish::Forces;
use crate::{Curve, Error, Outcome, Settings, Stage, check_embedded};

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
fn released<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| catch_unwind(AssertUnwindSafe(work))).map_err(|panic| {
        let text = panic.downcast_ref::<&str>().map(|text| (*text).to_string());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        PanicError::new_err(text.unwrap_or_default())
    })
}

fn to_python(error: Error) -> PyErr {
    let needed = match error {
        Error::TooFew { needed, .. }
        | Error::TooCoarse { needed, .. }
        | Error::Pierced { needed, .. } => Some(needed),
        _ => None,
    };
    let places = match error {
        Error::Setting { .. } => return PyValueError::new_err(error.to_string()),
        Error::TooFewVertices { component, .. } => vec![(component, None)],
        Error::NotFinite { component, vertex } => vec![(component, Some(vertex))],
        Error::Coincident { component, vertex, next } => {
            vec![(component, Some(vertex)), (component, Some(next))]
        }
        Error::SelfCrossing { component, vertex, other_component, other_vertex } => {
            vec![(component, Some(vertex)), (other_component, Some(other_vertex))]
        }
        Error::Empty
        | Error::TooThin { .. }
        | Error::TooEntangled { .. }
        | Error::TooFew { .. }
        | Error::TooCoarse { .. }
        | Error::Pierced { .. } => vec![],
    };
    let raised = CurveError::new_err(error.to_string());
    let explained = |py: Python<'_>| {
        raised.value(py).setattr("places", places)?;
        raised.value(py).setattr("needed", needed)
    };
    Python::attach(explained).map_or_else(|e| e, |()| raised)
}

type Arrays<'py> = Vec<PyReadonlyArray2<'py, f64>>;

fn curve(components: Arrays<'_>) -> PyResult<Curve> {
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

fn arrays<'py>(py: Python<'py>, curve: &Curve) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
    (0..curve.components())
        .map(|c| {
            let v = curve.component(c);
            let flat = v.iter().flat_map(DVec3::to_array).collect();
            PyArray1::from_vec(py, flat).reshape([v.len(), 3])
        })
        .collect()
}

/// What a curve measures, in its own unit; L_p, L_c and L_a are ropelengths, lengths over the radius.
///
/// n vertices on so many components; dl the mean edge, dispersion the largest |s_i/dl - 1|; MinRad, SR
/// and R_s the thickness by curvature, by distance, and the smaller of both; R_c, L_c and L_a are None
/// where the inscribed curve has no thickness of its own. Baranska, Pieranski, Rawdon, section 2.
#[pyclass(frozen, get_all, module = "sono")]
struct Measures {
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

#[pyfunction]
fn measure(py: Python<'_>, components: Arrays<'_>) -> PyResult<Measures> {
    let curve = curve(components)?;
    released(py, || check_embedded(&curve).map(|()| crate::measure(&curve).into()))?
        .map_err(to_python)
}

#[pyfunction]
fn refine<'py>(
    py: Python<'py>,
    components: Arrays<'py>,
    n: usize,
) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
    let curve = curve(components)?;
    let refined = released(py, || crate::refine(&curve, n, 0.25))?.map_err(to_python)?;
    arrays(py, &refined)
}

/// The same curve with as few vertices as triangle moves leave, by exact isotopy.
#[pyfunction]
fn simplify<'py>(
    py: Python<'py>,
    components: Arrays<'py>,
) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
    let curve = curve(components)?;
    let simple = released(py, || crate::simplified(&curve))?.map_err(to_python)?;
    arrays(py, &simple)
}

type CrossingArrays<'py> =
    (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<bool>>);

/// The crossings seen from above: places of the upper and lower strands, whether right-handed. Of
/// more than `most`, only some.
#[pyfunction]
fn crossings<'py>(
    py: Python<'py>,
    components: Arrays<'py>,
    most: usize,
) -> PyResult<CrossingArrays<'py>> {
    let curve = curve(components)?;
    let found = released(py, || crate::invariants::projection::crossings(&curve, most))?;
    Ok((
        PyArray1::from_iter(py, found.iter().map(|c| c.over)),
        PyArray1::from_iter(py, found.iter().map(|c| c.under)),
        PyArray1::from_iter(py, found.iter().map(|c| c.right)),
    ))
}

/// The determinant of an n x n matrix of entries (row, column, value) modulo `PRIME`.
#[pyfunction]
fn determinant(py: Python<'_>, n: usize, entries: Vec<(usize, usize, u64)>) -> PyResult<u64> {
    if entries.iter().any(|&(i, j, _)| i.max(j) >= n) {
        return Err(PyValueError::new_err("an entry lies outside the matrix"));
    }
    released(py, || crate::invariants::modular::determinant(n, &entries))
}

#[pyfunction]
fn loosen<'py>(
    py: Python<'py>,
    components: Arrays<'py>,
) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
    let curve = curve(components)?;
    let loose = released(py, || crate::loosened(&curve))?.map_err(to_python)?;
    arrays(py, &loose)
}

#[pyfunction]
fn default_settings() -> String {
    serde_json::to_string(&Settings::default()).expect("plain numbers")
}

#[pyclass(frozen, get_all, module = "sono._core")]
struct Status {
    outcome: &'static str,
    stage: &'static str,
    progress: f64,
    sweeps: u64,
    undone: u64,
    epsilon: f64,
    overlap: f64,
    dispersion: f64,
    best: Py<Measures>,
}

impl Status {
    fn new(py: Python<'_>, status: &crate::Status) -> PyResult<Self> {
        Ok(Self {
            outcome: name_of(status.outcome),
            stage: match status.stage {
                Stage::Loosen => "loosen",
                Stage::Collapse => "collapse",
                Stage::Anneal => "anneal",
                Stage::Reanneal => "reanneal",
                Stage::Settle => "settle",
            },
            progress: status.progress,
            sweeps: status.sweeps,
            undone: status.undone,
            epsilon: status.epsilon,
            overlap: status.met.overlap,
            dispersion: status.met.dispersion,
            best: Py::new(py, Measures::from(status.best))?,
        })
    }
}

#[pyclass(module = "sono._core")]
struct Collapse(crate::Collapse);

#[pymethods]
impl Collapse {
    #[new]
    fn new(
        py: Python<'_>,
        components: Arrays<'_>,
        loosened: bool,
        settings: &str,
    ) -> PyResult<Self> {
        let curve = curve(components)?;
        let settings = settings_from_json(settings)?;
        released(py, || crate::Collapse::new(&curve, loosened, settings))?
            .map(Self)
            .map_err(to_python)
    }

    fn advance(&mut self, py: Python<'_>, seconds: f64) -> PyResult<Status> {
        let budget = budget(seconds)?;
        let status = released(py, || self.0.advance(budget))?.map_err(to_python)?;
        Status::new(py, &status)
    }

    fn status(&self, py: Python<'_>) -> PyResult<Status> {
        Status::new(py, &released(py, || self.0.status())?)
    }

    fn loosened<'py>(&self, py: Python<'py>) -> PyResult<Option<Vec<Bound<'py, PyArray2<f64>>>>> {
        self.0.loosened().map(|curve| arrays(py, curve)).transpose()
    }

    fn best<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        arrays(py, &released(py, || self.0.best())?)
    }

    fn state(&self, py: Python<'_>) -> PyResult<String> {
        released(py, || serde_json::to_string(&self.0))?
            .map_err(|e| PyValueError::new_err(e.to_string()))
    }

    #[staticmethod]
    fn restore(py: Python<'_>, state: &str) -> PyResult<Self> {
        restored(py, state, crate::Collapse::is_sound).map(Self)
    }
}

#[pyclass(module = "sono._core")]
struct Tightener(crate::Tightener);

#[pymethods]
impl Tightener {
    #[new]
    fn new(
        py: Python<'_>,
        components: Arrays<'_>,
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
        released(py, || begin(&curve, n, settings))?.map(Self).map_err(to_python)
    }

    fn advance(&mut self, py: Python<'_>, seconds: f64) -> PyResult<Status> {
        let budget = budget(seconds)?;
        let status = released(py, || self.0.advance(budget))?;
        Status::new(py, &status)
    }

    fn status(&self, py: Python<'_>) -> PyResult<Status> {
        Status::new(py, &released(py, || self.0.status())?)
    }

    fn best<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        arrays(py, self.0.best())
    }

    fn state(&self, py: Python<'_>) -> PyResult<String> {
        released(py, || serde_json::to_string(&self.0))?
            .map_err(|e| PyValueError::new_err(e.to_string()))
    }

    #[staticmethod]
    fn restore(py: Python<'_>, state: &str) -> PyResult<Self> {
        restored(py, state, crate::Tightener::is_sound).map(Self)
    }
}

#[pyclass(frozen, get_all, module = "sono._core")]
struct PolishStatus {
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

#[pyclass(module = "sono._core")]
struct Polish(crate::Polish);

#[pymethods]
impl Polish {
    #[new]
    fn new(
        py: Python<'_>,
        components: Arrays<'_>,
        n: usize,
        passing: bool,
        seed: u64,
    ) -> PyResult<Self> {
        let curve = curve(components)?;
        released(py, || crate::Polish::new(&curve, n, passing, seed))?.map(Self).map_err(to_python)
    }

    fn advance(&mut self, py: Python<'_>, seconds: f64) -> PyResult<PolishStatus> {
        let budget = budget(seconds)?;
        let status = released(py, || self.0.advance(budget))?;
        PolishStatus::new(py, &status)
    }

    fn status(&self, py: Python<'_>) -> PyResult<PolishStatus> {
        PolishStatus::new(py, &released(py, || self.0.status())?)
    }

    fn best<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        arrays(py, &released(py, || self.0.best())?)
    }

    fn forces<'py>(&self, py: Python<'py>) -> PyResult<ForceArrays<'py>> {
        force_arrays(py, released(py, || self.0.forces())?)
    }

    fn state(&self, py: Python<'_>) -> PyResult<String> {
        released(py, || serde_json::to_string(&self.0))?
            .map_err(|e| PyValueError::new_err(e.to_string()))
    }

    #[staticmethod]
    fn restore(py: Python<'_>, state: &str) -> PyResult<Self> {
        restored(py, state, crate::Polish::is_sound).map(Self)
    }
}

type Array<'py, T> = Bound<'py, PyArray1<T>>;
/// Tension, couple, the contacts' beads and forces, the residual.
type ForceArrays<'py> =
    (Array<'py, f64>, Array<'py, f64>, Bound<'py, PyArray2<i64>>, Array<'py, f64>, f64);

fn force_arrays(py: Python<'_>, forces: Forces) -> PyResult<ForceArrays<'_>> {
    let Forces { tension, couple, contacts, residual } = forces;
    let beads = contacts.iter().flat_map(|c| [c.0 as i64, c.1 as i64]).collect();
    let pressing = contacts.iter().map(|c| c.2).collect();
    Ok((
        PyArray1::from_vec(py, tension),
        PyArray1::from_vec(py, couple),
        PyArray1::from_vec(py, beads).reshape([contacts.len(), 2])?,
        PyArray1::from_vec(py, pressing),
        residual,
    ))
}

/// The forces that come nearest to balance on a curve.
#[pyfunction]
fn balance<'py>(py: Python<'py>, components: Arrays<'py>) -> PyResult<ForceArrays<'py>> {
    let curve = curve(components)?;
    let forces = released(py, || check_embedded(&curve).map(|()| crate::polish::balance(&curve)))?
        .map_err(to_python)?;
    force_arrays(py, forces)
}

/// What was saved by `state`, if it is a state that can go on.
fn restored<T>(py: Python<'_>, state: &str, is_sound: fn(&T) -> bool) -> PyResult<T>
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

fn name_of(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Running => "running",
        Outcome::Tight => "tight",
        Outcome::Stuck => "stuck",
    }
}

fn budget(seconds: f64) -> PyResult<Duration> {
    Duration::try_from_secs_f64(seconds).map_err(|e| PyValueError::new_err(e.to_string()))
}

fn settings_from_json(settings: &str) -> PyResult<Settings> {
    serde_json::from_str(settings).map_err(|e| PyValueError::new_err(format!("settings: {e}")))
}

#[pymodule]
mod _core {
    use super::{Bound, PyAnyMethods, PyModule, PyResult, PyTuple};

    #[pymodule_export]
    use super::{
        Collapse, CurveError, Measures, PanicError, Polish, PolishStatus, Status, Tightener,
        balance, crossings, default_settings, determinant, loosen, measure, refine, simplify,
    };

    /// What an error has that nobody explained further.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let error = module.getattr("CurveError")?;
        error.setattr("places", PyTuple::empty(module.py()))?;
        error.setattr("needed", module.py().None())
    }
}
