//! Which frequencies of a form that repeats are worth a trial: those at which the residual itself is loudest (Lomb's periodogram).

use statrs::distribution::{ContinuousCDF as _, FisherSnedecor};

use super::criteria::LINE_TOLERANCE;
use super::data::Data;
use super::fit::Fit;
use super::in_step::is_in_step;
use crate::diagnose::periodogram::periodogram;
use crate::effects::{FrequencySearch, Start, ToneWeight};

/// Frequencies that are tried.
const MOST_FREQUENCIES: usize = 4;

/// The loudest of `search` in the weighted residual `rest` of `fit`.
#[must_use]
pub fn strongest(search: &FrequencySearch, data: &Data<'_>, fit: &Fit, rest: &[f64]) -> Vec<Start> {
    let rows = Rows::of(search, data, fit, rest);
    let harmonics = |frequency: f64| (1..=search.harmonics).map(move |times| times as f64 * frequency);
    // A wave in step with the motion itself is not told from a law of the motion.
    let is_motion = |frequency: f64| harmonics(frequency).any(|one| is_in_step(data, fit, one));
    let mut heard: Vec<(f64, f64)> = Vec::new();
    for &(first, apart, count) in &search.frequencies {
        let frequencies: Vec<f64> = (0..count).map(|at| first + apart * at as f64).collect();
        // Of a form with harmonics, what all of them take: the sum is largest at the fundamental (least squares: M. G. Christensen,
        // A. Jakobsson, Multi-Pitch Estimation, 2009).
        let mut power = vec![0.0; count];
        for times in 1..=search.harmonics {
            let one = rows.spectrum(times as f64 * first, times as f64 * apart, count);
            power.iter_mut().zip(one).for_each(|(all, one)| *all += one);
        }
        let level = |at: Option<usize>| at.and_then(|at| power.get(at)).copied().unwrap_or(f64::NEG_INFINITY);
        let peaks = (0..count).filter(|at| power[*at] >= level(at.checked_sub(1)) && power[*at] >= level(Some(at + 1)));
        heard.extend(peaks.map(|at| (power[at], frequencies[at])));
    }
    heard.sort_by(|a, b| b.0.total_cmp(&a.0));
    let others = heard.into_iter().map(|(_, frequency)| frequency).filter(|frequency| !is_motion(*frequency));
    others.take(MOST_FREQUENCIES).map(|frequency| search.start(frequency)).collect()
}

/// Where the spectrum around a line is looked at, of its frequency to either side: beyond the skirts of the line itself, and no farther than
/// a spectrum stays alike.
const AROUND: [f64; 7] = [0.015, 0.0225, 0.03, 0.0375, 0.045, 0.0525, 0.06];

/// Whether `frequency`, Hz, is that of one of `lines`.
#[must_use]
pub fn is_on_a_line(lines: &[f64], frequency: f64) -> bool {
    lines.iter().any(|line| (frequency / line - 1.0).abs() < LINE_TOLERANCE)
}

/// Logarithm of one over the probability that noise is as loud at `frequency`, Hz, as `rest` is, a weighted residual: the harmonic F-test
/// (D. J. Thomson, *Proc. IEEE* 70, 1982), its background from the spectrum around the line. Noise of any colour that is alike there, and
/// a law's misfit, which has no lines, are both held against it.
#[must_use]
pub fn line_nats(data: &Data<'_>, rest: &[f64], frequency: f64) -> f64 {
    let rows = Rows::windowed(data, rest);
    let sides = AROUND.iter().flat_map(|part| [1.0 - part, 1.0 + part]);
    let around: Vec<f64> = sides.map(|part| rows.power(part * frequency)).collect();
    let background = around.iter().sum::<f64>() / around.len() as f64;
    // A trial has a phase of its own, and with it two degrees of freedom, at each frequency.
    let degrees = 2.0 * data.trials.len() as f64;
    let ratio = rows.power(frequency) / background.max(f64::MIN_POSITIVE);
    let chance = FisherSnedecor::new(degrees, degrees * around.len() as f64).map_or(1.0, |law| law.sf(ratio));
    -chance.max(f64::MIN_POSITIVE).ln()
}

/// What is listened to of one trial.
struct Heard {
    /// Time of each row that counts, and its residual times its weight.
    rows: Vec<(f64, f64)>,
    /// Squares of the weights.
    square: f64,
}

impl Heard {
    /// Of rows with time, weight and residual.
    fn of(rows: impl Iterator<Item = (f64, f64, f64)>) -> Self {
        let mut square = 0.0;
        let weighed = rows.filter(|(_, weight, _)| *weight != 0.0).map(|(time, weight, rest)| {
            square += weight * weight;
            (time, weight * rest)
        });
        Self { rows: weighed.collect(), square }
    }
}

/// The trials, one after another: each has a phase of its own.
struct Rows(Vec<Heard>);

impl Rows {
    fn of(search: &FrequencySearch, data: &Data<'_>, fit: &Fit, rest: &[f64]) -> Self {
        let starts = data.starts();
        let trial = |number: usize| {
            let (trial, surface) = (&data.trials[number], fit.model.surface(&fit.values, number));
            Heard::of((0..trial.len()).map(|row| {
                let depth = trial.position[row] - surface;
                let inside = fit.model.bilateral || depth > 0.0;
                let weight = match search.weight {
                    ToneWeight::Even => 1.0,
                    ToneWeight::Inside => f64::from(inside),
                    ToneWeight::Depth => f64::from(inside) * depth,
                };
                (trial.time[row], weight * data.weights[number][row], rest[starts[number] + row])
            }))
        };
        Self((0..data.trials.len()).map(trial).collect())
    }

    /// `rest` under Hann's window over each trial, which keeps what lies far from a frequency out of it.
    fn windowed(data: &Data<'_>, rest: &[f64]) -> Self {
        let trial = |(trial, start): (&super::trial::ContactTrial, usize)| {
            let turn = std::f64::consts::TAU / trial.len().max(1) as f64;
            Heard::of((0..trial.len()).map(|row| {
                let window = 0.5 - 0.5 * (turn * (row as f64 + 0.5)).cos();
                (trial.time[row], window, rest[start + row])
            }))
        };
        Self(data.trials.iter().zip(data.starts()).map(trial).collect())
    }

    /// What a wave of that frequency takes.
    fn power(&self, frequency: f64) -> f64 {
        self.spectrum(frequency, 0.0, 1)[0]
    }

    /// What waves of `count` frequencies take, the first `first` and each `apart` from the one before, Hz.
    fn spectrum(&self, first: f64, apart: f64, count: usize) -> Vec<f64> {
        let mut all = vec![0.0; count];
        for trial in &self.0 {
            let own = periodogram(&trial.rows, first, apart, count);
            let scale = 2.0 / trial.square.max(f64::MIN_POSITIVE);
            all.iter_mut().zip(own).for_each(|(all, own)| *all += scale * own);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a wave under weights that are its own, half of the weights' squares times that of its size, whatever its phase.
    #[test]
    fn a_wave_takes_half_of_its_square_times_those_of_the_weights_in_each_trial() {
        let (size, frequency) = (0.3, 4.0);
        let trial = |phase: f64| {
            let row = |at: i32| {
                let (time, weight) = (1e-3 * f64::from(at), 2.0);
                (time, weight, weight * size * (std::f64::consts::TAU * frequency * time + phase).sin())
            };
            Heard::of((0..1000).map(row))
        };
        let rows = Rows(vec![trial(0.2), trial(1.9)]);
        let taken = 2.0 * 0.5 * (1000.0 * 2.0 * 2.0) * size * size;
        // Four whole periods: sums of sines and cosines of twice the frequency vanish.
        assert!((rows.power(frequency) - taken).abs() < 1e-9 * taken, "{} {taken}", rows.power(frequency));
        assert!(rows.power(2.0 * frequency) < 1e-9 * taken);
    }
}
