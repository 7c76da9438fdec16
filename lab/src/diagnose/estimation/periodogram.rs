//! Which frequencies of a form that repeats are worth a trial: those at which the residual itself is loudest.

use super::levenberg_marquardt::FitData;
use crate::diagnose::model::{Model, index};
use crate::diagnose::thresholds::periodogram::MAX_FREQUENCIES;
use crate::effects::{Abscissa, FrequencySearch, Start, ToneWeight, gate};

/// The loudest of `tones` in the whitened residual `base` of `model`.
pub fn strongest(
    tones: &FrequencySearch,
    data: FitData<'_>,
    model: &Model,
    values: &[f64],
    base: &[f64],
) -> Vec<Start> {
    let on_effort = tones.abscissa == Abscissa::Position;
    let channel = if on_effort { &data.whitener.effort } else { &data.whitener.force };
    let Some(noise_model) = channel else { return Vec::new() };
    let offset = if on_effort { data.whitener.force_rows() } else { 0 };
    let mut heard = Vec::new();
    for &(first, apart, count) in &tones.frequencies {
        let mut loud = vec![0.0; count];
        let mut sums = vec![(0.0, 0.0, 0.0); count];
        let mut row = offset;
        for (trial, both) in data.trials.iter().enumerate() {
            // Along time each trial has a phase of its own, along the way all share one.
            if tones.abscissa == Abscissa::Time {
                accumulate_power(&mut loud, &mut sums);
            }
            let filtered = both.filtered(on_effort);
            for &at in &noise_model.rows[trial] {
                let value = base[row];
                row += 1;
                let weight = tone_weight(
                    tones.weight,
                    model,
                    values,
                    filtered.position[at],
                    filtered.velocity[at] * filtered.filter_width,
                ) / noise_model.deviation[trial][at];
                if weight == 0.0 || value == 0.0 {
                    continue;
                }
                let along = match tones.abscissa {
                    Abscissa::Time => at as f64 * filtered.step,
                    Abscissa::Position => filtered.position[at],
                };
                correlate(&mut sums, first, apart, along, weight, value);
            }
        }
        accumulate_power(&mut loud, &mut sums);
        let loud = loud.iter().enumerate().map(|(at, loud)| (*loud, first + apart * at as f64));
        heard.extend(peaks(&loud.collect::<Vec<_>>()));
    }
    heard.sort_by(|a, b| b.0.total_cmp(&a.0));
    heard.truncate(MAX_FREQUENCIES);
    heard.iter().map(|(_, frequency)| tones.start(*frequency)).collect()
}

/// Adds what the sums heard to `loud` and empties them.
fn accumulate_power(loud: &mut [f64], sums: &mut [(f64, f64, f64)]) {
    for (loud, (sine, cosine, weight)) in loud.iter_mut().zip(sums) {
        *loud += (*sine * *sine + *cosine * *cosine) / weight.max(f64::MIN_POSITIVE);
        (*sine, *cosine, *weight) = (0.0, 0.0, 0.0);
    }
}

fn tone_weight(weight: ToneWeight, model: &Model, values: &[f64], position: f64, width: f64) -> f64 {
    let depth = position - values[index::SURFACE];
    let inside = if model.contact == Some(true) { 1.0 } else { gate(depth, width.abs()) };
    match weight {
        ToneWeight::Even => 1.0,
        ToneWeight::Inside => inside,
        ToneWeight::Depth => inside * depth,
    }
}

/// Adds one row to the sums of all frequencies, each turned on from the last.
fn correlate(sums: &mut [(f64, f64, f64)], first: f64, apart: f64, along: f64, weight: f64, value: f64) {
    let (mut sine, mut cosine) = (std::f64::consts::TAU * first * along).sin_cos();
    let (turn_sine, turn_cosine) = (std::f64::consts::TAU * apart * along).sin_cos();
    let (product, square) = (weight * value, weight * weight);
    for (a, b, c) in sums {
        *a += product * sine;
        *b += product * cosine;
        *c += square;
        (sine, cosine) = (sine * turn_cosine + cosine * turn_sine, cosine * turn_cosine - sine * turn_sine);
    }
}

/// Local maxima.
fn peaks(heard: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let level = |at: usize| heard.get(at).map_or(f64::NEG_INFINITY, |(level, _)| *level);
    let is_peak = |at: &usize| {
        let before = if *at == 0 { f64::NEG_INFINITY } else { level(at - 1) };
        level(*at) >= before && level(*at) >= level(at + 1)
    };
    (0..heard.len()).filter(is_peak).map(|at| heard[at]).collect()
}
