//! Which frequencies of a form that repeats are worth a trial: those at which the residual itself is loudest (Lomb's periodogram).

use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF as _, FisherSnedecor};

use super::criteria::LINE_TOLERANCE;
use super::data::Data;
use super::fit::Fit;
use super::in_step::is_in_step;
use crate::effects::{FrequencySearch, Start, ToneWeight};

/// Frequencies that are tried.
const MOST_FREQUENCIES: usize = 4;

/// The loudest of `search` in the weighted residual `rest` of `fit`.
#[must_use]
pub fn strongest(search: &FrequencySearch, data: &Data<'_>, fit: &Fit, rest: &[f64]) -> Vec<Start> {
    let rows = Rows::of(search, data, fit, rest);
    let mut heard: Vec<(f64, f64)> = Vec::new();
    for &(first, apart, count) in &search.frequencies {
        let frequencies: Vec<f64> = (0..count).map(|at| first + apart * at as f64).collect();
        // Of a form with harmonics, what all of them take: the sum is largest at the fundamental (least squares: M. G. Christensen,
        // A. Jakobsson, Multi-Pitch Estimation, 2009).
        let harmonics = |frequency: f64| (1..=search.harmonics).map(move |times| times as f64 * frequency);
        let mut power = vec![0.0; count];
        for times in 1..=search.harmonics {
            let one = rows.spectrum(times as f64 * first, times as f64 * apart, count);
            power.iter_mut().zip(one).for_each(|(all, one)| *all += one);
        }
        let level = |at: Option<usize>| at.and_then(|at| power.get(at)).copied().unwrap_or(f64::NEG_INFINITY);
        let peaks = (0..count).filter(|at| power[*at] >= level(at.checked_sub(1)) && power[*at] >= level(Some(at + 1)));
        // A wave in step with the motion itself is not told from a law of the motion.
        let is_motion = |at: &usize| harmonics(frequencies[*at]).any(|one| is_in_step(data, fit, one));
        heard.extend(peaks.filter(|at| !is_motion(at)).map(|at| (power[at], frequencies[at])));
    }
    heard.sort_by(|a, b| b.0.total_cmp(&a.0));
    heard.truncate(MOST_FREQUENCIES);
    heard.iter().map(|(_, frequency)| search.start(*frequency)).collect()
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

/// Time, weight and residual of each row that counts, a list a trial: each has a phase of its own.
struct Rows(Vec<Vec<(f64, f64, f64)>>);

impl Rows {
    fn of(search: &FrequencySearch, data: &Data<'_>, fit: &Fit, rest: &[f64]) -> Self {
        let starts = data.starts();
        let trial = |number: usize| {
            let (trial, surface) = (&data.trials[number], fit.model.surface(&fit.values, number));
            let row = |row: usize| {
                let depth = trial.position[row] - surface;
                let inside = fit.model.bilateral || depth > 0.0;
                let weight = match search.weight {
                    ToneWeight::Even => 1.0,
                    ToneWeight::Inside => f64::from(inside),
                    ToneWeight::Depth => f64::from(inside) * depth,
                };
                (trial.time[row], weight * data.weights[number][row], rest[starts[number] + row])
            };
            (0..trial.len()).map(row).filter(|(_, weight, _)| *weight != 0.0).collect::<Vec<_>>()
        };
        Self((0..data.trials.len()).map(trial).collect())
    }

    /// `rest` under Hann's window over each trial, which keeps what lies far from a frequency out of it.
    fn windowed(data: &Data<'_>, rest: &[f64]) -> Self {
        let trial = |(trial, start): (&super::trial::ContactTrial, usize)| {
            let turn = std::f64::consts::TAU / trial.len().max(1) as f64;
            let row = |row: usize| {
                let window = 0.5 - 0.5 * (turn * (row as f64 + 0.5)).cos();
                (trial.time[row], window, rest[start + row])
            };
            (0..trial.len()).map(row).collect()
        };
        Self(data.trials.iter().zip(data.starts()).map(trial).collect())
    }

    /// What a wave of that frequency takes.
    fn power(&self, frequency: f64) -> f64 {
        self.spectrum(frequency, 0.0, 1)[0]
    }

    /// What waves of `count` frequencies take, the first `first` and each `apart` from the one before, Hz.
    fn spectrum(&self, first: f64, apart: f64, count: usize) -> Vec<f64> {
        let starts: Vec<usize> = (0..count).step_by(TURNS).collect();
        let part = |start: &usize| {
            let mut power = vec![0.0; TURNS.min(count - start)];
            let frequency = first + apart * *start as f64;
            self.0.iter().for_each(|rows| add_powers(rows, frequency, apart, &mut power));
            power
        };
        starts.par_iter().flat_map(part).collect()
    }
}

/// Frequencies that are reached by turning each row's wave on from the one before: rounding adds up over them.
const TURNS: usize = 64;

/// Adds to each of `power` what `rows` hold of waves from `frequency` on, each `apart` from the one before.
fn add_powers(rows: &[(f64, f64, f64)], frequency: f64, apart: f64, power: &mut [f64]) {
    let square: f64 = rows.iter().map(|(_, weight, _)| weight * weight).sum();
    let wave = |frequency: f64| {
        let pulse = std::f64::consts::TAU * frequency;
        rows.iter().map(move |(time, ..)| (pulse * time).sin_cos())
    };
    let mut waves: Vec<(f64, f64)> = wave(frequency).collect();
    let turns: Vec<(f64, f64)> = wave(apart).collect();
    for power in power {
        let (mut sine, mut cosine) = (0.0, 0.0);
        for ((row, wave), turn) in rows.iter().zip(&mut waves).zip(&turns) {
            let signal = row.1 * row.2;
            sine += signal * wave.0;
            cosine += signal * wave.1;
            *wave = (wave.0 * turn.1 + wave.1 * turn.0, wave.1 * turn.1 - wave.0 * turn.0);
        }
        *power += 2.0 * (sine * sine + cosine * cosine) / f64::max(square, f64::MIN_POSITIVE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two trials of rows that are not evenly spaced, with two waves of other phases and a weight of their own.
    fn rows() -> Rows {
        let trial = |phase: f64| {
            let row = |at: usize| {
                let at = at as f64;
                let time = 0.01 * at + 1e-3 * (1.7 * at).sin();
                (time, 1.0 + 0.3 * (0.9 * at).cos(), (7.0 * time + phase).sin() + 0.4 * (31.0 * time - phase).cos())
            };
            (0..900).map(row).collect()
        };
        Rows(vec![trial(0.3), trial(1.1)])
    }

    #[test]
    fn a_spectrum_is_at_each_frequency_what_a_wave_of_it_takes() {
        let (rows, count) = (rows(), 200);
        let spectrum = rows.spectrum(0.2, 0.05, count);
        let directly = |frequency: f64| {
            let trial = |rows: &Vec<(f64, f64, f64)>| {
                let sum = |wave: fn(f64) -> f64| {
                    let each = rows
                        .iter()
                        .map(|(time, weight, rest)| weight * rest * wave(std::f64::consts::TAU * frequency * time));
                    each.sum::<f64>()
                };
                let square: f64 = rows.iter().map(|(_, weight, _)| weight * weight).sum();
                2.0 * (sum(f64::sin).powi(2) + sum(f64::cos).powi(2)) / square
            };
            rows.0.iter().map(trial).sum::<f64>()
        };
        assert_eq!(spectrum.len(), count);
        let loudest = spectrum.iter().fold(0.0f64, |most, power| most.max(*power));
        // 64 turns of a rounding each, over sums of 900 rows.
        for (at, power) in spectrum.iter().enumerate() {
            let direct = directly(0.2 + 0.05 * at as f64);
            assert!((power - direct).abs() < 1e-12 * loudest, "{at}: {power} {direct}");
        }
    }
}
