//! Whether an engine is done.

use serde::{Deserialize, Serialize};

/// Whether an engine is done. Not getting there is no error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Go on.
    Running,
    /// It has done what it is for.
    Tight,
    /// The final tolerance is out of reach; the best state so far is all there is.
    Stuck,
}
