//! The core of sono: tight knots on the bead rope.
//!
//! **Curve -> measures** is one road, **curve -> loose curve -> rope -> sweeps of SONO -> Newton steps of
//! the polish -> tight curve** the other. Dependencies point one way only:
//! `error, segments, curve <- neighbours, sticks <- measures, projection <- inscribed, embedded, procedures,
//! passage <- rope, loosen <- tighten <- collapse, polish <- python`; `modular` stands alone.

pub mod collapse;
pub mod curve;
pub mod embedded;
pub mod error;
pub mod inscribed;
pub mod loosen;
pub mod measures;
pub mod modular;
pub mod neighbours;
pub mod passage;
pub mod polish;
pub mod procedures;
pub mod projection;
#[cfg(feature = "python")]
mod python;
pub mod rope;
pub mod segments;
pub mod settings;
pub mod sticks;
pub mod tighten;

pub use collapse::Collapse;
pub use curve::Curve;
pub use embedded::check_embedded;
pub use error::{Error, Result};
pub use inscribed::refine;
pub use loosen::{Loosening, loosened, simplified};
pub use measures::{Measures, measure};
pub use polish::Polish;
pub use settings::Settings;
pub use tighten::{Outcome, Stage, Status, Tightener};
