//! The certified bound: never too small, hardly too large, and refused where nothing is proven.

mod common;

use std::f64::consts::TAU;

use approx::assert_relative_eq;
use common::{hopf, polygon, torus};
use glam::DVec3;
use proptest::prelude::*;
use sono::certify::bound::{Bound, Decider, certify_boxes};
use sono::certify::interval::Interval;
use sono::certify::pairs::{Along, closest};
use sono::certify::point::{Point, exactly};
use sono::{Curve, Error, certify, measure, refine};

/// What rounding may cost.
const DIGITS: f64 = 1e-10;

fn agrees(curve: &Curve) -> Bound {
    let (bound, m) = (certify(curve).unwrap(), measure(curve));
    let l_c = m.l_c.unwrap();
    assert!(bound.l_c > l_c * (1. - 1e-12) && bound.l_c < l_c * (1. + DIGITS), "{bound:?} {m:?}");
    assert_relative_eq!(bound.inscribed_length, m.inscribed_length, max_relative = DIGITS);
    assert_relative_eq!(bound.r, m.r_s, max_relative = DIGITS);
    assert_relative_eq!(bound.r_c, m.r_c.unwrap(), max_relative = DIGITS);
    assert_relative_eq!(bound.min_rad, m.min_rad, max_relative = DIGITS);
    bound
}

fn scaled(curve: &Curve, factor: f64) -> Curve {
    let mut scaled = curve.clone();
    scaled.scale(factor);
    scaled
}

#[test]
fn it_is_the_measured_bound_rounded_up() {
    for n in [60, 100, 1000, 5000] {
        let curve = torus(2., 3., n);
        agrees(&curve);
        agrees(&refine(&curve, n, 0.).unwrap());
        agrees(&hopf(n));
    }
    agrees(&scaled(&torus(3., 5., 400), 1e50));
    agrees(&scaled(&torus(3., 5., 400), 1e-50));
}

#[test]
fn circles_have_closed_forms() {
    for n in [7, 8, 12, 48, 1001] {
        let circle = Curve::new(vec![polygon(n, DVec3::X, DVec3::Y, DVec3::ZERO)]).unwrap();
        let bound = certify(&circle).unwrap();
        let x = 0.5 * TAU / n as f64;
        // K_P is the incircle.
        assert_relative_eq!(bound.inscribed_length, TAU * x.cos(), max_relative = 1e-12);
        assert!(bound.inscribed_length > TAU * x.cos() * (1. - 1e-15));
        assert!(bound.longest_edge > 2. * x.sin() * (1. - 1e-15));
        assert!(bound.l_c > TAU);
    }
}

#[test]
fn each_component_has_its_own_bends() {
    // A small ring of short edges round a strand of a large one of long edges.
    let large = polygon(60, 4. * DVec3::X, 4. * DVec3::Y, DVec3::ZERO);
    let small = polygon(60, DVec3::X, DVec3::Z, 4. * DVec3::X);
    let bound = agrees(&Curve::new(vec![large.clone(), small.clone()]).unwrap());
    let turned = agrees(&Curve::new(vec![small, large]).unwrap());
    assert_relative_eq!(bound.l_c, turned.l_c, max_relative = 1e-12);
    assert!(matches!(bound.decided_by, Decider::Pair(i, j) if i < 60 && j >= 60));
}

#[test]
fn a_nudge_the_wrong_way_makes_the_bound_larger() {
    const NUDGE: f64 = 1e-12;
    // Held up by its contacts.
    let rope = hopf(200);
    let bound = certify(&rope).unwrap();
    let Decider::Pair(i, j) = bound.decided_by else { panic!("{bound:?}") };
    let mut closer = rope.clone();
    let towards = (rope.vertices()[j] - rope.vertices()[i]).normalize();
    closer.vertices_mut()[i] += NUDGE * towards;
    assert!(certify(&closer).unwrap().l_c > bound.l_c);
    // Held up by its bends: an ellipse; a corner pushed out is sharper.
    let mut ellipse = Curve::new(vec![polygon(200, 2. * DVec3::X, DVec3::Y, DVec3::ZERO)]).unwrap();
    let bound = certify(&ellipse).unwrap();
    let Decider::Bend(tip) = bound.decided_by else { panic!("{bound:?}") };
    assert!(tip % 100 == 0);
    ellipse.vertices_mut()[tip] *= 1. + NUDGE;
    assert!(certify(&ellipse).unwrap().l_c > bound.l_c);
    // Longer where nothing else changes: one of the straights of a stadium, thicker than its ends.
    let bound = certify(&stadium(0.)).unwrap();
    let longer = certify(&stadium(NUDGE)).unwrap();
    assert!(longer.r >= bound.r && longer.inscribed_length > bound.inscribed_length);
    assert!(longer.l_c > bound.l_c);
}

/// Two half circles of radius 1 and two straights, one half being moved away by so much.
fn stadium(by: f64) -> Curve {
    let end = |i: usize| 0.5 * TAU * (i as f64 + 0.5) / 50.;
    let half = |sign: f64, x: f64| {
        (0..50).map(move |i| DVec3::new(x + sign * end(i).sin(), sign * end(i).cos(), 0.))
    };
    let straight =
        |sign: f64| (1..40).map(move |i| DVec3::new(sign * (2. - 0.1 * i as f64), -sign, 0.));
    let v = half(1., 2. + by).chain(straight(1.)).chain(half(-1., -2.)).chain(straight(-1.));
    Curve::new(vec![v.collect()]).unwrap()
}

#[test]
fn what_is_not_proven_is_refused_with_its_vertices() {
    let ring = |z: f64| polygon(20, DVec3::X, DVec3::Y, z * DVec3::Z);
    let error = certify(&Curve::new(vec![ring(0.), ring(0.3)]).unwrap()).unwrap_err();
    let Error::ClosePair { component, vertex, other_component, other_vertex, r, needed } = error
    else {
        panic!("{error}")
    };
    assert_eq!((component, other_component, vertex), (0, 1, other_vertex));
    assert_relative_eq!(r, 0.15, max_relative = 1e-14);
    assert_relative_eq!(needed, 2f64.sqrt() * (0.025 * TAU).sin(), max_relative = 1e-14);
    // One corner of a circle is pulled out to a spike.
    let mut spike = polygon(40, DVec3::X, DVec3::Y, DVec3::ZERO);
    spike[11] *= 1.3;
    let error = certify(&Curve::new(vec![spike]).unwrap()).unwrap_err();
    assert!(matches!(error, Error::SharpBend { component: 0, vertex: 11, .. }), "{error}");
    let eight = [[0., 0., 0.], [2., 2., 0.], [2., 0., 0.], [0., 2., 0.]].map(DVec3::from);
    let error = certify(&Curve::new(vec![eight.to_vec()]).unwrap()).unwrap_err();
    assert!(matches!(error, Error::SelfCrossing { .. }), "{error}");
    let fold = [[0., 0., 0.], [1., 0., 0.], [2., 0., 0.], [1., 1e-9, 0.]].map(DVec3::from);
    let error = certify(&Curve::new(vec![fold.to_vec()]).unwrap()).unwrap_err();
    assert!(matches!(error, Error::SharpBend { .. } | Error::SelfCrossing { .. }), "{error}");
}

#[test]
fn three_vertices_and_straight_angles_are_no_trouble() {
    let triangle = [DVec3::X, DVec3::Y, DVec3::Z].to_vec();
    assert!(certify(&Curve::new(vec![triangle]).unwrap()).is_err());
    agrees(&stadium(0.)); // whose straights do not turn
}

#[test]
fn each_figure_follows_from_those_before() {
    for k in 0..200 {
        let curve = scaled(&hopf(60), 1. + 0.01 * f64::from(k));
        let vertices: Vec<_> = curve.vertices().iter().map(|v| exactly(*v)).collect();
        let along = Along {
            component: (0..120).map(|i| i / 60).collect(),
            arclength: vec![Interval::from(0.); 120],
            around: vec![Interval::from(0.); 2],
            least: vec![Interval::from(1.); 2],
        };
        let pair = closest(&vertices, &along, f64::INFINITY).unwrap();
        let Bound { longest_edge, r, r_c, inscribed_length, l_c, .. } = certify(&curve).unwrap();
        let squared = |x| Interval::from(x).squared();
        // What was rounded up in place of down would be beyond these, which are rounded twice.
        assert!(squared(r).low() < 0.25 * pair.squared.next_down());
        let r_c_squared = squared(r) - Interval::from(0.25) * squared(longest_edge);
        assert!(squared(r_c).low() < r_c_squared.low());
        // Fused, so that the sign is that of what is exact.
        assert!(l_c.mul_add(r_c, -inscribed_length) > 0.);
    }
}

/// Vertices that are known up to `width` only.
fn blurred(curve: &Curve, width: f64) -> Vec<Point> {
    let blurred = |x: f64| Interval::new(x - width, x + width);
    curve.vertices().iter().map(|v| v.to_array().map(blurred)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Intervals so wide that none of their ends can be taken for the other.
    #[test]
    fn a_bound_for_boxes_holds_for_all_polygons_in_them(
        n in 150usize..250,
        knot in prop::sample::select(vec![(2., 3.), (2., 5.), (3., 4.), (0., 0.)]),
        width in 1e-9f64..1e-5,
        moves in prop::collection::vec(prop::array::uniform3(-1f64..1.), 250),
    ) {
        // And an ellipse, whose bends decide.
        let ellipse = vec![polygon(n, 2. * DVec3::X, DVec3::Y, DVec3::ZERO)];
        let curve = if knot.0 > 0. { torus(knot.0, knot.1, n) } else { Curve::new(ellipse).unwrap() };
        let bound = certify_boxes(&curve, &blurred(&curve, width)).unwrap();
        let mut moved = curve.clone();
        for (v, by) in moved.vertices_mut().iter_mut().zip(moves) {
            *v += width * DVec3::from(by);
        }
        for inside in [&curve, &moved] {
            // Those of single points are sharp, up to their rounding.
            let single = certify(inside).unwrap();
            prop_assert!(bound.longest_edge > single.longest_edge);
            prop_assert!(bound.min_rad < single.min_rad);
            prop_assert!(bound.r < single.r);
            prop_assert!(bound.r_c < single.r_c);
            prop_assert!(bound.inscribed_length > single.inscribed_length);
            prop_assert!(bound.l_c > single.l_c);
            if let Decider::Bend(_) = bound.decided_by {
                let squares = bound.min_rad.powi(2) + 0.25 * single.longest_edge.powi(2);
                prop_assert!(bound.r.powi(2) < squares);
            }
        }
    }

    #[test]
    fn the_closest_pair_that_may_count_is_found(
        boxes in prop::collection::vec((prop::array::uniform3(-2f64..2.), 0f64..0.3), 2..60),
        cut in 0usize..60,
        (blur, least, more) in (0f64..0.4, 0f64..20., 0f64..3.),
        reach in 0f64..9.,
    ) {
        let blurred = |x: f64, blur: f64| Interval::new(x - blur, x + blur);
        let vertices: Vec<Point> =
            boxes.iter().map(|(v, width)| v.map(|x| blurred(x, *width))).collect();
        let n = vertices.len();
        let cut = cut.min(n);
        let place = |i: usize| if i < cut { i } else { i - cut } as f64;
        let along = Along {
            component: (0..n).map(|i| usize::from(i >= cut)).collect(),
            arclength: (0..n).map(|i| blurred(place(i), blur)).collect(),
            around: [cut, n - cut].map(|n| blurred(n as f64, more)).to_vec(),
            least: vec![blurred(least, more), blurred(0.5 * least, blur)],
        };
        let mut slow = f64::INFINITY;
        for j in 0..n {
            for i in 0..j {
                let c = along.component[i];
                let (forth, around) = (place(j) - place(i), along.around[c].high());
                let farthest = (forth + 2. * blur).min(around - forth + 2. * blur);
                if c != along.component[j] || farthest >= along.least[c].low() {
                    let gap = |(a, b): (&Interval, &Interval)| {
                        (a.low() - b.high()).max(b.low() - a.high()).max(0.).powi(2)
                    };
                    slow = slow.min(vertices[i].iter().zip(&vertices[j]).map(gap).sum());
                }
            }
        }
        match closest(&vertices, &along, reach) {
            Some(pair) => {
                prop_assert!(pair.i < pair.j && pair.squared < reach);
                prop_assert!((pair.squared - slow).abs() < 1e-12, "{pair:?} {slow}");
                prop_assert!(pair.squared == 0. || pair.squared < slow);
            }
            None => prop_assert!(slow >= reach - 1e-12),
        }
    }
}
