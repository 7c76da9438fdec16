//! `plastic_set`: what the deepest contact leaves behind.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::physics::Physics;
use crate::scale::Unit;

/// Memory of the deepest point: beyond a yield depth a share of the way stays as a dent, and unloading is elastic.
#[derive(Debug, Clone)]
pub struct Dent {
    share: f64,
    yield_depth: f64,
    deepest: f64,
}

impl Dent {
    /// The dent, m, once the tool has been at `depth` below the surface as it was.
    pub fn left_by(&mut self, depth: f64) -> f64 {
        self.deepest = self.deepest.max(depth);
        self.share * (self.deepest - self.yield_depth).max(0.0)
    }
}

/// `plastic_set`
#[derive(Debug)]
pub struct PlasticSet {
    yield_depth: f64,
    depth: f64,
}

impl PlasticSet {
    /// With or without a depth that is borne elastically.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let share = if chance.random_bool(0.4) { 0.0 } else { chance.random_range(0.1..0.5) };
        Self { yield_depth: share * scene.depth, depth: scene.depth }
    }

    fn share(size: f64) -> f64 {
        0.05 * size
    }
}

impl Shape for PlasticSet {
    fn form(&self) -> &'static str {
        "memory of the deepest point, elastic unloading"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 15.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let share = Self::share(size);
        vec![
            Parameter::new("set_ratio", share, Unit::One),
            Parameter::new("yield_depth", self.yield_depth, Unit::Length),
            Parameter::new("set_at_full_depth", share * (self.depth - self.yield_depth), Unit::Length),
        ]
    }
}

impl Acting for PlasticSet {
    fn put(&self, size: f64, physics: &mut Physics) {
        let (share, yield_depth) = (Self::share(size), self.yield_depth);
        physics.contact.dent = Some(Dent { share, yield_depth, deepest: f64::NEG_INFINITY });
    }
}
