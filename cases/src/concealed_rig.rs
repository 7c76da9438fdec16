//! A rig with concealed physics that can be asked: trials along any reference, beyond those of its case.

use anyhow::Result;

use crate::case::{self, Case};
use crate::case_request::CaseRequest;
use crate::case_spec::CaseSpec;
use crate::closed_loop::{LoopSetup, SAMPLE_PERIOD_S, SimulatedTrial, simulate_commanded, simulate_trial};
use crate::effect::SimulatedEffect;
use crate::excitation::{self, Excitation};
use crate::physics::RigModel;
use crate::recorded_trial::RecordedTrial;
use crate::rng::{self, CaseRng, Stream};
use crate::scale::{Scale, Unit};
use crate::simulator::{OwnSimulator, Simulator as _, SimulatorKind};
use crate::test_rig::TestRig;

/// Trials of the case itself; those that are asked for count on from there.
const TRIALS_OF_THE_CASE: usize = 2;

/// A rig in our own simulation.
pub struct ConcealedRig {
    /// Its case: rig file, two trials, truth.
    pub case: Case,
    spec: CaseSpec,
    rig: TestRig,
    effects: Vec<(Box<dyn SimulatedEffect>, f64)>,
    noise: CaseRng,
    rich: CaseRng,
    trials: usize,
}

/// Greatest values of a trial, at the scale of the case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Excursion {
    /// Least and greatest position, m or rad.
    pub position: (f64, f64),
    /// Greatest speed.
    pub speed: f64,
    /// Greatest force at the sensor, either way.
    pub force: f64,
    /// Greatest effort, either way.
    pub effort: f64,
    /// Length, s.
    pub duration_s: f64,
}

impl ConcealedRig {
    /// The rig of case `index` of `seed`, as [`crate::draw()`] draws it.
    ///
    /// # Errors
    /// As [`crate::draw()`].
    pub fn draw(seed: u64, index: u64, request: &CaseRequest) -> Result<Self> {
        let mut simulator = OwnSimulator;
        let spec = CaseSpec::draw(request, simulator.supported(), &mut rng::stream(seed, index, Stream::Spec))?;
        let rig = TestRig::draw(&simulator, &spec, seed, index);
        let (truths, effects, trials) =
            rig.sized_effects(&mut simulator, &spec, &rng::stream(seed, index, Stream::Effect))?;
        let case = case::case(SimulatorKind::Own, seed, index, &spec, &rig, truths, &trials);
        // Streams of their own: what is asked for later leaves the case as it was.
        let mut noise = rng::stream(seed, index, Stream::Noise);
        noise.set_stream(u64::MAX);
        let mut rich = rng::stream(seed, index, Stream::Excitation);
        rich.set_stream(u64::MAX - 1);
        Ok(Self { case, spec, rig, effects, noise, rich, trials: TRIALS_OF_THE_CASE })
    }

    /// Size and coordinate of the case.
    #[must_use]
    pub fn scale(&self) -> Scale {
        self.spec.scale
    }

    /// A rich reference, as cases with rich excitation have it, at the scale of the case; another with each call.
    pub fn rich_reference(&mut self) -> Vec<f64> {
        let setup = &self.rig.setup;
        let deepest = self.rig.deepest;
        let depths = excitation::depth_path(Excitation::Rich, &setup.nominal, deepest, &mut self.rich);
        let believed = self.rig.stated;
        let reference = excitation::reference_for(
            &depths,
            &crate::nominal::NominalParameters { surface: setup.nominal.surface, ..believed },
            &setup.control,
        );
        let length = self.scale().apply(1.0, Unit::Length);
        reference.iter().map(|position| position * length).collect()
    }

    /// What the rig without its concealed physics reaches along `reference`, at the scale of the case.
    #[must_use]
    pub fn nominal_excursion(&self, reference: &[f64]) -> Excursion {
        let setup = &self.rig.setup;
        let model = RigModel::new(setup.nominal, 0, SAMPLE_PERIOD_S / setup.steps as f64);
        let length = self.scale().apply(1.0, Unit::Length);
        let bench: Vec<f64> = reference.iter().map(|position| position / length).collect();
        self.excursion(&simulate_trial(setup, model, &bench))
    }

    /// Runs a trial of `rows` periods from rest at `first`: `command` receives the row, the encoder's reading and the true force and
    /// gives the position to go to; the effort ends at `effort_limit`. All at the scale of the case. Returns what is recorded along
    /// `reference`, and what really happened.
    pub fn record(
        &mut self,
        reference: &[f64],
        effort_limit: f64,
        command: &mut dyn FnMut(usize, f64, f64) -> f64,
    ) -> (RecordedTrial, Excursion) {
        let setup: LoopSetup = self.rig.setup;
        let mut model = RigModel::new(setup.nominal, self.trials, SAMPLE_PERIOD_S / setup.steps as f64);
        self.trials += 1;
        self.effects.iter().filter(|(_, size)| *size > 0.0).for_each(|(shape, size)| shape.apply(*size, &mut model));
        let (length, force) = (self.scale().apply(1.0, Unit::Length), self.scale().apply(1.0, Unit::Force));
        let bench: Vec<f64> = reference.iter().map(|position| position / length).collect();
        let first = bench.first().copied().unwrap_or(0.0);
        let mut follow = |row: usize, reading: f64, felt: f64| command(row, reading * length, felt * force) / length;
        let track = simulate_commanded(&setup, model, bench.len(), first, effort_limit / force, &mut follow);
        let recorded = RecordedTrial::new(&track, &bench, &self.spec, &self.rig.sensors, &mut self.noise);
        (recorded, self.excursion(&track))
    }

    fn excursion(&self, track: &SimulatedTrial) -> Excursion {
        let (length, force) = (self.scale().apply(1.0, Unit::Length), self.scale().apply(1.0, Unit::Force));
        let peak = |values: &[f64]| values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let low = track.position.iter().copied().fold(f64::INFINITY, f64::min);
        let high = track.position.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Excursion {
            position: (length * low, length * high),
            speed: length * peak(&track.velocity),
            force: force * peak(&track.force),
            effort: force * peak(&track.effort),
            duration_s: track.position.len() as f64 * SAMPLE_PERIOD_S,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_request::EffectSelection;

    #[test]
    fn the_case_is_the_one_that_is_drawn_and_its_rig_repeats_its_trial() {
        let request = CaseRequest {
            selection: Some(EffectSelection::single("coulomb_friction", Some(3.0))),
            bench: Some(true),
            ..CaseRequest::default()
        };
        let mut rig = ConcealedRig::draw(7, 3, &request).unwrap();
        assert_eq!(rig.case, crate::draw(7, 3, &request).unwrap());
        let reference = rig.rig.references[0].clone();
        let length = rig.scale().apply(1.0, Unit::Length);
        let scaled: Vec<f64> = reference.iter().map(|x| x * length).collect();
        let (recorded, reached) = rig.record(&scaled, f64::INFINITY, &mut |row, _, _| scaled[row]);
        // The same motion to the encoder: only the noise of the force is another.
        assert_eq!(recorded.columns[1].2, rig.case.trials[0].columns[1].2);
        assert!(reached.effort > 0.0 && reached.effort != rig.nominal_excursion(&scaled).effort);
    }

    #[test]
    fn the_effort_ends_at_its_limit() {
        let request = CaseRequest { selection: Some(EffectSelection::Nothing), ..CaseRequest::default() };
        let mut rig = ConcealedRig::draw(7, 4, &request).unwrap();
        let reference = rig.rich_reference();
        let free = rig.nominal_excursion(&reference).effort;
        let (_, reached) = rig.record(&reference, 0.5 * free, &mut |row, _, _| reference[row]);
        assert!(reached.effort <= 0.5 * free * (1.0 + 1e-12), "{} of {free}", reached.effort);
    }
}
