//! The simulator of a case: our own, or an external one.

use anyhow::Result;
use serde::{Deserialize, Serialize};

use crate::closed_loop::{self, LoopSetup, SAMPLE_PERIOD_S, SimulatedTrial};
use crate::effect::registry::{ALL, EffectInfo};
use crate::effect::{self, EffectShape, NominalMotion, SimulatedEffect};
use crate::nominal::NominalParameters;
use crate::physics::RigModel;
use crate::rng::CaseRng;

/// The simulator that made a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SimulatorKind {
    /// Ours.
    Own,
    /// MuJoCo.
    Mujoco,
    /// Drake.
    Drake,
    /// Exudyn.
    Exudyn,
}

impl SimulatorKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Own, Self::Mujoco, Self::Drake, Self::Exudyn];

    /// As the answers and the command line write it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Mujoco => "mujoco",
            Self::Drake => "drake",
            Self::Exudyn => "exudyn",
        }
    }
}

/// The effects that a simulation has.
#[derive(Debug, Clone, Copy)]
pub struct SupportedEffects {
    /// One by one.
    pub effects: &'static [EffectInfo],
    /// Pairs that it cannot simulate together, or of which one contains the other, or that describe the same part.
    pub incompatible: &'static [[&'static str; 2]],
}

impl SupportedEffects {
    /// Of our own simulation.
    pub const OWN: Self = Self {
        effects: &ALL,
        incompatible: &[["coulomb_friction", "stribeck_friction"], ["backlash", "transmission_compliance"]],
    };

    /// Whether a case can hold both.
    #[must_use]
    pub fn are_compatible(&self, one: &EffectInfo, other: &EffectInfo) -> bool {
        one != other && !self.incompatible.iter().any(|pair| pair.contains(&one.name) && pair.contains(&other.name))
    }
}

/// A simulator of trials. Everything else of a case, from the rig to the noise, is the same for all simulators.
pub trait Simulator {
    /// An effect whose parameters are drawn except for its size.
    type Effect: EffectShape + ?Sized;

    /// Which simulator this is.
    fn source(&self) -> SimulatorKind;

    /// The effects that it has.
    fn supported(&self) -> SupportedEffects;

    /// The nominal physics of a rig that conceals `effects`: `drawn`, unless one of them takes the place of a part.
    fn nominal(&self, drawn: NominalParameters, effects: &[&EffectInfo]) -> NominalParameters {
        let _ = effects;
        drawn
    }

    /// The effect `name` with a shape at random; none where it is not offered.
    fn draw_effect(&self, name: &str, motion: &NominalMotion, rng: &CaseRng) -> Option<Box<Self::Effect>>;

    /// Runs a trial along each of `references`, m, one value a period; an effect of size zero is not there.
    ///
    /// # Errors
    /// The simulation cannot be had, or gave up.
    fn run(
        &mut self,
        setup: &LoopSetup,
        references: &[Vec<f64>],
        effects: &[(&Self::Effect, f64)],
    ) -> Result<Vec<SimulatedTrial>>;
}

/// Our own simulation.
#[derive(Debug, Clone, Copy)]
pub struct OwnSimulator;

impl Simulator for OwnSimulator {
    type Effect = dyn SimulatedEffect;

    fn source(&self) -> SimulatorKind {
        SimulatorKind::Own
    }

    fn supported(&self) -> SupportedEffects {
        SupportedEffects::OWN
    }

    fn draw_effect(&self, name: &str, motion: &NominalMotion, rng: &CaseRng) -> Option<Box<Self::Effect>> {
        effect::draw(name, motion, rng)
    }

    fn run(
        &mut self,
        setup: &LoopSetup,
        references: &[Vec<f64>],
        effects: &[(&Self::Effect, f64)],
    ) -> Result<Vec<SimulatedTrial>> {
        let trial = |(trial, reference): (usize, &Vec<f64>)| {
            let mut model = RigModel::new(setup.nominal, trial, SAMPLE_PERIOD_S / setup.steps as f64);
            for (shape, size) in effects.iter().filter(|(_, size)| *size > 0.0) {
                shape.apply(*size, &mut model);
            }
            closed_loop::simulate_trial(setup, model, reference)
        };
        Ok(references.iter().enumerate().map(trial).collect())
    }
}
