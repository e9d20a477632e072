//! One Newton step.
//!
//! With the multipliers' changes eliminated, a step (d, delta) of vertices and edge lengths solves
//! `(sum D grad g grad g^T - z Hess g) (d, delta) = -grad f + sum (mu w/g) grad g`,
//! D = (z - mu w')/g.

use serde::{Deserialize, Serialize};

use super::barrier::Barrier;
use super::direction::Direction;
use super::matrix::{Bordered, Matrix};
use super::problem::{Multipliers, Surroundings, Terms, Unknowns};
use crate::geometry::neighbours::Pair;

/// What is always added to the diagonal, in units of 1/l, since rigid motions are free.
const LEAST_SHIFT: f64 = 1e-9;
/// What is added besides when the matrix is indefinite, four times as much at each new attempt; a
/// fourth of it after a good step, and nothing when it has become small.
const FIRST_SHIFT: f64 = 1e-3;
const NO_SHIFT: f64 = 1e-8;
const HOPELESS_SHIFT: f64 = 1e12;
/// The pattern is analysed with pairs this far beyond the range of the barrier, so that they may
/// come and go.
const SPARE: f64 = 1.3;

/// A change of the unknowns and the multipliers.
pub struct Change {
    pub to: Direction,
    pub dz: Multipliers,
}

/// A Newton step.
pub struct Step {
    pub straight: Change,
    /// Derivative of the barrier function at the start.
    pub slope: f64,
    pub matrix: Bordered,
}

impl Step {
    /// The way of the share `a` of the step, straight or on its `arc`, which adds its square's share.
    pub fn to(&self, a: f64, arc: Option<&Change>) -> Direction {
        let mut to = self.straight.to.clone();
        if let Some(arc) = arc {
            to.add(a, &arc.to);
        }
        to.scale(a);
        to
    }

    /// The change of the multipliers on it.
    pub fn dz(&self, a: f64, arc: Option<&Change>) -> Multipliers {
        let dz = self.straight.dz.map(|dz| a * dz);
        match arc {
            Some(arc) => dz.map_with(&arc.dz, |dz, arc| dz + a * a * arc),
            None => dz,
        }
    }
}

/// What passes from one step to the next.
#[derive(Default, Serialize, Deserialize)]
pub struct Newton {
    shift: f64,
    factorisations: u64,
    matrix: Matrix,
}

impl Newton {
    /// Whether what was restored fits a rope of n beads.
    pub fn is_sound(&self, n: usize) -> bool {
        self.shift >= 0. && self.matrix.is_sound(n)
    }

    /// How many factorisations there have been.
    pub fn factorisations(&self) -> u64 {
        self.factorisations
    }

    /// The step from where `rope` is, `z` being the multipliers of the terms `around` it; `None` if the
    /// matrix is beyond repair.
    pub fn step(
        &mut self,
        rope: &Unknowns,
        around: &Surroundings,
        z: &Multipliers,
        barrier: Barrier,
    ) -> Option<Step> {
        let Surroundings { terms, bystanders } = around;
        let is_near = |pair: &&Pair| rope.contact(**pair).g < SPARE * barrier.hat;
        let soon = bystanders.iter().filter(is_near).copied();
        self.matrix.analyse(&rope.curve, &terms.contacts, soon);
        let stiffness = terms.map_with(z, |t, z| barrier.stiffness(t, *z));
        let bordered = self.matrix.assemble(&rope.curve, terms, &stiffness, z);
        let mut downhill = Direction::lengthening(&rope.curve, -1.);
        terms.iter().for_each(|t| t.push(barrier.force(t), &mut downhill));
        let to = loop {
            self.factorisations += 1;
            let [shift, corner] = [LEAST_SHIFT, 0.].map(|least| (self.shift + least) / rope.l[0]);
            let corner = vec![corner; rope.l.len()];
            if let Some(to) = self.matrix.solve(&bordered, shift, &corner, &downhill) {
                break to;
            }
            self.shift = (4. * self.shift).max(FIRST_SHIFT);
            if self.shift > HOPELESS_SHIFT {
                return None;
            }
        };
        let dz = terms
            .map_with(z, |t, z| barrier.force(t) - z - barrier.stiffness(t, *z) * t.course(&to)[0]);
        let slope = -downhill.dot(&to);
        Some(Step { straight: Change { to, dz }, slope, matrix: bordered })
    }

    /// What makes an arc of the last step: to third order, all that the perturbed conditions are off by falls
    /// to 1 - a of it on the share a, but for what is not quadratic in bends. The factor is that of the step.
    pub fn arc(
        &mut self,
        step: &Step,
        terms: &Terms,
        z: &Multipliers,
        barrier: Barrier,
    ) -> Option<Change> {
        let Change { to: along, dz } = &step.straight;
        let forces = terms.map_with(z, |t, z| barrier.rise(t, *z, t.course(along)));
        let off = terms.map_with(dz, |t, dz| dz * t.course(along)[0] / t.g);
        let off = off.map_with(&forces, |off, rise| off + rise);
        let mut rest = along.clone();
        rest.scale(0.);
        for ((t, dz), off) in terms.iter().zip(dz.iter()).zip(off.iter()) {
            t.turn(*dz, along, &mut rest);
            t.push(-off, &mut rest);
        }
        let to = self.matrix.solve_again(&step.matrix, &rest)?;
        let dz = terms.map_with(z, |t, z| -barrier.stiffness(t, *z) * t.course(&to)[0]);
        Some(Change { to, dz: dz.map_with(&off, |dz, off| dz - off) })
    }

    /// Takes note that the share `a` of the last step was taken.
    pub fn learn(&mut self, a: f64) {
        if a > 0.5 {
            self.shift *= 0.25;
        }
        if self.shift < NO_SHIFT {
            self.shift = 0.;
        }
    }
}

#[cfg(test)]
mod tests {
    use faer::{Mat, Side};
    use glam::DVec3;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::super::barrier::longest_step;
    use super::super::problem::left_over;
    use super::super::term::Term;
    use super::*;
    use crate::beads::COARSE;
    use crate::geometry::curve::Curve;

    const BARRIER: Barrier = Barrier { mu: 0.1, hat: 4. };

    /// Small tangles in a row, two radii apart, the least of so few beads that neighbours of neighbours
    /// are neighbours.
    fn tangles(random: &mut Pcg64Mcg) -> Curve {
        let component = |(c, n): (usize, usize)| {
            let mut vertex = |_| {
                let v: [f64; 3] = std::array::from_fn(|_| random.random_range(0.0..0.4));
                2.5 * c as f64 * DVec3::X + DVec3::from(v)
            };
            (0..n).map(&mut vertex).collect()
        };
        Curve::new([3, 4, 5, 12].into_iter().enumerate().map(component).collect()).unwrap()
    }

    /// The shortest required edges that let a component turn as it does.
    fn shortest(v: &[DVec3]) -> f64 {
        let n = v.len();
        let at = |i: usize| v[i % n];
        let edge = |i: usize| at(i).distance(at(i + 1));
        let bend = |i: usize| (at(i) - 2. * at(i + 1) + at(i + 2)).length().sqrt();
        (0..n).map(|i| edge(i).max(bend(i))).fold(0., f64::max)
    }

    /// A rope, what is around it, and multipliers.
    struct Case {
        rope: Unknowns,
        around: Surroundings,
        z: Multipliers,
    }

    impl Case {
        /// Bends near their limit make the edge lengths' part of the matrix indefinite, contacts that
        /// press hard the vertices'. Some contacts come and some go, so that the pattern has idle pairs,
        /// or is too small.
        fn new(round: usize, random: &mut Pcg64Mcg) -> Self {
            let curve = tangles(random);
            let slack = [3., 1.02][round % 2];
            let hard = [1e-6, 0.1, 30.][round % 3];
            let least = |range| slack * shortest(&curve.vertices()[range]);
            let rope = Unknowns { l: curve.ranges().map(least).collect(), curve };
            let (near, bystanders): (Vec<_>, Vec<_>) =
                close_pairs(&rope).into_iter().partition(|_| random.random_bool(0.7));
            let terms = rope.terms(&near);
            assert!(terms.contacts.len() > 20 && terms.iter().all(|t| t.g > 0.));
            let mut z = terms.map(|t| if t.sign > 0. { hard } else { 1. });
            z.iter_mut().for_each(|z| *z *= 10f64.powf(random.random_range(-1.0..1.)));
            Self { rope, around: Surroundings { terms, bystanders }, z }
        }

        /// The whole matrix for a shift, term by term.
        fn matrix(&self, shift: f64) -> Mat<f64> {
            let (n, size, l) = (3 * self.rope.curve.n(), self.size(), self.rope.l[0]);
            let diagonal = |i| if i < n { (shift + LEAST_SHIFT) / l } else { shift / l };
            let mut matrix = Mat::from_fn(size, size, |i, j| if i == j { diagonal(i) } else { 0. });
            for (t, z) in self.around.terms.iter().zip(self.z.iter()) {
                let (gradient, [_, dw]) = (self.gradient(t), BARRIER.weight(t));
                let stiffness = (z - BARRIER.mu * dw) / t.g;
                for (i, j) in (0..size).flat_map(|i| (0..size).map(move |j| (i, j))) {
                    matrix[(i, j)] += stiffness * gradient[i] * gradient[j];
                }
                for (a, b) in (0..3).flat_map(|a| (0..3).map(move |b| (a, b))) {
                    let second = 2. * t.sign * t.coefficients[a] * t.coefficients[b];
                    let at = |axis| (3 * t.beads[a] + axis, 3 * t.beads[b] + axis);
                    (0..3).for_each(|axis| matrix[at(axis)] -= z * second);
                }
                matrix[(n + t.component, n + t.component)] -= 2. * z * t.h[1];
            }
            matrix
        }

        /// The way down the barrier function.
        fn downhill(&self) -> Vec<f64> {
            let mut downhill = vec![0.; 3 * self.rope.curve.n()];
            downhill.extend(self.rope.curve.ranges().map(|range| -(range.len() as f64)));
            for t in self.around.terms.iter() {
                let force = BARRIER.mu * BARRIER.weight(t)[0] / t.g;
                downhill.iter_mut().zip(self.gradient(t)).for_each(|(sum, g)| *sum += force * g);
            }
            downhill
        }

        fn gradient(&self, t: &Term) -> Vec<f64> {
            let mut gradient = vec![0.; self.size()];
            for (i, part) in t.gradient() {
                (0..3).for_each(|axis| gradient[3 * i + axis] += part[axis]);
            }
            gradient[3 * self.rope.curve.n() + t.component] += t.h[0];
            gradient
        }

        /// By how much the perturbed conditions are off on the share `a` of a step, against 1 - a of what
        /// they were off by.
        fn off(&self, step: &Step, a: f64, arc: Option<&Change>) -> f64 {
            let pairs: Vec<_> = self.around.terms.contacts.iter().map(Term::pair).collect();
            let off_after = |to: &Direction, z: &Multipliers| {
                let rope = self.rope.moved(1., to);
                let terms = rope.terms(&pairs);
                let left = left_over(&rope.curve, &terms, z);
                let products = terms.map_with(z, |t, z| BARRIER.excess(t, *z));
                let beads = left.beads.iter().flat_map(DVec3::to_array);
                beads.chain(left.lengths).chain(products.iter().copied()).collect::<Vec<_>>()
            };
            let z = self.z.map_with(&step.dz(a, arc), |z, dz| z + dz);
            let after = off_after(&step.to(a, arc), &z);
            let before = off_after(&step.to(0., None), &self.z);
            let squares = after.iter().zip(before).map(|(f, f_0)| (f - (1. - a) * f_0).powi(2));
            squares.sum::<f64>().sqrt()
        }

        fn size(&self) -> usize {
            3 * self.rope.curve.n() + self.rope.l.len()
        }

        fn assert_solved(&self, step: &Step, shift: f64) {
            let (matrix, rhs) = (self.matrix(shift), self.downhill());
            let beads = step.straight.to.beads.iter().flat_map(DVec3::to_array);
            let x: Vec<_> = beads.chain(step.straight.to.lengths.iter().copied()).collect();
            let norm = rhs.iter().fold(0f64, |most, b| most.max(b.abs()));
            for (i, b) in rhs.iter().enumerate() {
                let row: f64 = x.iter().enumerate().map(|(j, x)| matrix[(i, j)] * x).sum();
                assert!((row - b).abs() < 1e-8 * norm, "row {i} gives {row}, not {b}");
            }
            let slope = -rhs.iter().zip(&x).map(|(b, x)| b * x).sum::<f64>();
            assert!(slope < 0. && (slope - step.slope).abs() < 1e-9 * slope.abs());
        }
    }

    /// Pairs within the barrier's range, each of two tangles in a row.
    fn close_pairs(rope: &Unknowns) -> Vec<Pair> {
        let n = rope.curve.n() as u32;
        let are_close = |&(i, j): &Pair| {
            let [c, d] = [i, j].map(|i| rope.curve.component_of(i as usize));
            d == c + 1 && rope.contact((i, j)).g < BARRIER.hat
        };
        (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))).filter(are_close).collect()
    }

    fn is_definite(matrix: &Mat<f64>) -> bool {
        matrix.llt(Side::Lower).is_ok()
    }

    #[test]
    fn a_step_solves_the_dense_system() {
        let mut random = Pcg64Mcg::seed_from_u64(2);
        let mut newton = Newton::default();
        let (mut at_once, mut by_blocks, mut by_lengths) = (0, 0, 0);
        for round in 0..60 {
            let case = Case::new(round, &mut random);
            newton.shift = 0.;
            let before = newton.factorisations();
            let step = newton.step(&case.rope, &case.around, &case.z, BARRIER).unwrap();
            case.assert_solved(&step, newton.shift);
            // The shift is 0 if that will do, else the first of its row that does.
            assert!(is_definite(&case.matrix(newton.shift)));
            if newton.factorisations() == before + 1 {
                at_once += 1;
                continue;
            }
            let less = if newton.shift > FIRST_SHIFT { 0.25 * newton.shift } else { 0. };
            let (matrix, n) = (case.matrix(less), 3 * case.rope.curve.n());
            assert!(!is_definite(&matrix));
            let on_beads = Mat::from_fn(n, n, |i, j| matrix[(i, j)]);
            *if is_definite(&on_beads) { &mut by_lengths } else { &mut by_blocks } += 1;
        }
        let times = [at_once, by_blocks, by_lengths];
        assert!(times.iter().all(|&times| times >= 5), "{times:?}");
    }

    #[test]
    fn an_arc_follows_the_perturbed_conditions_to_third_order() {
        let mut random = Pcg64Mcg::seed_from_u64(3);
        let mut newton = Newton::default();
        let mut cases = 0;
        // Of the edges of all others bends are no quadratic.
        for round in (0..120).step_by(2) {
            let case = Case::new(round, &mut random);
            newton.shift = 0.;
            let step = newton.step(&case.rope, &case.around, &case.z, BARRIER).unwrap();
            if newton.shift > 0. || case.rope.l.iter().any(|&l| l < COARSE) {
                continue;
            }
            cases += 1;
            let terms = case.around.terms.iter();
            let share = terms.fold(1f64, |a, t| a.min(longest_step(t, &step.straight.to, 0.5)));
            let arc = newton.arc(&step, &case.around.terms, &case.z, BARRIER).unwrap();
            let [line, arc] = [None, Some(&arc)].map(|arc| case.off(&step, 1e-3 * share, arc));
            assert!(arc < 0.2 * line, "{round}: {arc} on the arc, {line} on the line");
        }
        assert!(cases >= 5, "{cases}");
    }
}
