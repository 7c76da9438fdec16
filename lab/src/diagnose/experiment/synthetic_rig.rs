//! A recording that was never made: what a model would show of a motion.

use super::hypothesis::Hypothesis;
use super::trajectory::Trajectory;
use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::estimation::whitener::{NoiseModel, Whitener};
use crate::diagnose::model::index;
use crate::diagnose::signals::derivative_filter::DerivativeFilter;
use crate::diagnose::signals::filtered_trial::{AnalysisTrial, FilteredTrial};
use crate::diagnose::thresholds::experiment_synthetic_rig::{LOAD_MARGIN, MAX_EFFORT_ITERATIONS};

/// Where motions are tried.
pub struct SyntheticRig<'a> {
    problem: &'a IdentificationProblem,
    answer: Hypothesis,
    /// Deviation of each channel's expected noise in a row of its track.
    pub(super) noise_models: [Option<f64>; 2],
    /// Rows of each channel's track that are worth one.
    pub(super) memory: [f64; 2],
}

impl<'a> SyntheticRig<'a> {
    /// A bench on which `answer` is the truth, its sensors as good as the noise models of `whitener` say.
    #[must_use]
    pub fn new(problem: &'a IdentificationProblem, whitener: &Whitener, mut answer: Hypothesis) -> Self {
        // Clocks are no physics; a alternative may still move its own.
        answer.values[index::FORCE_TIMING] = 0.0;
        answer.values[index::EFFORT_TIMING] = 0.0;
        let noise_models = [whitener.force.as_ref().and_then(typical), whitener.effort.as_ref().and_then(typical)];
        // White noise behind a Gaussian is autocorrelated: the sum of its correlation over all rows.
        let memory = |filter: &DerivativeFilter| {
            (2.0 * std::f64::consts::PI.sqrt() * filter.filter_width / filter.step()).max(1.0)
        };
        Self {
            problem,
            answer,
            noise_models,
            memory: [memory(&problem.sampler.contact_filter), memory(&problem.sampler.drive_filter)],
        }
    }

    /// The truth.
    #[must_use]
    pub fn answer(&self) -> &Hypothesis {
        &self.answer
    }

    /// The greatest force, or effort, of the recordings.
    #[must_use]
    pub fn greatest(&self, effort: bool) -> f64 {
        if effort { self.answer.excitation.effort } else { self.answer.excitation.force }
    }

    /// The sensor that would tell where no motion does.
    #[must_use]
    pub fn wanted(&self) -> &'static str {
        match (self.answer.model.contact.is_some(), self.answer.model.drive) {
            (true, false) => "record the drive's effort as well, or use a quieter force sensor",
            (false, _) => "record the contact force as well, or the position on the motor's side",
            (true, true) => {
                "a finer position sensor, a quieter force sensor, or the position on the motor's side would tell"
            }
        }
    }

    /// The expected noise of a channel, N or N m.
    #[must_use]
    pub fn noise_model(&self, effort: bool) -> Option<f64> {
        self.noise_models[usize::from(effort)]
    }

    /// What the answer would show of `course`.
    #[must_use]
    pub fn run(&self, course: &Trajectory) -> AnalysisTrial {
        let filtered = |filter: &DerivativeFilter| {
            let rows = course.rows(filter.step());
            let column = |at: usize| rows.iter().map(|row| row[at]).collect::<Vec<f64>>();
            self.filtered(filter, column(0), column(1), column(2), vec![true; rows.len()])
        };
        self.shown(filtered(&self.problem.sampler.contact_filter), filtered(&self.problem.sampler.drive_filter))
    }

    /// What the answer would show of the recorded motions themselves.
    #[must_use]
    pub fn rerun(&self) -> Vec<AnalysisTrial> {
        let again = |filter: &DerivativeFilter, filtered: &FilteredTrial| {
            let (position, velocity) = (filtered.position.clone(), filtered.velocity.clone());
            self.filtered(filter, position, velocity, filtered.acceleration.clone(), filtered.valid.clone())
        };
        let (filter, drive) = (&self.problem.sampler.contact_filter, &self.problem.sampler.drive_filter);
        let trials = self.problem.sampler.trials.iter();
        trials.map(|trial| self.shown(again(filter, &trial.contact), again(drive, &trial.drive))).collect()
    }

    fn filtered(
        &self,
        filter: &DerivativeFilter,
        position: Vec<f64>,
        velocity: Vec<f64>,
        acceleration: Vec<f64>,
        valid: Vec<bool>,
    ) -> FilteredTrial {
        let noise =
            self.problem.sampler.uniform_trials.iter().map(|raw| raw.figures.position.noise).fold(0.0, f64::max);
        let [level_noise, slope_noise, bend_noise] = filter.noise();
        let force_noise =
            self.problem.sampler.uniform_trials.iter().filter_map(|raw| raw.figures.force).map(|force| force.noise);
        // As a recording of it would be looked at.
        let at_rest = |(v, a): (&f64, &f64)| {
            f64::from(v.abs() <= 3.0 * noise * slope_noise && a.abs() <= 3.0 * noise * bend_noise)
        };
        let jerk = slope(&acceleration, filter.step());
        let snap = slope(&jerk, filter.step());
        FilteredTrial {
            step: filter.step(),
            filter_width: filter.filter_width,
            at_rest: velocity.iter().zip(&acceleration).map(at_rest).collect(),
            velocity_noise: noise * slope_noise,
            acceleration_noise: noise * bend_noise,
            force_noise: level_noise * force_noise.fold(0.0, f64::max),
            position,
            velocity,
            crackle: slope(&snap, filter.step()),
            jerk,
            snap,
            acceleration,
            force: None,
            force_rate: None,
            force_second_derivative: None,
            force_third_derivative: None,
            effort: None,
            effort_rate: None,
            command: None,
            one_step_speed: 0.0,
            valid,
            prefiltered: None,
        }
    }

    fn shown(&self, mut contact: FilteredTrial, mut drive: FilteredTrial) -> AnalysisTrial {
        self.sense(&mut contact);
        self.sense(&mut drive);
        if self.answer.model.drive {
            self.drive(&mut drive);
        }
        AnalysisTrial { number: 0, contact, drive }
    }

    /// Whether `course` would ask for no more force and effort than the recordings did, by what the answer says of both.
    #[must_use]
    pub fn bears(&self, course: &Trajectory) -> bool {
        let trial = self.run(course);
        let peak =
            |values: &Option<Vec<f64>>| values.iter().flatten().fold(0.0f64, |peak, value| peak.max(value.abs()));
        let within = |values: &Option<Vec<f64>>, most: f64| peak(values) <= LOAD_MARGIN * most;
        within(&trial.contact.force, self.greatest(false)) && within(&trial.drive.effort, self.greatest(true))
    }

    /// Fills in the reading of the force sensor.
    fn sense(&self, filtered: &mut FilteredTrial) {
        let Some(bilateral) = self.answer.model.contact else { return };
        let Hypothesis { model, values, .. } = &self.answer;
        let borne = model.contact_force(values, 0, filtered, bilateral);
        let force = model.reading(values, 0, filtered, &borne);
        let rate = slope(&force, filtered.step);
        let bend = slope(&rate, filtered.step);
        filtered.force_third_derivative = Some(slope(&bend, filtered.step));
        filtered.force_second_derivative = Some(bend);
        filtered.force_rate = Some(rate);
        filtered.force = Some(force);
    }

    /// Fills in the effort that the motion takes; rows that the drive cannot follow do not count.
    fn drive(&self, filtered: &mut FilteredTrial) {
        let mut effort = self.rigid(filtered);
        let mut best = (f64::INFINITY, effort.clone(), Vec::new());
        // What the drive makes of a command may depend on the command: what is left of the balance is taken off it, for as
        // long as that helps.
        for _ in 0..MAX_EFFORT_ITERATIONS {
            filtered.effort_rate = Some(slope(&effort, filtered.step));
            filtered.effort = Some(effort.clone());
            let rest = self.effort_rest(filtered);
            let size: f64 = rest.iter().map(|rest| rest * rest).sum();
            let next = effort.iter().zip(&rest).map(|(effort, rest)| effort - rest).collect();
            if size.is_nan() || size >= best.0 {
                break;
            }
            best = (size, std::mem::replace(&mut effort, next), rest);
        }
        let (_, effort, rest) = best;
        filtered.effort_rate = Some(slope(&effort, filtered.step));
        filtered.effort = Some(effort);
        let noise_model = self.noise_models[1].unwrap_or(f64::INFINITY);
        for (at, valid) in filtered.valid.iter_mut().enumerate() {
            *valid &= filtered.at_rest[at] == 0.0 && rest.get(at).is_some_and(|rest| rest.abs() <= noise_model);
        }
    }

    /// The effort that a stiff drive without friction would take.
    fn rigid(&self, filtered: &FilteredTrial) -> Vec<f64> {
        let (inertia, viscous) = (self.answer.values[index::INERTIA], self.answer.values[index::VISCOUS]);
        let force = |at: usize| filtered.force.as_ref().map_or(0.0, |force| force[at]);
        let load = |at: usize| inertia * filtered.acceleration[at] + viscous * filtered.velocity[at] + force(at);
        (0..filtered.len()).map(load).collect()
    }

    fn effort_rest(&self, filtered: &FilteredTrial) -> Vec<f64> {
        let Hypothesis { model, values, .. } = &self.answer;
        let bilateral = model.contact.unwrap_or(false);
        let force = model.contact.map(|_| model.contact_force(values, 0, filtered, bilateral));
        model.balance(values, 0, filtered, |at| force.as_ref().map_or(0.0, |force| force[at]))
    }
}

/// The expected noise of an ordinary row.
fn typical(noise_model: &NoiseModel) -> Option<f64> {
    let mut all: Vec<f64> = noise_model.deviation.iter().flatten().copied().filter(|value| value.is_finite()).collect();
    let middle = all.len() / 2;
    (!all.is_empty()).then(|| *all.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Rate of values `step` seconds apart.
fn slope(values: &[f64], step: f64) -> Vec<f64> {
    let last = values.len().saturating_sub(1);
    (0..values.len())
        .map(|at| {
            let (before, after) = (at.saturating_sub(1), (at + 1).min(last));
            (values[after] - values[before]) / (step * (after - before).max(1) as f64)
        })
        .collect()
}
