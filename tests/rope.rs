//! The bead rope: no strand passes another, whatever is asked of it.

mod common;

use common::{hopf, linking};
use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use sono::sono::rope::Rope;

#[test]
fn a_sweep_that_would_pass_a_strand_is_undone() {
    // Two linked rings that shrink without end; overlaps are not removed at all, or too slowly.
    for (c_1, c_2, shrink) in
        [(0.5, 0., 0.99), (0.1, 0., 0.999), (0.5, 0.01, 0.95), (0.5, 0.5, 0.5)]
    {
        let mut rope = Rope::new(hopf(30));
        let linked = linking(rope.curve()).round();
        let mut states = vec![rope.curve().clone()];
        let mut undone = 0;
        for _ in 0..1000 {
            rope.stretch(shrink);
            let length = rope.length();
            // Sweeps after a list are not looked at one by one.
            if rope.sweep(c_1, c_2, 0.).is_none() || !rope.confirm() {
                undone += 1;
                assert!(states.contains(rope.curve()), "undone to what it never was");
                assert!((rope.length() - 1.001 * length).abs() < 1e-12 * length);
            } else {
                states.push(rope.curve().clone());
            }
            assert!((linking(rope.curve()) - linked).abs() < 1e-6, "{c_1} {c_2} {shrink}");
        }
        assert!(undone > 10, "{c_1} {c_2} {shrink}: {undone} undone");
        let passages = rope.passages();
        assert_eq!((passages.refused, passages.shown), (undone, states.len() as u64 - 1));
        assert!(rope.lost() >= undone && rope.lost() <= 1000);
        assert!(passages.margin.is_none_or(|margin| margin > 1.));
    }
}

#[test]
fn beads_are_not_displaced_through_a_strand() {
    let mut rope = Rope::new(hopf(14));
    let linked = linking(rope.curve()).round();
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let (mut moved, mut refused) = (0, 0);
    for _ in 0..1000 {
        let before = rope.curve().clone();
        rope.displace(|| {
            let step = DVec3::from_array(std::array::from_fn(|_| random.random_range(-1.0..1.)));
            0.1 * step.clamp_length_max(1.)
        });
        for (now, then) in rope.curve().vertices().iter().zip(before.vertices()) {
            *if now == then { &mut refused } else { &mut moved } += 1;
        }
        assert!((linking(rope.curve()) - linked).abs() < 1e-6);
    }
    assert!(moved > 3 && refused > 3, "{moved} moved, {refused} refused");
}
