//! The Python module `sono._core`: arrays in, arrays out, the interpreter released while Rust works.
//! No logic; the only folder that names pyo3.

mod about;
mod certify;
mod collapse;
mod curve;
mod diagrams;
mod dict;
mod engine;
mod errors;
mod forces;
mod invariants;
mod measures;
mod polish;
mod tightener;

use pyo3::prelude::*;

#[pymodule]
mod _core {
    use pyo3::prelude::*;
    use pyo3::types::PyTuple;

    #[pymodule_export]
    use super::about::about;
    #[pymodule_export]
    use super::certify::certify;
    #[pymodule_export]
    use super::collapse::Collapse;
    #[pymodule_export]
    use super::curve::{loosen, refine, simplify};
    #[pymodule_export]
    use super::diagrams::{homfly, meeting, pieces, shortened};
    #[pymodule_export]
    use super::engine::{default_polish_settings, default_settings};
    #[pymodule_export]
    use super::errors::{CurveError, PanicError};
    #[pymodule_export]
    use super::forces::balance;
    #[pymodule_export]
    use super::invariants::{crossings, determinant};
    #[pymodule_export]
    use super::measures::{measure, writhe};
    #[pymodule_export]
    use super::polish::Polish;
    #[pymodule_export]
    use super::tightener::Tightener;

    /// What an error has that nobody explained further.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let error = module.getattr("CurveError")?;
        error.setattr("places", PyTuple::empty(module.py()))?;
        error.setattr("needed", module.py().None())
    }
}
