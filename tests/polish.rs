//! The polish: valid at every step, exact at its end, in balance, resumable.

mod common;

use std::f64::consts::{PI, TAU};

use common::{finish, hopf, polygon, quick, torus};
use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde_json::json;
use sono::polish::{Settings, balance};
use sono::{Curve, Error, Outcome, Polish, Tightener, measure};

/// A rough trefoil: collapsed only.
fn rough() -> Curve {
    finish(Tightener::collapse(&torus(2., 3., 100), 1000, quick()).unwrap()).best().clone()
}

fn polished(curve: &Curve, n: usize) -> Polish {
    polished_with(curve, n, Settings::default())
}

fn polished_with(curve: &Curve, n: usize, settings: Settings) -> Polish {
    let mut polish = Polish::new(curve, n, false, 1, settings).unwrap();
    while polish.step() == Outcome::Running {}
    polish
}

#[test]
fn the_trefoil_of_120_vertices_is_tight_to_the_last_digit() {
    let polish = polished(&rough(), 120);
    let status = polish.status();
    assert_eq!(status.outcome, Outcome::Tight);
    assert!(status.residual <= 1e-8 && status.mu <= 1e-11, "{status:?}");
    assert!(status.excess <= 1e-8);
    let m = measure(&polish.best());
    assert_eq!(m, status.best);
    assert!(m.dispersion <= 1e-10 && (m.r_s - 1.).abs() <= 1e-12, "{m:?}");
    assert!(m.l_p <= 32.6920 && m.l_c.unwrap() <= 32.9410, "{} {:?}", m.l_p, m.l_c);
}

#[test]
fn every_step_is_a_rope_and_the_best_one_is_kept() {
    let mut polish = Polish::new(&rough(), 90, false, 1, Settings::default()).unwrap();
    let mut shortest = polish.status().best.l_p;
    while polish.step() == Outcome::Running {
        let now = polish.status().best;
        assert!((now.r_s - 1.).abs() < 1e-12 && now.dispersion < 0.1, "{now:?}");
        // The required length is bounded; what a rope measures exceeds it by its unequal edges.
        assert!(now.l_p < shortest + 0.05, "{} after {shortest}", now.l_p);
        shortest = shortest.min(now.l_p);
    }
    assert!(polish.status().best.l_p <= shortest + 1e-9);
}

#[test]
fn a_saved_polish_goes_on_as_if_it_had_never_stopped() {
    let whole = polished(&rough(), 80);
    let mut part = Polish::new(&rough(), 80, false, 1, Settings::default()).unwrap();
    for steps in 0.. {
        let outcome = part.step();
        if outcome != Outcome::Running {
            break;
        }
        if steps % 5 == 0 {
            part = serde_json::from_str(&serde_json::to_string(&part).unwrap()).unwrap();
        }
    }
    assert_eq!(part.best(), whole.best());
    assert_eq!(part.status(), whole.status());
}

/// The first-order change of length when the beads of a tight rope move by `d` and the rope is
/// scaled back to thickness 1, computed by moving them a little.
fn change_of_length(curve: &Curve, d: &[DVec3], step: f64) -> f64 {
    let mut moved = curve.clone();
    moved.vertices_mut().iter_mut().zip(d).for_each(|(v, d)| *v += step * *d);
    // Edges may not get longer than the longest: that one counts for all.
    let longest = |curve: &Curve| curve.edge_lengths(0).fold(0., f64::max);
    let rope = |curve: &Curve| curve.n() as f64 * longest(curve) / measure(curve).r_s;
    (rope(&moved) - rope(curve)) / step
}

#[test]
fn no_small_displacement_shortens_a_tight_rope() {
    let tight = polished(&rough(), 100).best();
    let mut random = Pcg64Mcg::seed_from_u64(5);
    for trial in 0..200 {
        // Rough in one half of the trials, smooth along the rope in the other.
        let mut direction =
            || DVec3::from_array(std::array::from_fn(|_| random.random_range(-1.0..1.)));
        let d: Vec<_> = if trial % 2 == 0 {
            (0..tight.n()).map(|_| direction()).collect()
        } else {
            let waves: Vec<_> = (1..6).map(|k| (k, direction(), direction())).collect();
            let at = |i: usize, k: i32| TAU * f64::from(k) * i as f64 / tight.n() as f64;
            let wave =
                |i| move |&(k, a, b): &(i32, DVec3, DVec3)| a * at(i, k).cos() + b * at(i, k).sin();
            (0..tight.n()).map(|i| waves.iter().map(wave(i)).sum()).collect()
        };
        let change = change_of_length(&tight, &d, 1e-7);
        assert!(change > -1e-4, "trial {trial}: {change}");
    }
}

#[test]
fn forces_balance_and_a_fit_to_the_vertices_finds_them() {
    let polish = polished(&rough(), 100);
    let (own, fitted) = (polish.forces(), balance(&polish.best()));
    assert!(
        own.residual <= 1e-8 && fitted.residual <= 1e-6,
        "{} {}",
        own.residual,
        fitted.residual
    );
    let mean = own.tension.iter().sum::<f64>() / 100.;
    assert!((mean - 1.).abs() < 0.02, "{mean}");
    let total = |contacts: &[(usize, usize, f64)]| contacts.iter().map(|c| c.2).sum::<f64>();
    let (a, b) = (total(&own.contacts), total(&fitted.contacts));
    assert!((a - b).abs() < 1e-3 * a, "{a} {b}");
    assert!(own.tension.iter().chain(&own.couple).all(|&f| f >= 0.));
    // A rope that is not tight is out of balance.
    assert!(balance(&rough()).residual > 1e-3);
    assert!(balance(&torus(2., 3., 100)).residual > 0.1);
}

#[test]
fn the_tight_unknot_is_the_regular_polygon() {
    let flat: Vec<_> = polygon(60, DVec3::X, 1.2 * DVec3::Y, DVec3::ZERO);
    let m = measure(&polished(&Curve::new(vec![flat]).unwrap(), 40).best());
    // Beads 19 edges apart, one less than opposite ones, must keep their distance already.
    let expected = 80. * (PI / 40.).sin() / (PI * 19. / 40.).sin();
    assert!((m.l_p - expected).abs() < 1e-8, "{} {expected}", m.l_p);
}

#[test]
fn the_hopf_link_lies_on_both_sides_of_its_exact_length() {
    // Each component's beads settle astride the other's centre, which gains up to dl^2/16 of the
    // radius 2 and with it up to dl^2 pi/4 in L_p; L_c remains a bound.
    for n in [120, 240, 480] {
        let m = measure(&polished(&hopf(50), n).best());
        let gain = 0.25 * PI * m.dl * m.dl;
        assert!(m.l_p < 8. * PI && m.l_c.unwrap() > 8. * PI, "{m:?}");
        assert!(m.l_c.unwrap() < 8. * PI + 2. * m.dl * m.dl, "{m:?}");
        assert!((m.l_a.unwrap() - 8. * PI).abs() < gain, "{n} {:?} {gain}", m.l_a);
    }
}

#[test]
fn far_and_slid_vertices_are_no_obstacle() {
    let tight = polished(&rough(), 160).best();
    let mut far = tight.clone();
    far.vertices_mut().iter_mut().for_each(|v| *v += 1e5);
    let mut slid = tight.clone();
    for i in (0..160).step_by(2) {
        let onward = tight.vertices()[i + 1] - tight.vertices()[i];
        slid.vertices_mut()[i] += 0.02 * onward;
    }
    for curve in [far, slid] {
        let status = polished(&curve, 160).status();
        assert_eq!(status.outcome, Outcome::Tight, "{status:?}");
        // Bead positions in the grooves of so coarse a rope differ.
        assert!(status.best.l_p < 34., "{status:?}");
    }
}

#[test]
fn what_cannot_be_polished_is_refused() {
    let flat = [[0., 0., 0.], [2., 2., 0.], [2., 0., 0.], [0., 2., 0.]].map(DVec3::from);
    let crossing = Curve::new(vec![flat.to_vec()]).unwrap();
    assert!(matches!(
        Polish::new(&crossing, 100, false, 0, Settings::default()),
        Err(Error::SelfCrossing { .. })
    ));
    assert!(matches!(
        Polish::new(&rough(), 12, false, 0, Settings::default()),
        Err(Error::TooCoarse { .. })
    ));
    // Two turns of a thin trefoil so close together that 40 edges would mix them up.
    let close = |i: usize| {
        let t = TAU * i as f64 / 400.;
        let r = 2. + 0.05 * (3. * t).cos();
        DVec3::new(r * (2. * t).cos(), r * (2. * t).sin(), 0.05 * (3. * t).sin())
    };
    let large = Curve::new(vec![(0..400).map(close).collect()]).unwrap();
    assert!(matches!(
        Polish::new(&large, 40, false, 0, Settings::default()),
        Err(Error::TooCoarse { .. })
    ));
}

/// A long loop, its ends arcs of radius 1.02, has far to glide on its way to a circle.
#[test]
fn a_long_loop_glides_to_a_circle_in_as_many_steps_as_it_takes() {
    for (half, n) in [(15., 120), (20., 160), (20., 240)] {
        let (w, ends) = (1.02, 1.02 * PI);
        let length = 2. * (2. * half + ends);
        let vertex = |k: usize| {
            let s = (k as f64 + 0.5) / n as f64 * length;
            let (side, s) = if s < 0.5 * length { (1., s) } else { (-1., s - 0.5 * length) };
            let angle = (s - 2. * half).max(0.) / w;
            side * DVec3::new(s.min(2. * half) - half + w * angle.sin(), -w * angle.cos(), 0.)
        };
        let polish = polished(&Curve::new(vec![(0..n).map(vertex).collect()]).unwrap(), n);
        let status = polish.status();
        assert_eq!(status.outcome, Outcome::Tight, "{half} {n} {status:?}");
        let circumscribed = 2. * n as f64 * (PI / n as f64).tan();
        assert!((status.best.l_p - circumscribed).abs() < 1e-6, "{half} {n} {status:?}");
    }
}

/// Settings of which the one of that name has another value.
fn with(name: &str, value: f64) -> Settings {
    let mut settings = serde_json::to_value(Settings::default()).unwrap();
    let is_whole = settings[name].is_u64();
    settings[name] = if is_whole { json!(value as u64) } else { json!(value) };
    serde_json::from_value(settings).unwrap()
}

fn names(settings: impl serde::Serialize) -> Vec<String> {
    serde_json::to_value(settings).unwrap().as_object().unwrap().keys().cloned().collect()
}

#[test]
fn settings_out_of_range_are_named_with_their_value_and_range() {
    let triangle = Curve::new(vec![polygon(3, DVec3::X, DVec3::Y, DVec3::ZERO)]).unwrap();
    for name in names(Settings::default()) {
        let wrong = match name.as_str() {
            "gliding_share" => -0.5,
            "most_restarts" => 101.,
            _ => 0.,
        };
        let error = Polish::new(&triangle, 60, false, 0, with(&name, wrong)).err().unwrap();
        let said = format!("setting {name} = {wrong} is out of range: ");
        assert!(error.to_string().starts_with(&said), "{error}");
    }
    let wrong = Settings { mu_power: f64::NAN, ..Default::default() };
    assert!(wrong.check().is_err());
    assert_eq!(
        with("centred", 1000.).check().unwrap_err().to_string(),
        "setting centred = 1000 is out of range: in [0.1, 100]"
    );
}

#[test]
fn no_setting_is_one_of_sono_as_well() {
    let of_sono = names(sono::Settings::default());
    assert!(names(Settings::default()).iter().all(|name| !of_sono.contains(name)));
}

#[test]
fn ropes_are_valid_and_tight_at_the_limits_of_all_settings() {
    let limits = [
        ("first_mu", [1e-6, 10.]),
        ("passing_mu", [1e-9, 10.]),
        ("last_mu", [1e-14, 1e-4]),
        ("mu_factor", [0.01, 0.9]),
        ("mu_power", [1., 2.]),
        ("centred", [0.1, 100.]),
        ("balanced", [0.001, 100.]),
        ("contact_range", [0.1, 100.]),
        ("least_contact_range", [0.001, 1.]),
        ("longest_way", [0.001, 0.1]),
        ("most_used", [0.5, 0.999]),
        ("least_descent", [1e-8, 0.4]),
        ("multiplier_range", [2., 1e10]),
        ("patience", [1., f64::from(u32::MAX)]),
        ("gliding_share", [0., 1.]),
        ("restart_factor", [1., 1000.]),
        ("most_restarts", [0., 100.]),
        ("most_iterations", [1., f64::from(u32::MAX)]),
        ("tight_residual", [1e-12, 1e-4]),
    ];
    assert_eq!(limits.len(), names(Settings::default()).len());
    let rough = rough();
    for (name, value) in limits.into_iter().flat_map(|(name, ends)| ends.map(|end| (name, end))) {
        let passing = name == "passing_mu";
        let mut polish = Polish::new(&rough, 60, passing, 1, with(name, value)).unwrap();
        while polish.step() == Outcome::Running {}
        let status = polish.status();
        let at_once = (name, value) == ("most_iterations", 1.);
        let expected = if at_once { Outcome::Stuck } else { Outcome::Tight };
        assert_eq!(status.outcome, expected, "{name} {value} {status:?}");
        assert!((status.best.r_s - 1.).abs() < 1e-12 && status.best.l_p < 33., "{status:?}");
        assert_eq!(status.progress, if at_once { 0. } else { 1. }, "{name} {value}");
    }
}

#[test]
fn a_saved_polish_keeps_its_settings() {
    let settings = Settings { mu_factor: 0.5, last_mu: 1e-8, centred: 1., ..Default::default() };
    let whole = polished_with(&rough(), 80, settings);
    let mut part = Polish::new(&rough(), 80, false, 1, settings).unwrap();
    for _ in 0..5 {
        part.step();
    }
    let saved = serde_json::to_string(&part).unwrap();
    let mut resumed: Polish = serde_json::from_str(&saved).unwrap();
    while resumed.step() == Outcome::Running {}
    assert_eq!((resumed.best(), resumed.status()), (whole.best(), whole.status()));
    assert_ne!(polished(&rough(), 80).status(), whole.status());
    // One out of range is no state that can go on.
    let edited = saved.replace(r#""mu_factor":0.5"#, r#""mu_factor":1.5"#);
    assert!(resumed.is_sound() && !serde_json::from_str::<Polish>(&edited).unwrap().is_sound());
}

#[test]
fn the_excess_is_as_large_as_the_last_mu() {
    let exact = polished(&rough(), 100).status().best.l_p;
    for last_mu in [1e-9, 1e-7, 1e-5] {
        let settings = Settings { last_mu, ..Default::default() };
        let status = polished_with(&rough(), 100, settings).status();
        assert_eq!((status.outcome, status.mu), (Outcome::Tight, last_mu));
        // 100 edges, 100 bends and 200 contacts, each of which is worth mu, give or take 10.
        assert!((100. ..4000.).contains(&(status.excess / last_mu)), "{status:?}");
        let longer = status.best.l_p - exact;
        assert!(50. * last_mu < longer && longer < status.excess, "{longer} {status:?}");
    }
}
