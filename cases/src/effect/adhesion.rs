//! `adhesion`: a neck that stretches and snaps.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::physics::Physics;
use crate::scale::Unit;

/// Forms on touch; bears the spring's pull up to its strength, then flows and weakens over its length until it snaps.
#[derive(Debug, Clone)]
pub struct Neck {
    pull: f64,
    length: f64,
    snap: f64,
    /// Depth at which the spring pulls with the full strength, below which the neck flows.
    flow: f64,
    formed: bool,
}

impl Neck {
    /// Forms or snaps, the tool being at `depth` in a surface of `stiffness`.
    pub fn advance(&mut self, depth: f64, stiffness: f64) {
        self.flow = -self.pull / stiffness;
        let stretched = (self.flow - depth).max(0.0) / self.length;
        self.formed = depth > 0.0 || (self.formed && stretched < self.snap);
    }

    /// The strongest pull it bears, as a force, at `depth`; zero where there is no neck.
    #[must_use]
    pub fn least(&self, depth: f64) -> f64 {
        if self.formed { -self.pull * (1.0 - (self.flow - depth).max(0.0) / self.length) } else { 0.0 }
    }
}

/// `adhesion`
#[derive(Debug)]
pub struct Adhesion {
    length: f64,
    snap: f64,
    unit: f64,
}

impl Adhesion {
    /// With a neck that is short against the contact's depth.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let length = scene.depth * chance.random_range(0.05..0.4);
        Self { length, snap: chance.random_range(0.3..1.0), unit: 0.02 * scene.force }
    }
}

impl Shape for Adhesion {
    fn form(&self) -> &'static str {
        "a neck that flows and snaps"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 50.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![
            Parameter::new("pull_off", size * self.unit, Unit::Force),
            Parameter::new("neck_length", self.length * self.snap, Unit::Length),
        ]
    }
}

impl Acting for Adhesion {
    fn put(&self, size: f64, physics: &mut Physics) {
        let (length, snap) = (self.length, self.snap);
        physics.contact.neck = Some(Neck { pull: size * self.unit, length, snap, flow: 0.0, formed: false });
    }
}
