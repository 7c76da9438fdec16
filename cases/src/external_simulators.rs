//! Cases in external simulators: MuJoCo, Drake and Exudyn, each a script in `cases/simulators` that runs as a
//! process process. Specification, rig, sensors, strength, search and recording are those of all cases; the integrator, the
//! contacts, the joints, the friction and the force sensor are those of the simulator.

use anyhow::{Result, bail};

use crate::closed_loop::{LoopSetup, SimulatedTrial};
use crate::effect::registry::EffectInfo;
use crate::effect::{EffectShape, NominalMotion};
use crate::nominal::NominalParameters;
use crate::rng::CaseRng;
use crate::simulator::{Simulator, SimulatorKind, SupportedEffects};

mod process;
pub mod shape;
pub mod supported;

use crate::python::Python;
use process::{SimulatorProcess, SimulatorReply};
use shape::ExternalEffect;

/// A simulator that waits for trials.
#[derive(Debug)]
pub struct ExternalSimulator {
    source: SimulatorKind,
    process: SimulatorProcess,
}

impl ExternalSimulator {
    /// Starts the script of `source` under `python`, and waits until the simulator has been loaded.
    ///
    /// # Errors
    /// `source` is our own, or the script does not come up.
    pub fn start(python: &Python, source: SimulatorKind) -> Result<Self> {
        if source == SimulatorKind::Own {
            bail!("our own simulation needs no script");
        }
        Ok(Self { source, process: SimulatorProcess::start(python, source.name())? })
    }
}

impl Simulator for ExternalSimulator {
    type Effect = ExternalEffect;

    fn source(&self) -> SimulatorKind {
        self.source
    }

    fn supported(&self) -> SupportedEffects {
        supported::effects_of(self.source)
    }

    fn nominal(&self, drawn: NominalParameters, effects: &[&EffectInfo]) -> NominalParameters {
        // Drake has either contact, and its Hunt-Crossley contact has no linear damper beside it.
        let replaced =
            self.source == SimulatorKind::Drake && effects.iter().any(|info| info.name == "hunt_crossley_damping");
        if replaced { NominalParameters { damping: 0.0, ..drawn } } else { drawn }
    }

    fn draw_effect(&self, name: &str, motion: &NominalMotion, rng: &CaseRng) -> Option<Box<Self::Effect>> {
        let info = self.supported().effects.iter().find(|info| info.name == name)?;
        shape::draw(info.name, motion, rng).map(Box::new)
    }

    fn run(
        &mut self,
        setup: &LoopSetup,
        references: &[Vec<f64>],
        effects: &[(&Self::Effect, f64)],
    ) -> Result<Vec<SimulatedTrial>> {
        let present = || effects.iter().filter(|(_, size)| *size > 0.0);
        let values = present().map(|(effect, size)| (effect.name, effect.parameters(*size))).collect::<Vec<_>>();
        match self.process.simulate(setup, references, &values)? {
            SimulatorReply::Trials(trials) => Ok(trials),
            // A size that the simulator cannot bring to an end is no possible size: the search looks below it.
            SimulatorReply::GaveUp(_) if !values.is_empty() => Ok(references.iter().map(|_| diverged()).collect()),
            SimulatorReply::GaveUp(why) => bail!("{} gave up on a trial without any effect: {why}", self.source.name()),
        }
    }
}

/// A trial that went to diverged, which [`SimulatedTrial::stays_within`] refuses.
fn diverged() -> SimulatedTrial {
    SimulatedTrial { position: vec![f64::NAN], ..SimulatedTrial::default() }
}
