//! The measures against closed forms, against brute force, and under motions of the curve.

mod common;

use std::f64::consts::{PI, TAU};

use approx::assert_relative_eq;
use common::{bends, brute_force_sr, hopf, polygon, torus};
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use sono::{Curve, check_embedded, measure};

#[test]
fn regular_polygons_measure_what_closed_forms_say() {
    for n in [5, 6, 7, 12, 101, 480] {
        let x = PI / n as f64;
        let curve = Curve::new(vec![polygon(n, DVec3::X, DVec3::Y, DVec3::ZERO)]).unwrap();
        let m = measure(&curve);
        let dl = 2. * x.sin();
        assert_relative_eq!(m.dl, dl, max_relative = 1e-13);
        // Rounding turns an edge by about 1e-15/dl, and that is compared with an angle of about dl.
        let digits = 1e-14 / (dl * dl);
        assert_relative_eq!(m.min_rad, x.cos(), max_relative = digits);
        // Pairs from ceil(pi MinRad/dl - 1) edges on count.
        let least = (PI * x.cos() / dl - 1.).ceil();
        let sr = (least * x).sin();
        assert_relative_eq!(m.sr, sr, max_relative = 1e-13);
        let r_s = sr.min(1.);
        assert_relative_eq!(m.r_s, r_s, max_relative = 1e-13);
        assert_relative_eq!(m.inscribed_length, TAU * x.cos(), max_relative = digits);
        assert_relative_eq!(m.l_p, n as f64 * dl / r_s, max_relative = 1e-12);
        if r_s > dl / 2f64.sqrt() {
            let l_c = TAU * x.cos() / (r_s * r_s - 0.25 * dl * dl).sqrt();
            assert_relative_eq!(m.l_c.unwrap(), l_c, max_relative = digits);
            assert_relative_eq!(m.l_a.unwrap(), (4. * m.l_p + l_c) / 5., max_relative = 1e-14);
        } else {
            assert_eq!((m.r_c, m.l_c, m.l_a), (None, None, None));
        }
    }
}

#[test]
fn the_hopf_link_of_circles_tends_to_eight_pi() {
    for n in [60, 120, 960] {
        let m = measure(&hopf(n));
        // A vertex of each polygon lies in the centre of the other: all distances there are 1.
        assert_relative_eq!(m.sr, 0.5, max_relative = 1e-12);
        assert_relative_eq!(m.r_s, 0.5, max_relative = 1e-12);
        let x = PI / n as f64;
        assert_relative_eq!(m.l_p, 8. * n as f64 * x.sin(), max_relative = 1e-12);
        assert!(m.l_p < 8. * PI && m.l_c.unwrap() > 8. * PI);
    }
}

#[test]
fn thickness_is_that_of_the_closest_strands() {
    let m = measure(&torus(2., 3., 3000));
    assert_relative_eq!(m.sr, 0.8, max_relative = 1e-3);
    assert!(m.min_rad > 1.);
}

#[test]
fn a_hundred_thousand_vertices_are_measured_like_a_thousand() {
    let (few, many) = (measure(&torus(2., 3., 1000)), measure(&torus(2., 3., 100_000)));
    assert_relative_eq!(few.l_p, many.l_p, max_relative = 1e-3);
    assert_relative_eq!(many.l_p, many.l_c.unwrap(), max_relative = 1e-6);
}

#[test]
fn a_fold_has_no_thickness_and_no_bound() {
    let fold = [[0., 0., 0.], [1., 0., 0.], [2., 0., 1e-9], [1., 1e-9, 0.]].map(DVec3::from);
    let m = measure(&Curve::new(vec![fold.to_vec()]).unwrap());
    assert!(m.r_s < 1e-8 && m.l_c.is_none());
}

#[test]
fn components_that_share_a_vertex_have_no_thickness() {
    let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y].to_vec();
    let touching = vec![triangle.clone(), triangle.iter().map(|v| -v).collect()];
    assert_eq!(measure(&Curve::new(touching).unwrap()).sr, 0.);
}

/// A closed random walk of unequal steps, perhaps with a second component.
fn random_curve() -> impl Strategy<Value = Curve> {
    let component = (4usize..80).prop_flat_map(|n| {
        prop::collection::vec(prop::array::uniform3(-1f64..1.), n).prop_map(|steps| {
            let steps: Vec<_> = steps.into_iter().map(DVec3::from).collect();
            let drift = steps.iter().sum::<DVec3>() / steps.len() as f64;
            let walk = steps.iter().scan(DVec3::ZERO, |at, step| {
                *at += 0.5 * (*step - drift);
                Some(*at)
            });
            walk.collect::<Vec<_>>()
        })
    });
    prop::collection::vec(component, 1..3)
        .prop_filter_map("degenerate", |components| Curve::new(components).ok())
}

/// A smooth closed curve: a few random harmonics, unequally spaced.
fn smooth_curve() -> impl Strategy<Value = Curve> {
    let harmonics = prop::collection::vec(prop::array::uniform6(-1f64..1.), 3);
    (harmonics, 20usize..200, 0f64..0.5).prop_filter_map("degenerate", |(harmonics, n, uneven)| {
        let vertex = |i: usize| {
            let t = TAU * i as f64 / n as f64;
            let t = t + uneven * t.sin();
            let term = |(k, h): (usize, &[f64; 6])| {
                let (sin, cos) = (t * (k + 1) as f64).sin_cos();
                (DVec3::new(h[0], h[1], h[2]) * sin + DVec3::new(h[3], h[4], h[5]) * cos)
                    / (k + 1) as f64
            };
            harmonics.iter().enumerate().map(term).sum()
        };
        Curve::new(vec![(0..n).map(vertex).collect()]).ok()
    })
}

fn assert_same(a: &Curve, b: &Curve, scale: f64) {
    let (a, b) = (measure(a), measure(b));
    let pairs = [
        (a.dl * scale, b.dl),
        (a.min_rad * scale, b.min_rad),
        (a.sr * scale, b.sr),
        (a.r_s * scale, b.r_s),
        (a.l_p, b.l_p),
        (a.l_c.unwrap_or(0.), b.l_c.unwrap_or(0.)),
    ];
    for (a, b) in pairs {
        assert_relative_eq!(a, b, max_relative = 1e-9);
    }
}

fn rebuilt(curve: &Curve, change: impl Fn(&mut Vec<DVec3>)) -> Curve {
    let components = (0..curve.components()).map(|c| {
        let mut component = curve.component(c).to_vec();
        change(&mut component);
        component
    });
    Curve::new(components.collect()).unwrap()
}

proptest! {
    #[test]
    fn sr_agrees_with_brute_force(curve in prop_oneof![random_curve(), smooth_curve()]) {
        prop_assert_eq!(measure(&curve).sr, brute_force_sr(&curve));
    }

    #[test]
    fn l_c_bounds_the_inscribed_curve(curve in smooth_curve()) {
        // R_c is a thickness of K_P: so it is below its least radius of curvature, and K_P sampled
        // finely has no doubly critical chord shorter than 2 R_c.
        let m = measure(&curve);
        if let Some(r_c) = m.r_c {
            prop_assert!(r_c <= m.min_rad * (1. + 1e-12));
            let fine = sono::geometry::inscribed::Inscribed::new(&curve);
            let lengths: Vec<_> = fine.lengths().collect();
            prop_assert!((lengths.iter().sum::<f64>() - m.inscribed_length).abs() < 1e-9 * m.length);
            let (fine, _) = fine.sample(&[1500], 0.);
            let found = measure(&fine);
            prop_assert!(found.r_s >= r_c * (1. - 1e-2), "{} < {}", found.r_s, r_c);
        }
    }

    #[test]
    fn equal_edges_give_the_papers_index_rule(n in 60usize..150, q in 1usize..4) {
        let curve = sono::refine(&torus(2., (2 * q + 1) as f64, 400), n, 0.).unwrap();
        let (min_rad, dl) = bends(&curve)[0];
        let least = (PI * min_rad / dl - 1.).ceil() as usize;
        let mut closest = f64::INFINITY;
        for i in 0..n {
            for j in 0..i {
                if curve.index_distance(i, j).unwrap() >= least {
                    closest = closest.min(curve.vertices()[i].distance(curve.vertices()[j]));
                }
            }
        }
        prop_assert!((measure(&curve).sr - 0.5 * closest).abs() < 1e-12);
    }

    #[test]
    fn motions_shifts_and_reversal_change_nothing(
        curve in smooth_curve(),
        axis in prop::array::uniform3(-1f64..1.),
        angle in 0f64..6.,
        offset in prop::array::uniform3(-100f64..100.),
        scale in 0.01f64..100.,
        shift in 0usize..20,
    ) {
        let axis = DVec3::from(axis).try_normalize().unwrap_or(DVec3::Z);
        let turn = DQuat::from_axis_angle(axis, angle);
        let moved = rebuilt(&curve, |v| {
            v.iter_mut().for_each(|v| *v = turn * *v * scale + DVec3::from(offset));
        });
        assert_same(&curve, &moved, scale);
        assert_same(&curve, &rebuilt(&curve, |v| v.rotate_left(shift)), 1.);
        assert_same(&curve, &rebuilt(&curve, |v| v.reverse()), 1.);
    }

    #[test]
    fn flat_random_walks_cross_and_are_refused(n in 20usize..60, seed in 0u64..1000) {
        // A closed walk in a plane that turns twice crosses itself.
        let wobble = |i: usize| 1. + 0.3 * ((i as u64 * 7919 + seed * 104_729) % 100) as f64 / 100.;
        let vertex = |i: usize| {
            let t = 2. * TAU * i as f64 / n as f64 + 0.01;
            wobble(i) * DVec3::new(t.cos(), t.sin(), 0.)
        };
        let flat = Curve::new(vec![(0..n).map(vertex).collect()]).unwrap();
        prop_assert!(check_embedded(&flat).is_err());
    }
}
