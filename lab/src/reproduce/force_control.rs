//! Why a fast estimate matters: an indirect adaptive force controller, flown by each estimator's K.
//!
//! The drive keeps its position controller. Above it, the commanded depth is
//!
//! ```text
//! r = F_d / G + I,   dI/dt = w (F_d - F) / G,   G = Kp K / (Kp + K)
//! ```
//! with K the estimate: G is what a millimetre of command is worth in newtons, the first term is what an exact K would need alone, and
//! the integral mends the rest as fast as w allows if K is right. Where K is too small the loop is too fast, and rings; where it is too
//! great, it dawdles.

use anyhow::Result;
use palpate::{Flags, Sample};
use rayon::prelude::*;

use super::comparison::{JUMPS, STIFFNESS};
use super::estimator::{Estimator, PAPER_COVARIANCE, PAPER_GAMMA, Running};
use super::measure::MeanAndDeviation;
use super::paper_contact::PaperContact;
use crate::rig::Rig;
use crate::simulate::{self, CommandSource, Measurement};

/// Runs of each.
pub const SEEDS: u64 = 5;
/// The force that is asked for, N.
pub const TARGET_FORCE_N: f64 = 3.0;
/// w, 1/s.
const BANDWIDTH_RAD_S: f64 = 2.0;
/// Bounds that no estimate leaves, N/m.
const BOUNDS: (f64, f64) = (100.0, 3000.0);
/// K before anything is known: stiff, so that the loop is slow.
const INITIAL_STIFFNESS_N_M: f64 = 1000.0;
/// Speed of the approach, m/s.
const APPROACH_SPEED_M_S: f64 = 0.02;
/// Amplitude of the dither on the command, m, and its frequency, Hz: what the estimators live on.
const DITHER: (f64, f64) = (1.5e-3, 10.0);
/// Share of the wanted force within which it is held.
const HOLD_TOLERANCE: f64 = 0.05;
/// Rows of one period of the dither: the force is judged by its mean over them.
const DITHER_PERIOD_ROWS: usize = 100;

/// Where K comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StiffnessSource {
    /// An estimator, behind the matched filter or the paper's velocity.
    Estimated(Estimator, bool),
    /// What it was at first, for ever.
    Fixed,
    /// The truth, which nobody has.
    Known,
}

impl StiffnessSource {
    /// In the order of the page.
    pub fn all() -> [Self; 8] {
        [
            Self::Fixed,
            Self::Estimated(Estimator::Ewrls { window: 300, covariance: PAPER_COVARIANCE }, false),
            Self::Estimated(Estimator::Sprls { gamma: PAPER_GAMMA, covariance: PAPER_COVARIANCE }, false),
            Self::Estimated(Estimator::Bls(300), false),
            Self::Estimated(Estimator::Blmf(300), false),
            Self::Estimated(Estimator::Adaptive, true),
            Self::Estimated(Estimator::Cusum, true),
            Self::Known,
        ]
    }

    /// For the reader.
    pub fn name(self) -> String {
        match self {
            Self::Estimated(estimator, true) => format!("matched, {}", estimator.name()),
            Self::Estimated(estimator, false) => estimator.name(),
            Self::Fixed => "no estimate: K stays 250 N/m".into(),
            Self::Known => "the true K, known at once".into(),
        }
    }
}

/// One flight, row by row.
#[derive(Debug, Clone, Default)]
pub struct Flight {
    /// Seconds.
    pub time: Vec<f64>,
    /// Mean force over a period of the dither, N.
    pub force: Vec<f64>,
    /// The stiffness that the controller believed.
    pub stiffness: Vec<f64>,
}

/// How one source did, mean and spread over the runs.
#[derive(Debug, Clone)]
pub struct ForceControlResult {
    /// Which.
    pub source: StiffnessSource,
    /// Milliseconds from the jump up until the force stays within 5 %.
    pub settled_up: MeanAndDeviation,
    /// The same from the jump down.
    pub settled_down: MeanAndDeviation,
    /// Largest departure after the jump up, % of the wanted force.
    pub peak_up: MeanAndDeviation,
    /// The same after the jump down.
    pub peak_down: MeanAndDeviation,
    /// Root mean square of the departure from the first jump to the end, %.
    pub rms: MeanAndDeviation,
    /// Runs whose force still departs by more than twice the band in the last second before the second jump: they swing.
    pub unstable: usize,
    /// The first run.
    pub flight: Flight,
}

struct Adaptive {
    source: StiffnessSource,
    running: Option<Running>,
    gain: f64,
    believed: f64,
    depth: f64,
    integral: f64,
    touched: bool,
    log: Vec<(f64, f64, f64)>,
}

impl Adaptive {
    fn new(source: StiffnessSource, gain: f64) -> Result<Self> {
        let running = match source {
            StiffnessSource::Estimated(estimator, is_matched) => {
                Some(Running::new(estimator, super::comparison::front_end(is_matched))?)
            }
            _ => None,
        };
        let believed = if source == StiffnessSource::Fixed { STIFFNESS[0] } else { INITIAL_STIFFNESS_N_M };
        let log = Vec::new();
        Ok(Self { source, running, gain, believed, depth: -2e-3, integral: 0.0, touched: false, log })
    }

    fn update_estimate(&mut self, measurement: &Measurement) {
        if self.source == StiffnessSource::Known {
            let part = JUMPS.iter().filter(|jump| measurement.time >= **jump as f64 * 1e-3).count();
            self.believed = STIFFNESS[part];
        }
        let sample = Sample { position: measurement.position as f32, force: measurement.force as f32, elapsed: 1e-3 };
        // A sample that is rejected leaves what was believed.
        if let Some(Ok(estimate)) = self.running.as_mut().map(|running| running.update(sample)) {
            let doubtful = Flags::NO_CONTACT | Flags::STIFFNESS_UNCERTAIN | Flags::TOO_FEW | Flags::HELD;
            if !estimate.flags.intersects(doubtful) {
                self.believed = f64::from(estimate.impedance.stiffness).clamp(BOUNDS.0, BOUNDS.1);
            }
        }
    }
}

impl CommandSource for Adaptive {
    fn command(&mut self, measurement: &Measurement) -> f64 {
        self.update_estimate(measurement);
        self.log.push((measurement.time, measurement.true_force, self.believed));
        let dither = DITHER.0 * (std::f64::consts::TAU * DITHER.1 * measurement.time).sin();
        if !self.touched {
            self.touched = measurement.force > 0.5 * TARGET_FORCE_N;
            self.depth += APPROACH_SPEED_M_S * 1e-3;
            let worth = self.gain * self.believed / (self.gain + self.believed);
            self.integral = self.depth - TARGET_FORCE_N / worth;
            return self.depth + dither;
        }
        let worth = self.gain * self.believed / (self.gain + self.believed);
        self.integral += 1e-3 * BANDWIDTH_RAD_S * (TARGET_FORCE_N - measurement.force) / worth;
        TARGET_FORCE_N / worth + self.integral + dither
    }
}

/// The rig of the steps under force control: the tool is steered, so the reference says only where it starts.
fn rig() -> Result<Rig> {
    let mut rig = PaperContact::Steps.rig()?;
    if let Some(reference) = &mut rig.reference {
        (reference.free_depth, reference.sine_amplitude) = (-2e-3, 0.0);
    }
    Ok(rig)
}

/// All sources.
///
/// # Errors
/// None for the rig file of this repository.
pub fn study(done: &(dyn Fn() + Sync)) -> Result<Vec<ForceControlResult>> {
    let rig = rig()?;
    let gain = rig.control.map_or(775.0, |control| control.proportional);
    StiffnessSource::all()
        .into_par_iter()
        .map(|source| {
            let flights: Vec<Flight> = (1..=SEEDS).map(|seed| fly(&rig, gain, source, seed)).collect::<Result<_>>()?;
            done();
            Ok(row(source, flights))
        })
        .collect()
}

fn fly(rig: &Rig, gain: f64, source: StiffnessSource, seed: u64) -> Result<Flight> {
    let mut controller = Adaptive::new(source, gain)?;
    simulate::simulate_commanded(rig, seed, &rig.name, &mut controller)?;
    let mut flight = Flight::default();
    let mut sum = 0.0;
    for (k, (time, force, believed)) in controller.log.iter().enumerate() {
        sum += force - k.checked_sub(DITHER_PERIOD_ROWS).map_or(0.0, |past| controller.log[past].1);
        flight.time.push(*time);
        flight.force.push(sum / (k + 1).min(DITHER_PERIOD_ROWS) as f64);
        flight.stiffness.push(*believed);
    }
    Ok(flight)
}

fn row(source: StiffnessSource, mut flights: Vec<Flight>) -> ForceControlResult {
    let departures = |flight: &Flight, rows: std::ops::Range<usize>| -> Vec<f64> {
        let end = rows.end.min(flight.force.len());
        flight.force[rows.start.min(end)..end].iter().map(|force| (force / TARGET_FORCE_N - 1.0).abs()).collect()
    };
    let [up, down] = JUMPS;
    let over = |measure: &dyn Fn(&Flight) -> f64| MeanAndDeviation::of(flights.iter().map(measure));
    let settled = |rows: std::ops::Range<usize>| {
        over(&|flight| {
            let last = departures(flight, rows.clone()).iter().rposition(|d| d.is_nan() || *d > HOLD_TOLERANCE);
            last.map_or(0.0, |last| last as f64 + 1.0)
        })
    };
    let peak = |rows: std::ops::Range<usize>| {
        over(&|flight| 100.0 * departures(flight, rows.clone()).into_iter().fold(0.0, f64::max))
    };
    let swing =
        |flight: &Flight, rows: std::ops::Range<usize>| departures(flight, rows).into_iter().fold(0.0, f64::max);
    let end = 15_800;
    let unstable = flights.iter().filter(|flight| swing(flight, down - 1000..down) > 2.0 * HOLD_TOLERANCE).count();
    let rms = over(&|flight| {
        let all = departures(flight, up..end);
        100.0 * (all.iter().map(|d| d * d).sum::<f64>() / all.len() as f64).sqrt()
    });
    let (settled_up, settled_down) = (settled(up..down), settled(down..end));
    let (peak_up, peak_down) = (peak(up..down), peak(down..end));
    ForceControlResult {
        source,
        settled_up,
        settled_down,
        peak_up,
        peak_down,
        rms,
        unstable,
        flight: flights.swap_remove(0),
    }
}
