//! Twins: what the same sensors would have shown of the same motion, had the model been the whole truth.
//!
//! A twin follows the recorded motion, seen through a finer lens, and takes force and effort from the model; then the
//! sensors do to it what they do: an offset of the encoder within its step, rounding, noise. Twins run through the very
//! code that the recording ran through. What they show of mismatch is what a model without fault would show.

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, StandardNormal};
use rayon::prelude::*;

use crate::diagnose::linalg::solve;
use crate::diagnose::model::{Channels, Model, Rest, index};
use crate::diagnose::signals::dequantize::unround;
use crate::diagnose::signals::derivative_filter::Lens;
use crate::diagnose::signals::filtered_trial::{Track, Trial};
use crate::diagnose::signals::uniform_trial::Raw;
use crate::effects::Reading;

/// Everything that twins are made from.
pub struct Studio {
    /// Trials as recorded.
    pub raws: Vec<Raw>,
    /// Through which the contact is analysed.
    pub lens: Lens,
    /// Through which the drive is analysed.
    pub drive_lens: Lens,
    /// The recorded trials through both.
    pub trials: Vec<Trial>,
    /// The recorded trials through a finer one.
    fine: Vec<Track>,
    /// Rows of each trial at which the encoder rests on one count.
    rests: Vec<Vec<(usize, usize)>>,
    seed: u64,
}

/// Noise of a trial's channels before they round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Of the force.
    pub force: Colour,
    /// Of the effort.
    pub effort: Colour,
}

/// Noise of a channel: a white part, and one that grows with the frequency.
///
/// The second is what a drive does at a coarse encoder's steps: it shakes the tool by less than a step, which the effort
/// shows and the position hides, the less the quicker.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Colour {
    /// Deviation of the white part.
    pub white: f64,
    /// Deviation of the other, on the raw rows.
    pub blue: f64,
}

/// What a model says the trials were, row by row of the recording.
pub struct Truth {
    force: Vec<Option<Vec<f64>>>,
    effort: Vec<Option<Vec<f64>>>,
}

/// Widths of the filter over which a rest begins and ends.
const EDGE: f64 = 3.0;

/// Twins from which the noise of the sensors is told.
const FOR_NOISE: usize = 4;

impl Studio {
    /// Prepares `raws`.
    #[must_use]
    pub fn new(raws: Vec<Raw>, lens: Lens, drive_lens: Lens, seed: u64) -> Self {
        let finest = lens.first().every_row();
        let fine = raws.par_iter().map(|raw| Track::of(raw, &finest)).collect();
        let least = (2.0 * EDGE * lens.blur / lens.period).ceil() as usize;
        let rests = raws.iter().map(|raw| rests(raw, least)).collect();
        let mut studio = Self { trials: Vec::new(), fine, rests, raws, lens, drive_lens, seed };
        studio.trials = studio.raws.par_iter().enumerate().map(|(number, raw)| studio.look(number, raw)).collect();
        studio
    }

    fn look(&self, number: usize, raw: &Raw) -> Trial {
        let mut drive = Track::of(raw, &self.drive_lens).commanded(raw, &self.drive_lens);
        // At rest friction holds whatever the balance asks for: such rows say nothing for it, and no more against it.
        drive.seen.iter_mut().zip(&drive.still).for_each(|(seen, still)| *seen &= *still == 0.0);
        Trial { number, contact: Track::of(raw, &self.lens), drive }
    }

    /// What `model` with `values` says of the trials.
    #[must_use]
    pub fn truth(&self, model: &Model, values: &[f64]) -> Truth {
        let tell = |(trial, fine): (usize, &Track)| {
            let (borne, reading) = match model.contact {
                Some(bilateral) => {
                    let borne = model.contact_force(values, trial, fine, bilateral);
                    let mut reading = model.rows(values, trial, fine, &borne);
                    late(&mut reading, fine, values[index::FORCE_TIMING]);
                    (Some(borne), Some(reading))
                }
                None => (None, fine.force.clone()),
            };
            let effort = fine.effort.as_ref().filter(|_| model.drive).map(|effort| {
                let on_tool = borne.as_ref().or(fine.force.as_ref());
                let on_tool = |at: usize| on_tool.map_or(0.0, |force| force[at]);
                match model.effort_limit(values, trial).zip(self.raws[trial].effort.as_ref()) {
                    Some((limit, commands)) => self.commanded(model, values, trial, on_tool, (limit, commands)),
                    None => {
                        let rest = model.balance(values, trial, fine, on_tool);
                        let exact: Vec<f64> = effort.iter().zip(&rest).map(|(effort, rest)| effort - rest).collect();
                        (0..exact.len()).map(|at| held(&exact, at)).collect()
                    }
                }
            });
            (reading, effort)
        };
        let (force, effort) = self.fine.par_iter().enumerate().map(tell).unzip();
        Truth { force, effort }
    }

    /// Commands, row by row, of a drive that gives no more than a limit. What they were beyond it is in no smoothed effort,
    /// so they are those recorded, less what is left of the balance where they are within it. A motion seen more sharply
    /// than the drive is looked at asks for efforts that no drive could give.
    fn commanded(
        &self,
        model: &Model,
        values: &[f64],
        trial: usize,
        on_tool: impl Fn(usize) -> f64,
        (limit, commands): (f64, &Vec<f64>),
    ) -> Vec<f64> {
        let calm = Track::of(&self.raws[trial], &self.drive_lens.every_row());
        let rest = model.balance(values, trial, &calm, on_tool);
        let command = |(at, command): (usize, &f64)| {
            if command.abs() > limit { *command } else { command - held(&rest, at) }
        };
        commands.iter().enumerate().map(command).collect()
    }

    /// Twin `number` of `truth`.
    #[must_use]
    pub fn twin(&self, truth: &Truth, noise: &[Noise], number: u64) -> Vec<Trial> {
        let mut chance = ChaCha8Rng::seed_from_u64(self.seed);
        chance.set_stream(number);
        self.raws
            .iter()
            .enumerate()
            .map(|(trial, raw)| {
                let mut twin = raw.clone();
                let position = raw.figures.position;
                let rounding = position.resolution / 12f64.sqrt();
                let shake = (position.noise * position.noise - rounding * rounding).max(0.0).sqrt();
                let offset = position.resolution * chance.random::<f64>();
                twin.position.clone_from(&self.fine[trial].position);
                let shaken = Colour { white: shake, blue: 0.0 };
                blemish(&mut twin.position, shaken, position.resolution, offset, &mut chance);
                unround(|row| row as f64, &mut twin.position, position.resolution);
                self.misplace(&mut twin.position, trial, &mut chance);
                if let (Some(force), Some(figures)) = (&truth.force[trial], raw.figures.force) {
                    let mut force = force.clone();
                    blemish(&mut force, noise[trial].force, figures.resolution, 0.0, &mut chance);
                    twin.force = Some(force);
                }
                if let Some(effort) = &truth.effort[trial] {
                    let mut effort = effort.clone();
                    blemish(&mut effort, noise[trial].effort, 0.0, 0.0, &mut chance);
                    twin.effort = Some(effort);
                }
                self.look(trial, &twin)
            })
            .collect()
    }

    /// A tool at rest stands anywhere within its count, elsewhere at each rest, for as long as it rests.
    fn misplace(&self, position: &mut [f64], trial: usize, chance: &mut ChaCha8Rng) {
        let raw = &self.raws[trial];
        let edge = (EDGE * self.lens.blur / raw.period).ceil().max(1.0);
        for (first, end) in &self.rests[trial] {
            let shift = raw.figures.position.resolution * (chance.random::<f64>() - 0.5);
            for (row, value) in position.iter_mut().enumerate().take(*end).skip(*first) {
                let inside = (row - first).min(end - 1 - row) as f64 / edge;
                *value += shift * if inside < 1.0 { inside * inside * (3.0 - 2.0 * inside) } else { 1.0 };
            }
        }
    }

    /// The noise that makes twins of `model` as restless as the recording is.
    ///
    /// Told from third differences of the residual, over one row and over two: physics that was left out is smooth beside
    /// them, and their ratio tells the colour.
    #[must_use]
    pub fn noise(&self, model: &Model, values: &[f64], truth: &Truth) -> Vec<Noise> {
        // From what the raw rows show: without any, rounding would be quieter than it is.
        let raw = self.raws.iter().map(|raw| {
            let white = raw
                .figures
                .force
                .map_or(0.0, |force| (force.noise.powi(2) - force.resolution.powi(2) / 12.0).max(0.0).sqrt());
            Noise { force: Colour { white, blue: 0.0 }, effort: Colour::default() }
        });
        let force = self.noise_beyond(model, values, truth, &raw.collect::<Vec<_>>(), false);
        // The drive's balance takes in the measured force, noise and all.
        self.noise_beyond(model, values, truth, &force, true)
    }

    fn noise_beyond(&self, model: &Model, values: &[f64], truth: &Truth, known: &[Noise], effort: bool) -> Vec<Noise> {
        let channels = Channels { force: !effort, effort };
        let pick = |rest: Rest| if effort { rest.effort } else { rest.force };
        let rests = |trials: &[Trial]| -> Vec<Vec<f64>> {
            trials.iter().map(|trial| pick(model.rest(values, trial, channels))).collect()
        };
        let mut seen = rests(&self.trials);
        if !effort {
            for ((seen, raw), trial) in seen.iter_mut().zip(&self.raws).zip(&self.trials) {
                raw.hum.iter().for_each(|frequency| without_tone(seen, frequency * trial.contact.step));
            }
        }
        let numbers = (0..FOR_NOISE as u64).into_par_iter();
        let twins: Vec<Vec<Vec<f64>>> = numbers.map(|number| rests(&self.twin(truth, known, number))).collect();
        let lens = if effort { &self.drive_lens } else { &self.lens };
        let white = unit(lens, Colour { white: 1.0, blue: 0.0 }, self.seed);
        let blue = unit(lens, Colour { white: 0.0, blue: 1.0 }, self.seed);
        (0..self.raws.len())
            .map(|trial| {
                let track = self.trials[trial].track(effort);
                let beyond = |lag: usize| {
                    let known: f64 = twins.iter().map(|twin| unrest(&twin[trial], track, lag)).sum();
                    unrest(&seen[trial], track, lag) - known / FOR_NOISE as f64
                };
                let beyond = [beyond(1), beyond(2)];
                let more = |before: Colour| {
                    let base = before.white * before.white;
                    if self.raws[trial].force.is_none() {
                        // A drive whose torque is told by its current has noise at all frequencies; there is no force
                        // to say otherwise.
                        return Colour { white: (base + beyond[0] / white[0]).max(0.0).sqrt(), blue: 0.0 };
                    }
                    let (a, b) = mixture([base * white[0] + beyond[0], base * white[1] + beyond[1]], white, blue);
                    Colour { white: a.sqrt(), blue: b.sqrt() }
                };
                if effort {
                    Noise { effort: more(known[trial].effort), ..known[trial] }
                } else {
                    Noise { force: more(known[trial].force), ..known[trial] }
                }
            })
            .collect()
    }
}

/// What a row shows of an effort that is held to the next row: the mean of the two.
fn held(values: &[f64], at: usize) -> f64 {
    0.5 * (values[at] + values[(at + 1).min(values.len() - 1)])
}

/// Takes off `values` what goes with a tone of `turns` a row: it is no noise, however restless.
fn without_tone(values: &mut [f64], turns: f64) {
    let angle = |at: usize| std::f64::consts::TAU * turns * at as f64;
    let waves = [f64::sin, f64::cos].map(|wave| (0..values.len()).map(|at| wave(angle(at))).collect::<Vec<f64>>());
    let directions: Vec<(usize, Vec<f64>)> = waves.into_iter().enumerate().collect();
    let Some(parts) = solve(&directions, values) else { return };
    for ((_, wave), part) in directions.iter().zip(parts.iter()) {
        values.iter_mut().zip(wave).for_each(|(value, wave)| *value -= part * wave);
    }
}

/// Stretches of at least `least` rows in which a stepping encoder does not step.
fn rests(raw: &Raw, least: usize) -> Vec<(usize, usize)> {
    let step = raw.figures.position.resolution;
    let mut rests = Vec::new();
    let mut first = 0;
    for row in 1..=raw.len() {
        let moved = row == raw.len() || (raw.position[row] - raw.position[row - 1]).abs() > 1e-3 * step;
        if moved {
            if step > 0.0 && row - first >= least {
                rests.push((first, row));
            }
            first = row;
        }
    }
    rests
}

/// What a clock that is a fraction of a sample late writes down of `force`.
fn late(force: &mut [f64], track: &Track, by: f64) {
    if by != 0.0 {
        let mut reading = Reading {
            start: 0.0,
            step: track.step,
            blur: track.blur,
            added_blur: 0.0,
            acceleration: &track.acceleration,
            force,
        };
        reading.delay(by);
    }
}

/// Parts of white and blue, neither below zero, that together are as restless as `seen` at both lags.
fn mixture(seen: [f64; 2], white: [f64; 2], blue: [f64; 2]) -> (f64, f64) {
    let determinant = white[0] * blue[1] - white[1] * blue[0];
    let a = (seen[0] * blue[1] - seen[1] * blue[0]) / determinant;
    let b = (white[0] * seen[1] - white[1] * seen[0]) / determinant;
    if a >= 0.0 && b >= 0.0 {
        (a, b)
    } else if a < 0.0 {
        // The quicker of the two lags is the less touched by physics.
        (0.0, (seen[0] / blue[0]).max(0.0))
    } else {
        ((seen[0] / white[0]).max(0.0), 0.0)
    }
}

/// Restlessness at both lags that noise of deviation one has behind `lens`.
fn unit(lens: &Lens, colour: Colour, seed: u64) -> [f64; 2] {
    let mut chance = ChaCha8Rng::seed_from_u64(seed ^ 0x5eed);
    let mut noise = vec![0.0; 4000 * lens.stride];
    blemish(&mut noise, colour, 0.0, 0.0, &mut chance);
    let smooth = lens.level(&noise);
    [1, 2].map(|lag| median_third_difference(&smooth, |_| true, lag).powi(2).max(f64::MIN_POSITIVE))
}

fn blemish(values: &mut [f64], noise: Colour, step: f64, offset: f64, chance: &mut ChaCha8Rng) {
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

fn unrest(values: &[f64], track: &Track, lag: usize) -> f64 {
    if values.is_empty() { 0.0 } else { median_third_difference(values, |at| track.seen[at], lag).powi(2) }
}

fn median_third_difference(values: &[f64], seen: impl Fn(usize) -> bool, lag: usize) -> f64 {
    let mut sizes: Vec<f64> = (3 * lag..values.len())
        .filter(|&at| (at - 3 * lag..=at).all(&seen))
        .map(|at| (values[at] - 3.0 * values[at - lag] + 3.0 * values[at - 2 * lag] - values[at - 3 * lag]).abs())
        .collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
}
