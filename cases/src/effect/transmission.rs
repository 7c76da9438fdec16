//! Two masses with something between them: `backlash`, `transmission_compliance`.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::transmission::Transmission;
use crate::rng::CaseRng;
use crate::scale::Unit;

/// Natural frequency of the stiffest transmission, rad/s: it has to be soft against the step of 20 kHz.
const MAX_NATURAL_RATE_RAD_S: f64 = 6000.0;

/// What both effects draw.
#[derive(Debug)]
struct MassSplit {
    share: f64,
    /// Damping over stiffness, s: a stiff part rings for a shorter time.
    relaxation: f64,
    reduced: f64,
}

impl MassSplit {
    fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let share = rng.random_range(0.2..0.4);
        Self { share, relaxation: rng.random_range(1.5e-4..4e-4), reduced: share * (1.0 - share) * motion.nominal.mass }
    }

    fn tool_mass(&self) -> f64 {
        self.reduced / (1.0 - self.share)
    }

    fn transmission(&self, rate: f64, gap: f64) -> Transmission {
        let stiffness = self.reduced * rate * rate;
        Transmission { share: self.share, stiffness, damping: self.relaxation * stiffness, gap }
    }
}

/// `backlash`
#[derive(Debug)]
pub struct Backlash {
    split: MassSplit,
    unit: f64,
}

impl Backlash {
    /// Between stiff teeth.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        Self { split: MassSplit::draw(motion, rng), unit: 0.002 * motion.depth }
    }
}

impl EffectShape for Backlash {
    fn form(&self) -> &'static str {
        "two masses with a gap between stiff teeth"
    }

    fn size_range(&self) -> SizeRange {
        // Less is lost between two steps of any encoder here.
        SizeRange { smallest: 1.0, initial: 1.0, largest: 150.0 }
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let gap = EffectParameter::new("gap", size * self.unit, Unit::Length);
        vec![gap, EffectParameter::new("tool_mass", self.split.tool_mass(), Unit::Mass)]
    }
}

impl SimulatedEffect for Backlash {
    fn apply(&self, size: f64, model: &mut RigModel) {
        self.split.transmission(MAX_NATURAL_RATE_RAD_S, size * self.unit).add_to(&mut model.drive);
    }
}

/// `transmission_compliance`
#[derive(Debug)]
pub struct TransmissionCompliance {
    split: MassSplit,
}

impl TransmissionCompliance {
    /// Lightly damped.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        Self { split: MassSplit::draw(motion, rng) }
    }

    fn transmission(&self, size: f64) -> Transmission {
        self.split.transmission(MAX_NATURAL_RATE_RAD_S / size.sqrt(), 0.0)
    }
}

impl EffectShape for TransmissionCompliance {
    fn form(&self) -> &'static str {
        "two masses with a spring between them"
    }

    fn size_range(&self) -> SizeRange {
        // A link that rings above 120 Hz is as good as rigid to samples at 1 kHz.
        SizeRange { smallest: 60.0, initial: 150.0, largest: 2500.0 }
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let transmission = self.transmission(size);
        vec![
            EffectParameter::new("stiffness", transmission.stiffness, Unit::Stiffness),
            EffectParameter::new("damping", transmission.damping, Unit::Damping),
            EffectParameter::new("tool_mass", self.split.tool_mass(), Unit::Mass),
        ]
    }
}

impl SimulatedEffect for TransmissionCompliance {
    fn apply(&self, size: f64, model: &mut RigModel) {
        self.transmission(size).add_to(&mut model.drive);
    }
}
