//! Curves for the tests, and the measures computed the slow way.

// Each test file is a crate of its own and uses a part of this.
#![allow(dead_code)]

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use sono::{Curve, Outcome, Settings, Tightener};

/// A torus knot T(p, q) on `n` vertices, its edges not equal.
pub fn torus(p: f64, q: f64, n: usize) -> Curve {
    let vertex = |i: usize| {
        let t = TAU * i as f64 / n as f64;
        let r = 2. + 0.8 * (q * t).cos();
        DVec3::new(r * (p * t).cos(), r * (p * t).sin(), 0.8 * (q * t).sin())
    };
    Curve::new(vec![(0..n).map(vertex).collect()]).unwrap()
}

/// A regular polygon of circumradius 1 in a plane spanned by `x` and `y`.
pub fn polygon(n: usize, x: DVec3, y: DVec3, centre: DVec3) -> Vec<DVec3> {
    let vertex = |i: usize| {
        let t = TAU * i as f64 / n as f64;
        centre + t.cos() * x + t.sin() * y
    };
    (0..n).map(vertex).collect()
}

/// The Hopf link of two regular polygons whose smooth limit is the tight one of radius R = 1/2.
pub fn hopf(n: usize) -> Curve {
    Curve::new(vec![
        polygon(n, DVec3::X, DVec3::Y, DVec3::ZERO),
        polygon(n, DVec3::X, DVec3::Z, DVec3::X),
    ])
    .unwrap()
}

/// The radius of the inscribed arc and the longest edge of each component: MinRad and S.
pub fn bends(curve: &Curve) -> Vec<(f64, f64)> {
    let bend = |c: usize| {
        let edges: Vec<_> = curve.edge_lengths(c).collect();
        let rad = |(i, angle): (usize, f64)| {
            let before = edges[(i + edges.len() - 1) % edges.len()];
            0.5 * before.min(edges[i]) / (0.5 * angle).tan()
        };
        let min_rad = curve.turning_angles(c).enumerate().map(rad).fold(f64::INFINITY, f64::min);
        (min_rad, edges.iter().copied().fold(0., f64::max))
    };
    (0..curve.components()).map(bend).collect()
}

/// SR over all pairs of vertices, by the definition.
pub fn brute_force_sr(curve: &Curve) -> f64 {
    let bends = bends(curve);
    let mut closest = f64::INFINITY;
    for i in 0..curve.n() {
        for j in 0..i {
            let (min_rad, longest) = bends[curve.component_of(i)];
            let far = match arclength_between(curve, j, i) {
                Some(along) => along >= PI * min_rad - longest,
                None => true,
            };
            if far {
                closest = closest.min(curve.vertices()[i].distance(curve.vertices()[j]));
            }
        }
    }
    0.5 * closest
}

/// Arclength between vertices `j` < `i`, the shorter way; `None` between components.
fn arclength_between(curve: &Curve, j: usize, i: usize) -> Option<f64> {
    let c = curve.component_of(i);
    let start = curve.range(c).start;
    (c == curve.component_of(j)).then(|| {
        let forth: f64 = curve.edge_lengths(c).skip(j - start).take(i - j).sum();
        forth.min(curve.component_length(c) - forth)
    })
}

/// The linking number of the first two components: the solid angles of all pairs of edges.
pub fn linking(curve: &Curve) -> f64 {
    let edges = |c: usize| {
        let v = curve.component(c);
        (0..v.len()).map(|i| [v[i], v[(i + 1) % v.len()]]).collect::<Vec<_>>()
    };
    let angle = |[a, b]: [DVec3; 2], [c, d]: [DVec3; 2]| {
        let sides = [c - a, d - a, d - b, c - b];
        let n: [_; 4] =
            std::array::from_fn(|k| sides[k].cross(sides[(k + 1) % 4]).normalize_or_zero());
        let open = |k: usize| n[k].dot(n[(k + 1) % 4]).clamp(-1., 1.).asin();
        (0..4).map(open).sum::<f64>() * (d - c).cross(b - a).dot(c - a).signum()
    };
    let others = edges(1);
    edges(0).iter().flat_map(|&e| others.iter().map(move |&f| angle(e, f))).sum::<f64>()
        / (2. * TAU)
}

/// Runs a tightener to its end.
pub fn finish(mut tightener: Tightener) -> Tightener {
    while tightener.step() == Outcome::Running {}
    tightener
}

/// Settings that end soon.
pub fn quick() -> Settings {
    Settings { anneal_sweeps: 10_000, settle_sweeps: 100, ..Default::default() }
}
