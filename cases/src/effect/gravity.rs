//! `gravity_load`: weight, constant along a line and by the angle about an axis.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::{Chance, sign};
use crate::physics::Physics;
use crate::scale::Unit;

/// `G`, or `G sin(q + q0)` about an axis.
#[derive(Debug, Clone, Copy)]
pub struct Gravity {
    weight: f64,
    /// Radians per metre of the bench, and q0.
    angle: Option<(f64, f64)>,
}

impl Gravity {
    /// N against forward motion at `position`.
    #[must_use]
    pub fn force(&self, position: f64) -> f64 {
        self.angle.map_or(self.weight, |(slope, zero)| self.weight * (slope * position + zero).sin())
    }
}

/// `gravity_load`
#[derive(Debug)]
pub struct GravityLoad {
    angle: Option<(f64, f64)>,
    unit: f64,
}

impl GravityLoad {
    /// Up or down.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let angle = scene.scale.rotary.then(|| (scene.scale.length, chance.random_range(-1.2..1.2)));
        Self { angle, unit: 0.02 * scene.effort * sign(chance) }
    }

    /// The same wherever the tool is.
    #[must_use]
    pub fn constant(scene: &Scene, chance: &mut Chance) -> Self {
        Self { angle: None, unit: 0.02 * scene.effort * sign(chance) }
    }
}

impl Shape for GravityLoad {
    fn form(&self) -> &'static str {
        if self.angle.is_some() { "by angle" } else { "constant" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 60.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let weight = Parameter::new("load", size * self.unit, Unit::Force);
        let zero = self.angle.map(|(_, zero)| Parameter::new("angle_zero", zero, Unit::Angle));
        std::iter::once(weight).chain(zero).collect()
    }
}

impl Acting for GravityLoad {
    fn put(&self, size: f64, physics: &mut Physics) {
        physics.drive.gravity = Some(Gravity { weight: size * self.unit, angle: self.angle });
    }
}
