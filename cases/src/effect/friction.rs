//! Dry friction: `coulomb_friction`, `stribeck_friction`, `load_dependent_friction`. Set-valued: it holds what stands.

use rand::RngExt;

use super::spots::Spots;
use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::{Chance, log_uniform};
use crate::physics::Physics;
use crate::scale::Unit;

/// All dry friction of the drive.
#[derive(Debug, Clone, Default)]
pub struct Friction {
    /// Against motion forward and backward, N.
    pub coulomb: (f64, f64),
    /// More while it is slow.
    pub stribeck: Option<Stribeck>,
    /// Per newton of contact force.
    pub load: f64,
    /// Places where it sticks.
    pub spots: Option<Spots>,
}

/// `S exp(-(|v|/u)^n)` on top of what remains at speed.
#[derive(Debug, Clone, Copy)]
pub struct Stribeck {
    kinetic: f64,
    extra: f64,
    speed: f64,
    exponent: i32,
}

impl Friction {
    /// Friction against motion forward and backward, N, at `velocity` under contact force `load`.
    #[must_use]
    pub fn brake(&self, position: f64, velocity: f64, load: f64) -> (f64, f64) {
        let mut both = self.load * load.abs();
        if let Some(Stribeck { kinetic, extra, speed, exponent }) = self.stribeck {
            both += kinetic + extra * (-(velocity.abs() / speed).powi(exponent)).exp();
        }
        if let Some(spots) = &self.spots {
            both += spots.at(position);
        }
        (self.coulomb.0 + both, self.coulomb.1 + both)
    }
}

/// `coulomb_friction`
#[derive(Debug)]
pub struct Coulomb {
    asymmetry: f64,
    unit: f64,
}

impl Coulomb {
    /// Alike in both directions half of the time.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let asymmetry = if chance.random_bool(0.5) { 0.0 } else { chance.random_range(-0.4..0.4) };
        Self { asymmetry, unit: 0.02 * scene.effort }
    }

    /// Alike in both directions.
    #[must_use]
    pub fn even(scene: &Scene) -> Self {
        Self { asymmetry: 0.0, unit: 0.02 * scene.effort }
    }

    fn levels(&self, size: f64) -> (f64, f64) {
        let level = size * self.unit;
        (level * (1.0 + self.asymmetry), level * (1.0 - self.asymmetry))
    }
}

impl Shape for Coulomb {
    fn form(&self) -> &'static str {
        if self.asymmetry == 0.0 { "set-valued" } else { "set-valued, asymmetric" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 25.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let (forward, backward) = self.levels(size);
        vec![
            Parameter::new("coulomb", 0.5 * (forward + backward), Unit::Force),
            Parameter::new("coulomb_forward", forward, Unit::Force),
            Parameter::new("coulomb_backward", backward, Unit::Force),
        ]
    }
}

impl Acting for Coulomb {
    fn put(&self, size: f64, physics: &mut Physics) {
        physics.drive.friction.coulomb = self.levels(size);
    }
}

/// `stribeck_friction`
#[derive(Debug)]
pub struct Slowing {
    ratio: f64,
    speed: f64,
    exponent: i32,
    unit: f64,
}

impl Slowing {
    /// At rest two to four times as much as at speed.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let speed = scene.speed * log_uniform(chance, 0.05, 0.4);
        let exponent = if chance.random_bool(0.5) { 1 } else { 2 };
        Self { ratio: chance.random_range(0.25..0.5), speed, exponent, unit: 0.02 * scene.effort }
    }

    /// Falling off as an exponential of the speed.
    #[must_use]
    pub fn exponential(scene: &Scene, chance: &mut Chance) -> Self {
        Self { exponent: 1, ..Self::draw(scene, chance) }
    }
}

impl Shape for Slowing {
    fn form(&self) -> &'static str {
        if self.exponent == 1 { "set-valued, exponential" } else { "set-valued, Gaussian" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 30.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let level = size * self.unit;
        vec![
            Parameter::new("static", level, Unit::Force),
            Parameter::new("coulomb", self.ratio * level, Unit::Force),
            Parameter::new("stribeck_velocity", self.speed, Unit::Velocity),
        ]
    }
}

impl Acting for Slowing {
    fn put(&self, size: f64, physics: &mut Physics) {
        let level = size * self.unit;
        let (kinetic, extra) = (self.ratio * level, (1.0 - self.ratio) * level);
        physics.drive.friction.stribeck = Some(Stribeck { kinetic, extra, speed: self.speed, exponent: self.exponent });
    }
}

/// `load_dependent_friction`: `mu |F|`
#[derive(Debug)]
pub struct LoadDependent;

impl Shape for LoadDependent {
    fn form(&self) -> &'static str {
        "set-valued, in proportion to the contact force"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(0.05, 0.6)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("coefficient", size, Unit::One)]
    }
}

impl Acting for LoadDependent {
    fn put(&self, size: f64, physics: &mut Physics) {
        physics.drive.friction.load = size;
    }
}
