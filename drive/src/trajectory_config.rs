//! How a trajectory is followed, within which limits.

use palpate::error::{ConfigError, require, require_not_negative, require_positive};
use serde::{Deserialize, Serialize};

/// How a trajectory is followed, and what it must not pass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TrajectoryConfig {
    /// Depths that the tool must not leave, from the surface, m: least and greatest.
    pub depth: [f32; 2],
    /// Greatest speed, mean over 16 ticks, m/s.
    pub speed: f32,
    /// Greatest contact force either way, N.
    pub force: f32,
    /// Greatest effort either way, N.
    pub effort: f32,
    /// N/m.
    pub proportional: f32,
    /// N s/m.
    pub derivative: f32,
    /// Share of a new difference of the error that passes the low-pass of its rate, above 0, at most 1.
    pub pass: f32,
    /// References of the whole run.
    pub length: u32,
    /// Ticks without a request of the host after which the run ends: 10 to 2000.
    pub timeout: u16,
}

impl TrajectoryConfig {
    /// Whether a run can be prepared with it.
    ///
    /// # Errors
    /// The value that is out of its range.
    pub fn check(&self) -> Result<(), ConfigError> {
        let [least, greatest] = self.depth;
        require(least.is_finite() && greatest.is_finite() && least < greatest, "depth", "a range")?;
        require_positive(self.speed, "speed")?;
        require_positive(self.force, "force")?;
        require_positive(self.effort, "effort")?;
        require_positive(self.proportional, "proportional")?;
        require_not_negative(self.derivative, "derivative")?;
        require(self.pass > 0.0 && self.pass <= 1.0, "pass", "above 0, at most 1")?;
        require(self.length > 0, "length", "at least one reference")?;
        require((10..=2_000).contains(&self.timeout), "timeout", "10 to 2000 ticks")
    }
}
