//! The rig of a case with its trajectories, and the search for what it conceals.

use anyhow::{Result, anyhow};
use rand::RngExt;

use crate::chance::{self, Chance, Stream};
use crate::effect::name::Known;
use crate::effect::{self, Scene, Shape};
use crate::nominal::{Control, Nominal};
use crate::plan::Plan;
use crate::reference;
use crate::scale::Scale;
use crate::search::{self, Found};
use crate::sensors::Sensors;
use crate::simulate::{Encoder, PERIOD, STEPS, Setup, Track};
use crate::strength::{self, Residual};
use crate::truth::{TrueEffect, TrueValue};
use crate::world::World;

/// The rig of a case with its trajectories.
#[derive(Debug, Clone)]
pub struct Bench {
    /// What its effects leave alone.
    pub setup: Setup,
    /// What the rig file says of it.
    pub stated: Nominal,
    /// Its sensors.
    pub sensors: Sensors,
    /// What the controller follows, m, one value a period.
    pub references: Vec<Vec<f64>>,
}

impl Bench {
    /// The rig of case `index` of `seed` in `world`.
    #[must_use]
    pub fn draw<W: World>(world: &W, plan: &Plan, seed: u64, index: u64) -> Self {
        let chance = &mut chance::stream(seed, index, Stream::Rig);
        let (drawn, deepest) = Nominal::draw(chance, plan.bilateral);
        let control = Control::draw(chance, &drawn);
        let sensors = Sensors::new(plan.grade);
        let offset = sensors.position_step * chance.random_range(-0.5..0.5);
        let encoder = Encoder { step: sensors.position_step, offset };
        let concealed: Vec<&Known> = plan.effects.iter().map(|(known, _)| *known).collect();
        let nominal = world.nominal(drawn, &concealed);
        let stated = if plan.exact { nominal } else { misstated(&drawn, deepest, chance) };
        let paths = &mut chance::stream(seed, index, Stream::Reference);
        let believed = Nominal { surface: drawn.surface, ..misstated(&drawn, deepest, paths) };
        let references = (0..2)
            .map(|_| {
                let depths = reference::depths(plan.reference, &drawn, deepest, paths);
                reference::lead(&depths, &believed, &control)
            })
            .collect();
        Self { setup: Setup { nominal, control, encoder, steps: STEPS }, stated, sensors, references }
    }

    /// The larger of both residuals over the floor, that of the effort only where it is recorded.
    #[must_use]
    pub fn ratio(&self, residual: Residual, effort: bool) -> f64 {
        let largest = if effort { residual.force.max(residual.effort) } else { residual.force };
        largest / self.sensors.floor()
    }

    /// Finds the size of each effect of `plan` alone, and runs them together.
    ///
    /// # Errors
    /// `world` has no such effect, or gave up.
    pub fn conceal<W: World>(
        &self,
        world: &mut W,
        plan: &Plan,
        chance: &Chance,
    ) -> Result<(Vec<TrueEffect>, Vec<Track>)> {
        let mut tracks = world.run(&self.setup, &self.references, &[])?;
        let scene = scene(&tracks, &self.setup.nominal, plan.scale);
        let (mut effects, mut shapes) = (Vec::new(), Vec::new());
        for (known, asked) in &plan.effects {
            let missing = || anyhow!("{} has no shape", known.name);
            let shape = world.shape(known.name, &scene, chance).ok_or_else(missing)?;
            let size;
            (size, tracks) = if *asked > 0.0 {
                let found = self.size(world, shape.as_ref(), *asked, plan.effort, &scene)?;
                (found.size, found.left)
            } else {
                (0.0, world.run(&self.setup, &self.references, &[])?)
            };
            effects.push(self.answer(known, *asked, shape.as_ref(), size, plan, &tracks));
            shapes.push((shape, size));
        }
        if shapes.len() > 1 {
            let all: Vec<_> = shapes.iter().map(|(shape, size)| (shape.as_ref(), *size)).collect();
            tracks = world.run(&self.setup, &self.references, &all)?;
        }
        Ok((effects, tracks))
    }

    /// The size at which `shape` alone is as strong as `asked`.
    fn size<W: World>(
        &self,
        world: &mut W,
        shape: &W::Effect,
        asked: f64,
        effort: bool,
        scene: &Scene,
    ) -> Result<Found<Vec<Track>>> {
        search::find(asked, shape.sizes(), |size| {
            let tracks = world.run(&self.setup, &self.references, &[(shape, size)])?;
            let sane = tracks.iter().all(|track| track.is_sane(scene.travel));
            let ratio = || self.ratio(strength::residual(&tracks, &self.setup.nominal, &self.sensors), effort);
            Ok((if sane { ratio() } else { f64::INFINITY }, tracks))
        })
    }

    /// What is true of an effect that alone left `tracks`.
    fn answer<S: Shape + ?Sized>(
        &self,
        known: &Known,
        asked: f64,
        shape: &S,
        size: f64,
        plan: &Plan,
        tracks: &[Track],
    ) -> TrueEffect {
        let residual = strength::residual(tracks, &self.setup.nominal, &self.sensors);
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

fn values<S: Shape + ?Sized>(shape: &S, size: f64, scale: Scale) -> Vec<TrueValue> {
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
