//! The parameters of the polish.

use serde::{Deserialize, Serialize};

use crate::error::{Result, within};

/// Parameters of the polish, none of which SONO has; R = 1, the rope's tension being 1. Unknown names are
/// refused. Steps are valid whatever they are: what that rests on is no setting.
///
/// ```
/// use sono::polish::Settings;
/// let settings: Settings = serde_json::from_str(r#"{"last_mu": 1e-9}"#)?;
/// assert_eq!(settings, Settings { last_mu: 1e-9, ..Default::default() });
/// assert!(serde_json::from_str::<Settings>(r#"{"lost_mu": 1e-9}"#).is_err());
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Barrier parameter mu at the start, in units of dl^3, in [1e-6, 10]: a rope's length is then off
    /// by as much as its discretisation. It is `last_mu` at least, and at most what edges have room for.
    pub first_mu: f64,
    /// mu at the end on a level that only leads to the next, in units of dl^3, in [1e-9, 10]. It is
    /// `last_mu` at least.
    pub passing_mu: f64,
    /// mu at the end, a length, in [1e-14, 1e-4]: that of the rope exceeds its minimum by up to about
    /// so much for each constraint.
    pub last_mu: f64,
    /// mu falls to this share of it, in [0.01, 0.9], or to `mu_power`, whichever is less.
    pub mu_factor: f64,
    /// Exponent, in [1, 2], of the power of it to which mu falls.
    pub mu_power: f64,
    /// Error of the perturbed conditions at which mu falls, in units of mu, in [0.1, 100].
    pub centred: f64,
    /// Force left over at which mu falls, in units of mu, in [0.001, 100]; `centred` times the last mu will do.
    /// What a rope gains by sliding far it gains in small steps once mu is small.
    pub balanced: f64,
    /// Range of the contacts' barrier in |v_i - v_j|^2 - 4, in units of sqrt mu, in [0.1, 100]. It is
    /// l^2 at most, l being the longest edge: as far as a contact moves when the beads slide by half an
    /// edge. Pairs beyond would only cost time.
    pub contact_range: f64,
    /// The least that this range may be, in units of l^2, in [0.001, 1].
    pub least_contact_range: f64,
    /// Longest way of a bead in one step, in radii, in [0.001, 0.1].
    pub longest_way: f64,
    /// Share of a constraint or a multiplier that a step may use up, in [0.5, 0.999].
    pub most_used: f64,
    /// A step must lower the barrier function by this share of what its slope promises, in [1e-8, 0.4].
    pub least_descent: f64,
    /// Multipliers stay within this factor of what the barrier's forces are, in [2, 1e10].
    pub multiplier_range: f64,
    /// Iterations at its first mu, 1 at least, after which a rope that is still gliding begins anew with
    /// a larger one, as it does when it cannot move.
    pub patience: u32,
    /// A rope that has meanwhile got shorter than this share of its length, in [0, 1], may go on gliding.
    pub gliding_share: f64,
    /// By what the first mu is multiplied then, in [1, 1000].
    pub restart_factor: f64,
    /// How often it may begin anew, at most 100.
    pub most_restarts: u32,
    /// Iterations, 1 at least, in which a rope gets tight or is stuck.
    pub most_iterations: u32,
    /// Largest imbalance of forces in a rope that is tight though digits do not suffice for a further
    /// step, in [1e-12, 1e-4].
    pub tight_residual: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            first_mu: 0.01,
            passing_mu: 3e-3,
            last_mu: 1e-11,
            mu_factor: 0.2,
            mu_power: 1.2,
            centred: 10.,
            balanced: 0.1,
            contact_range: 3.,
            least_contact_range: 0.1,
            longest_way: 0.1,
            most_used: 0.99,
            least_descent: 1e-4,
            multiplier_range: 1000.,
            patience: 200,
            gliding_share: 0.9,
            restart_factor: 10.,
            most_restarts: 3,
            most_iterations: 2000,
            tight_residual: 1e-8,
        }
    }
}

impl Settings {
    /// # Errors
    /// [`crate::Error::Setting`] names the first parameter that is out of range.
    pub fn check(&self) -> Result<()> {
        within("first_mu", self.first_mu, 1e-6..=10., "in [1e-6, 10]")?;
        within("passing_mu", self.passing_mu, 1e-9..=10., "in [1e-9, 10]")?;
        within("last_mu", self.last_mu, 1e-14..=1e-4, "in [1e-14, 1e-4]")?;
        within("mu_factor", self.mu_factor, 0.01..=0.9, "in [0.01, 0.9]")?;
        within("mu_power", self.mu_power, 1.0..=2., "in [1, 2]")?;
        within("centred", self.centred, 0.1..=100., "in [0.1, 100]")?;
        within("balanced", self.balanced, 0.001..=100., "in [0.001, 100]")?;
        within("contact_range", self.contact_range, 0.1..=100., "in [0.1, 100]")?;
        let least = self.least_contact_range;
        within("least_contact_range", least, 0.001..=1., "in [0.001, 1]")?;
        within("longest_way", self.longest_way, 0.001..=0.1, "in [0.001, 0.1]")?;
        within("most_used", self.most_used, 0.5..=0.999, "in [0.5, 0.999]")?;
        within("least_descent", self.least_descent, 1e-8..=0.4, "in [1e-8, 0.4]")?;
        within("multiplier_range", self.multiplier_range, 2.0..=1e10, "in [2, 1e10]")?;
        within("patience", self.patience.into(), 1.0..=f64::MAX, "at least 1")?;
        within("gliding_share", self.gliding_share, 0.0..=1., "in [0, 1]")?;
        within("restart_factor", self.restart_factor, 1.0..=1000., "in [1, 1000]")?;
        within("most_restarts", self.most_restarts.into(), 0.0..=100., "at most 100")?;
        within("most_iterations", self.most_iterations.into(), 1.0..=f64::MAX, "at least 1")?;
        within("tight_residual", self.tight_residual, 1e-12..=1e-4, "in [1e-12, 1e-4]")
    }
}
