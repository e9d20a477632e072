//! SONO: sweeps of three procedures on a bead rope, and the stages they make up.
//! Imports `beads`, `passage`, `resample`, `loosening` and what these import; nothing of `polish`.
//!
//! `settings, stage, best, procedures <- rope <- tighten <- begin <- collapse`.

mod begin;
mod best;
pub mod collapse;
pub mod procedures;
pub mod rope;
pub mod settings;
pub mod stage;
pub mod tighten;
