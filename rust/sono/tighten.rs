//! SONO, "Shrink On No Overlaps": the tightening loop.
//!
//! Baranska, Pieranski, Rawdon, "Ropelength of tight polygonal knots", section 3.2; first described
//! in P. Pieranski, "In search of ideal knots" (1998). A sweep is EE, RO, CC. After it the required
//! edge length dl shrinks if the violations met are below the tolerance of the moment, and grows a
//! little if they are above twice that. What the paper leaves to the experimenter who watches and
//! adjusts is done here in stages, each a [`Tightener`] of its own:
//!
//! 1. [`Stage::Collapse`] shortens a loose rope at a fixed rate and tolerance until it jams. Its
//!    edges are at most about half a radius long, whatever n is wanted in the end, so that no
//!    strand fits between beads; beads are taken out as the rope gets shorter.
//! 2. [`Stage::Anneal`] at a coarse n lowers the tolerance, and epsilon with it, geometrically from
//!    large: beads that may overlap a lot still rearrange, and the rope leaves local minima.
//!    [`Stage::Reanneal`] does the same from a smaller tolerance on twice the beads: enough to free
//!    them from each other's grooves, too little to lose the shape.
//! 3. [`Stage::Settle`] goes on at any n until dispersion and overlaps are below 1e-6.
//!
//! ```
//! use sono::{Curve, Outcome, Settings, Stage, Tightener, measure};
//! use glam::DVec3;
//! let trefoil = (0..60).map(|i| {
//!     let t = std::f64::consts::TAU * i as f64 / 60.;
//!     let r = 2. + 0.8 * (3. * t).cos();
//!     DVec3::new(r * (2. * t).cos(), r * (2. * t).sin(), 0.8 * (3. * t).sin())
//! });
//! let curve = Curve::new(vec![trefoil.collect()])?;
//! let settings = Settings { anneal_sweeps: 20_000, ..Default::default() };
//! let mut loose = Tightener::collapse(&curve, 1000, settings)?;
//! while loose.step() == Outcome::Running {}
//! let mut tight = Tightener::anneal(&loose.best(), 60, settings)?;
//! while tight.step() == Outcome::Running {}
//! assert!(measure(&tight.best()).l_p < 33.);
//! # Ok::<(), sono::Error>(())
//! ```

use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::geometry::curve::Curve;
use crate::measures::{Measures, measure};
use crate::outcome::Outcome;
use crate::passage::Passages;
use crate::resample::on_chords;
use crate::sono::best::Best;
use crate::sono::rope::{Rope, Violation};
use crate::sono::settings::Settings;
use crate::sono::stage::Stage;

/// Tolerance while collapsing, while the jammed rope is then eased, and at the end of the anneal.
pub const COLLAPSED: f64 = 0.3;
const EASED: f64 = 0.03;
const ANNEALED: f64 = 3e-3;
/// Share of its length that a collapsing rope loses in a sweep.
const COLLAPSE_RATE: f64 = 3e-3;
/// Overlap and curvature below which it is scaled down too, by as much: they are soon removed.
const LIGHT: f64 = 0.1;
/// Thickness in excess of 1 at which a collapsing rope is scaled down.
const SLACK: f64 = 0.02;
/// A rope has jammed when it loses less than this share of its length in so many sweeps.
const JAMMED: f64 = 2e-3;
const JAM_SWEEPS: u64 = 2000;
/// Edge length below which a collapsing rope gives up beads, and the one it then has.
const TOO_FINE: f64 = 0.35;
const LOOSE: f64 = 0.5;
/// Sweeps in which a jammed rope is eased.
const EASE_SWEEPS: u64 = 1000;
/// Sweeps between two looks at what the rope measures, at its slack while it collapses, and at the
/// tension of several components.
const BURST: u64 = 1000;
const SLACK_SWEEPS: u64 = 100;
const TENSION_SWEEPS: u64 = 10;

/// Where a [`Tightener`] stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Status {
    /// Whether it is done.
    pub outcome: Outcome,
    /// Which stage this is.
    pub stage: Stage,
    /// Share of the planned sweeps done; 0 while collapsing.
    pub progress: f64,
    /// Sweeps done.
    pub sweeps: u64,
    /// Those that were undone because a strand might have passed another.
    pub lost: u64,
    /// The moves of many sweeps each of which it was looked at whether one might.
    pub passages: Passages,
    /// The overshoot of RO at this moment.
    pub epsilon: f64,
    /// What the last sweep met.
    pub met: Violation,
    /// Measures of the best state so far, R_s = 1.
    pub best: Measures,
}

/// Tightens a rope, stage by stage; everything needed to go on later is serialised with it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Tightener {
    settings: Settings,
    stage: Stage,
    rope: Rope,
    sweeps: u64,
    planned: u64,
    first_tolerance: f64,
    met: Violation,
    outcome: Outcome,
    best: Best,
    /// Length at the last look for a jam.
    length: f64,
}

impl Tightener {
    /// One stage on a rope, of so many sweeps in which the tolerance falls from this one.
    pub(super) fn new(
        rope: Rope,
        stage: Stage,
        planned: u64,
        tolerance: f64,
        settings: Settings,
    ) -> Self {
        let mut tightener = Self {
            settings,
            stage,
            best: Best::new(rope.curve()),
            rope,
            sweeps: 0,
            planned,
            first_tolerance: tolerance,
            met: Violation::default(),
            outcome: Outcome::Running,
            length: f64::MAX,
        };
        tightener.best.offer(tightener.rope.curve(), settings.tolerance);
        tightener
    }

    /// Whether a restored state is one that can go on.
    pub fn is_sound(&self) -> bool {
        self.settings.check().is_ok()
            && self.rope.is_sound()
            && self.best.curve().is_sound()
            && self.planned > 0
            && self.first_tolerance > 0.
            && self.first_tolerance.is_finite()
    }

    /// Works for about `budget`, unless done before.
    pub fn advance(&mut self, budget: Duration) -> Status {
        let start = Instant::now();
        while self.outcome == Outcome::Running && start.elapsed() < budget {
            for _ in 0..50 {
                self.step();
            }
        }
        self.status()
    }

    /// One sweep, and what follows from it.
    pub fn step(&mut self) -> Outcome {
        if self.outcome == Outcome::Running {
            self.sweep();
            if self.sweeps.is_multiple_of(TENSION_SWEEPS) && self.rope.curve().components() > 1 {
                self.rope.share_tension();
            }
            if self.is_collapsing() && self.sweeps.is_multiple_of(SLACK_SWEEPS) {
                self.take_in_slack();
            }
            if self.sweeps.is_multiple_of(BURST) || self.sweeps == self.planned {
                self.look();
            }
        }
        self.outcome
    }

    fn sweep(&mut self) {
        let tolerance = self.tolerance();
        let Settings { c_1, c_2, .. } = self.settings;
        if let Some(met) = self.rope.sweep(c_1, c_2, 0.5 * tolerance) {
            self.met = met;
            self.shrink_on_no_overlaps(tolerance);
        }
        self.sweeps += 1;
    }

    /// Looks at what the rope measures, and whether the stage is done.
    fn look(&mut self) {
        self.rope.confirm();
        let valid = self.best.offer(self.rope.curve(), self.settings.tolerance);
        self.outcome = self.judge(valid);
        if self.stage == Stage::Collapse && self.outcome == Outcome::Tight {
            self.best.replace(self.rope.curve());
        }
    }

    fn shrink_on_no_overlaps(&mut self, tolerance: f64) {
        let rate = match self.stage {
            Stage::Collapse => COLLAPSE_RATE,
            _ => tolerance / 300.,
        };
        if self.met.worst() < tolerance {
            self.rope.stretch(1. - rate);
        } else if self.met.worst() > 2. * tolerance {
            // Past the planned sweeps the aim is no longer a short rope but a valid one.
            let overdue = self.sweeps > self.planned;
            let rate = if overdue { 1e-3 * self.met.worst() } else { 0.3 * rate };
            self.rope.stretch(1. + rate);
        }
    }

    /// The violation tolerated at this moment.
    fn tolerance(&self) -> f64 {
        let last = match self.stage {
            Stage::Loosen | Stage::Collapse => {
                return if self.is_collapsing() { COLLAPSED } else { EASED };
            }
            Stage::Anneal | Stage::Reanneal => ANNEALED.min(self.first_tolerance),
            Stage::Settle => 0.5 * self.settings.tolerance,
        };
        self.first_tolerance * (last / self.first_tolerance).powf(self.progress())
    }

    /// Whether the rope still has to jam; then it is eased, and the end of that is planned.
    fn is_collapsing(&self) -> bool {
        self.stage == Stage::Collapse && self.planned == u64::MAX
    }

    fn progress(&self) -> f64 {
        (self.sweeps as f64 / self.planned as f64).min(1.)
    }

    /// Scales a collapsing rope down as far as its beads allow, and takes out beads that have come
    /// close: EE alone would shorten long slack only as fast as tension diffuses along the chain.
    fn take_in_slack(&mut self) {
        self.rope.confirm();
        let curve = self.rope.curve();
        let given = measure(curve);
        let slack = given.r_s > 1. + SLACK;
        if self.rope.dl() < TOO_FINE {
            // A component is no shorter than 2 pi.
            let n = ((self.rope.length() / LOOSE) as usize).max(12 * curve.components());
            if let Ok((fewer, _)) = on_chords(curve, &given, n, 0.25) {
                self.rope = self.rope.followed_by(fewer);
            }
        } else if slack {
            self.rope = self.rope.followed_by(curve.clone());
        } else if self.met.overlap.max(self.met.curvature) < LIGHT {
            self.rope.scale(1. - LIGHT);
        }
    }

    fn judge(&mut self, valid: bool) -> Outcome {
        match self.stage {
            _ if self.rope.undone() >= BURST => Outcome::Stuck,
            Stage::Collapse if self.sweeps >= self.planned => Outcome::Tight,
            Stage::Collapse if self.sweeps.is_multiple_of(JAM_SWEEPS) => {
                let before = std::mem::replace(&mut self.length, self.rope.curve().length());
                if self.length > (1. - JAMMED) * before {
                    self.planned = self.sweeps + EASE_SWEEPS;
                }
                Outcome::Running
            }
            Stage::Anneal | Stage::Reanneal if self.sweeps >= self.planned => Outcome::Tight,
            Stage::Settle if self.sweeps >= self.planned && valid => Outcome::Tight,
            Stage::Settle if self.sweeps >= 2 * self.planned => Outcome::Stuck,
            _ => Outcome::Running,
        }
    }

    /// The best state so far, its R_s = 1, its centre at the origin.
    pub fn best(&self) -> &Curve {
        self.best.curve()
    }

    /// Where it stands.
    pub fn status(&self) -> Status {
        Status {
            outcome: self.outcome,
            stage: self.stage,
            progress: self.progress(),
            sweeps: self.sweeps,
            lost: self.rope.lost(),
            passages: self.rope.passages(),
            epsilon: 0.5 * self.tolerance(),
            met: self.met,
            best: measure(self.best()),
        }
    }
}
