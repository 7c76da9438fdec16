//! A case: a rig, two trials, and the truth about them.

use std::path::Path;

use anyhow::{Context, Result};

use crate::bench::Bench;
use crate::chance::{self, Stream};
use crate::nominal::Nominal;
use crate::plan::Plan;
use crate::recording::{Recording, channels};
use crate::rig::RigFile;
use crate::scale::{Scale, Unit};
use crate::sensors::Sensors;
use crate::strength;
use crate::truth::Truth;
use crate::wish::Wish;
use crate::world::{Own, World};

/// One case.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The rig file's text.
    pub rig: String,
    /// Two trials.
    pub trials: Vec<Recording>,
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

/// Case `index` of `seed` in our own simulation, as `wish` has it: the same for the same three.
///
/// # Errors
/// The wish names an unknown effect, or one that its other choices hide.
pub fn draw(seed: u64, index: u64, wish: &Wish) -> Result<Case> {
    draw_in(&mut Own, seed, index, wish)
}

/// Case `index` of `seed` in `world`, as `wish` has it: the same for the same four.
///
/// # Errors
/// The wish names an effect that `world` does not have, or one that its other choices hide; or `world` gave up.
pub fn draw_in<W: World>(world: &mut W, seed: u64, index: u64, wish: &Wish) -> Result<Case> {
    let plan = Plan::draw(wish, world.offer(), &mut chance::stream(seed, index, Stream::Plan))?;
    let bench = Bench::draw(world, &plan, seed, index);
    let (effects, tracks) = bench.conceal(world, &plan, &chance::stream(seed, index, Stream::Shape))?;
    let mut noise = chance::stream(seed, index, Stream::Noise);
    let trials = tracks
        .iter()
        .zip(&bench.references)
        .map(|(track, reference)| Recording::new(track, reference, &plan, &bench.sensors, &mut noise))
        .collect();
    let scale = plan.scale;
    let Sensors { position_step, force_step, force_noise } = bench.sensors;
    let truth = Truth {
        source: world.source(),
        seed,
        index,
        kind: plan.kind,
        effects,
        strength: bench.ratio(strength::residual(&tracks, &bench.setup.nominal, &bench.sensors), plan.effort),
        floor: scale.apply(bench.sensors.floor(), Unit::Force),
        floor_unit: Unit::Force.name(scale.rotary),
        channels: channels(&plan),
        grade: plan.grade,
        sensors: Sensors {
            position_step: scale.apply(position_step, Unit::Length),
            force_step: scale.apply(force_step, Unit::Force),
            force_noise: scale.apply(force_noise, Unit::Force),
        },
        sensors_stated: plan.stated.0,
        nominal: scaled(&bench.setup.nominal, scale),
        stated: scaled(&bench.stated, scale),
        reference: plan.reference,
        scale,
    };
    Ok(Case { rig: rig_file(&bench, &plan).text(), trials, truth })
}

fn rig_file(bench: &Bench, plan: &Plan) -> RigFile {
    RigFile {
        scale: plan.scale,
        stated: bench.stated,
        drive: plan.effort,
        control: plan.control_stated.then_some(bench.setup.control),
        sensors: plan.stated.0.then_some(bench.sensors),
        noise: plan.stated.1,
    }
}

fn scaled(nominal: &Nominal, scale: Scale) -> Nominal {
    Nominal {
        mass: scale.apply(nominal.mass, Unit::Mass),
        viscous: scale.apply(nominal.viscous, Unit::Damping),
        stiffness: scale.apply(nominal.stiffness, Unit::Stiffness),
        damping: scale.apply(nominal.damping, Unit::Damping),
        surface: scale.apply(nominal.surface, Unit::Length),
        bilateral: nominal.bilateral,
    }
}
