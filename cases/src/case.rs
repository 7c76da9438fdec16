//! A case: a rig, two trials, and the truth about them.

use std::path::Path;

use anyhow::{Context, Result, anyhow};
use rand::RngExt;

use crate::chance::{self, Chance, Stream};
use crate::effect::name::Known;
use crate::effect::{self, Scene, Shape};
use crate::nominal::{Control, Nominal};
use crate::physics::Physics;
use crate::plan::Plan;
use crate::recording::{Recording, channels};
use crate::reference;
use crate::rig::RigFile;
use crate::scale::{Scale, Unit};
use crate::search::{self, Found};
use crate::sensors::Sensors;
use crate::simulate::{self, Encoder, PERIOD, STEPS, Setup, Track};
use crate::strength::{self, Residual};
use crate::truth::{TrueEffect, TrueValue, Truth};
use crate::wish::Wish;

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

/// Case `index` of `seed`, as `wish` has it: the same for the same three.
///
/// # Errors
/// The wish names an unknown effect, or one that its other choices hide.
pub fn draw(seed: u64, index: u64, wish: &Wish) -> Result<Case> {
    let plan = Plan::draw(wish, &mut chance::stream(seed, index, Stream::Plan))?;
    let bench = Bench::draw(&plan, seed, index);
    let (effects, tracks) = bench.conceal(&plan, &chance::stream(seed, index, Stream::Shape))?;
    let mut noise = chance::stream(seed, index, Stream::Noise);
    let trials = tracks
        .iter()
        .zip(&bench.references)
        .map(|(track, reference)| Recording::new(track, reference, &plan, &bench.sensors, &mut noise))
        .collect();
    let together = bench.ratio(strength::residual(&tracks, &bench.setup.nominal), plan.effort);
    Ok(Case { rig: bench.rig_file(&plan).text(), trials, truth: bench.truth(&plan, seed, index, effects, together) })
}

/// The rig of a case with its trajectories.
struct Bench {
    setup: Setup,
    stated: Nominal,
    sensors: Sensors,
    references: Vec<Vec<f64>>,
}

impl Bench {
    fn draw(plan: &Plan, seed: u64, index: u64) -> Self {
        let chance = &mut chance::stream(seed, index, Stream::Rig);
        let (nominal, deepest) = Nominal::draw(chance, plan.bilateral);
        let control = Control::draw(chance, &nominal);
        let sensors = Sensors::new(plan.grade);
        let offset = sensors.position_step * chance.random_range(-0.5..0.5);
        let encoder = Encoder { step: sensors.position_step, offset };
        let stated = if plan.exact { nominal } else { misstated(&nominal, deepest, chance) };
        let paths = &mut chance::stream(seed, index, Stream::Reference);
        let believed = Nominal { surface: nominal.surface, ..misstated(&nominal, deepest, paths) };
        let references = (0..2)
            .map(|_| {
                let depths = reference::depths(plan.reference, &nominal, deepest, paths);
                reference::lead(&depths, &believed, &control)
            })
            .collect();
        Self { setup: Setup { nominal, control, encoder, steps: STEPS }, stated, sensors, references }
    }

    fn run(&self, effects: &[(&dyn Shape, f64)]) -> Vec<Track> {
        let trial = |(trial, reference): (usize, &Vec<f64>)| {
            let mut physics = Physics::new(self.setup.nominal, trial, PERIOD / self.setup.steps as f64);
            for (shape, size) in effects.iter().filter(|(_, size)| *size > 0.0) {
                shape.put(*size, &mut physics);
            }
            simulate::run(&self.setup, physics, reference)
        };
        self.references.iter().enumerate().map(trial).collect()
    }

    fn ratio(&self, residual: Residual, effort: bool) -> f64 {
        let largest = if effort { residual.force.max(residual.effort) } else { residual.force };
        largest / self.sensors.floor()
    }

    /// Finds the size of each effect alone, and runs them together.
    fn conceal(&self, plan: &Plan, chance: &Chance) -> Result<(Vec<TrueEffect>, Vec<Track>)> {
        let mut tracks = self.run(&[]);
        let scene = scene(&tracks, &self.setup.nominal, plan.scale);
        let (mut effects, mut shapes) = (Vec::new(), Vec::new());
        for (known, asked) in &plan.effects {
            let missing = || anyhow!("{} has no shape", known.name);
            let shape = effect::draw(known.name, &scene, chance).ok_or_else(missing)?;
            let size;
            (size, tracks) = if *asked > 0.0 {
                let found = self.size(shape.as_ref(), *asked, plan.effort, &scene);
                (found.size, found.left)
            } else {
                (0.0, self.run(&[]))
            };
            effects.push(self.answer(known, *asked, shape.as_ref(), size, plan, &tracks));
            shapes.push((shape, size));
        }
        if shapes.len() > 1 {
            tracks = self.run(&shapes.iter().map(|(shape, size)| (shape.as_ref(), *size)).collect::<Vec<_>>());
        }
        Ok((effects, tracks))
    }

    /// The size at which `shape` alone is as strong as `asked`.
    fn size(&self, shape: &dyn Shape, asked: f64, effort: bool, scene: &Scene) -> Found<Vec<Track>> {
        search::find(asked, shape.sizes(), |size| {
            let tracks = self.run(&[(shape, size)]);
            let sane = tracks.iter().all(|track| track.is_sane(scene.travel));
            let ratio = || self.ratio(strength::residual(&tracks, &self.setup.nominal), effort);
            (if sane { ratio() } else { f64::INFINITY }, tracks)
        })
    }

    /// What is true of an effect that alone left `tracks`.
    fn answer(
        &self,
        known: &Known,
        asked: f64,
        shape: &dyn Shape,
        size: f64,
        plan: &Plan,
        tracks: &[Track],
    ) -> TrueEffect {
        let residual = strength::residual(tracks, &self.setup.nominal);
        TrueEffect {
            name: known.name,
            acts_in: known.acts,
            listed: known.listed,
            form: shape.form(),
            parameters: values(shape, size, plan.scale),
            strength_asked: asked,
            strength: self.ratio(residual, plan.effort),
            in_force: residual.force / self.sensors.floor(),
            in_effort: residual.effort / self.sensors.floor(),
        }
    }

    fn rig_file(&self, plan: &Plan) -> RigFile {
        RigFile {
            scale: plan.scale,
            stated: self.stated,
            drive: plan.effort,
            control: plan.control_stated.then_some(self.setup.control),
            sensors: plan.stated.0.then_some(self.sensors),
            noise: plan.stated.1,
        }
    }

    fn truth(&self, plan: &Plan, seed: u64, index: u64, effects: Vec<TrueEffect>, strength: f64) -> Truth {
        let scale = plan.scale;
        let Sensors { position_step, force_step, force_noise } = self.sensors;
        Truth {
            seed,
            index,
            kind: plan.kind,
            effects,
            strength,
            floor: scale.apply(self.sensors.floor(), Unit::Force),
            floor_unit: Unit::Force.name(scale.rotary),
            channels: channels(plan),
            grade: plan.grade,
            sensors: Sensors {
                position_step: scale.apply(position_step, Unit::Length),
                force_step: scale.apply(force_step, Unit::Force),
                force_noise: scale.apply(force_noise, Unit::Force),
            },
            sensors_stated: plan.stated.0,
            nominal: scaled(&self.setup.nominal, scale),
            stated: scaled(&self.stated, scale),
            reference: plan.reference,
            scale,
        }
    }
}

/// Every value wrong by up to 30 %, and the surface by a tenth of the depth.
fn misstated(nominal: &Nominal, deepest: f64, chance: &mut Chance) -> Nominal {
    let mut factor = || chance.random_range(0.7..1.3);
    Nominal {
        mass: nominal.mass * factor(),
        viscous: nominal.viscous * factor(),
        stiffness: nominal.stiffness * factor(),
        damping: nominal.damping * factor(),
        surface: nominal.surface + (factor() - 1.0) / 3.0 * deepest,
        bilateral: nominal.bilateral,
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

fn values(shape: &dyn Shape, size: f64, scale: Scale) -> Vec<TrueValue> {
    let value = |parameter: effect::Parameter| TrueValue {
        name: parameter.name,
        value: scale.apply(parameter.value, parameter.unit),
        unit: parameter.unit.name(scale.rotary),
    };
    shape.parameters(size).into_iter().map(value).collect()
}

fn scene(tracks: &[Track], nominal: &Nominal, scale: Scale) -> Scene {
    let all = |of: fn(&Track) -> &Vec<f64>| tracks.iter().flat_map(of).copied();
    let largest = |of| all(of).fold(0.0, |most: f64, value| most.max(value.abs()));
    let low = all(|track| &track.position).fold(f64::INFINITY, f64::min);
    let high = all(|track| &track.position).fold(f64::NEG_INFINITY, f64::max);
    let touching = all(|track| &track.velocity).zip(all(|track| &track.force)).filter(|(_, force)| *force != 0.0);
    let (sum, count) = touching.fold((0.0, 0.0), |(sum, count), (v, _)| (sum + v * v, count + 1.0));
    Scene {
        nominal: *nominal,
        depth: high - nominal.surface,
        force: largest(|track| &track.force),
        effort: largest(|track| &track.effort),
        speed: f64::sqrt(sum / f64::max(count, 1.0)).max(1e-3),
        travel: (low, high),
        duration: tracks.iter().map(|track| track.force.len()).max().unwrap_or(0) as f64 * PERIOD,
        scale,
    }
}
