//! The closed loop in which the rig is moved: as its file states it, else estimated from the recordings.

use nalgebra::{DMatrix, DVector};

use crate::recording::Recording;
use crate::rig::{Contact, Control, Drive, Rig};

/// Bandwidth of a loop of which nothing is known, rad/s.
const DEFAULT_BANDWIDTH_RAD_S: f64 = 40.0;

/// Its damping ratio.
const DEFAULT_DAMPING_RATIO: f64 = 0.5;

/// Most rows of a regression.
const MAX_ROWS: usize = 20_000;

/// Span over which positions are smoothed before they are differentiated, s.
const SMOOTHING_S: f64 = 0.015;

/// Angle that a loop may swing from one row to the next, and part of its speed that it may lose: a sampled loop needs less to be stable
/// with a margin (G. F. Franklin, J. D. Powell, M. Workman, *Digital Control*, 1998, ch. 7: twenty rows a period and more).
const QUICKEST_PART: f64 = 0.3;

/// Following error over the way, in root mean square, of a tool that is led.
const LED_ERROR: f64 = 0.01;

/// Stiffness of what leads a tool over the contact's: it gives way by the same hundredth.
const LED_STIFFNESS: f64 = 100.0;

/// Samples a second of a rig of which no recording is there.
const DEFAULT_RATE_HZ: f64 = 1000.0;

/// A position loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopModel {
    /// The drive; of a rig without one, the inertia and friction that the recorded forces and references fit.
    pub drive: Drive,
    /// Its controller.
    pub control: Control,
    /// Rows a second of reference and recording.
    pub rate_hz: f64,
}

impl LoopModel {
    /// The loop of `rig` as its file states it, else by least squares from `trials`, else one that suits its drive and contact.
    #[must_use]
    pub fn new(rig: &Rig, trials: &[Recording]) -> Self {
        let rate_hz = trials.iter().map(Recording::rate).find(|rate| rate.is_finite()).unwrap_or(DEFAULT_RATE_HZ);
        if let (Some(drive), Some(control)) = (rig.drive, rig.control) {
            return Self { drive, control, rate_hz };
        }
        if trials.iter().any(is_led) {
            return Self::leading(rig, rate_hz);
        }
        let fitted = trials.iter().filter_map(|trial| Self::fit(rig, trial, rate_hz)).next();
        fitted.unwrap_or_else(|| Self::suitable(rig, rate_hz))
    }

    /// By least squares: the effort, or where none is recorded the force less the inertia's, of the error and its rate.
    fn fit(rig: &Rig, trial: &Recording, rate_hz: f64) -> Option<Self> {
        let reference = trial.reference.as_ref()?;
        let step = rate_hz.recip();
        let width = (SMOOTHING_S * rate_hz).round().max(1.0) as usize;
        let position = smoothed(&trial.position, width);
        let error: Vec<f64> = smoothed(reference, width).iter().zip(&position).map(|(r, x)| r - x).collect();
        let error_rate = slope(&error, step);
        let control = |proportional: f64, derivative: f64| Control {
            proportional,
            derivative: derivative.max(0.0),
            derivative_filter_hz: None,
            effort_saturation: f64::INFINITY,
            rate_hz,
        };
        if let (Some(effort), Some(drive)) = (&trial.effort, rig.drive) {
            let gains = least_squares(&[&error, &error_rate], &smoothed(effort, width))?;
            return (gains[0] > 0.0).then(|| Self { drive, control: control(gains[0], gains[1]), rate_hz });
        }
        let velocity = slope(&position, step);
        let acceleration = slope(&smoothed(&velocity, width), step);
        let opposing = |values: &[f64]| values.iter().map(|value| -value).collect::<Vec<f64>>();
        let columns: [&[f64]; 4] = [&error, &error_rate, &opposing(&acceleration), &opposing(&velocity)];
        let fitted = least_squares(&columns, &smoothed(trial.force.as_ref()?, width))?;
        let drive = Drive { inertia: fitted[2], viscous: fitted[3].max(0.0), encoder: None, load_scale: 1.0 };
        // What swings within some rows was fitted to rounding: no sampled loop does.
        let is_shown = fitted[0] > 0.0
            && fitted[2] > 0.0
            && fitted[0] < fitted[2] * (QUICKEST_PART * rate_hz).powi(2)
            && fitted[1] < fitted[2] * QUICKEST_PART * rate_hz;
        is_shown.then(|| Self { drive, control: control(fitted[0], fitted[1]), rate_hz })
    }

    /// A tool that is led: a loop a hundred times as stiff as the contact, as quick as its rows can show.
    fn leading(rig: &Rig, rate_hz: f64) -> Self {
        let stiffness = LED_STIFFNESS * rig.contact.map_or(1.0, |contact| contact.stiffness.max(f64::MIN_POSITIVE));
        let bandwidth = 0.5 * QUICKEST_PART * rate_hz;
        let inertia = stiffness / (bandwidth * bandwidth);
        let control = Control {
            proportional: stiffness,
            derivative: 2.0 * inertia * bandwidth,
            derivative_filter_hz: None,
            effort_saturation: f64::INFINITY,
            rate_hz,
        };
        Self { drive: Drive { inertia, viscous: 0.0, encoder: None, load_scale: 1.0 }, control, rate_hz }
    }

    /// A loop of the usual bandwidth.
    fn suitable(rig: &Rig, rate_hz: f64) -> Self {
        let bandwidth = DEFAULT_BANDWIDTH_RAD_S.min(0.05 * rate_hz * std::f64::consts::TAU);
        let contact = rig.contact.map_or(1.0, |contact: Contact| contact.stiffness.max(f64::MIN_POSITIVE));
        let drive = rig.drive.unwrap_or(Drive {
            inertia: contact / (bandwidth * bandwidth),
            viscous: 0.0,
            encoder: None,
            load_scale: 1.0,
        });
        let control = Control {
            proportional: drive.inertia * bandwidth * bandwidth,
            derivative: 2.0 * DEFAULT_DAMPING_RATIO * drive.inertia * bandwidth,
            derivative_filter_hz: None,
            effort_saturation: f64::INFINITY,
            rate_hz,
        };
        Self { drive, control: rig.control.unwrap_or(control), rate_hz }
    }
}

/// Whether the tool of `trial` is where its reference is, to a hundredth of its way: the contact does not push it back, and a reference
/// beyond a limit is a tool beyond it.
fn is_led(trial: &Recording) -> bool {
    let Some(reference) = trial.reference.as_ref().filter(|_| trial.effort.is_none()) else { return false };
    let mean = trial.position.iter().sum::<f64>() / trial.position.len().max(1) as f64;
    let way: f64 = trial.position.iter().map(|x| (x - mean).powi(2)).sum();
    let error: f64 = trial.position.iter().zip(reference).map(|(x, r)| (x - r).powi(2)).sum();
    error < LED_ERROR * LED_ERROR * way
}

/// Moving average over `width` rows to either side.
fn smoothed(values: &[f64], width: usize) -> Vec<f64> {
    let mut sums = Vec::with_capacity(values.len() + 1);
    sums.push(0.0);
    values.iter().for_each(|value| sums.push(sums[sums.len() - 1] + value));
    let mean = |at: usize| {
        let (from, to) = (at.saturating_sub(width), (at + width + 1).min(values.len()));
        (sums[to] - sums[from]) / (to - from) as f64
    };
    (0..values.len()).map(mean).collect()
}

/// Central differences.
fn slope(values: &[f64], step: f64) -> Vec<f64> {
    let last = values.len().saturating_sub(1);
    let at = |row: usize| {
        let (before, after) = (row.saturating_sub(1), (row + 1).min(last));
        (values[after] - values[before]) / (step * (after - before).max(1) as f64)
    };
    (0..values.len()).map(at).collect()
}

/// The weights of `columns` that come closest to `target`.
fn least_squares(columns: &[&[f64]], target: &[f64]) -> Option<Vec<f64>> {
    let stride = target.len().div_ceil(MAX_ROWS);
    let rows: Vec<usize> = (0..target.len()).step_by(stride).collect();
    // In units of their own size: an acceleration beside a position would not be solved for.
    let sizes: Vec<f64> = columns
        .iter()
        .map(|column| column.iter().fold(f64::MIN_POSITIVE, |most, value| value.abs().max(most)))
        .collect();
    let matrix = DMatrix::from_fn(rows.len(), columns.len(), |row, at| columns[at][rows[row]] / sizes[at]);
    let target = DVector::from_fn(rows.len(), |row, _| target[rows[row]]);
    let solved = matrix.svd(true, true).solve(&target, 1e-9).ok()?;
    let weights: Vec<f64> = solved.iter().zip(&sizes).map(|(weight, size)| weight / size).collect();
    weights.iter().all(|weight| weight.is_finite()).then_some(weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::simulate;

    /// The bench, its controller left out of the file, recorded for ten seconds.
    fn recorded() -> (Rig, Control, Recording) {
        let text = include_str!("../../rigs/bench.toml").replace("period_s = 30.0", "period_s = 4.0");
        let mut rig = Rig::parse(&text.replace("contact_s = 15.0", "contact_s = 2.0"), "bench.toml").unwrap();
        rig.simulation.duration_s = 10.0;
        let trial = simulate(&rig, 1, "bench.toml").unwrap().recording;
        let control = rig.control.take().unwrap();
        (rig, control, trial)
    }

    #[test]
    fn gains_that_the_file_leaves_out_are_estimated_from_effort_and_reference() {
        let (rig, control, trial) = recorded();
        let found = LoopModel::new(&rig, &[trial]).control;
        assert!((found.proportional / control.proportional - 1.0).abs() < 0.1, "{found:?}");
        assert!((found.derivative / control.derivative - 1.0).abs() < 0.3, "{found:?}");
    }

    #[test]
    fn without_an_effort_the_force_tells_the_ratio_of_gain_to_inertia() {
        let (mut rig, control, mut trial) = recorded();
        let inertia = rig.drive.take().unwrap().inertia;
        trial.effort = None;
        let found = LoopModel::new(&rig, &[trial]);
        assert!((found.control.proportional / control.proportional - 1.0).abs() < 0.2, "{found:?}");
        assert!((found.drive.inertia / inertia - 1.0).abs() < 0.4, "{found:?}");
    }
}
