//! Springs that are not straight: `nonlinear_stiffness`, `layered_stiffness`, and a bump that buckles.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::stiffness::{ForceBump, Spring, StiffnessLayer};
use crate::rng::{CaseRng, sign};
use crate::scale::Unit;

/// `nonlinear_stiffness`
#[derive(Debug)]
pub struct NonlinearStiffness {
    form: usize,
    depth: f64,
    stiffness: f64,
    harder: bool,
}

impl NonlinearStiffness {
    /// Of any form.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let depth = motion.depth * rng.random_range(0.4..0.8);
        Self { form: rng.random_range(0..3), depth, stiffness: motion.nominal.stiffness, harder: sign(rng) > 0.0 }
    }

    /// A power law.
    #[must_use]
    pub fn power(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        Self { form: 0, ..Self::draw(motion, rng) }
    }

    fn exponent(&self, size: f64) -> f64 {
        if self.harder { 1.0 + size } else { 1.0 / (1.0 + size) }
    }
}

impl EffectShape for NonlinearStiffness {
    fn form(&self) -> &'static str {
        ["power law", "cubic hardening", "exponential hardening"][self.form]
    }

    fn size_range(&self) -> SizeRange {
        let largest = match (self.form, self.harder) {
            (0, true) => 1.2,
            (0, false) => 0.66,
            _ => 3.0,
        };
        SizeRange::new(0.1, largest)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let (k, d) = (self.stiffness, self.depth);
        match self.form {
            0 => {
                let exponent = self.exponent(size);
                vec![
                    EffectParameter::new("exponent", exponent, Unit::One),
                    EffectParameter::new("reference_depth", d, Unit::Length),
                ]
            }
            1 => vec![EffectParameter::new("hardening", k * size / (d * d), Unit::Hardening)],
            _ => vec![EffectParameter::new("stiffening", size / d, Unit::PerLength)],
        }
    }
}

impl SimulatedEffect for NonlinearStiffness {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let depth = self.depth;
        model.contact.spring = match self.form {
            0 => Spring::Power { depth, exponent: self.exponent(size) },
            1 => Spring::Cubic { depth: depth / size.sqrt() },
            _ => Spring::Exponential { depth: depth / size },
        };
    }
}

/// `layered_stiffness`
#[derive(Debug)]
pub struct LayeredStiffness {
    depth: f64,
    stiffness: f64,
    harder: bool,
}

impl LayeredStiffness {
    /// At a depth that the trials pass.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let depth = motion.depth * rng.random_range(0.3..0.65);
        Self { depth, stiffness: motion.nominal.stiffness, harder: rng.random_bool(0.7) }
    }

    fn second(&self, size: f64) -> f64 {
        self.stiffness * if self.harder { 1.0 + size } else { 1.0 / (1.0 + size) }
    }
}

impl EffectShape for LayeredStiffness {
    fn form(&self) -> &'static str {
        "two slopes with a rounded knee"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(0.1, 5.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![
            EffectParameter::new("layer_depth", self.depth, Unit::Length),
            EffectParameter::new("second_stiffness", self.second(size), Unit::Stiffness),
        ]
    }
}

impl SimulatedEffect for LayeredStiffness {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let extra = self.second(size) - self.stiffness;
        model.contact.layer = Some(StiffnessLayer { depth: self.depth, width: 0.03 * self.depth, extra });
    }
}

/// Outside of the list: a shell that buckles at a depth.
#[derive(Debug)]
pub struct Buckling {
    depth: f64,
    width: f64,
    unit: f64,
}

impl Buckling {
    /// At a depth that the trials pass.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let depth = motion.depth * rng.random_range(0.35..0.6);
        Self { depth, width: depth * rng.random_range(0.15..0.3), unit: 0.05 * motion.force }
    }
}

impl EffectShape for Buckling {
    fn form(&self) -> &'static str {
        "a hump of force over depth"
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(1.0, 12.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        vec![
            EffectParameter::new("height", size * self.unit, Unit::Force),
            EffectParameter::new("depth", self.depth, Unit::Length),
            EffectParameter::new("width", self.width, Unit::Length),
        ]
    }
}

impl SimulatedEffect for Buckling {
    fn apply(&self, size: f64, model: &mut RigModel) {
        let (depth, width) = (self.depth, self.width);
        model.contact.bump = Some(ForceBump { depth, width, height: size * self.unit });
    }
}
