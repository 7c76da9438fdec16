//! What becomes of the effort before it acts: `effort_saturation`, `effort_lag`. The recording holds the command.

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::physics::Physics;
use crate::scale::Unit;

/// No effort beyond a limit.
#[derive(Debug, Clone, Copy)]
pub struct Clip {
    limit: f64,
}

impl Clip {
    /// What acts of `effort`, N.
    #[must_use]
    pub fn apply(&self, effort: f64) -> f64 {
        effort.clamp(-self.limit, self.limit)
    }
}

/// `effort_saturation`
#[derive(Debug)]
pub struct EffortSaturation {
    peak: f64,
}

impl EffortSaturation {
    /// Below the peak that the trials ask for.
    #[must_use]
    pub fn draw(scene: &Scene) -> Self {
        Self { peak: scene.effort }
    }

    fn limit(&self, size: f64) -> f64 {
        self.peak / (1.0 + size)
    }
}

impl Shape for EffortSaturation {
    fn form(&self) -> &'static str {
        "clipping"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(0.3, 3.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("limit", self.limit(size), Unit::Force)]
    }
}

impl Acting for EffortSaturation {
    fn put(&self, size: f64, physics: &mut Physics) {
        physics.drive.clip = Some(Clip { limit: self.limit(size) });
    }
}

/// First order: `tau u' = command - u`.
#[derive(Debug, Clone, Copy)]
pub struct Lag {
    time: f64,
    effort: f64,
}

impl Lag {
    /// The mean effort over the next step of `dt`, exact for a command that is held.
    pub fn advance(&mut self, command: f64, dt: f64) -> f64 {
        let gone = -(-dt / self.time).exp_m1();
        let before = self.effort - command;
        self.effort -= before * gone;
        command + before * gone * self.time / dt
    }
}

/// `effort_lag`
#[derive(Debug)]
pub struct EffortLag;

impl Shape for EffortLag {
    fn form(&self) -> &'static str {
        "first order"
    }

    fn sizes(&self) -> Sizes {
        // Half a sample is what the hold of the effort leaves open; beyond that a whole one.
        Sizes { smallest: 1.5e-3, first: 2e-3, largest: 0.03 }
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("time_constant", size, Unit::Time)]
    }
}

impl Acting for EffortLag {
    fn put(&self, size: f64, physics: &mut Physics) {
        physics.drive.lag = Some(Lag { time: size, effort: 0.0 });
    }
}
