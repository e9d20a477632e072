//! The tight rope as an optimisation problem, R = 1.
//!
//! Unknowns are the vertices and one edge length l a component. The length of the rope, the sum of
//! n l, is to be least while all edges, bends and contacts ([`super::term`]) are at least 0.

use serde::{Deserialize, Serialize};

use super::direction::Direction;
use super::term::Term;
use crate::geometry::curve::Curve;
use crate::geometry::neighbours::Pair;

/// Something for each constraint, say its multiplier.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Grouped<T> {
    /// For the edge after each bead.
    pub edges: Vec<T>,
    /// For the bend at each bead.
    pub bends: Vec<T>,
    /// For each pair of beads in contact, sorted.
    pub contacts: Vec<T>,
}

/// The constraints where the rope is.
pub type Terms = Grouped<Term>;
/// Forces, in units of the rope's tension and halved: that of a term is 2 z |y|.
pub type Multipliers = Grouped<f64>;

impl<T> Grouped<T> {
    /// All of them, edges first and contacts last.
    pub fn iter(&self) -> impl Iterator<Item = &T> + Clone {
        self.edges.iter().chain(&self.bends).chain(&self.contacts)
    }

    /// The same, to be changed.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.edges.iter_mut().chain(&mut self.bends).chain(&mut self.contacts)
    }

    /// What `f` makes of each.
    pub fn map<U>(&self, f: impl Fn(&T) -> U) -> Grouped<U> {
        let group = |group: &[T]| group.iter().map(&f).collect();
        Grouped {
            edges: group(&self.edges),
            bends: group(&self.bends),
            contacts: group(&self.contacts),
        }
    }

    /// What `f` makes of each and what another has in its place.
    pub fn map_with<U, V>(&self, other: &Grouped<U>, f: impl Fn(&T, &U) -> V) -> Grouped<V> {
        let group = |a: &[T], b: &[U]| a.iter().zip(b).map(|(a, b)| f(a, b)).collect();
        Grouped {
            edges: group(&self.edges, &other.edges),
            bends: group(&self.bends, &other.bends),
            contacts: group(&self.contacts, &other.contacts),
        }
    }
}

/// The unknowns: where a rope is, and how long its edges are required to be.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Unknowns {
    /// The vertices.
    pub curve: Curve,
    /// The edge length of each component.
    pub l: Vec<f64>,
}

impl Unknowns {
    /// A curve, each component's edges being as long as its longest.
    pub fn new(curve: Curve) -> Self {
        Self { l: curve.longest_edges().collect(), curve }
    }

    /// What is to be least.
    pub fn length(&self) -> f64 {
        self.curve.ranges().zip(&self.l).map(|(range, l)| range.len() as f64 * l).sum()
    }

    /// The longest required edge.
    pub fn longest(&self) -> f64 {
        self.l.iter().copied().fold(0., f64::max)
    }

    /// Where a step leads, the share `a` of it being taken.
    pub fn moved(&self, a: f64, step: &Direction) -> Self {
        let mut moved = self.clone();
        let vertices = moved.curve.vertices_mut().iter_mut();
        vertices.zip(&step.beads).for_each(|(v, d)| *v += a * *d);
        moved.l.iter_mut().zip(&step.lengths).for_each(|(l, d)| *l += a * d);
        moved
    }

    /// The edge after each bead.
    pub fn edges(&self) -> impl Iterator<Item = Term> {
        let v = self.curve.vertices();
        self.corners().map(|(c, [_, i, j])| Term::edge(v, [i, j], c, self.l[c]))
    }

    /// The bend at each bead.
    pub fn bends(&self) -> impl Iterator<Item = Term> {
        let v = self.curve.vertices();
        self.corners().map(|(c, beads)| Term::bend(v, beads, c, self.l[c]))
    }

    /// The contact of two beads.
    pub fn contact(&self, pair: Pair) -> Term {
        Term::contact(self.curve.vertices(), pair)
    }

    /// All edges and bends, and the contacts of these pairs.
    pub fn terms(&self, pairs: &[Pair]) -> Terms {
        Terms {
            edges: self.edges().collect(),
            bends: self.bends().collect(),
            contacts: pairs.iter().map(|&pair| self.contact(pair)).collect(),
        }
    }

    /// Each bead's component, and the bead before it, itself, and the one after.
    fn corners(&self) -> impl Iterator<Item = (usize, [usize; 3])> {
        self.curve.ranges().enumerate().flat_map(|(c, range)| {
            let (start, n) = (range.start, range.len());
            (0..n).map(move |k| (c, [k + n - 1, k, k + 1].map(|k| start + k % n)))
        })
    }
}

/// What a step of a rope has to look at.
pub struct Surroundings {
    pub terms: Terms,
    /// Pairs beyond the range of the barrier that a step might yet bring together, sorted.
    pub bystanders: Vec<Pair>,
}

/// grad f - sum `z` grad g: what is left over of the forces on each bead and each edge length.
pub fn left_over(curve: &Curve, terms: &Terms, z: &Multipliers) -> Direction {
    let mut left = Direction::lengthening(curve, 1.);
    terms.iter().zip(z.iter()).for_each(|(t, z)| t.push(-z, &mut left));
    left
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn gradients_are_derivatives() {
        let v: Vec<_> = (0..5).map(|i| DVec3::new(0.3 * i as f64, (i * i) as f64, 1.)).collect();
        let rope = Unknowns { curve: Curve::new(vec![v]).unwrap(), l: vec![7.] };
        let beads = (0..5).map(|i| DVec3::new(1., i as f64, -0.5)).collect();
        let (step, a) = (Direction { beads, lengths: vec![0.3] }, 1e-3);
        let (before, after) = (rope.terms(&[(0, 3)]), rope.moved(a, &step).terms(&[(0, 3)]));
        assert_eq!(before.iter().count(), 11);
        for (t, t_after) in before.iter().zip(after.iter()) {
            let [b, c] = t.course(&step);
            let slope: f64 = t.gradient().map(|(i, g)| g.dot(step.beads[i])).sum();
            assert!((slope + t.h[0] * step.lengths[0] - b).abs() < 1e-9 * b.abs().max(1.));
            let expected = t.g + a * b + a * a * c;
            assert!((t_after.g - expected).abs() < 1e-6 * a * rope.l[0].powi(4));
        }
    }
}
