//! Curves in space: what they are, what comes close to what, and how they move without crossing
//! themselves. Imports nothing but `error`.
//!
//! `curve, segments, grid, boxes <- separation <- neighbours, embedded, sticks <- inscribed`.

mod boxes;
pub mod curve;
pub mod embedded;
mod grid;
pub mod inscribed;
pub mod neighbours;
pub mod segments;
pub mod separation;
pub mod sticks;
