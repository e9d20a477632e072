//! One Newton step, and the matrix it needs: 3x3 blocks bordered by the edge lengths.
//!
//! With the multipliers' changes eliminated, a step (d, delta) of vertices and edge lengths solves
//! `(sum D grad g grad g^T - z Hess g) (d, delta) = -grad f + sum (mu w/g) grad g`,
//! D = (z - mu w')/g. The edge lengths are few, so they are eliminated last.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::problem::Term;
use super::system::{Symmetric, System, symmetric};
use crate::geometry::curve::Curve;

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

/// A step of the vertices, the edge lengths and the multipliers.
pub struct Step {
    pub d: Vec<DVec3>,
    pub delta: Vec<f64>,
    pub dz: Vec<f64>,
    /// Derivative of the barrier function along (d, delta).
    pub slope: f64,
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
        self.shift >= 0.
            && self.matrix.pairs.is_sorted_by(|a, b| a < b)
            && self.matrix.pairs.iter().all(|&(i, j)| i < j && (j as usize) < n)
    }

    /// How many factorisations there have been.
    pub fn factorisations(&self) -> u64 {
        self.factorisations
    }

    /// The step for barrier parameter `mu` and contact range `hat`, `z` being the multipliers of
    /// `terms`; `None` if the matrix is beyond repair. `bystanders` are pairs that may be contacts soon.
    pub fn step(
        &mut self,
        curve: &Curve,
        l: &[f64],
        terms: &[Term],
        z: &[f64],
        (mu, hat): (f64, f64),
        bystanders: &[(u32, u32)],
    ) -> Option<Step> {
        let soon = bystanders
            .iter()
            .copied()
            .filter(|&(i, j)| Term::contact(curve.vertices(), i, j).g < SPARE * hat);
        self.matrix.analyse(curve, &terms[2 * curve.n()..], soon);
        let weights: Vec<_> = terms.iter().map(|t| t.weight(hat)).collect();
        let stiffness: Vec<_> = terms
            .iter()
            .zip(z)
            .zip(&weights)
            .map(|((t, z), (_, dw))| (z - mu * dw) / t.g)
            .collect();
        let bordered = self.matrix.assemble(curve, terms, &stiffness, z);
        let mut d = vec![DVec3::ZERO; curve.n()];
        let mut delta: Vec<_> = curve.ranges().map(|range| -(range.len() as f64)).collect();
        for (t, (w, _)) in terms.iter().zip(&weights) {
            let force = mu * w / t.g;
            t.gradient().for_each(|(i, gradient)| d[i] += force * gradient);
            delta[t.component] += force * t.h[0];
        }
        let downhill = (d.clone(), delta.clone());
        loop {
            self.factorisations += 1;
            let shift = (self.shift + LEAST_SHIFT) / l[0];
            let corner: Vec<_> = bordered.corner.iter().map(|c| c + self.shift / l[0]).collect();
            if self.matrix.factor(&bordered, shift)
                && self.matrix.solve(&bordered.border, &corner, &mut d, &mut delta)
            {
                break;
            }
            self.shift = (4. * self.shift).max(FIRST_SHIFT);
            if self.shift > HOPELESS_SHIFT {
                return None;
            }
            (d, delta) = downhill.clone();
        }
        let slope =
            -dot(&downhill.0, &d) - downhill.1.iter().zip(&delta).map(|(a, b)| a * b).sum::<f64>();
        let dz = (0..terms.len())
            .map(|k| {
                let [along, _] = terms[k].course(&d, &delta);
                mu * weights[k].0 / terms[k].g - z[k] - stiffness[k] * along
            })
            .collect();
        Some(Step { d, delta, dz, slope })
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

/// The matrix of a rope, analysed for a set of contacts.
#[derive(Default, Serialize, Deserialize)]
pub struct Matrix {
    /// The pairs of beads it was analysed for, sorted.
    pairs: Vec<(u32, u32)>,
    /// Made anew from the pairs after a restart.
    #[serde(skip)]
    system: Option<System>,
}

/// The numbers of a matrix: its blocks, and the rows and the corner of the edge lengths.
pub struct Bordered {
    blocks: Vec<Symmetric>,
    pub border: Vec<Vec<DVec3>>,
    pub corner: Vec<f64>,
}

impl Matrix {
    /// Makes room for `contacts`, in the order of their beads, and with them for those to come `soon`.
    pub fn analyse(
        &mut self,
        curve: &Curve,
        contacts: &[Term],
        soon: impl Iterator<Item = (u32, u32)>,
    ) {
        let pair = |t: &Term| (t.beads[0] as u32, t.beads[1] as u32);
        let n = curve.n();
        let mut known = self.pairs.iter();
        let idle = self.pairs.len().saturating_sub(contacts.len());
        let fits = contacts.iter().all(|t| known.any(|&known| known == pair(t)));
        if !fits || 3 * idle > self.pairs.len() + 2 * n {
            self.pairs = contacts.iter().map(pair).chain(soon).collect();
            self.pairs.sort_unstable();
            self.system = None;
        }
        self.system.get_or_insert_with(|| {
            let neighbours = (0..n).map(|i| [i, curve.next(i)]);
            let seconds = (0..n).map(|i| [curve.prev(i), curve.next(i)]);
            let contacts = self.pairs.iter().map(|&(i, j)| [i as usize, j as usize]);
            System::new(n, &neighbours.chain(seconds).chain(contacts).collect::<Vec<_>>())
        });
    }

    /// The sum of `stiffness` grad g grad g^T - `z` Hess g over all terms.
    pub fn assemble(
        &self,
        curve: &Curve,
        terms: &[Term],
        stiffness: &[f64],
        z: &[f64],
    ) -> Bordered {
        let n = curve.n();
        let mut blocks = vec![[0.; 6]; 3 * n + self.pairs.len()];
        let mut border = vec![vec![DVec3::ZERO; n]; curve.components()];
        let mut corner = vec![0.; curve.components()];
        let mut pair = 0;
        for (k, ((t, d), z)) in terms.iter().zip(stiffness).zip(z).enumerate() {
            let m = symmetric(t.y, 4. * d, -2. * t.sign * z);
            let [i, j, e] = t.beads;
            let (ends, between): (_, &[_]) = if k < n {
                ([(i, 1.), (j, 1.), (i, 0.)], &[(n + i, -1.)])
            } else if k < 2 * n {
                let seconds = 2 * n + j;
                ([(i, 1.), (j, 4.), (e, 1.)], &[(n + i, -2.), (n + j, -2.), (seconds, 1.)])
            } else {
                while self.pairs[pair] != (i as u32, j as u32) {
                    pair += 1;
                }
                ([(i, 1.), (j, 1.), (i, 0.)], &[(3 * n + pair, -1.)])
            };
            for (block, factor) in ends.iter().chain(between) {
                blocks[*block].iter_mut().zip(m).for_each(|(sum, m)| *sum += factor * m);
            }
            let c = t.component;
            t.gradient().for_each(|(i, gradient)| border[c][i] += d * t.h[0] * gradient);
            corner[c] += d * t.h[0] * t.h[0] - 2. * z * t.h[1];
        }
        Bordered { blocks, border, corner }
    }

    /// Factors the blocks with `shift` added to their diagonal; returns whether they are definite.
    pub fn factor(&mut self, bordered: &Bordered, shift: f64) -> bool {
        self.system.as_mut().expect("analysed before").factor(&bordered.blocks, shift)
    }

    /// Solves for (d, delta), given the right-hand side in them; returns whether the whole matrix is
    /// positive definite.
    pub fn solve(
        &mut self,
        border: &[Vec<DVec3>],
        corner: &[f64],
        d: &mut Vec<DVec3>,
        delta: &mut [f64],
    ) -> bool {
        let system = self.system.as_mut().expect("analysed before");
        let columns: Vec<_> = border.iter().map(|column| system.solve(column)).collect();
        *d = system.solve(d);
        let k = corner.len();
        let schur = Mat::from_fn(k, k, |i, j| {
            (if i == j { corner[i] } else { 0. }) - dot(&border[i], &columns[j])
        });
        let Ok(factor) = schur.llt(Side::Lower) else { return false };
        let solved = factor.solve(Mat::from_fn(k, 1, |i, _| delta[i] - dot(&border[i], d)));
        for (i, column) in columns.iter().enumerate() {
            delta[i] = solved[(i, 0)];
            d.iter_mut().zip(column).for_each(|(d, column)| *d -= delta[i] * *column);
        }
        true
    }
}

fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::super::problem::chain_terms;
    use super::*;

    const MU: f64 = 0.1;
    const HAT: f64 = 4.;

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

    /// The whole matrix, its terms' gradients and second derivatives one by one, and the right-hand side.
    fn dense(
        curve: &Curve,
        terms: &[Term],
        z: &[f64],
        [shift, corner_shift]: [f64; 2],
    ) -> (Mat<f64>, Vec<f64>) {
        let n = 3 * curve.n();
        let size = n + curve.components();
        let mut matrix = Mat::from_fn(size, size, |i, j| match i == j {
            true if i < n => shift,
            true => corner_shift,
            false => 0.,
        });
        let mut rhs = vec![0.; size];
        for (c, range) in curve.ranges().enumerate() {
            rhs[n + c] = -(range.len() as f64);
        }
        for (t, z) in terms.iter().zip(z) {
            let (w, dw) = t.weight(HAT);
            let stiffness = (z - MU * dw) / t.g;
            let mut gradient = vec![0.; size];
            for (i, part) in t.gradient() {
                (0..3).for_each(|axis| gradient[3 * i + axis] += part[axis]);
            }
            gradient[n + t.component] += t.h[0];
            for i in 0..size {
                rhs[i] += MU * w / t.g * gradient[i];
                (0..size).for_each(|j| matrix[(i, j)] += stiffness * gradient[i] * gradient[j]);
            }
            for (a, ca) in t.beads.into_iter().zip(t.coefficients) {
                for (b, cb) in t.beads.into_iter().zip(t.coefficients) {
                    (0..3)
                        .for_each(|x| matrix[(3 * a + x, 3 * b + x)] -= 2. * z * t.sign * ca * cb);
                }
            }
            matrix[(n + t.component, n + t.component)] -= 2. * z * t.h[1];
        }
        (matrix, rhs)
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
            let curve = tangles(&mut random);
            let n = curve.n() as u32;
            let pairs: Vec<_> = (0..n)
                .flat_map(|i| (i + 1..n).map(move |j| (i, j)))
                .filter(|&(i, j)| {
                    let [c, d] = [i, j].map(|i| curve.component_of(i as usize));
                    d == c + 1 && Term::contact(curve.vertices(), i, j).g < HAT
                })
                .collect();
            // Some come and some go, so that the pattern has idle pairs, or is too small.
            let (near, far): (Vec<_>, Vec<_>) =
                pairs.iter().copied().partition(|_| random.random_bool(0.7));
            // Bends near their limit make the edge lengths' part indefinite, contacts that press hard
            // the vertices'.
            let slack = [3., 1.02][round % 2];
            let hard = [1e-6, 0.1, 30.][round % 3];
            let l: Vec<_> =
                curve.ranges().map(|range| slack * shortest(&curve.vertices()[range])).collect();
            let contacts = near.iter().map(|&(i, j)| Term::contact(curve.vertices(), i, j));
            let terms: Vec<_> = chain_terms(&curve, &l).chain(contacts).collect();
            assert!(terms.len() > 2 * curve.n() + 20 && terms.iter().all(|t| t.g > 0.));
            let draw = |t: &Term| {
                10f64.powf(random.random_range(-1.0..1.)) * if t.sign > 0. { hard } else { 1. }
            };
            let z: Vec<_> = terms.iter().map(draw).collect();

            newton.shift = 0.;
            let before = newton.factorisations();
            let step = newton.step(&curve, &l, &terms, &z, (MU, HAT), &far).unwrap();
            let shifts = |shift: f64| [(shift + LEAST_SHIFT) / l[0], shift / l[0]];
            let (matrix, rhs) = dense(&curve, &terms, &z, shifts(newton.shift));
            let x: Vec<_> = step
                .d
                .iter()
                .flat_map(|d| d.to_array())
                .chain(step.delta.iter().copied())
                .collect();
            let norm = rhs.iter().fold(0f64, |most, b| most.max(b.abs()));
            for (i, b) in rhs.iter().enumerate() {
                let row: f64 = x.iter().enumerate().map(|(j, x)| matrix[(i, j)] * x).sum();
                assert!((row - b).abs() < 1e-8 * norm, "{round}: row {i} gives {row}, not {b}");
            }
            let slope = -rhs.iter().zip(&x).map(|(b, x)| b * x).sum::<f64>();
            assert!(slope < 0. && (slope - step.slope).abs() < 1e-9 * slope.abs());

            // The shift is 0 if that will do, else the first of its row that does.
            assert!(is_definite(&matrix));
            if newton.factorisations() == before + 1 {
                at_once += 1;
            } else {
                let less = if newton.shift > FIRST_SHIFT { 0.25 * newton.shift } else { 0. };
                let (matrix, _) = dense(&curve, &terms, &z, shifts(less));
                assert!(!is_definite(&matrix));
                let blocks = Mat::from_fn(3 * curve.n(), 3 * curve.n(), |i, j| matrix[(i, j)]);
                if is_definite(&blocks) {
                    by_lengths += 1;
                } else {
                    by_blocks += 1;
                }
            }
        }
        let times = [at_once, by_blocks, by_lengths];
        assert!(times.iter().all(|&times| times >= 5), "{times:?}");
    }
}
