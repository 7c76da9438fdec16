//! `lost_motion`: play between the position sensor and the surface.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::physics::Physics;
use crate::scale::Unit;

/// Up to three gaps side by side, each flat while its flank has not been reached.
#[derive(Debug, Clone)]
pub struct Play {
    /// Half the gap of each, m.
    halves: [f64; 3],
    behind: [f64; 3],
}

impl Play {
    /// Where the touching end is when the sensor is at `position`, and which share of the velocity reaches it.
    pub fn follow(&mut self, position: f64) -> (f64, f64) {
        let (mut sum, mut engaged) = (0.0, 0.0);
        for (behind, half) in self.behind.iter_mut().zip(self.halves) {
            let pushed = behind.clamp(position - half, position + half);
            engaged += f64::from(pushed != *behind);
            *behind = pushed;
            sum += pushed;
        }
        (sum / 3.0, engaged / 3.0)
    }
}

/// `lost_motion`
#[derive(Debug)]
pub struct LostMotion {
    spread: f64,
    unit: f64,
}

impl LostMotion {
    /// With one sharp gap, or three that a worn joint spreads.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let spread = if chance.random_bool(0.5) { 0.0 } else { chance.random_range(0.1..0.4) };
        Self { spread, unit: 0.01 * scene.depth }
    }
}

impl Shape for LostMotion {
    fn form(&self) -> &'static str {
        if self.spread == 0.0 { "one gap" } else { "three gaps side by side" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("gap", size * self.unit, Unit::Length)]
    }
}

impl Acting for LostMotion {
    fn put(&self, size: f64, physics: &mut Physics) {
        let half = 0.5 * size * self.unit;
        let halves = [half * (1.0 - self.spread), half, half * (1.0 + self.spread)];
        // The tool comes from outside: whatever it pushes lags by half a gap.
        physics.contact.play = Some(Play { halves, behind: [f64::NEG_INFINITY; 3] });
    }
}
