//! Outside of the list: somebody pushes the tool.

use rand::{RngExt, SeedableRng};

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::physics::Physics;
use crate::scale::Unit;

/// Half sines of force on the tool.
#[derive(Debug, Clone)]
pub struct Pushes {
    /// Start and length, s, and height, N, of each.
    all: Vec<(f64, f64, f64)>,
}

impl Pushes {
    /// N at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let during = |&&(start, length, _): &&(f64, f64, f64)| t > start && t < start + length;
        self.all
            .iter()
            .filter(during)
            .map(|(start, length, height)| height * (std::f64::consts::PI * (t - start) / length).sin())
            .sum()
    }
}

/// A burst of pushes in every trial, elsewhere in each.
#[derive(Debug)]
pub struct Pushing {
    seed: u64,
    duration: f64,
    unit: f64,
}

impl Pushing {
    /// At random.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        Self { seed: chance.random(), duration: scene.duration, unit: 0.05 * scene.effort }
    }
}

impl Shape for Pushing {
    fn form(&self) -> &'static str {
        "bursts of pushes on the tool"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 20.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("height", size * self.unit, Unit::Force)]
    }
}

impl Acting for Pushing {
    fn put(&self, size: f64, physics: &mut Physics) {
        let mut chance = Chance::seed_from_u64(self.seed.wrapping_add(physics.trial as u64));
        let start = self.duration * chance.random_range(0.1..0.6);
        let height = size * self.unit;
        let all = (0..8)
            .map(|_| {
                let at = start + chance.random_range(0.0..0.3) * self.duration;
                (at, chance.random_range(0.05..0.3), height * chance.random_range(-1.0..1.0))
            })
            .collect();
        physics.drive.pushes = Some(Pushes { all });
    }
}
