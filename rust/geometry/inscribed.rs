//! The inscribed knot K_P: arcs tangent to the edges of P, and its sampling at equal chords.
//!
//! Proposition 2 of Baranska, Pieranski, Rawdon, "Ropelength of tight polygonal knots": an arc of
//! radius Rad(v_i) touches both edges at v_i at the distance t_i (half an edge) from it; together
//! the arcs make a C^{1,1} curve, here with straight pieces between arcs where edges are unequal.
//!
//! A coarse polygon need not have the knot type of its K_P: another strand may pass between corner
//! and arc. [`Inscribed::clear_of_strands`] therefore shortens t_i until the ball of radius t_i
//! about v_i meets only the two edges at v_i; these balls are disjoint, and rounding the corners
//! inside them moves no strand through another.

use glam::DVec3;

use crate::geometry::curve::{Curve, turning_angle};
use crate::geometry::sticks::Sticks;

/// The inscribed knot of a curve, all components.
///
/// ```
/// // That of a square of side 2 is its incircle.
/// use glam::DVec3;
/// use sono::geometry::inscribed::Inscribed;
/// let square = [(1., 1.), (-1., 1.), (-1., -1.), (1., -1.)].map(|(x, y)| DVec3::new(x, y, 0.));
/// let inscribed = Inscribed::new(&sono::Curve::new(vec![square.to_vec()])?);
/// assert!((inscribed.lengths().sum::<f64>() - std::f64::consts::TAU).abs() < 1e-14);
/// let (circle, _) = inscribed.sample(&[100], 0.);
/// assert!(circle.vertices().iter().all(|v| (v.length() - 1.).abs() < 1e-14));
/// # Ok::<(), sono::Error>(())
/// ```
pub struct Inscribed {
    components: Vec<Vec<Piece>>,
}

/// The arc at one vertex and the straight piece that follows it.
struct Piece {
    /// Where the arc leaves the edge before the vertex.
    start: DVec3,
    /// Direction of that edge.
    forward: DVec3,
    /// Unit vector towards the arc's centre.
    inward: DVec3,
    angle: f64,
    arc: f64,
    /// Direction of the edge after the vertex.
    onward: DVec3,
    straight: f64,
    /// Arclength at `start`, and the angle by which the curve has turned before.
    at: f64,
    turned: f64,
}

impl Piece {
    fn point(&self, s: f64) -> DVec3 {
        let on_arc = s.min(self.arc);
        let mut point = self.start + (s - on_arc) * self.onward;
        if self.angle > 0. {
            let radius = self.arc / self.angle;
            let half = 0.5 * on_arc / radius;
            point +=
                2. * radius * half.sin() * (half.cos() * self.forward + half.sin() * self.inward);
        } else {
            point += on_arc * self.forward;
        }
        point
    }

    fn length(&self) -> f64 {
        self.arc + self.straight
    }
}

impl Inscribed {
    /// K_P as the paper has it, each arc starting half an edge (the shorter one) from its vertex.
    pub fn new(curve: &Curve) -> Self {
        Self::with_tangents(curve, &half_edges(curve))
    }

    /// K_P with arcs short enough for no other strand to lie between a corner and its arc.
    pub fn clear_of_strands(curve: &Curve) -> Self {
        let mut tangents = half_edges(curve);
        let sticks = Sticks::new(curve);
        for (i, t) in tangents.iter_mut().enumerate() {
            *t = t.min(0.45 * sticks.room(i));
        }
        Self::with_tangents(curve, &tangents)
    }

    fn with_tangents(curve: &Curve, tangents: &[f64]) -> Self {
        let components = curve
            .ranges()
            .map(|range| pieces(&curve.vertices()[range.clone()], &tangents[range]))
            .collect();
        Self { components }
    }

    /// Length of each component.
    pub fn lengths(&self) -> impl Iterator<Item = f64> + '_ {
        self.components.iter().map(|pieces| length(pieces))
    }

    /// The curve of `n[c]` vertices on each component, all chords of a component equal, the first
    /// vertex `shift` edges after the start; and the most that there is of the curve above a chord.
    pub fn sample(&self, n: &[usize], shift: f64) -> (Curve, Above) {
        let mut most = Above::default();
        let mut equal = |(pieces, &n)| {
            let (vertices, above) = equal_chords(pieces, n, shift);
            most = most.max(above);
            vertices
        };
        let sampled = self.components.iter().map(Vec::as_slice).zip(n).map(&mut equal).collect();
        (Curve::from_components(sampled), most)
    }
}

/// The angle by which a curve turns in all above a chord, and its length there.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Above {
    /// The angle.
    pub turn: f64,
    /// The length.
    pub arc: f64,
}

impl Above {
    fn max(self, other: Self) -> Self {
        Self { turn: self.turn.max(other.turn), arc: self.arc.max(other.arc) }
    }
}

fn half_edges(curve: &Curve) -> Vec<f64> {
    let mut halves = Vec::with_capacity(curve.n());
    for c in 0..curve.components() {
        let edges: Vec<_> = curve.edge_lengths(c).collect();
        halves.extend(
            (0..edges.len())
                .map(|i| 0.5 * edges[i].min(edges[(i + edges.len() - 1) % edges.len()])),
        );
    }
    halves
}

fn pieces(v: &[DVec3], tangents: &[f64]) -> Vec<Piece> {
    let n = v.len();
    let (mut at, mut turned) = (0., 0.);
    (0..n)
        .map(|i| {
            let forward = (v[i] - v[(i + n - 1) % n]).normalize();
            let after = v[(i + 1) % n] - v[i];
            let onward = after.normalize();
            let angle = turning_angle(forward, onward);
            let half_tan = (0.5 * angle).tan();
            let t = tangents[i];
            let piece = Piece {
                start: v[i] - t * forward,
                forward,
                inward: onward.reject_from_normalized(forward).normalize_or_zero(),
                angle,
                arc: if half_tan > 0. { t * angle / half_tan } else { 2. * t },
                onward,
                straight: (after.length() - t - tangents[(i + 1) % n]).max(0.),
                at,
                turned,
            };
            at += piece.length();
            turned += angle;
            piece
        })
        .collect()
}

fn length(pieces: &[Piece]) -> f64 {
    pieces.last().map_or(0., |p| p.at + p.length())
}

/// Finds the chord that leads once around in exactly `n` steps, by the secant method.
fn equal_chords(pieces: &[Piece], n: usize, shift: f64) -> (Vec<DVec3>, Above) {
    let around = length(pieces);
    let first = around / n as f64;
    let start = shift * first;
    let mut walk = Walk { pieces, around, points: Vec::with_capacity(n), above: Above::default() };
    let mut chords = [first, first * (1. - 1e-3)];
    let mut gaps = chords.map(|chord| walk.gap(start, chord, n));
    for _ in 0..50 {
        let [(a, gap_a), (b, gap_b)] = [(chords[0], gaps[0]), (chords[1], gaps[1])];
        if gap_b.abs() <= 1e-14 * around || gap_a == gap_b {
            break;
        }
        let chord = (b - gap_b * (b - a) / (gap_b - gap_a)).clamp(0.5 * b, 2. * b);
        chords = [b, chord];
        gaps = [gap_b, walk.gap(start, chord, n)];
    }
    (walk.points, walk.above)
}

struct Walk<'a> {
    pieces: &'a [Piece],
    around: f64,
    points: Vec<DVec3>,
    above: Above,
}

impl Walk<'_> {
    /// Takes `n` steps of equal chords and returns by how much arclength they lead too far.
    fn gap(&mut self, start: f64, chord: f64, n: usize) -> f64 {
        self.points.clear();
        self.above = Above::default();
        let mut s = start;
        let mut at = self.pieces.partition_point(|p| p.at <= start).max(1) - 1;
        let mut point = self.point(&mut at, s);
        let mut turned = self.turned(at, s);
        for _ in 0..n {
            self.points.push(point);
            let from = (s, turned);
            s += chord;
            // The chord grows as fast as the arc, up to second order, so this converges quickly.
            for _ in 0..40 {
                point = self.point(&mut at, s);
                let missing = chord - point.distance(self.points[self.points.len() - 1]);
                s = (s + missing).clamp(from.0 + chord, from.0 + 3. * chord);
                if missing.abs() <= f64::EPSILON * self.around {
                    break;
                }
            }
            turned = self.turned(at, s);
            self.above = self.above.max(Above { turn: turned - from.1, arc: s - from.0 });
        }
        s - start - self.around
    }

    /// The angle by which the curve has turned from its start to arclength `s`, in the piece `at`.
    fn turned(&self, at: usize, s: f64) -> f64 {
        let turns = (s / self.around).floor();
        let (piece, last) = (&self.pieces[at], &self.pieces[self.pieces.len() - 1]);
        let on_arc = ((s - turns * self.around - piece.at) / piece.arc).clamp(0., 1.);
        turns * (last.turned + last.angle) + piece.turned + on_arc * piece.angle
    }

    /// The point at arclength `s`; `at` remembers the piece, since steps go forward.
    fn point(&self, at: &mut usize, s: f64) -> DVec3 {
        let turns = (s / self.around).floor();
        let s = s - turns * self.around;
        let n = self.pieces.len();
        if s + 0.5 * self.around < self.pieces[*at].at {
            *at = 0;
        }
        while s < self.pieces[*at].at {
            *at -= 1;
        }
        while *at + 1 < n && s >= self.pieces[*at + 1].at {
            *at += 1;
        }
        self.pieces[*at].point(s - self.pieces[*at].at)
    }
}
