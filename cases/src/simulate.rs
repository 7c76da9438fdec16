//! The closed loop: 1 kHz control of a body that is simulated far finer.

use crate::nominal::{Control, Nominal};
use crate::physics::Physics;

/// Period of control and recording, s.
pub const PERIOD: f64 = 1e-3;

/// Steps of the simulation in a period: 20 kHz.
pub const STEPS: usize = 20;

/// The part of a case that its effects leave alone.
#[derive(Debug, Clone, Copy)]
pub struct Setup {
    /// The rig.
    pub nominal: Nominal,
    /// Its controller.
    pub control: Control,
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
pub struct Track {
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

impl Track {
    /// Whether the loop stayed near `travel`, m.
    #[must_use]
    pub fn is_sane(&self, travel: (f64, f64)) -> bool {
        let room = 2.0 * (travel.1 - travel.0);
        self.position.iter().all(|x| *x > travel.0 - room && *x < travel.1 + room)
    }
}

/// PD with a filtered difference, its output held for a period.
struct Controller {
    control: Control,
    last: Option<f64>,
    slope: f64,
}

impl Controller {
    fn update(&mut self, error: f64) -> f64 {
        let difference = (error - self.last.replace(error).unwrap_or(error)) / PERIOD;
        let share = -(-std::f64::consts::TAU * self.control.filter_hz * PERIOD).exp_m1();
        self.slope += share * (difference - self.slope);
        self.control.proportional * error + self.control.derivative * self.slope
    }
}

/// Runs one trial along `reference`, m, one value a period.
#[must_use]
pub fn run(setup: &Setup, mut physics: Physics, reference: &[f64]) -> Track {
    let dt = PERIOD / setup.steps as f64;
    let mut controller = Controller { control: setup.control, last: None, slope: 0.0 };
    let mut track = Track::default();
    physics.drive.rest_at(reference.first().copied().unwrap_or(0.0), &mut physics.contact, dt);
    let mut felt = feel(&mut physics, 0.0, 0.0, dt);
    for (row, wanted) in reference.iter().enumerate() {
        let tool = physics.drive.tool;
        let reading = setup.encoder.read(tool.position);
        let effort = controller.update(wanted - reading);
        track.position.push(tool.position);
        track.velocity.push(tool.velocity);
        track.reading.push(reading);
        track.force.push(felt);
        track.effort.push(effort);
        let mut sum = 0.5 * felt;
        for step in 0..setup.steps {
            let t = row as f64 * PERIOD + step as f64 * dt;
            physics.drive.step(effort, &mut physics.contact, t, dt);
            felt = feel(&mut physics, t + dt, effort, dt);
            sum += felt;
        }
        track.force_mean.push((sum - 0.5 * felt) / setup.steps as f64);
    }
    track
}

fn feel(physics: &mut Physics, t: f64, effort: f64, dt: f64) -> f64 {
    let (force, acceleration) = physics.drive.felt();
    let position = physics.drive.tool.position;
    physics.gauge.read(crate::gauge::Input { t, force, acceleration, position, effort }, dt)
}
