//! Curves in space: what they are, what comes close to what, and how they move without crossing
//! themselves. Imports nothing but `error`.
//!
//! `curve, segments <- neighbours, boxes <- embedded, sticks <- inscribed`.

pub mod curve;
pub mod embedded;
pub mod inscribed;
pub mod neighbours;
pub mod segments;
pub mod sticks;
