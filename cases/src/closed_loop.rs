//! The closed loop: 1 kHz control of a body that is simulated far finer.

use crate::nominal::{NominalParameters, PdGains};
use crate::physics::RigModel;

/// Period of control and recording, s.
pub const SAMPLE_PERIOD_S: f64 = 1e-3;

/// Steps of the simulation in a period: 20 kHz.
pub const SUBSTEPS: usize = 20;

/// The part of a case that its effects leave alone.
#[derive(Debug, Clone, Copy)]
pub struct LoopSetup {
    /// The rig.
    pub nominal: NominalParameters,
    /// Its controller.
    pub control: PdGains,
    /// The encoder, m.
    pub encoder: Encoder,
    /// Simulation steps in a period.
    pub steps: usize,
}

/// A position sensor: whole steps, with the zero anywhere between two of them.
#[derive(Debug, Clone, Copy)]
pub struct Encoder {
    /// m
    pub step: f64,
    /// m
    pub offset: f64,
}

impl Encoder {
    /// The reading at `position`.
    #[must_use]
    pub fn read(&self, position: f64) -> f64 {
        self.step * ((position + self.offset) / self.step).round() + 0.0
    }
}

/// One trial, row by row at 1 kHz; force before noise and rounding.
#[derive(Debug, Clone, Default)]
pub struct SimulatedTrial {
    /// True position, m.
    pub position: Vec<f64>,
    /// True velocity, m/s.
    pub velocity: Vec<f64>,
    /// What the encoder reads, m.
    pub reading: Vec<f64>,
    /// What the force sensor feels, N.
    pub force: Vec<f64>,
    /// The same, its mean until the next row, N.
    pub force_mean: Vec<f64>,
    /// What the controller commands until the next row, N.
    pub effort: Vec<f64>,
}

impl SimulatedTrial {
    /// Whether the loop stayed near `travel`, m.
    #[must_use]
    pub fn stays_within(&self, travel: (f64, f64)) -> bool {
        let room = 2.0 * (travel.1 - travel.0);
        self.position.iter().all(|x| *x > travel.0 - room && *x < travel.1 + room)
    }
}

/// PD with a filtered difference, its output held for a period.
struct Controller {
    control: PdGains,
    last: Option<f64>,
    slope: f64,
}

impl Controller {
    fn update(&mut self, error: f64) -> f64 {
        let difference = (error - self.last.replace(error).unwrap_or(error)) / SAMPLE_PERIOD_S;
        let share = -(-std::f64::consts::TAU * self.control.filter_hz * SAMPLE_PERIOD_S).exp_m1();
        self.slope += share * (difference - self.slope);
        self.control.proportional * error + self.control.derivative * self.slope
    }
}

/// Runs one trial along `reference`, m, one value a period.
#[must_use]
pub fn simulate_trial(setup: &LoopSetup, model: RigModel, reference: &[f64]) -> SimulatedTrial {
    let first = reference.first().copied().unwrap_or(0.0);
    simulate_commanded(setup, model, reference.len(), first, f64::INFINITY, &mut |row, _, _| reference[row])
}

/// Runs one trial of `rows` periods from rest at `first`, m: `command` receives the row, the encoder's reading, m, and the force at
/// the sensor, N, and gives the position to go to, m. The controller's effort ends at `effort_limit`, N.
#[must_use]
pub fn simulate_commanded(
    setup: &LoopSetup,
    mut model: RigModel,
    rows: usize,
    first: f64,
    effort_limit: f64,
    command: &mut dyn FnMut(usize, f64, f64) -> f64,
) -> SimulatedTrial {
    let dt = SAMPLE_PERIOD_S / setup.steps as f64;
    let mut controller = Controller { control: setup.control, last: None, slope: 0.0 };
    let mut trial = SimulatedTrial::default();
    model.drive.rest_at(first, &mut model.contact, dt);
    let mut felt = read_force(&mut model, 0.0, 0.0, dt);
    for row in 0..rows {
        let tool = model.drive.tool;
        let reading = setup.encoder.read(tool.position);
        let wanted = command(row, reading, felt);
        let effort = controller.update(wanted - reading).clamp(-effort_limit, effort_limit);
        trial.position.push(tool.position);
        trial.velocity.push(tool.velocity);
        trial.reading.push(reading);
        trial.force.push(felt);
        trial.effort.push(effort);
        let mut sum = 0.5 * felt;
        for step in 0..setup.steps {
            let t = row as f64 * SAMPLE_PERIOD_S + step as f64 * dt;
            model.drive.step(effort, &mut model.contact, t, dt);
            felt = read_force(&mut model, t + dt, effort, dt);
            sum += felt;
        }
        trial.force_mean.push((sum - 0.5 * felt) / setup.steps as f64);
    }
    trial
}

fn read_force(model: &mut RigModel, t: f64, effort: f64, dt: f64) -> f64 {
    let (force, acceleration) = model.drive.felt();
    let position = model.drive.tool.position;
    model.sensor.read(crate::physics::force_sensor::SensorInput { t, force, acceleration, position, effort }, dt)
}
