//! The parameters of SONO.

use serde::{Deserialize, Serialize};

use crate::error::{Result, within};

/// Parameters of SONO; lengths in units of the rope's radius. Unknown names are refused.
///
/// ```
/// let settings: sono::Settings = serde_json::from_str(r#"{"seed": 7}"#)?;
/// assert_eq!(settings, sono::Settings { seed: 7, ..Default::default() });
/// assert!(serde_json::from_str::<sono::Settings>(r#"{"sede": 7}"#).is_err());
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// EE's share of a correction, in (0, 1/2].
    pub c_1: f64,
    /// RO's share of a correction, in (0, 1/2].
    pub c_2: f64,
    /// Violation tolerated at the start of the anneal, in (0, 1/2]; epsilon is half the tolerance.
    pub anneal_tolerance: f64,
    /// Largest dispersion and overlap at the end, in [1e-12, 1e-2].
    pub tolerance: f64,
    /// Sweeps of the anneal.
    pub anneal_sweeps: u32,
    /// Sweeps of the settling, per vertex.
    pub settle_sweeps: u32,
    /// Seed of the small random displacement before the anneal.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            c_1: 0.5,
            c_2: 0.5,
            anneal_tolerance: 0.3,
            tolerance: 1e-6,
            anneal_sweeps: 200_000,
            settle_sweeps: 400,
            seed: 0,
        }
    }
}

impl Settings {
    /// # Errors
    /// [`crate::Error::Setting`] names the first parameter that is out of range.
    pub fn check(&self) -> Result<()> {
        let (half, range) = (f64::MIN_POSITIVE..=0.5, "in (0, 0.5]");
        within("c_1", self.c_1, half.clone(), range)?;
        within("c_2", self.c_2, half.clone(), range)?;
        within("anneal_tolerance", self.anneal_tolerance, half, range)?;
        within("tolerance", self.tolerance, 1e-12..=1e-2, "in [1e-12, 1e-2]")?;
        within("anneal_sweeps", self.anneal_sweeps.into(), 1.0..=f64::MAX, "at least 1")?;
        within("settle_sweeps", self.settle_sweeps.into(), 1.0..=f64::MAX, "at least 1")
    }
}
