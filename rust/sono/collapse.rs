//! From any embedded curve to a jammed rope.
//!
//! A curve that holds a rope of a thousand beads is collapsed as it is. A thinner one is first
//! loosened ([`crate::loosening`]), and so is a rope that has jammed at many times the length that its
//! diagram asks for: a knot of c crossings needs some 9 c radii of rope, 12 at most of the knots whose
//! ropelength is known.

use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::geometry::curve::Curve;
use crate::geometry::sticks::Moves;
use crate::invariants::projection::fewest_crossings;
use crate::loosening::{Loosening, simplified};
use crate::measures::measure;
use crate::outcome::Outcome;
use crate::passage::Passages;
use crate::resample::scaled;
use crate::sono::rope::Violation;
use crate::sono::settings::Settings;
use crate::sono::stage::Stage;
use crate::sono::tighten::{Status, Tightener};

/// Beads of a rope in the curve as it is, and of one in a loosened curve.
const AS_IT_IS: usize = 1200;
const LOOSENED: usize = 50_000;
/// A jammed rope is far too long if it is longer than this for each crossing and once more, and that
/// for each component.
const A_CROSSING: f64 = 12.;
const A_COMPONENT: f64 = 30.;

/// Collapses a curve; everything needed to go on later is serialised with it.
///
/// ```
/// // A flat triangle with a spike; its knot type is that of the circle, 2 pi radii long.
/// use std::time::Duration;
/// use glam::DVec3;
/// use sono::{Collapse, Curve, Outcome, Settings};
/// let corners = [(0., 0.), (9., 0.), (9.01, 50.), (9.02, 0.), (10., -5.)];
/// let spike = corners.map(|(x, y)| DVec3::new(x, y, 0.));
/// let curve = Curve::new(vec![spike.to_vec()])?;
/// let mut collapse = Collapse::new(&curve, false, Settings::default())?;
/// while collapse.advance(Duration::from_secs(1))?.outcome == Outcome::Running {}
/// assert!(collapse.status().best.l_p < 7.);
/// # Ok::<(), sono::Error>(())
/// ```
#[derive(Serialize, Deserialize)]
pub struct Collapse {
    settings: Settings,
    given: Curve,
    /// The collapse of the curve as it is, if it holds a rope.
    direct: Option<Tightener>,
    /// Whether that will not do.
    thin: bool,
    /// Begun anew after a restart: it takes seconds at most.
    #[serde(skip)]
    loosening: Option<Loosening>,
    loosened: Option<Curve>,
    /// What that took.
    moves: Moves,
    /// The collapse of the loosened curve.
    loose: Option<Tightener>,
}

impl Collapse {
    /// Collapses any embedded curve, in any unit; the number of vertices is chosen by itself. A curve
    /// that was loosened before is not loosened again.
    ///
    /// # Errors
    /// [`Error::Setting`], [`Error::SelfCrossing`]; [`Error::TooThin`] for a loosened curve.
    pub fn new(curve: &Curve, loosened: bool, settings: Settings) -> Result<Self> {
        let most = if loosened { LOOSENED } else { AS_IT_IS };
        let direct = match Tightener::collapse(curve, most, settings) {
            Ok(direct) => Some(direct),
            Err(Error::TooThin { .. }) if !loosened => None,
            Err(error) => return Err(error),
        };
        Ok(Self {
            settings,
            given: curve.clone(),
            thin: direct.is_none(),
            direct,
            loosening: None,
            loosened: None,
            moves: Moves::default(),
            loose: None,
        })
    }

    /// Whether a restored state is one that can go on.
    pub fn is_sound(&self) -> bool {
        self.given.is_sound()
            && self.loosened.as_ref().is_none_or(Curve::is_sound)
            && [&self.direct, &self.loose].into_iter().flatten().all(Tightener::is_sound)
            && (self.thin || self.direct.is_some())
    }

    /// Works for about `budget`, unless done before.
    ///
    /// # Errors
    /// [`Error::TooEntangled`], [`Error::TooThin`] where the curve cannot be loosened.
    pub fn advance(&mut self, budget: Duration) -> Result<Status> {
        let start = Instant::now();
        let left = || budget.saturating_sub(start.elapsed());
        if let Some(direct) = self.direct.as_mut().filter(|_| !self.thin) {
            direct.advance(left());
            self.thin =
                direct.status().outcome != Outcome::Running && is_far_too_long(direct.best());
        }
        if self.thin && self.loose.is_none() {
            match self.loosen(left()) {
                // A rope that is far too long is better than none.
                Err(_) if self.direct.is_some() => self.thin = false,
                Err(error) => return Err(error),
                Ok(()) => {}
            }
        }
        if let Some(loose) = &mut self.loose {
            loose.advance(left());
        }
        Ok(self.status())
    }

    fn loosen(&mut self, budget: Duration) -> Result<()> {
        if self.loosening.is_none() {
            let jammed = self.direct.as_ref().map(Tightener::best);
            self.loosening = Some(Loosening::new(jammed.unwrap_or(&self.given))?);
        }
        let loosening = self.loosening.as_mut().expect("just begun");
        if loosening.advance(budget)? {
            let loosened = loosening.curve();
            self.moves = loosening.moves();
            self.loose = Some(Tightener::collapse(&loosened, LOOSENED, self.settings)?);
            (self.loosened, self.loosening) = (Some(loosened), None);
        }
        Ok(())
    }

    /// The loosened curve, if it was loosened, so that little of the shape it had is left.
    pub fn loosened(&self) -> Option<&Curve> {
        self.loosened.as_ref()
    }

    /// What loosening took, if the curve was loosened, and where the rope stood that had jammed before, if
    /// there was one.
    pub fn loosening(&self) -> Option<(Moves, Option<Status>)> {
        let before = || self.direct.as_ref().map(Tightener::status);
        self.loosened.as_ref().map(|_| (self.moves, before()))
    }

    /// The shortest rope so far, its R_s = 1, its centre at the origin.
    pub fn best(&self) -> Curve {
        let ropes = [&self.loose, &self.direct].into_iter().flatten().map(Tightener::best);
        let shorter = |a: &&Curve, b: &&Curve| measure(a).l_p.total_cmp(&measure(b).l_p);
        ropes.min_by(shorter).cloned().unwrap_or_else(|| {
            let curve =
                self.loosening.as_ref().map_or_else(|| self.given.clone(), Loosening::curve);
            scaled(&curve, measure(&curve).r_s)
        })
    }

    /// Where it stands.
    pub fn status(&self) -> Status {
        let best = measure(&self.best());
        match (&self.loose, &self.direct) {
            (Some(sono), _) | (None, Some(sono)) if self.loose.is_some() || !self.thin => {
                Status { best, ..sono.status() }
            }
            _ => Status {
                outcome: Outcome::Running,
                stage: Stage::Loosen,
                progress: 0.,
                sweeps: 0,
                lost: 0,
                passages: Passages::default(),
                epsilon: 0.,
                met: Violation::default(),
                best,
            },
        }
    }
}

/// Whether a jammed rope is many times as long as its knot can need.
fn is_far_too_long(rope: &Curve) -> bool {
    let components = rope.components() as f64;
    let enough = ((measure(rope).l_p - A_COMPONENT * components) / A_CROSSING).floor();
    // So many crossings would ask for a rope of this length.
    let fewer = |simple| fewest_crossings(&simple, enough as usize) as f64 <= enough;
    enough >= 0. && simplified(rope).is_ok_and(fewer)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// An ellipse, which holds a rope 4 `slender`^2 radii long or a little longer.
    fn ellipse(slender: f64) -> Curve {
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / 200.;
        let vertex = |i| DVec3::new(slender * angle(i).cos(), angle(i).sin(), 0.);
        Curve::new(vec![(0..200).map(vertex).collect()]).unwrap()
    }

    #[test]
    fn a_knot_without_crossings_needs_little_rope() {
        assert!(!is_far_too_long(&ellipse(2.5)));
        assert!(is_far_too_long(&ellipse(3.)));
    }

    #[test]
    fn a_rope_that_jams_far_too_long_is_loosened() {
        let settings = Settings { anneal_sweeps: 1, ..Default::default() };
        let jammed = Tightener::anneal(&ellipse(4.), 200, settings).unwrap();
        let mut collapse = Collapse::new(&ellipse(4.), false, settings).unwrap();
        assert!(!collapse.thin);
        collapse.direct = Some(jammed);
        let mut stages = vec![];
        while collapse.advance(Duration::from_micros(100)).unwrap().outcome == Outcome::Running {
            stages.push(collapse.status().stage);
        }
        assert!(stages.contains(&Stage::Loosen), "{stages:?}");
        assert!(collapse.loosened().is_some());
        assert!(measure(&collapse.best()).l_p < 7.);
    }
}
