//! How each stage begins.

use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::error::Result;
use crate::geometry::curve::Curve;
use crate::resample::{resampled, rope_curve};
use crate::sono::rope::Rope;
use crate::sono::settings::Settings;
use crate::sono::stage::Stage;
use crate::sono::tighten::{COLLAPSED, Tightener};

/// Largest random displacement of a coordinate. It breaks symmetries, which SONO alone would keep,
/// and shakes beads out of each other's grooves.
const JITTER: f64 = 0.05;

impl Tightener {
    /// Collapses an embedded curve of any unit that holds a rope of at most `most` beads; their
    /// number is chosen by itself. See [`crate::Collapse`] for any other.
    ///
    /// # Errors
    /// [`crate::Error::Setting`], [`crate::Error::SelfCrossing`], [`crate::Error::TooThin`].
    pub fn collapse(curve: &Curve, most: usize, settings: Settings) -> Result<Self> {
        settings.check()?;
        let rope = jittered(Rope::new(rope_curve(curve, most)?), settings.seed);
        Ok(Self::new(rope, Stage::Collapse, u64::MAX, COLLAPSED, settings))
    }

    /// Anneals a rope on `n` vertices in all; `curve` must be one, of any unit: see
    /// [`Tightener::collapse`].
    ///
    /// # Errors
    /// [`crate::Error::Setting`], and those of [`resampled`].
    pub fn anneal(curve: &Curve, n: usize, settings: Settings) -> Result<Self> {
        let rope = jittered(rope_on(curve, n, settings)?, settings.seed);
        let planned = settings.anneal_sweeps.into();
        Ok(Self::new(rope, Stage::Anneal, planned, settings.anneal_tolerance, settings))
    }

    /// Anneals a rope that has been annealed on fewer vertices.
    ///
    /// # Errors
    /// [`crate::Error::Setting`], and those of [`resampled`].
    pub fn reanneal(curve: &Curve, n: usize, settings: Settings) -> Result<Self> {
        let rope = jittered(rope_on(curve, n, settings)?, settings.seed);
        let planned = settings.anneal_sweeps.div_ceil(2).into();
        Ok(Self::new(rope, Stage::Reanneal, planned, settings.anneal_tolerance / 6., settings))
    }

    /// Settles a rope on `n` vertices in all, starting at a tolerance of a coarser one's roughness.
    ///
    /// # Errors
    /// [`crate::Error::Setting`], and those of [`resampled`].
    pub fn settle(curve: &Curve, n: usize, settings: Settings) -> Result<Self> {
        let rope = rope_on(curve, n, settings)?;
        let tolerance = 0.3 * rope.dl().min(1.).powi(2);
        let planned = n as u64 * u64::from(settings.settle_sweeps);
        Ok(Self::new(rope, Stage::Settle, planned, tolerance, settings))
    }
}

fn rope_on(curve: &Curve, n: usize, settings: Settings) -> Result<Rope> {
    settings.check()?;
    Ok(Rope::of(resampled(curve, n, settings.seed)?))
}

/// A rope each bead of which is displaced at random.
fn jittered(mut rope: Rope, seed: u64) -> Rope {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    // On a fine rope more than a share of dl would tie knots into neighbouring edges.
    let size = JITTER.min(0.15 * rope.dl());
    let mut coordinate = || rng.random_range(-size..size);
    rope.displace(|| DVec3::new(coordinate(), coordinate(), coordinate()));
    rope
}
