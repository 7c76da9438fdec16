//! Damping that is not constant: `hunt_crossley_damping`, `quadratic_damping`.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::physics::Physics;
use crate::scale::Unit;

/// `alpha d (p/d)^n`, N s/m
#[derive(Debug, Clone, Copy)]
pub struct DepthDamping {
    alpha: f64,
    depth: f64,
    exponent: f64,
}

impl DepthDamping {
    /// The damping at depth `p`, none outside.
    #[must_use]
    pub fn at(&self, p: f64) -> f64 {
        self.alpha * self.depth * (p.max(0.0) / self.depth).powf(self.exponent)
    }
}

/// `hunt_crossley_damping`
#[derive(Debug)]
pub struct HuntCrossley {
    /// Where alpha holds, m.
    depth: f64,
    exponent: f64,
    unit: f64,
}

impl HuntCrossley {
    /// With an exponent between the textbook's 1 and Hertz's 1.5.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let depth = 0.6 * scene.depth;
        let exponent = if chance.random_bool(0.5) { 1.0 } else { chance.random_range(1.0..1.5) };
        Self { depth, exponent, unit: scene.nominal.damping / depth }
    }
}

impl Shape for HuntCrossley {
    fn form(&self) -> &'static str {
        if self.exponent == 1.0 { "damping in proportion to depth" } else { "damping as a power of depth" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(0.3, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![
            Parameter::new("alpha", size * self.unit, Unit::DampingGradient),
            Parameter::new("exponent", self.exponent, Unit::One),
        ]
    }
}

impl Acting for HuntCrossley {
    fn put(&self, size: f64, physics: &mut Physics) {
        let (depth, exponent) = (self.depth, self.exponent);
        physics.contact.depth_damping = Some(DepthDamping { alpha: size * self.unit, depth, exponent });
    }
}

/// `c u^2 (|v|/u)^n`, against the motion
#[derive(Debug, Clone, Copy)]
pub struct Drag {
    coefficient: f64,
    speed: f64,
    exponent: f64,
}

impl Drag {
    /// N at velocity `v`.
    #[must_use]
    pub fn force(&self, v: f64) -> f64 {
        let force = self.coefficient * self.speed * self.speed * (v.abs() / self.speed).powf(self.exponent);
        force.copysign(v)
    }
}

/// `quadratic_damping`
#[derive(Debug)]
pub struct Quadratic {
    speed: f64,
    exponent: f64,
    unit: f64,
}

impl Quadratic {
    /// With an exponent about two.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let exponent = if chance.random_bool(0.5) { 2.0 } else { chance.random_range(1.8..2.2) };
        Self { speed: scene.speed, exponent, unit: scene.nominal.damping / scene.speed }
    }
}

impl Shape for Quadratic {
    fn form(&self) -> &'static str {
        if self.exponent == 2.0 { "v |v|" } else { "a power of speed near two" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(0.3, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![
            Parameter::new("coefficient", size * self.unit, Unit::Drag),
            Parameter::new("exponent", self.exponent, Unit::One),
        ]
    }
}

impl Acting for Quadratic {
    fn put(&self, size: f64, physics: &mut Physics) {
        let (speed, exponent) = (self.speed, self.exponent);
        physics.contact.drag = Some(Drag { coefficient: size * self.unit, speed, exponent });
    }
}
