//! Distances of straight segments, each given by its two ends.

use glam::DVec3;

/// Distance of two segments: between inner points if those are closest, else from an end.
pub fn distance(a: [DVec3; 2], b: [DVec3; 2]) -> f64 {
    let (u, v, w) = (a[1] - a[0], b[1] - b[0], a[0] - b[0]);
    let normal = u.cross(v);
    let squared = normal.length_squared();
    if squared > 0. {
        let s = v.cross(w).dot(normal) / squared;
        let t = u.cross(w).dot(normal) / squared;
        if (0. ..=1.).contains(&s) && (0. ..=1.).contains(&t) {
            return w.dot(normal).abs() / squared.sqrt();
        }
    }
    let from_a = to_point(b, a[0]).min(to_point(b, a[1]));
    from_a.min(to_point(a, b[0])).min(to_point(a, b[1]))
}

/// Distance of a segment to a point.
pub fn to_point(segment: [DVec3; 2], point: DVec3) -> f64 {
    let along = segment[1] - segment[0];
    let t = (point - segment[0]).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
    point.distance(segment[0] + t.clamp(0., 1.) * along)
}
