//! Numbers that are known to lie between two others: (C10) of `docs/explanation/theorem.md`.
//!
//! The compiler moves arithmetic across a switch of the processor's rounding mode, so every operation
//! rounds to nearest and then steps outward by one representable number. What is rounded to nearest
//! lies within half a step of what is exact, also where it is subnormal, so an end is always beyond
//! the exact one, by half a step at least; and where it overflows to infinity, the largest finite
//! number is below.
//!
//! ```
//! use sono::certify::interval::Interval;
//! let third = Interval::from(1.) / Interval::from(3.);
//! assert!(third.low() < 1. / 3. && 1. / 3. < third.high());
//! assert!((third * Interval::from(3.)).contains(1.));
//! ```

use std::ops::{Add, Div, Mul, Sub};

/// All real numbers from `low` to `high`; an infinite end says that there is no bound on that side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    low: f64,
    high: f64,
}

impl From<f64> for Interval {
    /// The one number `x`, exactly.
    fn from(x: f64) -> Self {
        Self::new(x, x)
    }
}

impl Interval {
    /// Pi, which is a little above the double next to it.
    pub const PI: Self = Self { low: std::f64::consts::PI, high: std::f64::consts::PI.next_up() };

    /// All numbers from `low` to `high`. NaN, which infinite ends may lead to, is no bound.
    #[inline]
    pub fn new(low: f64, high: f64) -> Self {
        Self {
            low: if low.is_nan() { f64::NEG_INFINITY } else { low },
            high: if high.is_nan() { f64::INFINITY } else { high },
        }
    }

    /// What was rounded to nearest, one step further out on both sides.
    #[inline]
    fn outward(low: f64, high: f64) -> Self {
        Self::new(low.next_down(), high.next_up())
    }

    /// At most the number.
    #[inline]
    pub fn low(self) -> f64 {
        self.low
    }

    /// At least the number.
    #[inline]
    pub fn high(self) -> f64 {
        self.high
    }

    /// Whether `x` is one of the numbers.
    pub fn contains(self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// Whether this number is above the other one, whatever they are.
    #[inline]
    pub fn is_above(self, other: Self) -> bool {
        self.low > other.high
    }

    /// The smaller of two numbers.
    #[inline]
    pub fn min(self, other: Self) -> Self {
        Self::new(self.low.min(other.low), self.high.min(other.high))
    }

    /// The larger of two numbers.
    #[inline]
    pub fn max(self, other: Self) -> Self {
        Self::new(self.low.max(other.low), self.high.max(other.high))
    }

    /// All numbers of either interval, and those between.
    #[inline]
    pub fn hull(self, other: Self) -> Self {
        Self::new(self.low.min(other.low), self.high.max(other.high))
    }

    /// The distance from 0, exactly.
    #[inline]
    pub fn abs(self) -> Self {
        Self::new(self.low.max(-self.high).max(0.), self.high.max(-self.low))
    }

    /// The square, which is never negative.
    #[inline]
    pub fn squared(self) -> Self {
        let Self { low, high } = self.abs();
        let square = Self::outward(low * low, high * high);
        Self::new(square.low.max(0.), square.high)
    }

    /// The square root of what is not negative.
    #[inline]
    pub fn sqrt(self) -> Self {
        let root = Self::outward(self.low.max(0.).sqrt(), self.high.max(0.).sqrt());
        Self::new(root.low.max(0.), root.high)
    }
}

impl Add for Interval {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self::outward(self.low + other.low, self.high + other.high)
    }
}

impl Sub for Interval {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::outward(self.low - other.high, self.high - other.low)
    }
}

impl Mul for Interval {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let (low, high) = extremes([
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ]);
        Self::outward(low, high)
    }
}

impl Div for Interval {
    type Output = Self;

    /// The quotient; there is no bound on it where numbers near 0 divide.
    #[inline]
    fn div(self, other: Self) -> Self {
        if other.contains(0.) && (other.low < 0.) == (other.high > 0.) {
            return Self::new(f64::NEG_INFINITY, f64::INFINITY);
        }
        // An end that is 0 gets the sign of what is next to it, and so do the quotients.
        let start = if other.low == 0. { 0. } else { other.low };
        let end = if other.high == 0. { -0. } else { other.high };
        let (low, high) =
            extremes([self.low / start, self.low / end, self.high / start, self.high / end]);
        Self::outward(low, high)
    }
}

/// The least and the largest of four. NaN is 0 times infinity or a quotient of infinities, which stand
/// for unbounded numbers: the others, one of which is finite, reach all that these do.
#[inline]
fn extremes([a, b, c, d]: [f64; 4]) -> (f64, f64) {
    (a.min(b).min(c).min(d), a.max(b).max(c).max(d))
}
