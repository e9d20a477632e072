//! K_P and its samples.

mod common;

use approx::assert_relative_eq;
use common::torus;
use glam::DVec3;
use proptest::prelude::*;
use sono::geometry::inscribed::Inscribed;
use sono::resample::{rope_curve, share_out};
use sono::{Curve, Error, measure, refine};

proptest! {
    #[test]
    fn chords_are_equal(n in 30usize..400, q in 2usize..8, shift in 0f64..1.) {
        let sampled = refine(&torus(2., 2. * q as f64 + 1., 300), n.max(20 * q), shift).unwrap();
        prop_assert!(measure(&sampled).dispersion < 1e-11);
    }

    #[test]
    fn shares_add_up(n in 30usize..1000, lengths in prop::collection::vec(0.5f64..20., 1..6)) {
        let shares = share_out(n, &lengths);
        prop_assert_eq!(shares.iter().sum::<usize>(), n);
        let per_length = n as f64 / lengths.iter().sum::<f64>();
        for (share, length) in shares.iter().zip(&lengths) {
            // A component that gets its least of 3 takes up to 3 from the others.
            let most = 1. + 3. * (lengths.len() - 1) as f64;
            prop_assert!((*share as f64 - length * per_length).abs() < most || *share == 3);
        }
    }
}

#[test]
fn samples_lie_on_the_arcs() {
    // The K_P of a square of side 2 is its incircle.
    let square = [(1., 1.), (-1., 1.), (-1., -1.), (1., -1.)].map(|(x, y)| DVec3::new(x, y, 0.));
    let curve = Curve::new(vec![square.to_vec()]).unwrap();
    let (circle, above) = Inscribed::new(&curve).sample(&[100], 0.3);
    for v in circle.vertices() {
        assert_relative_eq!(v.length(), 1., max_relative = 1e-14);
    }
    assert_relative_eq!(above.turn, std::f64::consts::TAU / 100., max_relative = 1e-9);
}

#[test]
fn a_coarse_polygon_keeps_clear_of_its_strands() {
    // A strand passes through the corner of a long triangle: the arc must stay in front of it.
    let triangle = [[-10., 0., 0.], [10., 0., 0.], [0., 10., 0.]].map(DVec3::from).to_vec();
    let through = [[0., 9.5, -3.], [0., 9.5, 3.], [0., 20., 0.]].map(DVec3::from).to_vec();
    let curve = Curve::new(vec![triangle, through]).unwrap();
    let linked = rope_curve(&curve, 20_000).unwrap();
    let top = linked.component(0).iter().map(|v| v.y).fold(0., f64::max);
    assert!(top > 9.5, "the corner was cut at {top}, behind the strand at 9.5");
}

#[test]
fn rope_curves_have_short_edges() {
    for n in [8, 12, 30, 300, 3000] {
        let rope = rope_curve(&torus(2., 3., n), 20_000).unwrap();
        let m = measure(&rope);
        assert!(m.dl <= 0.56 * m.r_s, "{n}: {} {}", m.dl, m.r_s);
    }
}

#[test]
fn strands_that_all_but_touch_are_refused() {
    let mut components = vec![common::polygon(40, DVec3::X, DVec3::Y, DVec3::ZERO)];
    components.push(common::polygon(40, DVec3::X, DVec3::Y, DVec3::Z * 1e-7));
    let error = rope_curve(&Curve::new(components).unwrap(), 20_000).unwrap_err();
    assert!(matches!(error, Error::TooThin { .. }), "{error}");
}
