//! A bound on the ropelength of a polygon's type that is proven: no rounding can make it too small.
//!
//! `docs/explanation/theorem.md` has the theorem and its proof, [`bound`] computes it, in intervals: every number is
//! kept between two that are rounded outward. Imports nothing but `error` and `geometry`'s curves.
//!
//! `interval <- point <- pairs <- bound`.

pub mod bound;
pub mod interval;
pub mod pairs;
pub mod point;
