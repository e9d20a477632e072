//! The bead rope that a sweep acts on: vertices, required edge lengths, and the neighbour list.
//!
//! **No strand may pass another.** Beads closer than 2 + skin when the list was made are listed.
//! Until the next list no bead leaves the ball of radius skin/2 about its place of that time (a step
//! that leads out of it ends on its surface, and a new list is made). So beads that are not listed
//! never overlap, and in one sweep a bead moves by at most skin. Let d be the least distance of
//! listed beads, at most 2, and s the longest edge, before or after a sweep, whichever is worse.
//! While the beads move straight from the one place to the other they stay d - skin apart, edges stay
//! below s, and strands stay sqrt((d - skin)^2 - s^2/2) apart. Beads too near each other along the
//! rope to be listed are at most pi apart, and a curve of that length closes to a loop only where its
//! radius falls to 1/2; second differences of the vertices, too, stay below the larger of both ends.
//! A sweep after which one of these bounds fails is undone, together with all that followed the last
//! list.

use std::ops::Range;

use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::{Deserialize, Serialize};

use crate::curve::Curve;
use crate::error::{Error, Result};
use crate::inscribed::refine;
use crate::measures::measure;
use crate::neighbours::{Separation, for_each_close_pair};
use crate::procedures::{control_curvature, equalize_edges, least_index_distance, remove_overlaps};

/// The thickest skin of the neighbour list, hence the longest way of a bead in one sweep.
const THICKEST_SKIN: f64 = 0.25;
/// The thinnest, a skin that can still grow again.
const THINNEST_SKIN: f64 = 1e-9;

/// A list that lasts fewer sweeps gets a thicker skin, any other a thinner one; the thinner the skin
/// the shorter the list. One that lasts so long is made anew to learn whether a thinner one will do.
const SHORT_LIFE: usize = 150;
const LONG_LIFE: usize = 500;

/// Below this violation strands are so far from passing that [`Gap`] need not be measured.
const HARMLESS: f64 = 0.02;

/// What a sweep met before it corrected it, R = 1.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Violation {
    /// Largest overlap of two beads, 2 - r_ij.
    pub overlap: f64,
    /// Largest |dl/s_i - 1|.
    pub dispersion: f64,
    /// Largest 1 - dl/(2 sin(theta_i/2)).
    pub curvature: f64,
}

impl Violation {
    /// The largest of the three.
    pub fn worst(&self) -> f64 {
        self.overlap.max(self.dispersion).max(self.curvature)
    }
}

/// A rope of radius 1 on a closed curve.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Rope {
    curve: Curve,
    /// Required edge length of each component.
    dl: Vec<f64>,
    pairs: Vec<(u32, u32)>,
    /// Where the beads were when `pairs` was made.
    reference: Vec<DVec3>,
    skin: f64,
    /// Sweeps since `pairs` was made.
    age: usize,
    gap: Gap,
}

/// What keeps strands apart.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
struct Gap {
    /// Least distance of listed beads, at most 2.
    beads: f64,
    /// Longest edge.
    edge: f64,
    /// Longest second difference of the vertices, as a multiple of dl^2: one over the least radius.
    bend: f64,
}

impl Gap {
    fn of(curve: &Curve, dl: &[f64], pairs: &[(u32, u32)]) -> Self {
        let v = curve.vertices();
        let squared = pairs
            .iter()
            .fold(4f64, |least, &(i, j)| least.min(v[i as usize].distance_squared(v[j as usize])));
        let mut gap = Self { beads: squared.sqrt(), edge: 0., bend: 0. };
        for (range, dl) in curve.ranges().zip(dl) {
            let v = &v[range];
            let mut before = v[0] - v[v.len() - 1];
            let (mut edge, mut bend) = (0f64, 0f64);
            for i in 0..v.len() {
                let after = v[(i + 1) % v.len()] - v[i];
                edge = edge.max(after.length_squared());
                bend = bend.max((after - before).length_squared());
                before = after;
            }
            gap.edge = gap.edge.max(edge.sqrt());
            gap.bend = gap.bend.max(bend.sqrt() / (dl * dl));
        }
        gap
    }

    /// Whether no strand passed another while beads moved by at most `way` from the one state to
    /// the other.
    fn safe(self, other: Self, way: f64) -> bool {
        let beads = self.beads.min(other.beads) - way;
        let edge = self.edge.max(other.edge);
        beads > 0. && 2. * beads * beads > edge * edge && self.bend.max(other.bend) < 2.
    }
}

impl Rope {
    /// A rope on `curve`, scaled to R_s = 1, each component requiring its mean edge length.
    pub fn new(mut curve: Curve) -> Self {
        curve.scale(1. / measure(&curve).r_s);
        let dl: Vec<f64> = (0..curve.components())
            .map(|c| curve.component_length(c) / curve.range(c).len() as f64)
            .collect();
        let mut rope = Self {
            curve,
            dl,
            pairs: vec![],
            reference: vec![],
            skin: 0.,
            age: 0,
            gap: Gap::default(),
        };
        rope.skin = rope.longest_dl().powi(2).min(0.5 * THICKEST_SKIN);
        rope.list_neighbours();
        rope
    }

    /// A rope on `n` vertices in all, from one on any number: K_P at equal chords, the first
    /// vertex at random. Where it is `n` already, it is taken as it is.
    ///
    /// # Errors
    /// [`Error::TooFew`], [`Error::TooCoarse`].
    pub fn resampled(curve: &Curve, n: usize, seed: u64) -> Result<Self> {
        let shift = Pcg64Mcg::seed_from_u64(seed).random();
        let same = curve.n() == n;
        let mut resampled = if same { curve.clone() } else { refine(curve, n, shift)? };
        // On the rope as it was, too: longer edges would cut through its strands.
        resampled.scale(1. / measure(curve).r_s);
        let before = resampled.length() / n as f64;
        let rope = Self::new(resampled);
        // At index distance 1 neighbouring beads would have to be 2 R apart.
        let dl = rope.longest_dl().max(before);
        if least_index_distance(dl) < 2 {
            let needed = (measure(curve).l_p / 1.2) as usize + 1;
            return Err(Error::TooCoarse { n, dl, needed });
        }
        Ok(rope)
    }

    /// Whether a restored rope is one: all beads there are, all numbers are finite.
    pub(crate) fn is_sound(&self) -> bool {
        let n = self.curve.n() as u32;
        let Gap { beads, edge, bend } = self.gap;
        self.curve.is_sound()
            && self.dl.len() == self.curve.components()
            && self.dl.iter().all(|dl| dl.is_finite() && *dl > 0.)
            && self.pairs.iter().all(|&(i, j)| i < j && j < n)
            && self.reference.len() == self.curve.n()
            && self.reference.iter().all(|v| v.is_finite())
            && [self.skin, beads, edge, bend].iter().all(|x| x.is_finite() && *x >= 0.)
    }

    /// The curve as it is; its overlaps are those of the last sweep.
    pub fn curve(&self) -> &Curve {
        &self.curve
    }

    /// Mean required edge length.
    pub fn dl(&self) -> f64 {
        self.length() / self.curve.n() as f64
    }

    /// Largest required edge length.
    pub fn longest_dl(&self) -> f64 {
        self.dl.iter().copied().fold(0., f64::max)
    }

    /// Required length of all components together.
    pub fn length(&self) -> f64 {
        self.curve.ranges().zip(&self.dl).map(|(range, dl)| range.len() as f64 * dl).sum()
    }

    /// Multiplies the required edge lengths by `factor`.
    pub fn stretch(&mut self, factor: f64) {
        self.dl.iter_mut().for_each(|dl| *dl *= factor);
    }

    /// Scales the rope's shape and length, not its thickness, by a factor near 1.
    pub fn scale(&mut self, factor: f64) {
        self.curve.scale(factor);
        self.stretch(factor);
        self.list_neighbours();
    }

    /// Moves each bead by a `step()` of at most 0.1 R, unless strands might pass.
    pub fn displace(&mut self, mut step: impl FnMut() -> DVec3) {
        let before = self.gap;
        self.curve.vertices_mut().iter_mut().for_each(|v| *v += step());
        if !Gap::of(&self.curve, &self.dl, &self.pairs).safe(before, 0.1) {
            self.curve.vertices_mut().copy_from_slice(&self.reference);
        }
        self.list_neighbours();
    }

    /// One EE, RO and CC pass. Returns the violations met, or `None` where the sweep was undone.
    pub fn sweep(&mut self, c_1: f64, c_2: f64, epsilon: f64) -> Option<Violation> {
        self.age += 1;
        let mut met = Violation::default();
        let mut longest_edge = 0f64;
        for c in 0..self.dl.len() {
            let (range, dl) = (self.curve.range(c), self.dl[c]);
            let odd_first = self.age % 2 == 1;
            let (dispersion, longest) = equalize_edges(self.share(range), dl, c_1, odd_first);
            met.dispersion = met.dispersion.max(dispersion);
            longest_edge = longest_edge.max(longest);
        }
        met.overlap = remove_overlaps(self.curve.vertices_mut(), &self.pairs, c_2, epsilon);
        for c in 0..self.dl.len() {
            let (range, dl) = (self.curve.range(c), self.dl[c]);
            met.curvature = met.curvature.max(control_curvature(self.share(range), dl));
        }
        let out = self.pull_back();
        let gap = if met.worst().max(epsilon) < HARMLESS {
            // Corrections of a bead after it was met add up to less than this.
            Gap { beads: 1.5, edge: 1.1 * longest_edge, bend: 1.5 }
        } else {
            Gap::of(&self.curve, &self.dl, &self.pairs)
        };
        if !gap.safe(self.gap, self.skin) {
            self.undo();
            return None;
        }
        self.gap = gap;
        if out || self.age == LONG_LIFE {
            let factor = if self.age < SHORT_LIFE { 1.5 } else { 0.8 };
            self.skin = (self.skin * factor).min(THICKEST_SKIN);
            self.list_neighbours();
        }
        Some(met)
    }

    /// Lets all components pull with the same tension, the mean of s_i - dl.
    ///
    /// EE moves a vertex by c_1 (s_i - dl), so this difference is the force along the rope.
    pub fn share_tension(&mut self) {
        let tension: Vec<_> = (0..self.dl.len())
            .map(|c| self.curve.component_length(c) / self.curve.range(c).len() as f64 - self.dl[c])
            .collect();
        let mean = self.curve.ranges().zip(&tension).map(|(r, t)| r.len() as f64 * t).sum::<f64>()
            / self.curve.n() as f64;
        for (dl, t) in self.dl.iter_mut().zip(tension) {
            *dl += 0.1 * (t - mean);
        }
    }

    fn share(&mut self, range: Range<usize>) -> &mut [DVec3] {
        &mut self.curve.vertices_mut()[range]
    }

    /// Keeps the beads where the neighbour list is valid; returns whether one had left.
    fn pull_back(&mut self) -> bool {
        let allowed = 0.5 * self.skin;
        let mut beads = self.curve.vertices().iter().zip(&self.reference);
        if beads.all(|(v, r)| v.distance_squared(*r) <= allowed * allowed) {
            return false;
        }
        for (v, r) in self.curve.vertices_mut().iter_mut().zip(&self.reference) {
            *v = *r + (*v - *r).clamp_length_max(allowed);
        }
        true
    }

    fn undo(&mut self) {
        self.curve.vertices_mut().copy_from_slice(&self.reference);
        self.stretch(1.001);
        self.skin = (0.5 * self.skin).max(THINNEST_SKIN);
        self.list_neighbours();
    }

    fn list_neighbours(&mut self) {
        let least: Vec<_> = self.dl.iter().map(|&dl| least_index_distance(dl)).collect();
        let separation = Separation::by_index(&self.curve, &least);
        let reach = 2. + self.skin;
        let pairs = &mut self.pairs;
        pairs.clear();
        for_each_close_pair(&self.curve, &separation, reach, |i, j, _| {
            pairs.push((i as u32, j as u32));
            reach
        });
        pairs.sort_unstable();
        self.reference.clear();
        self.reference.extend_from_slice(self.curve.vertices());
        self.age = 0;
        self.gap = Gap::of(&self.curve, &self.dl, &self.pairs);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-1f64..1.).prop_map(DVec3::from)
    }

    /// Two edges, their ends in a row, as far apart as they are.
    fn gap([a, b, c, d]: [DVec3; 4]) -> Gap {
        let beads = [(a, c), (a, d), (b, c), (b, d)].map(|(p, q)| p.distance(q));
        let beads = beads.into_iter().fold(2., f64::min);
        Gap { beads, edge: a.distance(b).max(c.distance(d)), bend: 0. }
    }

    #[test]
    fn the_closest_pass_that_there_can_be_is_not_safe() {
        // Two edges at right angles, one above the other, pass through each other in their middles.
        for s in [1e-3, 0.01, 0.1, 0.5, 1., 1.2] {
            for way in [1e-6, 1e-3, 0.1, 0.25] {
                let at = |z: f64| {
                    gap([[-s, 0., z], [s, 0., z], [0., -s, -z], [0., s, -z]]
                        .map(|v| 0.5 * DVec3::from(v)))
                };
                assert!(!at(way).safe(at(-way), way), "{s} {way}");
                // But they may come near.
                assert!(at(way).safe(at(way), 0.));
            }
        }
    }

    proptest! {
        #[test]
        fn edges_that_pass_are_never_safe(
            directions in prop::array::uniform2(vector()),
            ways in prop::array::uniform4(vector()),
            (along, across) in (0f64..1., 0f64..1.),
            when in 0f64..1.,
            speed in 0f64..1.,
        ) {
            // They meet in the origin.
            let [x, y] = directions;
            let meeting = [-along * x, (1. - along) * x, -across * y, (1. - across) * y];
            let at = |t: f64| std::array::from_fn(|k| meeting[k] + speed * (t - when) * ways[k]);
            let way = ways.map(|way| speed * way.length()).into_iter().fold(0., f64::max);
            prop_assert!(!gap(at(0.)).safe(gap(at(1.)), way));
        }
    }

    #[test]
    fn a_rope_bent_to_half_its_radius_is_not_safe() {
        let gap = |bend| Gap { beads: 2., edge: 0.5, bend };
        assert!(gap(1.9).safe(gap(1.9), 0.1));
        assert!(!gap(1.9).safe(gap(2.), 0.1) && !gap(2.).safe(gap(1.9), 0.1));
    }

    #[test]
    fn beads_that_are_not_listed_do_not_overlap() {
        let vertex = |i: usize| {
            let t = std::f64::consts::TAU * i as f64 / 90.;
            let r = 2. + 0.8 * (3. * t).cos();
            DVec3::new(r * (2. * t).cos(), r * (2. * t).sin(), 0.8 * (3. * t).sin())
        };
        let mut rope = Rope::new(Curve::new(vec![(0..90).map(vertex).collect()]).unwrap());
        let mut lists = 0;
        for _ in 0..3000 {
            let (reference, skin) = (rope.reference.clone(), rope.skin);
            rope.stretch(0.999);
            if rope.sweep(0.5, 0.25, 0.05).is_none() {
                continue;
            }
            lists += usize::from(rope.age == 0);
            let v = rope.curve.vertices();
            for (i, (now, then)) in v.iter().zip(reference).enumerate() {
                assert!(now.distance(then) <= 0.5 * skin + 1e-12);
                for (j, other) in v[..i].iter().enumerate() {
                    let listed = || rope.pairs.binary_search(&(j as u32, i as u32)).is_ok();
                    // Required edges get shorter, and beads that are near along the rope count from then on.
                    let near = rope.curve.index_distance(i, j).unwrap() < 20;
                    assert!(near || now.distance(*other) >= 2. - 1e-12 || listed(), "{i} {j}");
                }
            }
        }
        assert!(lists > 5, "{lists}");
    }
}
