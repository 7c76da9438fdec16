//! The rig of a case with its reference trajectories, and the sizes of its concealed effects.

use anyhow::{Result, anyhow};
use rand::RngExt;

use crate::case_spec::CaseSpec;
use crate::closed_loop::{Encoder, LoopSetup, SAMPLE_PERIOD_S, SUBSTEPS, SimulatedTrial};
use crate::effect::registry::EffectInfo;
use crate::effect::{self, EffectShape, NominalMotion};
use crate::excitation;
use crate::nominal::{NominalParameters, PdGains};
use crate::rng::{self, CaseRng, Stream};
use crate::scale::Scale;
use crate::sensors::Sensors;
use crate::simulator::Simulator;
use crate::size_search::{self, SizeResult};
use crate::strength::{self, NominalResidual};
use crate::truth::{TrueEffect, TrueParameter};

/// The rig of a case with its trajectories.
#[derive(Debug, Clone)]
pub struct TestRig {
    /// What its effects leave alone.
    pub setup: LoopSetup,
    /// What the rig file says of it.
    pub stated: NominalParameters,
    /// Its sensors.
    pub sensors: Sensors,
    /// The deepest contact that suits it, m.
    pub deepest: f64,
    /// What the controller follows, m, one value a period.
    pub references: Vec<Vec<f64>>,
}

/// What is true of each effect, each with its size, and the trials with all of them.
pub type SizedEffects<W> = (Vec<TrueEffect>, Vec<(Box<<W as Simulator>::Effect>, f64)>, Vec<SimulatedTrial>);

impl TestRig {
    /// The rig of case `index` of `seed` in `simulator`.
    #[must_use]
    pub fn draw<W: Simulator>(simulator: &W, spec: &CaseSpec, seed: u64, index: u64) -> Self {
        let rng = &mut rng::stream(seed, index, Stream::Rig);
        let (drawn, deepest) = NominalParameters::draw(rng, spec.bilateral);
        let control = PdGains::draw(rng, &drawn);
        let sensors = Sensors::new(spec.grade);
        let offset = sensors.position_step * rng.random_range(-0.5..0.5);
        let encoder = Encoder { step: sensors.position_step, offset };
        let concealed: Vec<&EffectInfo> = spec.effects.iter().map(|(info, _)| *info).collect();
        let nominal = simulator.nominal(drawn, &concealed);
        let stated = if spec.exact { nominal } else { misstated(&drawn, deepest, rng) };
        let paths = &mut rng::stream(seed, index, Stream::Excitation);
        let believed = NominalParameters { surface: drawn.surface, ..misstated(&drawn, deepest, paths) };
        let references = (0..2)
            .map(|_| {
                let depths = excitation::depth_path(spec.excitation, &drawn, deepest, paths);
                excitation::reference_for(&depths, &believed, &control)
            })
            .collect();
        Self { setup: LoopSetup { nominal, control, encoder, steps: SUBSTEPS }, stated, sensors, deepest, references }
    }

    /// The larger of both residuals over the floor, that of the effort only where it is recorded.
    #[must_use]
    pub fn strength(&self, residual: NominalResidual, effort: bool) -> f64 {
        let largest = if effort { residual.force.max(residual.effort) } else { residual.force };
        largest / self.sensors.floor()
    }

    /// Finds the size of each effect of `spec` alone, and runs them together.
    ///
    /// # Errors
    /// `simulator` has no such effect, or gave up.
    pub fn simulate_with_effects<W: Simulator>(
        &self,
        simulator: &mut W,
        spec: &CaseSpec,
        rng: &CaseRng,
    ) -> Result<(Vec<TrueEffect>, Vec<SimulatedTrial>)> {
        self.sized_effects(simulator, spec, rng).map(|(effects, _, trials)| (effects, trials))
    }

    /// As [`Self::simulate_with_effects`], and the effects themselves with their sizes.
    ///
    /// # Errors
    /// `simulator` has no such effect, or gave up.
    pub fn sized_effects<W: Simulator>(
        &self,
        simulator: &mut W,
        spec: &CaseSpec,
        rng: &CaseRng,
    ) -> Result<SizedEffects<W>> {
        let mut trials = simulator.run(&self.setup, &self.references, &[])?;
        let motion = nominal_motion(&trials, &self.setup.nominal, spec.scale);
        let (mut effects, mut shapes) = (Vec::new(), Vec::new());
        for (info, requested) in &spec.effects {
            let missing = || anyhow!("{} has no shape", info.name);
            let shape = simulator.draw_effect(info.name, &motion, rng).ok_or_else(missing)?;
            let size;
            (size, trials) = if *requested > 0.0 {
                let found = self.find_size(simulator, shape.as_ref(), *requested, spec.effort, &motion)?;
                (found.size, found.trials)
            } else {
                (0.0, simulator.run(&self.setup, &self.references, &[])?)
            };
            effects.push(self.true_effect(info, *requested, shape.as_ref(), size, spec, &trials));
            shapes.push((shape, size));
        }
        if shapes.len() > 1 {
            let all: Vec<_> = shapes.iter().map(|(shape, size)| (shape.as_ref(), *size)).collect();
            trials = simulator.run(&self.setup, &self.references, &all)?;
        }
        Ok((effects, shapes, trials))
    }

    /// The size at which `shape` alone is as strong as `requested`.
    fn find_size<W: Simulator>(
        &self,
        simulator: &mut W,
        shape: &W::Effect,
        requested: f64,
        effort: bool,
        motion: &NominalMotion,
    ) -> Result<SizeResult<Vec<SimulatedTrial>>> {
        size_search::find_size(requested, shape.size_range(), |size| {
            let trials = simulator.run(&self.setup, &self.references, &[(shape, size)])?;
            let sane = trials.iter().all(|trial| trial.stays_within(motion.travel));
            let ratio = || self.strength(strength::residual(&trials, &self.setup.nominal, &self.sensors), effort);
            Ok((if sane { ratio() } else { f64::INFINITY }, trials))
        })
    }

    /// What is true of an effect that alone left `trials`.
    fn true_effect<S: EffectShape + ?Sized>(
        &self,
        info: &EffectInfo,
        requested: f64,
        shape: &S,
        size: f64,
        spec: &CaseSpec,
        trials: &[SimulatedTrial],
    ) -> TrueEffect {
        let residual = strength::residual(trials, &self.setup.nominal, &self.sensors);
        TrueEffect {
            name: info.name,
            acts_in: info.acts_in,
            listed: info.listed,
            form: shape.form(),
            parameters: values(shape, size, spec.scale),
            strength_asked: requested,
            strength: self.strength(residual, spec.effort),
            in_force: residual.force / self.sensors.floor(),
            in_effort: residual.effort / self.sensors.floor(),
        }
    }
}

/// Every value wrong by up to 30 %, and the surface by a tenth of the depth.
fn misstated(nominal: &NominalParameters, deepest: f64, rng: &mut CaseRng) -> NominalParameters {
    let mut factor = || rng.random_range(0.7..1.3);
    NominalParameters {
        mass: nominal.mass * factor(),
        viscous: nominal.viscous * factor(),
        stiffness: nominal.stiffness * factor(),
        damping: nominal.damping * factor(),
        surface: nominal.surface + (factor() - 1.0) / 3.0 * deepest,
        bilateral: nominal.bilateral,
    }
}

fn values<S: EffectShape + ?Sized>(shape: &S, size: f64, scale: Scale) -> Vec<TrueParameter> {
    let value = |parameter: effect::EffectParameter| TrueParameter {
        name: parameter.name,
        value: scale.apply(parameter.value, parameter.unit),
        unit: parameter.unit.name(scale.rotary),
    };
    shape.parameters(size).into_iter().map(value).collect()
}

fn nominal_motion(trials: &[SimulatedTrial], nominal: &NominalParameters, scale: Scale) -> NominalMotion {
    let all = |of: fn(&SimulatedTrial) -> &Vec<f64>| trials.iter().flat_map(of).copied();
    let largest = |of| all(of).fold(0.0, |most: f64, value| most.max(value.abs()));
    let low = all(|trial| &trial.position).fold(f64::INFINITY, f64::min);
    let high = all(|trial| &trial.position).fold(f64::NEG_INFINITY, f64::max);
    let touching = all(|trial| &trial.velocity).zip(all(|trial| &trial.force)).filter(|(_, force)| *force != 0.0);
    let (sum, count) = touching.fold((0.0, 0.0), |(sum, count), (v, _)| (sum + v * v, count + 1.0));
    NominalMotion {
        nominal: *nominal,
        depth: high - nominal.surface,
        force: largest(|trial| &trial.force),
        effort: largest(|trial| &trial.effort),
        speed: f64::sqrt(sum / f64::max(count, 1.0)).max(1e-3),
        travel: (low, high),
        duration: trials.iter().map(|trial| trial.force.len()).max().unwrap_or(0) as f64 * SAMPLE_PERIOD_S,
        scale,
    }
}
