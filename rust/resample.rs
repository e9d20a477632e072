//! From any curve to n equal edges: vertices at equal chords of its inscribed knot K_P.
//!
//! **The type stays what it is**, P -> K_P -> chords, though beads are put to new places. Let R_c be the
//! thickness of K_P.
//!
//! 1. *P -> K_P.* Where R_c is measured, by the theorem of `docs/explanation/theorem.md`. Else the curve goes through
//!    [`Inscribed::clear_of_strands`], which has its own proof.
//! 2. *K_P -> chords above which no arc is longer than 1.5 R_c.* Let R_c = 1, and T be the tangent at a place
//!    a of an arc of the length l <= 1.5 above a chord w. All tangents of the arc are within l < pi/2 of T, so
//!    w.T > 0, and the ends of the chord are on both sides of the plane normal to T at a: it meets the chord
//!    once, in x say. With N the direction from a to x, the ends are at most 1 - cos l from a along N, as a
//!    tangent turns from T to N by its distance from a at most; so |x - a| <= 1 - cos 1.5 < 0.93. So a can go
//!    straight to x within the disk of radius 1 normal to K_P at a. These disks do not meet, so no two places do,
//!    and all the time the curve is embedded.
//! 3. *K_P -> longer chords.* First as in 2, then vertices are removed one by one ([`coarsen`]), each by an
//!    exact isotopy.
//! 4. *A curve without R_c -> chords c* ([`rope_curve`]). The polygon Q of chords is measured: its radii M and
//!    half distances are at least r_s >= c/0.55. Let each place of the curve K go straight to the place of its
//!    chord that is as far along, as shares of both. Directions stay within `MOST_TURN` = 0.7 of that of the
//!    chord, and places within c/5 of it. Two places of the moving curve are not one. If the vertices of Q
//!    that are nearest to their chords' places count, they are 2 r_s - c - 2 c/5 > 2 c apart at least. Else let
//!    D <= pi M + 2 c be the length of the chords from the one to the other, which turn by c/M at most at each
//!    vertex, hence are within D/2M of one direction. For D < (pi - 1.4) M all directions are within
//!    D/2M + 0.7 < pi/2 of it, so along it the way advances. For larger D the chords advance along it by
//!    2 M sin(D/2M) > 1.5 M at least, but for the first and the last by more than 1.5 M - 2 c > 0.7 c > 2 c/5.
//!
//! Rounding moves sampled vertices by some 1e-15 of the curve's size, and 2 to 4 leave shares of R_c or c. In 1
//! the theorem's R > S/sqrt 2 is compared as rounded; `sono certify` proves it where it holds.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::beads::LONGEST_EDGE;
use crate::error::{Error, Result};
use crate::geometry::curve::Curve;
use crate::geometry::embedded::check_embedded;
use crate::geometry::inscribed::{Above, Inscribed};
use crate::geometry::sticks::Sticks;
use crate::measures::{Measures, measure};

/// Edge length of a loose rope, as a multiple of its radius.
const LOOSE_EDGE: f64 = 0.5;
/// Largest angle by which K_P may turn in all above a chord: it then stays within a fifth of the
/// chord's length from it, and has no room for a knot.
const MOST_TURN: f64 = 0.7;
/// From this edge length on, a rope is not resampled by taking chords, but straightened; so it is where an
/// arc of K_P above a chord is longer than this, in units of R_c.
const LONGEST_CHORD: f64 = 1.2;
const LONGEST_ARC: f64 = 1.5;
/// Beads of a rope that is made of a curve which is none.
pub const MOST_BEADS: usize = 20_000;

/// A rope of the curve's knot type, from any embedded polygon: K_P sampled with edges at most half
/// as long as its thickness R_s.
///
/// # Errors
/// [`Error::SelfCrossing`]; [`Error::TooThin`] where that takes over `most` beads.
pub fn rope_curve(curve: &Curve, most: usize) -> Result<Curve> {
    check_embedded(curve)?;
    let given = measure(curve);
    let inscribed = inscribed(curve, &given);
    let lengths: Vec<_> = inscribed.lengths().collect();
    let mut dl = LOOSE_EDGE * given.r_c.unwrap_or(given.dl);
    loop {
        let n = (lengths.iter().sum::<f64>() / dl).ceil();
        if n > most as f64 {
            return Err(Error::TooThin { limit: most });
        }
        let shares = share_out((n as usize).max(12 * lengths.len()), &lengths);
        let (sampled, Above { turn, .. }) = inscribed.sample(&shares, 0.);
        let r_s = measure(&sampled).r_s;
        if dl <= 1.1 * LOOSE_EDGE * r_s && turn <= MOST_TURN {
            return Ok(sampled);
        }
        dl = (0.7 * dl).min(LOOSE_EDGE * r_s).max(0.25 * dl);
    }
}

/// A rope on `n` vertices in all, from one on any number: K_P at equal chords, the first vertex at
/// random, scaled to R_s = 1. Where it is `n` already, the vertices are taken as they are.
///
/// # Errors
/// [`Error::TooCoarse`], and those of [`coarsen`].
pub fn resampled(curve: &Curve, n: usize, seed: u64) -> Result<Curve> {
    let shift = Pcg64Mcg::seed_from_u64(seed).random();
    let given = measure(curve);
    let rope = rope_on(curve, &given, n, shift)?;
    let dl = longest_mean_edge(&rope);
    if dl < LONGEST_EDGE {
        return Ok(rope);
    }
    let (mut needed, mut longest) = (n, dl);
    while longest >= LONGEST_EDGE {
        needed = (needed + 1).max((needed as f64 * longest / LONGEST_EDGE) as usize);
        longest = longest_mean_edge(&rope_on(curve, &given, needed, shift)?);
    }
    Err(Error::TooCoarse { n, dl, limit: LONGEST_EDGE, needed })
}

/// The same for a curve that measures what is `given`, however long the edges get.
fn rope_on(curve: &Curve, given: &Measures, n: usize, shift: f64) -> Result<Curve> {
    let (mut rope, r_s) = if curve.n() == n {
        (curve.clone(), given.r_s)
    } else {
        on_chords(curve, given, n, shift)?
    };
    rope.scale(1. / r_s);
    Ok(rope)
}

/// `n` vertices on a rope that measures what is `given`, by chords of K_P where that keeps the type, and how
/// thick they are.
///
/// # Errors
/// Those of [`coarsen`].
pub fn on_chords(curve: &Curve, given: &Measures, n: usize, shift: f64) -> Result<(Curve, f64)> {
    let (inscribed, shares) = shared_out(curve, n)?;
    let (refined, above) = inscribed.sample(&shares, shift);
    let is_fine = given.l_p / (n as f64) < LONGEST_CHORD;
    if is_fine && given.r_c.is_some_and(|r_c| above.arc <= LONGEST_ARC * r_c) {
        let r_s = measure(&refined).r_s;
        return Ok((refined, r_s));
    }
    Ok((coarsen(curve, n, shift)?, given.r_s))
}

/// The mean edge length of that component where it is largest.
fn longest_mean_edge(curve: &Curve) -> f64 {
    curve.mean_edges().fold(0., f64::max)
}

/// K_P sampled with `n` vertices in all at equal chords, in the curve's own unit, the first vertex
/// `shift` edges after the start: how a tight rope is refined. It keeps its type where edges are not much
/// longer than R_c; where the curve has no R_c, its arcs are as short as other strands ask for.
///
/// ```
/// use glam::DVec3;
/// let square = [(1., 1.), (-1., 1.), (-1., -1.), (1., -1.)].map(|(x, y)| DVec3::new(x, y, 0.));
/// let circle = sono::refine(&sono::Curve::new(vec![square.to_vec()])?, 100, 0.)?;
/// assert_eq!(circle.n(), 100);
/// assert!(sono::measure(&circle).dispersion < 1e-12);
/// # Ok::<(), sono::Error>(())
/// ```
///
/// # Errors
/// [`Error::TooFew`].
pub fn refine(curve: &Curve, n: usize, shift: f64) -> Result<Curve> {
    let (inscribed, shares) = shared_out(curve, n)?;
    Ok(inscribed.sample(&shares, shift).0)
}

/// A rope's K_P sampled with `n` vertices in all, so few that the chords might cut through a strand:
/// vertices between are removed one by one, where that is an isotopy.
///
/// # Errors
/// [`Error::TooFew`]; [`Error::Pierced`] where a strand is in the way; for a curve without R_c those of
/// [`rope_curve`].
pub fn coarsen(curve: &Curve, n: usize, shift: f64) -> Result<Curve> {
    let given = measure(curve);
    if given.r_c.is_none() {
        return coarsen(&rope_curve(curve, MOST_BEADS)?, n, shift);
    }
    let (inscribed, shares) = shared_out(curve, n)?;
    let dl = inscribed.lengths().sum::<f64>() / given.r_s / n as f64;
    let times = (dl / LOOSE_EDGE).ceil() as usize;
    let finer: Vec<_> = shares.iter().map(|share| times * share).collect();
    let mut sticks = Sticks::new(&inscribed.sample(&finer, shift).0);
    let mut left = 0;
    while left != sticks.n() && sticks.n() > n {
        left = sticks.n();
        for i in 0..times * n {
            if i % times != 0 && sticks.is_there(i) {
                sticks.remove(i);
            }
        }
    }
    if sticks.n() > n {
        return Err(Error::Pierced { n, needed: sticks.n() });
    }
    Ok(sticks.curve())
}

/// K_P of an embedded curve, of its type: where that has no R_c the arcs are as short as strands ask for.
fn inscribed(curve: &Curve, given: &Measures) -> Inscribed {
    match given.r_c {
        Some(_) => Inscribed::new(curve),
        None => Inscribed::clear_of_strands(curve),
    }
}

/// K_P of a curve, and what each component gets of `n` vertices.
fn shared_out(curve: &Curve, n: usize) -> Result<(Inscribed, Vec<usize>)> {
    let needed = 3 * curve.components();
    if n < needed {
        return Err(Error::TooFew { n, needed });
    }
    let inscribed = inscribed(curve, &measure(curve));
    let shares = share_out(n, &inscribed.lengths().collect::<Vec<_>>());
    Ok((inscribed, shares))
}

/// Shares `n` vertices out to the components in proportion to their lengths, at least 3 to each.
pub fn share_out(n: usize, lengths: &[f64]) -> Vec<usize> {
    let per_length = n as f64 / lengths.iter().sum::<f64>();
    let mut shares = vec![3; lengths.len()];
    for _ in 3 * lengths.len()..n {
        let lacking = |c: usize| lengths[c] * per_length - shares[c] as f64;
        let neediest = (0..shares.len()).max_by(|&a, &b| lacking(a).total_cmp(&lacking(b)));
        shares[neediest.expect("a curve has components")] += 1;
    }
    shares
}

/// The same shape, whose thickness is `r_s`, with R_s = 1 and its centre at the origin.
pub fn scaled(curve: &Curve, r_s: f64) -> Curve {
    let mut curve = curve.clone();
    curve.scale(1. / r_s);
    curve.centre();
    curve
}
