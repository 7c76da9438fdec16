//! `environment_mass`: mass that the tool moves along.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::physics::Physics;
use crate::scale::Unit;

/// Mass that engages over a depth, `m(p) = m (1 - exp(-p/d))`: by Lagrange `F = m(p) a + m'(p) v^2 / 2`, which keeps
/// the energy and needs no impulse at the first touch.
#[derive(Debug, Clone, Copy)]
pub struct Tissue {
    mass: f64,
    /// None: clamped to the tool, all there at any depth and on either side.
    depth: Option<f64>,
}

impl Tissue {
    /// Mass at depth `p`, and the force that moving in at `velocity` takes.
    #[must_use]
    pub fn at(&self, p: f64, velocity: f64) -> (f64, f64) {
        let Some(depth) = self.depth else { return (self.mass, 0.0) };
        if p <= 0.0 {
            return (0.0, 0.0);
        }
        let left = (-p / depth).exp();
        (self.mass * (1.0 - left), 0.5 * self.mass * left / depth * velocity * velocity)
    }
}

/// `environment_mass`
#[derive(Debug)]
pub struct EnvironmentMass {
    depth: f64,
    bilateral: bool,
    unit: f64,
}

impl EnvironmentMass {
    /// Engaged within a tenth of the contact's depth.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let depth = scene.depth * chance.random_range(0.04..0.12);
        Self { depth, bilateral: scene.nominal.bilateral, unit: 0.05 * scene.nominal.mass }
    }
}

impl Shape for EnvironmentMass {
    fn form(&self) -> &'static str {
        if self.bilateral { "mass clamped to the tool" } else { "mass that engages over a depth" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("mass", size * self.unit, Unit::Mass)]
    }
}

impl Acting for EnvironmentMass {
    fn put(&self, size: f64, physics: &mut Physics) {
        let depth = (!self.bilateral).then_some(self.depth);
        physics.contact.tissue = Some(Tissue { mass: size * self.unit, depth });
    }
}
