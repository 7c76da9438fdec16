//! A simulated rig with physics that the investigation does not know, supervised as a real one would be.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Result, bail};

use super::monitor::{LimitMonitor, Readings, Violation};
use super::test_bed::{Ending, TestBed, TrialOutcome, TrialRequest};
use crate::error::InputError;
use crate::experiment_design::Limits;
use crate::rig::{Reference, Rig};
use crate::simulate::{CommandSource, Measurement, simulate_commanded};

/// Share of the way between margin and limit at which the supervisor stops a trial.
const STOP_SHARE: f64 = 0.5;

/// Time in which a stopped tool is brought back to where it began, s.
const RETREAT_S: f64 = 1.0;

/// A simulated rig.
pub struct SimulatedBed {
    hidden: Rig,
    /// Names its file in errors.
    pub(super) origin: String,
    pub(super) seed: u64,
}

impl SimulatedBed {
    /// The rig of the file `hidden`, in place of that of `rig`.
    ///
    /// # Errors
    /// The file is at fault, is of another coordinate, or has no drive that could follow a reference.
    pub fn new(hidden: &Path, rig: &Rig, seed: u64) -> Result<Self> {
        let origin = hidden.display().to_string();
        let hidden = Rig::read(hidden)?;
        if hidden.coordinate != rig.coordinate {
            let expected = format!("{}, as in the rig file", rig.coordinate.name());
            bail!(InputError::new(&origin, format!("coordinate {}", hidden.coordinate.name()), expected));
        }
        if hidden.drive.is_none() {
            bail!(InputError::new(&origin, "no [drive]", "a drive that can follow a reference"));
        }
        Ok(Self { hidden, origin, seed })
    }

    /// The hidden rig, at rest where `request` begins, its effort limited as a drive limits it.
    pub(super) fn prepared(&self, request: &TrialRequest<'_>) -> Rig {
        let mut rig = self.hidden.clone();
        let surface = rig.surface();
        let first = request.reference.first().copied().unwrap_or(surface);
        let length = request.reference.len() as f64 / request.rate_hz;
        rig.simulation.rate_hz = request.rate_hz;
        rig.simulation.duration_s = length;
        let [low, high] = request.limits.position;
        rig.reference = Some(Reference {
            free_depth: first - surface,
            contact_depth: (if first - low > high - first { low } else { high }) - surface,
            period_s: 10.0 * length,
            contact_s: length,
            smoothing_s: 0.1,
            sine_amplitude: 0.0,
            sine_frequency_hz: 1.0,
        });
        if let (Some(control), Some(effort)) = (&mut rig.control, request.limits.effort) {
            control.effort_saturation = control.effort_saturation.min(effort);
        }
        rig
    }
}

impl TestBed for SimulatedBed {
    fn description(&self) -> String {
        format!("a simulation of {}", self.origin)
    }

    fn run(&mut self, request: &TrialRequest<'_>) -> Result<TrialOutcome> {
        let rig = self.prepared(request);
        let mut supervisor = Supervisor::new(request, rig.surface());
        let trial = match simulate_commanded(&rig, self.seed.wrapping_add(request.round), &self.origin, &mut supervisor)
        {
            Ok(trial) => trial,
            Err(error) => return Ok(TrialOutcome { recording: None, ending: Ending::Failed(error.to_string()) }),
        };
        let mut recording = trial.recording;
        let (ending, rows) = supervisor.ended();
        truncate(&mut recording, rows);
        Ok(TrialOutcome { recording: Some(recording), ending })
    }
}

/// Leaves the first `rows` rows.
pub(super) fn truncate(recording: &mut crate::recording::Recording, rows: usize) {
    recording.time.truncate(rows);
    recording.position.truncate(rows);
    let columns = [&mut recording.velocity, &mut recording.force, &mut recording.effort, &mut recording.reference];
    columns.into_iter().flatten().for_each(|column| column.truncate(rows));
}

/// Commands the reference row by row, and a way back once a limit comes near or the user stops.
pub(super) struct Supervisor<'a> {
    reference: &'a [f64],
    interrupted: &'a AtomicBool,
    monitor: LimitMonitor,
    surface: f64,
    row: usize,
    stopped: Option<Stop>,
}

/// Where and why a trial was stopped.
#[derive(Debug, Clone, Copy)]
struct Stop {
    row: usize,
    time: f64,
    position: f64,
    violation: Option<Violation>,
}

impl<'a> Supervisor<'a> {
    pub(super) fn new(request: &'a TrialRequest<'a>, surface: f64) -> Self {
        Self {
            reference: request.reference,
            interrupted: request.interrupted,
            monitor: LimitMonitor::new(stop_limits(request.limits)),
            surface,
            row: 0,
            stopped: None,
        }
    }

    /// How it ended, and after how many rows.
    pub(super) fn ended(&self) -> (Ending, usize) {
        match self.stopped {
            None => (Ending::Completed, self.reference.len()),
            Some(Stop { row, violation: Some(violation), .. }) => (Ending::Stopped(violation), row),
            Some(Stop { row, .. }) => (Ending::Interrupted, row),
        }
    }
}

/// Limits at which a trial is stopped: before those that must not be passed, behind those of a design.
pub(super) fn stop_limits(limits: &Limits) -> Limits {
    let inner = limits.with_margin();
    let between = |kept: f64, limit: f64| kept + STOP_SHARE * (limit - kept);
    let pair = |kept: Option<f64>, limit: Option<f64>| kept.zip(limit).map(|(kept, limit)| between(kept, limit));
    Limits {
        position: [between(inner.position[0], limits.position[0]), between(inner.position[1], limits.position[1])],
        speed: between(inner.speed, limits.speed),
        // The drive itself limits the effort: at its limit it is saturated, which a recording shows.
        effort: None,
        force: pair(inner.force, limits.force),
        ..*limits
    }
}

impl CommandSource for Supervisor<'_> {
    fn command(&mut self, measurement: &Measurement) -> f64 {
        let Measurement { time, position, force, .. } = *measurement;
        self.row += 1;
        if self.stopped.is_none() {
            let violation = self.monitor.check(&Readings { time, position, force: Some(force), effort: None });
            if violation.is_some() || self.interrupted.load(Ordering::Relaxed) {
                self.stopped = Some(Stop { row: self.row, time, position, violation });
            }
        }
        let last = self.reference.len() - 1;
        let command = match self.stopped {
            None => self.reference[self.row.min(last)],
            Some(stop) => {
                let part = ((time - stop.time) / RETREAT_S).min(1.0);
                stop.position + part * (self.reference[0] - stop.position)
            }
        };
        command - self.surface
    }
}
