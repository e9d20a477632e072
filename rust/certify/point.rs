//! Points in space of which each coordinate is known to lie in an interval: boxes.

use glam::DVec3;

use crate::certify::interval::Interval;

/// A point somewhere in a box.
pub type Point = [Interval; 3];

/// The point itself.
pub fn exactly(v: DVec3) -> Point {
    v.to_array().map(Interval::from)
}

/// The vector from `a` to `b`.
#[inline]
pub fn from_to(a: Point, b: Point) -> Point {
    std::array::from_fn(|k| b[k] - a[k])
}

/// The box round two boxes.
pub fn hull(a: Point, b: Point) -> Point {
    std::array::from_fn(|k| a[k].hull(b[k]))
}

/// The scalar product.
pub fn dot(a: Point, b: Point) -> Interval {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
pub fn cross(a: Point, b: Point) -> Point {
    std::array::from_fn(|k| {
        let (l, m) = ((k + 1) % 3, (k + 2) % 3);
        a[l] * b[m] - a[m] * b[l]
    })
}

/// The length of a vector, squared.
#[inline]
pub fn squared(a: Point) -> Interval {
    a[0].squared() + a[1].squared() + a[2].squared()
}

/// The length of a vector.
pub fn length(a: Point) -> Interval {
    squared(a).sqrt()
}
