//! A rig of the cases' own generator as a test bed; what really happens to it is watched apart from the investigation.

use palpate_cases::{ConcealedRig, Excursion};

use super::monitor::Violation;
use super::simulated_bed::{Supervisor, truncate};
use super::test_bed::{Ending, TestBed, TrialOutcome, TrialRequest};
use super::watched_bed::{Watched, WatchedBed};
use crate::experiment_design::Limits;
use crate::recording::Recording;
use crate::simulate::{CommandSource as _, Measurement};

/// A concealed rig.
pub struct ConcealedBed {
    rig: ConcealedRig,
    used: [f64; 4],
    seconds: f64,
}

impl ConcealedBed {
    /// Of `rig`, before any trial.
    #[must_use]
    pub fn new(rig: ConcealedRig) -> Self {
        Self { rig, used: [0.0; 4], seconds: 0.0 }
    }

    /// The independent monitor: the true motion against the limits.
    fn watch(&mut self, reached: &Excursion, limits: &Limits) {
        let [low, high] = limits.position;
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let open = |limit: Option<f64>| limit.unwrap_or(f64::INFINITY);
        let shares = [
            (reached.position.1 - middle).max(middle - reached.position.0) / half,
            reached.speed / limits.speed,
            reached.force / open(limits.force),
            reached.effort / open(limits.effort),
        ];
        self.used.iter_mut().zip(shares).for_each(|(used, share)| *used = used.max(share));
        self.seconds += reached.duration_s;
    }
}

/// A recorded trial of the generator as a recording.
#[must_use]
pub fn recording(trial: &palpate_cases::recorded_trial::RecordedTrial, name: &str) -> Recording {
    let column = |names: [&str; 2]| {
        let found = trial.columns.iter().find(|(column, ..)| names.contains(column));
        // Rounded as the file of a case is.
        found.map(|(_, digits, values)| {
            let scale = 10f64.powi(i32::try_from(*digits).unwrap_or(0));
            values.iter().map(|value| (value * scale).round() / scale).collect::<Vec<f64>>()
        })
    };
    Recording {
        name: name.to_owned(),
        time: column(["t_s", "t_s"]).unwrap_or_default(),
        position: column(["position_m", "position_rad"]).unwrap_or_default(),
        force: column(["force_N", "torque_Nm"]),
        effort: column(["effort_N", "effort_Nm"]),
        reference: column(["reference_m", "reference_rad"]),
        ..Recording::default()
    }
}

impl TestBed for ConcealedBed {
    fn description(&self) -> String {
        "a rig with concealed physics".to_owned()
    }

    fn run(&mut self, request: &TrialRequest<'_>) -> anyhow::Result<TrialOutcome> {
        // Positions are commanded as they are: the surface is nobody's concern here.
        let mut supervisor = Supervisor::new(request, 0.0);
        let mut next = request.reference[0];
        let rate = request.rate_hz;
        let mut command = |row: usize, position: f64, force: f64| {
            let commanded = next;
            let time = row as f64 / rate;
            next = supervisor.command(&Measurement { time, position, force, true_force: force });
            commanded
        };
        let effort = request.limits.effort.unwrap_or(f64::INFINITY);
        let (trial, reached) = self.rig.record(request.reference, effort, &mut command);
        self.watch(&reached, request.limits);
        let (ending, rows) = supervisor.ended();
        let mut recording = recording(&trial, "recording.csv");
        truncate(&mut recording, rows);
        let ending = if recording.time.is_empty() { Ending::Failed("nothing was recorded".to_owned()) } else { ending };
        Ok(TrialOutcome { recording: Some(recording), ending })
    }
}

impl WatchedBed for ConcealedBed {
    fn used(&self) -> [f64; 4] {
        self.used
    }

    fn watched(&self) -> Watched {
        Watched::TrueMotion
    }

    fn seconds(&self) -> f64 {
        self.seconds
    }

    fn rich_reference(&mut self) -> Vec<f64> {
        self.rig.rich_reference()
    }
}

/// Whether `ending` is that of a trial which a limit ended.
#[must_use]
pub fn stopped_by(ending: &Ending) -> Option<Violation> {
    if let Ending::Stopped(violation) = ending { Some(*violation) } else { None }
}
