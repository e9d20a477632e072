//! What the type of a knot is told by: the crossings of a projection, and determinants.
//! Imports nothing but `geometry`.

pub mod modular;
pub mod projection;
