//! The stages of a tightening, in their order.

use serde::{Deserialize, Serialize};

/// Which part of the tightening a [`crate::Tightener`] does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// From any embedded curve to one that holds a thick rope: [`crate::Loosening`].
    Loosen,
    /// From a loose to a jammed rope.
    Collapse,
    /// Lowers the tolerance from large to small.
    Anneal,
    /// The same on a refined rope, from a smaller tolerance on.
    Reanneal,
    /// Ends with dispersion and overlaps below the final tolerance.
    Settle,
}
