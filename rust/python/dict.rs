//! Dicts of plain values. Each list of keys is written once, here in Rust; `_core.pyi` types it.

use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A dict that goes to Python.
pub type Dict<'py> = Bound<'py, PyDict>;

/// A dict of keys: those of a struct's fields have their values, others what they are said to be.
macro_rules! dict {
    (@value $from:ident $key:ident) => { $from.$key };
    (@value $from:ident $key:ident $value:expr) => { $value };
    ($py:ident, $from:ident: $($key:ident $(= $value:expr)?),* $(,)?) => {{
        let dict = pyo3::types::PyDict::new($py);
        $(dict.set_item(stringify!($key), dict!(@value $from $key $($value)?))?;)*
        dict
    }};
}

pub(super) use dict;
