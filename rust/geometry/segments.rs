//! Distances of straight segments, each given by its two ends.

use glam::DVec3;

/// Squared sine of the angle below which segments count as parallel.
const PARALLEL: f64 = 1e-12;

/// Distance of two segments: between inner points if those are closest, else from an end.
pub fn distance(a: [DVec3; 2], b: [DVec3; 2]) -> f64 {
    let (u, v, w) = (a[1] - a[0], b[1] - b[0], a[0] - b[0]);
    let normal = u.cross(v);
    let squared = normal.length_squared();
    let mut inner = f64::INFINITY;
    if squared > 0. {
        let s = v.cross(w).dot(normal) / squared;
        let t = u.cross(w).dot(normal) / squared;
        if (0. ..=1.).contains(&s) && (0. ..=1.).contains(&t) {
            // Where rounding makes these points any points, their distance still bounds the least.
            inner = (w + s * u - t * v).length();
            if squared > PARALLEL * u.length_squared() * v.length_squared() {
                return inner;
            }
        }
    }
    let from_a = to_point(b, a[0]).min(to_point(b, a[1]));
    inner.min(from_a).min(to_point(a, b[0])).min(to_point(a, b[1]))
}

/// Where two segments come closest: how far along each, from 0 to 1.
pub fn closest(a: [DVec3; 2], b: [DVec3; 2]) -> [f64; 2] {
    let (u, v, w) = (a[1] - a[0], b[1] - b[0], a[0] - b[0]);
    let (uu, uv, vv) = (u.length_squared(), u.dot(v), v.length_squared());
    let (uw, vw) = (u.dot(w), v.dot(w));
    let squared = uu * vv - uv * uv;
    let s = if squared > PARALLEL * uu * vv {
        ((uv * vw - vv * uw) / squared).clamp(0., 1.)
    } else {
        0.
    };
    // The nearest point of b to that of a, and if it lies beyond an end, of a to this end.
    let t = ((uv * s + vw) / vv.max(f64::MIN_POSITIVE)).clamp(0., 1.);
    [((uv * t - uw) / uu.max(f64::MIN_POSITIVE)).clamp(0., 1.), t]
}

/// Distance of a segment to a point.
pub fn to_point(segment: [DVec3; 2], point: DVec3) -> f64 {
    let along = segment[1] - segment[0];
    let t = (point - segment[0]).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
    point.distance(segment[0] + t.clamp(0., 1.) * along)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ends of pieces of the line through (0, 1/3, 0) along (1, 1/7, 1/3).
    fn piece(from: f64, to: f64) -> [DVec3; 2] {
        [from, to].map(|t| DVec3::new(0., 1. / 3., 0.) + t * DVec3::new(1., 1. / 7., 1. / 3.))
    }

    #[test]
    fn crossing_segments_meet() {
        let above = [DVec3::new(0.5, -1., 0.25), DVec3::new(0.5, 1., 0.25)];
        assert_eq!(distance([DVec3::ZERO, DVec3::X], above), 0.25);
        let touching = [DVec3::new(0.5, -1., 0.), DVec3::new(0.5, 1., 0.)];
        assert_eq!(distance([DVec3::ZERO, DVec3::X], touching), 0.);
    }

    #[test]
    fn pieces_of_one_line_are_as_far_apart_as_their_ends() {
        for k in 1..1000 {
            let gap = 0.001 * f64::from(k);
            let (a, b) = (piece(0., 0.37), piece(0.37 + gap, 0.9 + gap));
            let expected = a[1].distance(b[0]);
            assert!((distance(a, b) - expected).abs() < 1e-12, "{gap}");
        }
    }

    #[test]
    fn segments_that_cross_at_a_small_angle_meet() {
        for exponent in 1..15 {
            let tilt = 10f64.powi(-exponent);
            let a = [DVec3::new(-1., -tilt, 0.), DVec3::new(1., tilt, 0.)];
            let b = [DVec3::new(-1., tilt, 0.), DVec3::new(1., -tilt, 0.)];
            assert!(distance(a, b) < 1e-14, "{tilt}");
        }
    }
}
