//! The tightening loop: valid, reproducible, resumable.

mod common;

use std::f64::consts::PI;

use common::{finish, quick, torus};
use glam::DVec3;
use sono::beads::{least_index_distance, most_bend};
use sono::sono::procedures::{control_curvature, equalize_edges, remove_overlaps};
use sono::{Curve, Error, Outcome, Polish, Settings, Tightener, measure};

fn loose() -> Curve {
    finish(Tightener::collapse(&torus(2., 3., 100), 1000, quick()).unwrap()).best().clone()
}

fn tight(n: usize, settings: Settings) -> Tightener {
    let annealed = finish(Tightener::anneal(&loose(), n, settings).unwrap());
    finish(Tightener::settle(annealed.best(), n, settings).unwrap())
}

#[test]
fn a_settled_rope_is_valid_and_short() {
    let tight = tight(60, quick());
    let status = tight.status();
    assert_eq!(status.outcome, Outcome::Tight);
    let m = measure(tight.best());
    assert_eq!(m, status.best);
    assert!(m.dispersion <= 1e-6, "{}", m.dispersion);
    assert!((m.r_s - 1.).abs() < 1e-12, "{}", m.r_s);
    assert!(m.l_p < 32.53 && m.l_c.unwrap() < 33.58, "{} {:?}", m.l_p, m.l_c);
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_does_not() {
    let [a, b, c] = [1, 1, 2].map(|seed| tight(40, Settings { seed, ..quick() }).best().clone());
    assert_eq!(a, b);
    assert_ne!(a, c);
}

#[test]
fn a_saved_run_goes_on_as_if_it_had_never_stopped() {
    let whole = finish(Tightener::anneal(&loose(), 50, quick()).unwrap());
    let mut part = Tightener::anneal(&loose(), 50, quick()).unwrap();
    for _ in 0..3333 {
        part.step();
    }
    let saved = serde_json::to_string(&part).unwrap();
    let resumed: Tightener = serde_json::from_str(&saved).unwrap();
    assert_eq!(finish(resumed).best(), whole.best());
}

#[test]
fn too_few_vertices_are_refused_with_a_number_that_will_do() {
    let Err(Error::TooCoarse { needed, .. }) = Tightener::settle(&loose(), 12, quick()) else {
        panic!("12 vertices cannot hold a trefoil")
    };
    assert!((13..=16).contains(&needed), "{needed}");
    assert!(Tightener::settle(&loose(), needed, quick()).is_ok());
    assert!(matches!(Tightener::settle(&loose(), 3, quick()), Err(Error::Pierced { .. })));
}

#[test]
fn coarse_ropes_get_tight() {
    for n in [15, 21] {
        let annealed = finish(Tightener::anneal(&loose(), n, quick()).unwrap());
        let mut polish = Polish::new(annealed.best(), n, false, 0, Default::default()).unwrap();
        while polish.step() == Outcome::Running {}
        let status = polish.status();
        assert_eq!(status.outcome, Outcome::Tight, "{n}");
        // Beads of neighbours touch, and all others keep their distance.
        assert!(status.best.l_p < 32.7 && status.best.dl < 2., "{n} {}", status.best.l_p);
        assert!((status.best.r_s - 1.).abs() < 1e-9 && status.best.l_c.is_none());
    }
}

#[test]
fn a_link_with_one_coarse_component_is_refused() {
    // 60 and 5 vertices on rings of radius 2: the second has edges of 2.4.
    let rings = vec![
        common::polygon(60, 2. * DVec3::X, 2. * DVec3::Y, DVec3::ZERO),
        common::polygon(5, 2. * DVec3::X, 2. * DVec3::Z, 2. * DVec3::X),
    ];
    let link = Curve::new(rings).unwrap();
    let error = Tightener::anneal(&link, 65, quick()).unwrap_err();
    assert!(matches!(error, Error::TooCoarse { .. }), "{error}");
}

#[test]
fn a_fine_rope_is_not_knotted_by_its_jitter() {
    let circle = Curve::new(vec![common::polygon(400, DVec3::X, DVec3::Y, DVec3::ZERO)]).unwrap();
    for seed in 0..5 {
        let settings = Settings { seed, anneal_sweeps: 300, ..Default::default() };
        let end = finish(Tightener::anneal(&circle, 400, settings).unwrap());
        // Any knot needs more than 31.
        assert!(measure(end.best()).l_p < 31., "{}", measure(end.best()).l_p);
    }
}

#[test]
fn settings_out_of_range_are_named() {
    let wrong = Settings { c_1: 0.7, ..Default::default() };
    let error = Tightener::collapse(&torus(2., 3., 60), 1000, wrong).unwrap_err();
    assert!(error.to_string().contains("c_1 = 0.7"), "{error}");
}

#[test]
fn the_index_rule_is_the_papers() {
    assert_eq!(least_index_distance(0.1), (31.416f64 * 0.99875 - 1.).ceil() as usize);
    // Coarse ropes turn so little that the rule, with their MinRad, exempts neighbours only.
    for dl in [1.235, 1.5, 1.9, 2.2] {
        assert_eq!(least_index_distance(dl), 2);
        let sharpest = 2. * (0.5 * most_bend(dl) / dl).asin();
        let min_rad = 0.5 * dl / (0.5 * sharpest).tan();
        assert!(min_rad > 2. * dl / PI && min_rad < 2.002 * dl / PI);
        assert!(min_rad.hypot(0.5 * dl) >= 1.);
    }
}

#[test]
fn equalizing_moves_both_ends_by_half_the_difference() {
    let mut v = [[0., 0., 0.], [3., 0., 0.], [3., 2., 0.], [0., 2., 0.]].map(DVec3::from);
    let worst = equalize_edges(&mut v[..], 2., 0.5, false);
    assert!((worst - 1. / 3.).abs() < 1e-15);
    assert_eq!(v[0].x, 0.5);
    let mut relaxed = v;
    for _ in 0..200 {
        equalize_edges(&mut relaxed[..], 2., 0.5, true);
    }
    assert!(equalize_edges(&mut relaxed[..], 2., 0.5, true) < 1e-12);
}

#[test]
fn overlaps_are_removed_to_two_plus_epsilon() {
    let mut v = [DVec3::ZERO, DVec3::X * 1.5, DVec3::X * 4.];
    let overlap = remove_overlaps(&mut v, &[(0, 1), (1, 2)], 0.5, 0.01);
    assert!((overlap - 0.5).abs() < 1e-15);
    assert!((v[1].distance(v[0]) - 2.01).abs() < 1e-15);
}

#[test]
fn corners_open_to_the_papers_angle() {
    // A square of 40 edges: its corners turn by 90 degrees.
    let dl = 0.5;
    let side = |at: DVec3, along: DVec3| (0..10).map(move |i| at + along * (dl * i as f64));
    let mut v: Vec<_> = side(DVec3::ZERO, DVec3::X)
        .chain(side(5. * DVec3::X, DVec3::Y))
        .chain(side(DVec3::new(5., 5., 0.), -DVec3::X))
        .chain(side(5. * DVec3::Y, -DVec3::Y))
        .collect();
    let worst = control_curvature(&mut v.clone(), dl);
    assert!((worst - (1. - dl / (2. * (0.25 * PI).sin()))).abs() < 0.05);
    for _ in 0..2000 {
        equalize_edges(&mut v, dl, 0.5, true);
        control_curvature(&mut v, dl);
    }
    let curve = Curve::new(vec![v]).unwrap();
    let sharpest = curve.turning_angles(0).fold(0., f64::max);
    assert!(sharpest <= 2. * (0.5 * dl).asin() + 1e-6, "{sharpest}");
    assert!(curve.edge_lengths(0).all(|s| (s - dl).abs() < 1e-6));
}
