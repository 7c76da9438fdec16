//! A case: a rig, two trials, and the truth about them.

use std::path::Path;

use anyhow::{Context, Result};

use crate::case_request::CaseRequest;
use crate::case_spec::CaseSpec;
use crate::closed_loop::SimulatedTrial;
use crate::nominal::NominalParameters;
use crate::recorded_trial::{RecordedTrial, channels};
use crate::rig_file::RigFile;
use crate::rng::{self, Stream};
use crate::scale::{Scale, Unit};
use crate::sensors::Sensors;
use crate::simulator::{OwnSimulator, Simulator, SimulatorKind};
use crate::strength;
use crate::test_rig::TestRig;
use crate::truth::{TrueEffect, Truth};

/// One case.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The rig file's text.
    pub rig: String,
    /// Two trials.
    pub trials: Vec<RecordedTrial>,
    /// What they conceal.
    pub truth: Truth,
}

impl Case {
    /// Writes `rig.toml`, `trial-1.csv` and `trial-2.csv` into `folder`, which is made where it is missing.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<()> {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
        let rig = folder.join("rig.toml");
        std::fs::write(&rig, &self.rig).with_context(|| format!("cannot write {}", rig.display()))?;
        for (number, trial) in self.trials.iter().enumerate() {
            trial.write(&folder.join(format!("trial-{}.csv", number + 1)))?;
        }
        Ok(())
    }
}

/// Case `index` of `seed` in our own simulation, as `request` has it: the same for the same three.
///
/// # Errors
/// The request names an unknown effect, or one that its other choices hide.
pub fn draw(seed: u64, index: u64, request: &CaseRequest) -> Result<Case> {
    draw_in(&mut OwnSimulator, seed, index, request)
}

/// Case `index` of `seed` in `simulator`, as `request` has it: the same for the same four.
///
/// # Errors
/// The request names an effect that `simulator` does not have, or one that its other choices hide; or `simulator` gave up.
pub fn draw_in<W: Simulator>(simulator: &mut W, seed: u64, index: u64, request: &CaseRequest) -> Result<Case> {
    let spec = CaseSpec::draw(request, simulator.supported(), &mut rng::stream(seed, index, Stream::Spec))?;
    let rig = TestRig::draw(simulator, &spec, seed, index);
    let (effects, trials) = rig.simulate_with_effects(simulator, &spec, &rng::stream(seed, index, Stream::Effect))?;
    Ok(case(simulator.source(), seed, index, &spec, &rig, effects, &trials))
}

/// The case of a drawn rig and its trials.
pub(crate) fn case(
    source: SimulatorKind,
    seed: u64,
    index: u64,
    spec: &CaseSpec,
    rig: &TestRig,
    effects: Vec<TrueEffect>,
    trials: &[SimulatedTrial],
) -> Case {
    let mut noise = rng::stream(seed, index, Stream::Noise);
    let recordings = trials
        .iter()
        .zip(&rig.references)
        .map(|(trial, reference)| RecordedTrial::new(trial, reference, spec, &rig.sensors, &mut noise))
        .collect();
    let scale = spec.scale;
    let Sensors { position_step, force_step, force_noise } = rig.sensors;
    let truth = Truth {
        source,
        seed,
        index,
        kind: spec.kind,
        effects,
        strength: rig.strength(strength::residual(trials, &rig.setup.nominal, &rig.sensors), spec.effort),
        floor: scale.apply(rig.sensors.floor(), Unit::Force),
        floor_unit: Unit::Force.name(scale.rotary),
        channels: channels(spec),
        grade: spec.grade,
        sensors: Sensors {
            position_step: scale.apply(position_step, Unit::Length),
            force_step: scale.apply(force_step, Unit::Force),
            force_noise: scale.apply(force_noise, Unit::Force),
        },
        sensors_stated: spec.stated.0,
        nominal: scaled(&rig.setup.nominal, scale),
        stated: scaled(&rig.stated, scale),
        excitation: spec.excitation,
        scale,
    };
    Case { rig: rig_file(rig, spec).text(), trials: recordings, truth }
}

fn rig_file(rig: &TestRig, spec: &CaseSpec) -> RigFile {
    RigFile {
        scale: spec.scale,
        stated: rig.stated,
        drive: spec.effort,
        control: spec.control_stated.then_some(rig.setup.control),
        sensors: spec.stated.0.then_some(rig.sensors),
        noise: spec.stated.1,
    }
}

fn scaled(nominal: &NominalParameters, scale: Scale) -> NominalParameters {
    NominalParameters {
        mass: scale.apply(nominal.mass, Unit::Mass),
        viscous: scale.apply(nominal.viscous, Unit::Damping),
        stiffness: scale.apply(nominal.stiffness, Unit::Stiffness),
        damping: scale.apply(nominal.damping, Unit::Damping),
        surface: scale.apply(nominal.surface, Unit::Length),
        bilateral: nominal.bilateral,
    }
}
