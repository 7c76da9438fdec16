//! Outside of the list: a loose contact in the sensor's cable.

use rand::{RngExt, SeedableRng};

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::{Chance, sign};
use crate::physics::Physics;
use crate::scale::Unit;

/// Short jumps of the reading.
#[derive(Debug, Clone)]
pub struct Glitches {
    /// Start and end, s, and height, N, of each.
    all: Vec<(f64, f64, f64)>,
}

impl Glitches {
    /// N at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        self.all.iter().filter(|(start, end, _)| t >= *start && t < *end).map(|(_, _, height)| height).sum()
    }
}

/// Jumps at random.
#[derive(Debug)]
pub struct LooseContact {
    seed: u64,
    duration: f64,
    unit: f64,
}

impl LooseContact {
    /// Some in every trial.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        Self { seed: chance.random(), duration: scene.duration, unit: 0.1 * scene.force }
    }
}

impl Shape for LooseContact {
    fn form(&self) -> &'static str {
        "short jumps of the reading"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 10.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("height", size * self.unit, Unit::Force)]
    }
}

impl Acting for LooseContact {
    fn put(&self, size: f64, physics: &mut Physics) {
        let mut chance = Chance::seed_from_u64(self.seed.wrapping_add(physics.trial as u64));
        let all = (0..15)
            .map(|_| {
                let start = chance.random_range(0.0..self.duration);
                let end = start + chance.random_range(0.005..0.06);
                (start, end, size * self.unit * sign(&mut chance) * chance.random_range(0.3..1.0))
            })
            .collect();
        physics.gauge.glitches = Some(Glitches { all });
    }
}
