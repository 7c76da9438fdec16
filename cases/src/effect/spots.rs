//! Outside of the list: a drive that is not the same everywhere.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::physics::Physics;
use crate::scale::Unit;

/// Narrow places with dry friction.
#[derive(Debug, Clone)]
pub struct Spots {
    places: Vec<f64>,
    width: f64,
    height: f64,
}

impl Spots {
    /// Friction at `position`, N.
    #[must_use]
    pub fn at(&self, position: f64) -> f64 {
        if self.places.iter().any(|place| (position - place).abs() < self.width) { self.height } else { 0.0 }
    }
}

/// Friction at a few places of the travel.
#[derive(Debug)]
pub struct StickySpots {
    places: Vec<f64>,
    width: f64,
    unit: f64,
}

impl StickySpots {
    /// Anywhere in the travel.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let (low, high) = scene.travel;
        let places = (0..chance.random_range(3..6)).map(|_| chance.random_range(low..high)).collect();
        Self { places, width: (high - low) * chance.random_range(0.01..0.03), unit: 0.05 * scene.effort }
    }
}

impl Shape for StickySpots {
    fn form(&self) -> &'static str {
        "dry friction at a few places"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 20.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let height = Parameter::new("friction", size * self.unit, Unit::Force);
        vec![height, Parameter::new("half_width", self.width, Unit::Length)]
    }
}

impl Acting for StickySpots {
    fn put(&self, size: f64, physics: &mut Physics) {
        let (places, height) = (self.places.clone(), size * self.unit);
        physics.drive.friction.spots = Some(Spots { places, width: self.width, height });
    }
}

/// Damping `c sin(2 pi x / l)` that feeds energy back where it is negative.
#[derive(Debug, Clone, Copy)]
pub struct Eddy {
    damping: f64,
    wave: f64,
    phase: f64,
}

impl Eddy {
    /// N at `position` and `velocity`.
    #[must_use]
    pub fn force(&self, position: f64, velocity: f64) -> f64 {
        self.damping * (self.wave * position + self.phase).sin() * velocity
    }
}

/// Damping whose sign depends on the position.
#[derive(Debug)]
pub struct SignedDamping {
    length: f64,
    phase: f64,
    unit: f64,
}

impl SignedDamping {
    /// A few waves over the travel.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let length = (scene.travel.1 - scene.travel.0) / chance.random_range(2.0..5.0);
        Self { length, phase: chance.random_range(0.0..6.2), unit: scene.nominal.viscous }
    }
}

impl Shape for SignedDamping {
    fn form(&self) -> &'static str {
        "viscous friction that changes sign over the travel"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(0.5, 10.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let damping = Parameter::new("damping", size * self.unit, Unit::Damping);
        vec![damping, Parameter::new("period", self.length, Unit::Length)]
    }
}

impl Acting for SignedDamping {
    fn put(&self, size: f64, physics: &mut Physics) {
        let wave = std::f64::consts::TAU / self.length;
        physics.drive.eddy = Some(Eddy { damping: size * self.unit, wave, phase: self.phase });
    }
}
