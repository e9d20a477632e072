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

/// A point in the middle of a box, or about there.
pub fn middle(a: Point) -> DVec3 {
    DVec3::from(a.map(|x| 0.5 * (x.low() + x.high())))
}

/// The point v + times w.
pub fn shifted(v: DVec3, times: f64, w: DVec3) -> Point {
    let (v, w) = (exactly(v), exactly(w));
    std::array::from_fn(|k| v[k] + Interval::from(times) * w[k])
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
