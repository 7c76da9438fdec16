//! Where the force that the contact's law lacks lies: in time, phase, depth, speed and frequency.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::contact_report::CHANNEL;
use super::diagnosis::{BinnedResidual, Location};
use crate::diagnose::contact::outcome::{Finding, Outcome};
use crate::diagnose::contact::trial::ContactTrial;
use crate::diagnose::phase::{self, Phase};
use crate::page::quantity;
use crate::rig::Coordinate;

/// Places that are told, and the least share of the channel's energy that is one.
const MOST_PLACES: usize = 4;
const LEAST_SHARE: f64 = 0.02;

/// Bins along a quantity.
const BINS: usize = 8;

/// A row of the channel.
struct Row {
    trial: usize,
    time: f64,
    depth: f64,
    speed: f64,
    phase: Phase,
    before: f64,
    after: f64,
    noise: f64,
    above: f64,
}

fn rows(outcome: &Outcome) -> Vec<Row> {
    let model = &outcome.chosen.model;
    let scales = &model.scales;
    let mut rows = Vec::new();
    for (at, trial) in outcome.trials.iter().enumerate() {
        let surface = model.surface(&outcome.chosen.values, at);
        for row in (0..trial.len()).filter(|row| outcome.weights[at][*row] > 0.0) {
            let before = before(outcome)[at][row].powi(2);
            let noise = outcome.weights[at][row].powi(-2);
            let (depth, speed) = (trial.position[row] - surface, trial.velocity[row]);
            rows.push(Row {
                trial: at,
                time: trial.origin_s + trial.time[row],
                depth,
                speed,
                phase: Phase::of(depth, speed, scales.depth, scales.speed, model.bilateral),
                before,
                after: outcome.residuals[2][at][row].powi(2),
                noise,
                above: before - noise,
            });
        }
    }
    rows
}

/// The mismatch that is located: of given values where nothing but them is wrong, else of refitted ones.
fn before(outcome: &Outcome) -> &[Vec<f64>] {
    match outcome.finding {
        Finding::NoMismatch | Finding::Parameters => &outcome.residuals[0],
        _ => &outcome.residuals[1],
    }
}

/// The stretches that hold most of the mismatch: share and states are those of the very rows that are named.
#[must_use]
pub fn locations(outcome: &Outcome, coordinate: Coordinate) -> Vec<Location> {
    let rows = rows(outcome);
    let total: f64 = rows.iter().map(|row| row.above).sum();
    if total <= 0.0 {
        return Vec::new();
    }
    // One pass through a phase is one place.
    let mut stretches: Vec<(f64, &[Row])> = rows
        .chunk_by(|a, b| (a.trial, a.phase) == (b.trial, b.phase))
        .map(|rows| (rows.iter().map(|row| row.above).sum::<f64>() / total, rows))
        .filter(|(share, _)| *share >= LEAST_SHARE)
        .collect();
    stretches.sort_by(|a, b| b.0.total_cmp(&a.0));
    stretches.truncate(MOST_PLACES);
    stretches.into_iter().filter_map(|(share, rows)| place(outcome, share, rows, coordinate)).collect()
}

fn place(outcome: &Outcome, share: f64, rows: &[Row], coordinate: Coordinate) -> Option<Location> {
    let (first, last) = (rows.first()?, rows.last()?);
    let range = |pick: &dyn Fn(&Row) -> f64| {
        rows.iter().map(pick).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let (low, high) = range(&|row| row.depth);
    let (slow, fast) = range(&|row| row.speed.abs());
    let (metre, speed) = (coordinate.position_unit(), coordinate.velocity_unit());
    Some(Location {
        channel: CHANNEL,
        trial: outcome.trials[first.trial].name.clone(),
        start_s: first.time,
        end_s: last.time,
        phase: first.phase,
        share: share.min(1.0),
        states: format!("x {}, |v| {}", quantity::between(low, high, metre), quantity::between(slow, fast, speed)),
    })
}

/// The maps of the page.
#[must_use]
pub fn maps(outcome: &Outcome, coordinate: Coordinate) -> Vec<BinnedResidual> {
    let rows = rows(outcome);
    let along = |name: &'static str, unit: &str, pick: &dyn Fn(&Row) -> f64| {
        binned(&rows, name, unit, &rows.iter().map(pick).collect::<Vec<_>>())
    };
    let mut maps = vec![
        by_phase(&rows),
        along("depth", coordinate.position_unit(), &|row| row.depth),
        along("speed", coordinate.velocity_unit(), &|row| row.speed),
        along("time", "s", &|row| row.time - outcome.trials[row.trial].origin_s),
        by_frequency(outcome),
    ];
    maps.retain(|map| map.labels.len() > 1);
    maps
}

fn by_phase(rows: &[Row]) -> BinnedResidual {
    let here: Vec<Phase> = phase::ALL.into_iter().filter(|phase| rows.iter().any(|row| row.phase == *phase)).collect();
    let labels = here.iter().map(|phase| phase::word(*phase).to_owned()).collect();
    summed(rows, "phase", String::new(), labels, &|row, _| here.iter().position(|phase| *phase == row.phase))
}

fn binned(rows: &[Row], along: &'static str, unit: &str, values: &[f64]) -> BinnedResidual {
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    let width = (high - low) / BINS as f64;
    let bins = if width > 0.0 { BINS } else { 0 };
    let (factor, unit) = quantity::prefixed_unit(low.abs().max(high.abs()), unit);
    let labels = (0..bins).map(|bin| quantity::short((low + (bin as f64 + 0.5) * width) / factor)).collect();
    let bin = |_: &Row, at: usize| (bins > 0).then(|| (((values[at] - low) / width) as usize).min(BINS - 1));
    summed(rows, along, unit, labels, &bin)
}

fn summed(
    rows: &[Row],
    along: &'static str,
    unit: String,
    labels: Vec<String>,
    bin: &dyn Fn(&Row, usize) -> Option<usize>,
) -> BinnedResidual {
    let total: f64 = rows.iter().map(|row| row.above).sum::<f64>().max(f64::MIN_POSITIVE);
    let mut sums = vec![[0.0; 4]; labels.len()];
    for (at, row) in rows.iter().enumerate() {
        if let Some(sum) = bin(row, at).and_then(|bin| sums.get_mut(bin)) {
            *sum = [sum[0] + row.before, sum[1] + row.after, sum[2] + row.noise, sum[3] + row.above];
        }
    }
    let over = |of: usize| sums.iter().map(|sum| sum[of] / sum[2].max(f64::MIN_POSITIVE)).collect();
    BinnedResidual {
        channel: CHANNEL,
        along,
        unit,
        labels,
        before: over(0),
        after: over(1),
        share: sums.iter().map(|sum| (sum[3] / total).clamp(0.0, 1.0)).collect(),
    }
}

/// Power of the missing force in bands, over that of the expected noise, which is taken as white.
fn by_frequency(outcome: &Outcome) -> BinnedResidual {
    let step = outcome.trials.first().map_or(1.0, |trial| trial.step_s);
    let longest = outcome.trials.iter().map(ContactTrial::len).max().unwrap_or(0);
    let highest = 0.45 / step;
    let lowest = (4.0 / (longest as f64 * step)).clamp(highest / 1000.0, highest / 2.0);
    let edges = crate::effects::geometric(lowest, highest, BINS + 1);
    let spectra = [before(outcome), outcome.residuals[2].as_slice()].map(|columns| spectrum(columns, step, &edges));
    let total_rows: usize = outcome.trials.iter().map(ContactTrial::len).sum();
    let even = |pair: &[f64]| outcome.expected_noise.powi(2) * total_rows as f64 * (pair[1] - pair[0]) * step;
    let noise: Vec<f64> = edges.windows(2).map(|pair| even(pair).max(f64::MIN_POSITIVE)).collect();
    let above: Vec<f64> = spectra[0].iter().zip(&noise).map(|(power, noise)| (power - noise).max(0.0)).collect();
    let total = above.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let over = |power: &[f64]| power.iter().zip(&noise).map(|(power, noise)| power / noise).collect();
    BinnedResidual {
        channel: CHANNEL,
        along: "frequency",
        unit: "Hz".to_owned(),
        labels: edges.windows(2).map(|pair| quantity::short((pair[0] * pair[1]).sqrt())).collect(),
        before: over(&spectra[0]),
        after: over(&spectra[1]),
        share: above.iter().map(|above| above / total).collect(),
    }
}

fn spectrum(columns: &[Vec<f64>], step: f64, edges: &[f64]) -> Vec<f64> {
    let mut power = vec![0.0; edges.len().saturating_sub(1)];
    for column in columns {
        let mut wave: Vec<Complex<f64>> = column.iter().map(|force| Complex::new(*force, 0.0)).collect();
        let rows = wave.len();
        FftPlanner::new().plan_fft_forward(rows).process(&mut wave);
        for (line, value) in wave.iter().enumerate().take(rows / 2).skip(1) {
            let frequency = line as f64 / (rows as f64 * step);
            let band = edges.partition_point(|edge| *edge <= frequency);
            if let Some(sum) = band.checked_sub(1).and_then(|band| power.get_mut(band)) {
                *sum += value.norm_sqr() / rows as f64;
            }
        }
    }
    power
}
