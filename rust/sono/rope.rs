//! The bead rope that a sweep acts on: vertices, required edge lengths, and the neighbour list.
//!
//! **No strand may pass another.** Beads closer than 2 + skin when the list was made are listed.
//! Until the next list no bead leaves the ball of radius skin/2 about its place of that time (a step
//! that leads out of it ends on its surface, and a new list is made). So beads that are not listed
//! never overlap. Before the new list the straight way from the old places to the new ones is looked
//! at as a whole: if a strand may pass another on it ([`crate::passage`]), all is undone that followed
//! the last list. So it is, too, before the rope is looked at in any other way that matters.

use std::ops::Range;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::beads::least_index_distance;
use crate::geometry::curve::Curve;
use crate::geometry::neighbours::{Pair, close_pairs};
use crate::geometry::separation::Separation;
use crate::geometry::sticks::Sticks;
use crate::measures::measure;
use crate::passage::{Passages, margin};
use crate::sono::procedures::{control_curvature, equalize_edges, remove_overlaps};

/// The thickest skin of the neighbour list, hence the longest way of a bead in one sweep.
const THICKEST_SKIN: f64 = 0.25;
/// The thinnest, a skin that can still grow again.
const THINNEST_SKIN: f64 = 1e-9;

/// A list that lasts fewer sweeps gets a thicker skin, any other a thinner one; the thinner the skin
/// the shorter the list. One that lasts so long is made anew to learn whether a thinner one will do.
const SHORT_LIFE: usize = 150;
const LONG_LIFE: usize = 500;

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
///
/// ```
/// use glam::DVec3;
/// use sono::sono::rope::Rope;
/// let angle = |i: usize| std::f64::consts::TAU * i as f64 / 60.;
/// let ring = (0..60).map(|i| DVec3::new(3. * angle(i).cos(), 2. * angle(i).sin(), 0.));
/// let mut rope = Rope::new(sono::Curve::new(vec![ring.collect()])?);
/// let before = rope.length();
/// rope.stretch(0.99);
/// // The edges are still too long, by what they were unequal and a hundredth.
/// assert!(rope.sweep(0.5, 0.5, 0.).expect("no strand passes").dispersion > 0.01);
/// assert!(rope.length() < before);
/// # Ok::<(), sono::Error>(())
/// ```
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Rope {
    curve: Curve,
    /// Required edge length of each component.
    dl: Vec<f64>,
    pairs: Vec<Pair>,
    /// Least index distance of listed beads, for each component.
    least: Vec<usize>,
    /// Where the beads were when `pairs` was made.
    reference: Vec<DVec3>,
    skin: f64,
    /// Sweeps since `pairs` was made.
    age: usize,
    /// How often in a row all was undone that followed a list.
    undone: u64,
    /// What was shown of all that followed a list, and how many sweeps were undone.
    passages: Passages,
    lost: u64,
}

impl Rope {
    /// A rope on `curve`, scaled to R_s = 1, each component requiring its mean edge length.
    pub fn new(mut curve: Curve) -> Self {
        curve.scale(1. / measure(&curve).r_s);
        Self::of(curve)
    }

    /// The same on a curve as it is, whose thickness R_s is 1 or about to be.
    pub fn of(curve: Curve) -> Self {
        let dl = curve.mean_edges().collect();
        let mut rope = Self {
            curve,
            dl,
            pairs: vec![],
            least: vec![],
            reference: vec![],
            skin: 0.,
            age: 0,
            undone: 0,
            passages: Passages::default(),
            lost: 0,
        };
        rope.skin = rope.longest_dl().powi(2).min(0.5 * THICKEST_SKIN);
        rope.list_neighbours();
        rope
    }

    /// What becomes of the rope on `curve`, a rope of its type: one of R_s = 1 that counts on.
    pub fn followed_by(&self, curve: Curve) -> Self {
        Self { passages: self.passages, lost: self.lost, ..Self::new(curve) }
    }

    /// Whether a restored rope is one: all beads there are, all numbers are finite.
    pub(crate) fn is_sound(&self) -> bool {
        let n = self.curve.n() as u32;
        self.curve.is_sound()
            && self.dl.len() == self.curve.components()
            && self.dl.iter().all(|dl| dl.is_finite() && *dl > 0.)
            && self.pairs.iter().all(|&(i, j)| i < j && j < n)
            && self.reference.len() == self.curve.n()
            && self.reference.iter().all(|v| v.is_finite())
            && self.least.len() == self.curve.components()
            && self.skin.is_finite()
            && self.skin >= 0.
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
        self.undo_unless_apart();
        self.curve.scale(factor);
        self.stretch(factor);
        self.list_neighbours();
    }

    /// Moves one bead after the other by a `step()`, unless a strand is in the way.
    pub fn displace(&mut self, mut step: impl FnMut() -> DVec3) {
        self.undo_unless_apart();
        let mut sticks = Sticks::new(&self.curve);
        for i in 0..self.curve.n() {
            sticks.shift(i, sticks.point(i) + step());
        }
        self.curve = sticks.curve();
        self.list_neighbours();
    }

    /// Undoes all that followed the last list if a strand might have passed another, and makes a new
    /// list; returns whether none might.
    pub fn confirm(&mut self) -> bool {
        let apart = self.undo_unless_apart();
        if apart {
            self.list_neighbours();
        }
        apart
    }

    /// The same without the new list, which the caller makes.
    fn undo_unless_apart(&mut self) -> bool {
        // Two beads that are not listed were 2 + skin apart and each came skin/2 closer.
        let pairs = self.pairs.iter().copied();
        let found = margin(&self.reference, &self.curve, &self.least, pairs, 2.);
        let apart = if self.age == 0 { found.is_some() } else { self.passages.may(found) };
        if apart {
            self.undone = 0;
        } else {
            self.undone += 1;
            self.lost += self.age as u64;
            self.undo();
        }
        apart
    }

    /// How often in a row all was undone that followed a list.
    pub fn undone(&self) -> u64 {
        self.undone
    }

    /// What was shown of the moves so far, each from one list to the next.
    pub fn passages(&self) -> Passages {
        self.passages
    }

    /// How many sweeps were undone.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// One EE, RO and CC pass. Returns the violations met, or `None` where all was undone that
    /// followed the last list.
    pub fn sweep(&mut self, c_1: f64, c_2: f64, epsilon: f64) -> Option<Violation> {
        self.age += 1;
        let mut met = Violation::default();
        for c in 0..self.dl.len() {
            let (range, dl) = (self.curve.range(c), self.dl[c]);
            let odd_first = self.age % 2 == 1;
            let dispersion = equalize_edges(self.share(range), dl, c_1, odd_first);
            met.dispersion = met.dispersion.max(dispersion);
        }
        met.overlap = remove_overlaps(self.curve.vertices_mut(), &self.pairs, c_2, epsilon);
        for c in 0..self.dl.len() {
            let (range, dl) = (self.curve.range(c), self.dl[c]);
            met.curvature = met.curvature.max(control_curvature(self.share(range), dl));
        }
        if self.pull_back() || self.age == LONG_LIFE {
            let factor = if self.age < SHORT_LIFE { 1.5 } else { 0.8 };
            if !self.undo_unless_apart() {
                return None;
            }
            self.skin = (self.skin * factor).min(THICKEST_SKIN);
            self.list_neighbours();
        }
        Some(met)
    }

    /// Lets all components pull with the same tension, the mean of s_i - dl.
    ///
    /// EE moves a vertex by c_1 (s_i - dl), so this difference is the force along the rope.
    pub fn share_tension(&mut self) {
        let tension: Vec<_> =
            self.curve.mean_edges().zip(&self.dl).map(|(mean, dl)| mean - dl).collect();
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
        self.least = self.dl.iter().map(|&dl| least_index_distance(dl)).collect();
        let separation = Separation::by_index(&self.curve, &self.least);
        self.pairs = close_pairs(&self.curve, &separation, 2. + self.skin);
        self.reference.clear();
        self.reference.extend_from_slice(self.curve.vertices());
        self.age = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let (reference, skin, least) = (rope.reference.clone(), rope.skin, rope.least[0]);
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
                    let near = rope.curve.index_distance(i, j).unwrap() < least.max(rope.least[0]);
                    assert!(near || now.distance(*other) >= 2. - 1e-12 || listed(), "{i} {j}");
                }
            }
        }
        assert!(lists > 5, "{lists}");
    }
}
