//! Intervals against exact arithmetic: whole numbers of 2^-1074, in which every double can be counted.
//!
//! Each case has some forty operations, on intervals and on the numbers in them: 4096 make over 100,000.

use num_bigint::{BigInt, Sign};
use proptest::prelude::*;
use sono::certify::interval::Interval;

/// Doubles are counted in 2^-UNIT.
const UNIT: u32 = 1074;

/// A finite double in these units.
fn whole(x: f64) -> BigInt {
    let (bits, exponent) = (x.abs().to_bits(), (x.abs().to_bits() >> 52) as u32);
    let fraction = bits & ((1 << 52) - 1);
    let size = match exponent {
        0 => BigInt::from(fraction),
        _ => BigInt::from(fraction | 1 << 52) << (exponent - 1),
    };
    if x < 0. { -size } else { size }
}

/// Whether an interval has value/scale, in units, the scale being above 0.
fn has(interval: Interval, value: &BigInt, scale: &BigInt) -> bool {
    let (low, high) = (interval.low(), interval.high());
    (low == f64::NEG_INFINITY || &(whole(low) * scale) <= value)
        && (high == f64::INFINITY || &(whole(high) * scale) >= value)
}

/// Whether it has the root of x.
fn has_root(interval: Interval, x: f64) -> bool {
    let (low, high) = (interval.low(), interval.high());
    let square = whole(x) << UNIT;
    low >= 0.
        && whole(low).pow(2) <= square
        && (high == f64::INFINITY || whole(high).pow(2) >= square)
}

/// Whether it is as narrow as one rounding to nearest and a step outward on both sides make it.
fn is_narrow(interval: Interval) -> bool {
    interval.high() <= interval.low().next_up().next_up()
}

/// Any finite number, often one that is hard: at the ends of what there is, or near to 1.
fn number() -> impl Strategy<Value = f64> {
    let least = f64::from_bits(1);
    let hard =
        [0., least, f64::MIN_POSITIVE, 1., f64::MAX, f64::MAX.sqrt(), f64::MIN_POSITIVE.sqrt()];
    let near =
        (prop::sample::select(hard.to_vec()), -3i64..4).prop_map(|(x, steps)| stepped(x, steps));
    let bits = any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |x| x.is_finite());
    let signed = |(x, minus): (f64, bool)| if minus { -x } else { x };
    (prop_oneof![near, bits, 0f64..4.], any::<bool>()).prop_map(signed)
}

/// The number so many steps further up, which stays finite.
fn stepped(x: f64, steps: i64) -> f64 {
    let step = |x: f64, _| if steps > 0 { x.next_up() } else { x.next_down() };
    (0..steps.abs()).fold(x, step).clamp(f64::MIN, f64::MAX)
}

/// Three numbers, and three more that may all but cancel them.
fn numbers() -> impl Strategy<Value = ([f64; 3], [f64; 3])> {
    let cancelling = |(a, minus, steps): ([f64; 3], bool, i64)| {
        let sign = if minus { -1. } else { 1. };
        (a, a.map(|x| stepped(sign * x, steps)))
    };
    let three = || prop::array::uniform3(number());
    prop_oneof![(three(), three()), (three(), any::<bool>(), -3i64..4).prop_map(cancelling),]
}

/// All numbers from the least to the greatest of three.
fn span(x: [f64; 3]) -> Interval {
    x.into_iter().map(Interval::from).reduce(Interval::hull).unwrap()
}

/// Checks what two intervals make, for two numbers in them.
fn check_two(a: Interval, b: Interval, x: f64, y: f64) -> Result<(), TestCaseError> {
    let (whole_x, whole_y) = (whole(x), whole(y));
    let one = BigInt::from(1);
    let unit = &one << UNIT;
    prop_assert!(has(a + b, &(&whole_x + &whole_y), &one), "{a:?} + {b:?}");
    prop_assert!(has(a - b, &(&whole_x - &whole_y), &one), "{a:?} - {b:?}");
    prop_assert!(has(a * b, &(&whole_x * &whole_y), &unit), "{a:?} * {b:?}");
    prop_assert!(!a.is_above(b) || x > y);
    prop_assert!(has(a.min(b), &(&whole_x).min(&whole_y).clone(), &one));
    prop_assert!(has(a.max(b), &(&whole_x).max(&whole_y).clone(), &one));
    if y != 0. {
        let signed = if whole_y.sign() == Sign::Minus { -whole_x } else { whole_x };
        let size = BigInt::from(whole_y.magnitude().clone());
        prop_assert!(has(a / b, &(signed << UNIT), &size), "{a:?} / {b:?}");
    }
    Ok(())
}

/// Checks what an interval makes, for a number in it.
fn check_one(a: Interval, x: f64) -> Result<(), TestCaseError> {
    let unit = BigInt::from(1) << UNIT;
    prop_assert!(a.contains(x));
    prop_assert!(has(a.squared(), &whole(x).pow(2), &unit), "{a:?} squared");
    prop_assert!(a.squared().low() >= 0.);
    prop_assert!(a.abs().contains(x.abs()) && a.abs().low() >= 0.);
    prop_assert!(x < 0. || has_root(a.sqrt(), x), "root of {a:?}");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4096))]

    #[test]
    fn no_operation_loses_what_is_exact((a, b) in numbers()) {
        for x in a {
            check_one(span(a), x)?;
            check_one(x.into(), x)?;
            for y in b {
                check_two(span(a), span(b), x, y)?;
                check_two(x.into(), y.into(), x, y)?;
            }
        }
    }

    #[test]
    fn single_numbers_make_narrow_intervals(x in number(), y in number()) {
        let (a, b) = (Interval::from(x), Interval::from(y));
        for made in [a + b, a - b, a * b, a.squared(), a.sqrt()] {
            prop_assert!(is_narrow(made), "{made:?}");
        }
        prop_assert!(y == 0. || is_narrow(a / b));
    }

    #[test]
    fn nothing_is_lost_beyond_what_is_finite((a, b) in numbers()) {
        // Squares of large numbers have an infinite end, and those of what is below it, and so on.
        let (a, b) = (span(a).squared(), span(b).squared());
        for made in [a + b, a - b, a * b, a / b, (a - b) * (b - a), (a * b).sqrt(), (a / b) / (b / a)] {
            prop_assert!(made.low() <= made.high(), "{made:?}");
            prop_assert!(made.low() < f64::INFINITY && made.high() > f64::NEG_INFINITY);
        }
    }
}

#[test]
fn pi_is_between_doubles() {
    // 3.14159265358979323846 lies between, counted in 1e-20.
    let pi = BigInt::from(314_159_265_358_979_323_846u128);
    let scale = BigInt::from(100_000_000_000_000_000_000u128);
    assert!(has(Interval::PI, &(&pi << UNIT), &scale));
    assert!(has(Interval::PI, &((&pi + 1) << UNIT), &scale));
    assert!(is_narrow(Interval::PI));
}

#[test]
fn what_may_divide_by_zero_has_no_bound() {
    let nothing_known = Interval::new(f64::NEG_INFINITY, f64::INFINITY);
    let (one, zero) = (Interval::from(1.), Interval::from(0.));
    assert_eq!(one / zero, nothing_known);
    assert_eq!(one / Interval::from(-0.), nothing_known);
    assert_eq!(one / Interval::new(-1., 1.), nothing_known);
    for end in [0., -0.] {
        let half_line = one / Interval::new(end, 2.);
        assert!(is_near(half_line.low(), 0.5) && half_line.high() == f64::INFINITY);
        let half_line = one / Interval::new(-2., end);
        assert!(is_near(half_line.high(), -0.5) && half_line.low() == f64::NEG_INFINITY);
    }
    assert_eq!(zero * nothing_known, nothing_known);
    let unbounded = Interval::new(1., f64::INFINITY);
    assert!((unbounded / unbounded).contains(1e300) && (unbounded / unbounded).contains(1e-300));
}

fn is_near(x: f64, y: f64) -> bool {
    (x - y).abs() < 1e-15
}

#[test]
fn above_is_above_for_all() {
    let (low, high) = (Interval::new(0., 1.), Interval::new(1., 2.));
    assert!(!high.is_above(low) && !low.is_above(high) && !high.is_above(high));
    assert!(Interval::new(1.5, 2.).is_above(low) && !Interval::new(0.5, 2.).is_above(low));
}
