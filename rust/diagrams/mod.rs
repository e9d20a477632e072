//! Diagrams of knots and links as plane graphs, the moves that keep their types, and what is computed
//! from them. Imports nothing.
//!
//! `diagram <- gauss, faces <- passes, flypes, sums, canonical <- exploring, homfly`.

pub mod canonical;
pub mod diagram;
pub mod exploring;
mod faces;
mod flypes;
pub mod gauss;
pub mod homfly;
mod passes;
pub mod polynomial;
pub mod sums;

pub use diagram::Diagram;
