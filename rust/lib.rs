//! The core of sono: tight knots on the bead rope.
//!
//! **Curve -> measures** is one road, **curve -> loose curve -> rope -> sweeps of SONO -> Newton steps of
//! the polish -> tight curve** the other. The radius of a rope is R = 1, and ropelength is length over
//! radius. Dependencies point one way only:
//! `error <- geometry <- measures, writhe, certify, invariants, beads, outcome, passage <- resample, loosening <- sono, polish <- python`.
//! `sono` and `polish` do not know each other; only `python` knows of Python. `diagrams` of knots know of
//! no curves.

pub mod beads;
pub mod certify;
pub mod diagrams;
pub mod error;
pub mod geometry;
pub mod invariants;
pub mod loosening;
pub mod measures;
pub mod outcome;
pub mod passage;
pub mod polish;
#[cfg(feature = "python")]
mod python;
pub mod resample;
pub mod sono;
pub mod writhe;

pub use certify::bound::{Bound, certify};
pub use error::{Error, Result};
pub use geometry::curve::Curve;
pub use geometry::embedded::check_embedded;
pub use loosening::{Loosening, loosened, simplified};
pub use measures::{Measures, measure};
pub use outcome::Outcome;
pub use polish::Polish;
pub use resample::refine;
pub use sono::collapse::Collapse;
pub use sono::settings::Settings;
pub use sono::stage::Stage;
pub use sono::tighten::{Status, Tightener};
pub use writhe::{Writhe, writhe};
