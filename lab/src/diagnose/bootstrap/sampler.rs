//! Replicates: what the same sensors would have shown of the same motion, had the model been the whole truth.
//!
//! A replicate follows the recorded motion, seen through a finer filter, and takes force and effort from the model; then the
//! sensors do to it what they do: an offset of the encoder within its step, rounding, noise. Replicates run through the very
//! code that the recording ran through. What they show of mismatch is what a model without fault would show.

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, StandardNormal};
use rayon::prelude::*;

use crate::diagnose::linalg::solve;
use crate::diagnose::model::{Channels, Model, Residual, index};
use crate::diagnose::signals::dequantize::dequantize;
use crate::diagnose::signals::derivative_filter::DerivativeFilter;
use crate::diagnose::signals::filtered_trial::{AnalysisTrial, FilteredTrial};
use crate::diagnose::signals::uniform_trial::UniformTrial;
use crate::diagnose::thresholds::sampler::{REST_EDGE_WIDTHS, SPECTRUM_REPLICATES};
use crate::effects::Reading;

/// Everything that replicates are made from.
pub struct BootstrapSampler {
    /// Trials as recorded.
    pub uniform_trials: Vec<UniformTrial>,
    /// Through which the contact is analysed.
    pub contact_filter: DerivativeFilter,
    /// Through which the drive is analysed.
    pub drive_filter: DerivativeFilter,
    /// The recorded trials through both.
    pub trials: Vec<AnalysisTrial>,
    /// The recorded trials through a finer one.
    fine: Vec<FilteredTrial>,
    /// Rows of each trial at which the encoder rests on one count.
    encoder_rests: Vec<Vec<(usize, usize)>>,
    seed: u64,
}

/// Noise of a trial's channels before they round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrialNoise {
    /// Of the force.
    pub force: NoiseSpectrum,
    /// Of the effort.
    pub effort: NoiseSpectrum,
}

/// Noise of a channel: a white part, and one that grows with the frequency.
///
/// The second is what a drive does at a coarse encoder's steps: it shakes the tool by less than a step, which the effort
/// shows and the position hides, the less the quicker.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NoiseSpectrum {
    /// Deviation of the white part.
    pub white: f64,
    /// Deviation of the other, on the raw rows.
    pub blue: f64,
}

/// What a model says the trials were, row by row of the recording.
pub struct NoiseFreeSignals {
    force: Vec<Option<Vec<f64>>>,
    effort: Vec<Option<Vec<f64>>>,
}

impl BootstrapSampler {
    /// Prepares `uniform_trials`.
    #[must_use]
    pub fn new(
        uniform_trials: Vec<UniformTrial>,
        contact_filter: DerivativeFilter,
        drive_filter: DerivativeFilter,
        seed: u64,
    ) -> Self {
        let finest = contact_filter.first().every_row();
        let fine = uniform_trials.par_iter().map(|raw| FilteredTrial::of(raw, &finest)).collect();
        let least = (2.0 * REST_EDGE_WIDTHS * contact_filter.filter_width / contact_filter.period).ceil() as usize;
        let encoder_rests = uniform_trials.iter().map(|raw| encoder_rests(raw, least)).collect();
        let mut sampler =
            Self { trials: Vec::new(), fine, encoder_rests, uniform_trials, contact_filter, drive_filter, seed };
        sampler.trials = sampler
            .uniform_trials
            .par_iter()
            .enumerate()
            .map(|(number, raw)| sampler.filter_trial(number, raw))
            .collect();
        sampler
    }

    fn filter_trial(&self, number: usize, raw: &UniformTrial) -> AnalysisTrial {
        let mut drive = FilteredTrial::of(raw, &self.drive_filter).commanded(raw, &self.drive_filter);
        // At rest friction holds whatever the balance asks for: such rows say nothing for it, and no more against it.
        drive.valid.iter_mut().zip(&drive.at_rest).for_each(|(valid, at_rest)| *valid &= *at_rest == 0.0);
        AnalysisTrial { number, contact: FilteredTrial::of(raw, &self.contact_filter), drive }
    }

    /// What `model` with `values` says of the trials.
    #[must_use]
    pub fn noise_free(&self, model: &Model, values: &[f64]) -> NoiseFreeSignals {
        let tell = |(trial, fine): (usize, &FilteredTrial)| {
            let (borne, reading) = match model.contact {
                Some(bilateral) => {
                    let borne = model.contact_force(values, trial, fine, bilateral);
                    let mut reading = model.rows(values, trial, fine, &borne);
                    apply_timing_offset(&mut reading, fine, values[index::FORCE_TIMING]);
                    (Some(borne), Some(reading))
                }
                None => (None, fine.force.clone()),
            };
            let effort = fine.effort.as_ref().filter(|_| model.drive).map(|effort| {
                let on_tool = borne.as_ref().or(fine.force.as_ref());
                let on_tool = |at: usize| on_tool.map_or(0.0, |force| force[at]);
                match model.effort_limit(values, trial).zip(self.uniform_trials[trial].effort.as_ref()) {
                    Some((limit, commands)) => {
                        self.command_before_limit(model, values, trial, on_tool, (limit, commands))
                    }
                    None => {
                        let residual = model.balance(values, trial, fine, on_tool);
                        let exact: Vec<f64> =
                            effort.iter().zip(&residual).map(|(effort, residual)| effort - residual).collect();
                        (0..exact.len()).map(|at| hold_mean(&exact, at)).collect()
                    }
                }
            });
            (reading, effort)
        };
        let (force, effort) = self.fine.par_iter().enumerate().map(tell).unzip();
        NoiseFreeSignals { force, effort }
    }

    /// Commands, row by row, of a drive that gives no more than a limit. What they were beyond it is in no smoothed effort,
    /// so they are those recorded, less what is left of the balance where they are within it. A motion seen more sharply
    /// than the drive is looked at asks for efforts that no drive could give.
    fn command_before_limit(
        &self,
        model: &Model,
        values: &[f64],
        trial: usize,
        on_tool: impl Fn(usize) -> f64,
        (limit, commands): (f64, &Vec<f64>),
    ) -> Vec<f64> {
        let calm = FilteredTrial::of(&self.uniform_trials[trial], &self.drive_filter.every_row());
        let residual = model.balance(values, trial, &calm, on_tool);
        let command = |(at, command): (usize, &f64)| {
            if command.abs() > limit { *command } else { command - hold_mean(&residual, at) }
        };
        commands.iter().enumerate().map(command).collect()
    }

    /// Twin `number` of `noise_free`.
    #[must_use]
    pub fn replicate(&self, noise_free: &NoiseFreeSignals, noise: &[TrialNoise], number: u64) -> Vec<AnalysisTrial> {
        let mut chance = ChaCha8Rng::seed_from_u64(self.seed);
        chance.set_stream(number);
        self.uniform_trials
            .iter()
            .enumerate()
            .map(|(trial, raw)| {
                let mut replicate = raw.clone();
                let position = raw.figures.position;
                let rounding = position.resolution / 12f64.sqrt();
                let shake = (position.noise * position.noise - rounding * rounding).max(0.0).sqrt();
                let offset = position.resolution * chance.random::<f64>();
                replicate.position.clone_from(&self.fine[trial].position);
                let shaken = NoiseSpectrum { white: shake, blue: 0.0 };
                add_sensor_errors(&mut replicate.position, shaken, position.resolution, offset, &mut chance);
                dequantize(|row| row as f64, &mut replicate.position, position.resolution);
                self.offset_at_rests(&mut replicate.position, trial, &mut chance);
                if let (Some(force), Some(figures)) = (&noise_free.force[trial], raw.figures.force) {
                    let mut force = force.clone();
                    add_sensor_errors(&mut force, noise[trial].force, figures.resolution, 0.0, &mut chance);
                    replicate.force = Some(force);
                }
                if let Some(effort) = &noise_free.effort[trial] {
                    let mut effort = effort.clone();
                    add_sensor_errors(&mut effort, noise[trial].effort, 0.0, 0.0, &mut chance);
                    replicate.effort = Some(effort);
                }
                self.filter_trial(trial, &replicate)
            })
            .collect()
    }

    /// A tool at rest stands anywhere within its count, elsewhere at each rest, for as long as it rests.
    fn offset_at_rests(&self, position: &mut [f64], trial: usize, chance: &mut ChaCha8Rng) {
        let raw = &self.uniform_trials[trial];
        let edge = (REST_EDGE_WIDTHS * self.contact_filter.filter_width / raw.period).ceil().max(1.0);
        for (first, end) in &self.encoder_rests[trial] {
            let shift = raw.figures.position.resolution * (chance.random::<f64>() - 0.5);
            for (row, value) in position.iter_mut().enumerate().take(*end).skip(*first) {
                let inside = (row - first).min(end - 1 - row) as f64 / edge;
                *value += shift * if inside < 1.0 { inside * inside * (3.0 - 2.0 * inside) } else { 1.0 };
            }
        }
    }

    /// The noise that makes replicates of `model` as restless as the recording is.
    ///
    /// Told from third differences of the residual, over one row and over two: physics that was left out is smooth beside
    /// them, and their ratio tells the colour.
    #[must_use]
    pub fn noise(&self, model: &Model, values: &[f64], noise_free: &NoiseFreeSignals) -> Vec<TrialNoise> {
        // From what the raw rows show: without any, rounding would be quieter than it is.
        let raw = self.uniform_trials.iter().map(|raw| {
            let white = raw
                .figures
                .force
                .map_or(0.0, |force| (force.noise.powi(2) - force.resolution.powi(2) / 12.0).max(0.0).sqrt());
            TrialNoise { force: NoiseSpectrum { white, blue: 0.0 }, effort: NoiseSpectrum::default() }
        });
        let force = self.excess_noise(model, values, noise_free, &raw.collect::<Vec<_>>(), false);
        // The drive's balance takes in the measured force, noise and all.
        self.excess_noise(model, values, noise_free, &force, true)
    }

    fn excess_noise(
        &self,
        model: &Model,
        values: &[f64],
        noise_free: &NoiseFreeSignals,
        known: &[TrialNoise],
        effort: bool,
    ) -> Vec<TrialNoise> {
        let channels = Channels { force: !effort, effort };
        let pick = |residual: Residual| if effort { residual.effort } else { residual.force };
        let residuals_of = |trials: &[AnalysisTrial]| -> Vec<Vec<f64>> {
            trials.iter().map(|trial| pick(model.residual(values, trial, channels))).collect()
        };
        let mut valid = residuals_of(&self.trials);
        if !effort {
            for ((valid, raw), trial) in valid.iter_mut().zip(&self.uniform_trials).zip(&self.trials) {
                raw.hum.iter().for_each(|frequency| remove_tone(valid, frequency * trial.contact.step));
            }
        }
        let numbers = (0..SPECTRUM_REPLICATES as u64).into_par_iter();
        let replicates: Vec<Vec<Vec<f64>>> =
            numbers.map(|number| residuals_of(&self.replicate(noise_free, known, number))).collect();
        let filter = if effort { &self.drive_filter } else { &self.contact_filter };
        let white = unit_roughness(filter, NoiseSpectrum { white: 1.0, blue: 0.0 }, self.seed);
        let blue = unit_roughness(filter, NoiseSpectrum { white: 0.0, blue: 1.0 }, self.seed);
        (0..self.uniform_trials.len())
            .map(|trial| {
                let filtered = self.trials[trial].filtered(effort);
                let beyond = |lag: usize| {
                    let known: f64 =
                        replicates.iter().map(|replicate| roughness(&replicate[trial], filtered, lag)).sum();
                    roughness(&valid[trial], filtered, lag) - known / SPECTRUM_REPLICATES as f64
                };
                let beyond = [beyond(1), beyond(2)];
                let more = |before: NoiseSpectrum| {
                    let base = before.white * before.white;
                    if self.uniform_trials[trial].force.is_none() {
                        // A drive whose torque is told by its current has noise at all frequencies; there is no force
                        // to say otherwise.
                        return NoiseSpectrum { white: (base + beyond[0] / white[0]).max(0.0).sqrt(), blue: 0.0 };
                    }
                    let (a, b) = spectrum_from_roughness(
                        [base * white[0] + beyond[0], base * white[1] + beyond[1]],
                        white,
                        blue,
                    );
                    NoiseSpectrum { white: a.sqrt(), blue: b.sqrt() }
                };
                if effort {
                    TrialNoise { effort: more(known[trial].effort), ..known[trial] }
                } else {
                    TrialNoise { force: more(known[trial].force), ..known[trial] }
                }
            })
            .collect()
    }
}

/// What a row shows of an effort that is held to the next row: the mean of the two.
fn hold_mean(values: &[f64], at: usize) -> f64 {
    0.5 * (values[at] + values[(at + 1).min(values.len() - 1)])
}

/// Takes off `values` what goes with a tone of `turns` a row: it is no noise, however restless.
fn remove_tone(values: &mut [f64], turns: f64) {
    let angle = |at: usize| std::f64::consts::TAU * turns * at as f64;
    let waves = [f64::sin, f64::cos].map(|wave| (0..values.len()).map(|at| wave(angle(at))).collect::<Vec<f64>>());
    let directions: Vec<(usize, Vec<f64>)> = waves.into_iter().enumerate().collect();
    let Some(parts) = solve(&directions, values) else { return };
    for ((_, wave), part) in directions.iter().zip(parts.iter()) {
        values.iter_mut().zip(wave).for_each(|(value, wave)| *value -= part * wave);
    }
}

/// Stretches of at least `least` rows in which a stepping encoder does not step.
fn encoder_rests(raw: &UniformTrial, least: usize) -> Vec<(usize, usize)> {
    let step = raw.figures.position.resolution;
    let mut found = Vec::new();
    let mut first = 0;
    for row in 1..=raw.len() {
        let moved = row == raw.len() || (raw.position[row] - raw.position[row - 1]).abs() > 1e-3 * step;
        if moved {
            if step > 0.0 && row - first >= least {
                found.push((first, row));
            }
            first = row;
        }
    }
    found
}

/// What a clock that is a fraction of a sample late writes down of `force`.
fn apply_timing_offset(force: &mut [f64], filtered: &FilteredTrial, by: f64) {
    if by != 0.0 {
        let mut reading = Reading {
            start: 0.0,
            step: filtered.step,
            filter_width: filtered.filter_width,
            added_filter_width: 0.0,
            acceleration: &filtered.acceleration,
            force,
        };
        reading.delay(by);
    }
}

/// Parts of white and blue, neither below zero, that together are as restless as `valid` at both lags.
fn spectrum_from_roughness(valid: [f64; 2], white: [f64; 2], blue: [f64; 2]) -> (f64, f64) {
    let determinant = white[0] * blue[1] - white[1] * blue[0];
    let a = (valid[0] * blue[1] - valid[1] * blue[0]) / determinant;
    let b = (white[0] * valid[1] - white[1] * valid[0]) / determinant;
    if a >= 0.0 && b >= 0.0 {
        (a, b)
    } else if a < 0.0 {
        // The quicker of the two lags is the less touched by physics.
        (0.0, (valid[0] / blue[0]).max(0.0))
    } else {
        ((valid[0] / white[0]).max(0.0), 0.0)
    }
}

/// Roughness at both lags that noise of deviation one has behind `filter`.
fn unit_roughness(filter: &DerivativeFilter, colour: NoiseSpectrum, seed: u64) -> [f64; 2] {
    let mut chance = ChaCha8Rng::seed_from_u64(seed ^ 0x5eed);
    let mut noise = vec![0.0; 4000 * filter.stride];
    add_sensor_errors(&mut noise, colour, 0.0, 0.0, &mut chance);
    let smooth = filter.smooth(&noise);
    [1, 2].map(|lag| median_third_difference(&smooth, |_| true, lag).powi(2).max(f64::MIN_POSITIVE))
}

fn add_sensor_errors(values: &mut [f64], noise: NoiseSpectrum, step: f64, offset: f64, chance: &mut ChaCha8Rng) {
    let mut before = 0.0;
    for value in values {
        if noise.white > 0.0 {
            let draw: f64 = StandardNormal.sample(chance);
            *value += noise.white * draw;
        }
        if noise.blue > 0.0 {
            let draw: f64 = StandardNormal.sample(chance);
            // The difference of white noise has twice its variance.
            *value += noise.blue * std::f64::consts::FRAC_1_SQRT_2 * (draw - before);
            before = draw;
        }
        if step > 0.0 {
            *value = ((*value + offset) / step).round() * step - offset;
        }
    }
}

fn roughness(values: &[f64], filtered: &FilteredTrial, lag: usize) -> f64 {
    if values.is_empty() { 0.0 } else { median_third_difference(values, |at| filtered.valid[at], lag).powi(2) }
}

fn median_third_difference(values: &[f64], valid: impl Fn(usize) -> bool, lag: usize) -> f64 {
    let mut sizes: Vec<f64> = (3 * lag..values.len())
        .filter(|&at| (at - 3 * lag..=at).all(&valid))
        .map(|at| (values[at] - 3.0 * values[at - lag] + 3.0 * values[at - 2 * lag] - values[at - 3 * lag]).abs())
        .collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
}
