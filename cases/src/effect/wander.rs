//! Outside of the list: a zero that walks at random, as with the temperature.

use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::physics::Physics;
use crate::scale::Unit;

/// Between the points of the walk, s.
const SPACING: f64 = 0.05;

/// A walk between points.
#[derive(Debug, Clone)]
pub struct Wander {
    points: Vec<f64>,
}

impl Wander {
    /// N at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let place = (t / SPACING).max(0.0);
        let at = (place as usize).min(self.points.len() - 2);
        self.points[at] + (place - at as f64).min(1.0) * (self.points[at + 1] - self.points[at])
    }
}

/// Low-passed random walk of the force.
#[derive(Debug)]
pub struct ThermalWander {
    seed: u64,
    time: f64,
    duration: f64,
    unit: f64,
}

impl ThermalWander {
    /// Slow against the motion.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let time = chance.random_range(0.5..2.0);
        Self { seed: chance.random(), time, duration: scene.duration, unit: 0.01 * scene.force }
    }
}

impl Shape for ThermalWander {
    fn form(&self) -> &'static str {
        "a low-passed random walk of the force"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 50.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let step = Parameter::new("step_per_root_second", size * self.unit, Unit::Force);
        vec![step, Parameter::new("smoothing", self.time, Unit::Time)]
    }
}

impl Acting for ThermalWander {
    fn put(&self, size: f64, physics: &mut Physics) {
        let mut chance = Chance::seed_from_u64(self.seed.wrapping_add(physics.trial as u64));
        let (mut walk, mut smooth) = (0.0, 0.0);
        let points = (0..(self.duration / SPACING) as usize + 4)
            .map(|_| {
                let step: f64 = StandardNormal.sample(&mut chance);
                walk += step * SPACING.sqrt() - walk * SPACING / 10.0;
                smooth += (walk - smooth) * SPACING / self.time;
                smooth * size * self.unit
            })
            .collect();
        physics.gauge.wander = Some(Wander { points });
    }
}
