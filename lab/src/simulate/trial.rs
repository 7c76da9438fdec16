//! The run itself: mover, controller and sensors on one clock.

use std::io::IsTerminal as _;

use indicatif::{ProgressBar, ProgressDrawTarget};
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use super::Trial;
use super::actuation::{Actuation, actuation_of, integration_steps};
use super::completed_rig::CompletedRig;
use super::quantized_sensor::QuantizedSensor;
use crate::effects::{Place, Reading};
use crate::error::InputError;
use crate::recording::Recording;

/// Integration steps from which a run takes long enough to be watched.
const PROGRESS_BAR_STEPS: f64 = 1e8;

/// Share of rows at the effort's limit from which a user should know.
const SATURATION_WARNING_FRACTION: f64 = 0.2;

/// One row as a pilot sees it.
#[derive(Debug, Clone, Copy)]
pub struct Measurement {
    /// Seconds.
    pub time: f64,
    /// Reading of the position sensor.
    pub position: f64,
    /// Reading of the force sensor, without the effects of the sensor.
    pub force: f64,
    /// The force itself, for the records: no pilot may fly by it.
    pub true_force: f64,
}

/// Whoever steers the tool in the place of the rig's reference.
pub trait CommandSource {
    /// The command from this row to the next: a depth counted from the surface.
    fn command(&mut self, measurement: &Measurement) -> f64;

    /// The effort from the next row on in the place of the rig's controller, where somebody else controls the drive.
    fn effort(&mut self, _measurement: &Measurement) -> Option<f64> {
        None
    }
}

struct Run<'a> {
    setting: &'a CompletedRig,
    surface: f64,
    encoder: QuantizedSensor,
    load_cell: QuantizedSensor,
    rng: ChaCha8Rng,
    /// Its force is the true one until the run is over.
    recording: Recording,
    /// True position, velocity and acceleration of the tool, row by row.
    motion: [Vec<f64>; 3],
    touched: bool,
    limited: usize,
    /// What the pilot commands, until the next row.
    command: Option<f64>,
}

/// Runs a completed rig, along its reference or as `pilot` steers it.
pub fn run(
    setting: &CompletedRig,
    seed: u64,
    origin: &str,
    mut source: Option<&mut dyn CommandSource>,
) -> Result<Trial, InputError> {
    let mut actuation = actuation_of(setting, origin)?;
    let mut run = Run::new(setting, seed);
    // The pilot's force sensor has a noise of its own: that of the recording is drawn when the run is over.
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(1);
    let rate = setting.simulation.rate_hz;
    // Half a row of slack: 0.3 s at 10 Hz is 2.9999999999999996 rows.
    let rows = (setting.simulation.duration_s * rate + 0.5).floor() as usize;
    let bar = bar(setting, rows);
    for row in 0..rows {
        let time = row as f64 / rate;
        run.advance(&mut actuation, row as f64, rate);
        let state = actuation.state();
        if !(state.position.is_finite() && state.velocity.is_finite()) {
            return Err(unbound(setting, origin, time));
        }
        run.record(&mut actuation, time);
        if let Some(source) = source.as_deref_mut() {
            run.command(source, time, &mut rng, &mut actuation);
        }
        if row % 4096 == 0 {
            bar.set_position(row as u64);
        }
    }
    bar.finish_and_clear();
    run.apply_sensors();
    Ok(run.into_trial(origin))
}

fn unbound(setting: &CompletedRig, origin: &str, time: f64) -> InputError {
    let found = format!("a motion that grows without bound, at {time} s");
    let gains = "gains that suit the inertia and the rate_hz of [control]";
    if setting.has_motion_effects() {
        let expected = format!("{gains}, and effects of a size that the drive can bear");
        return InputError::new(format!("{origin}: [control] and [[effect]]"), found, expected);
    }
    InputError::new(format!("{origin}: [control]"), found, gains)
}

fn bar(setting: &CompletedRig, rows: usize) -> ProgressBar {
    if integration_steps(setting) > PROGRESS_BAR_STEPS && std::io::stderr().is_terminal() {
        ProgressBar::with_draw_target(Some(rows as u64), ProgressDrawTarget::stderr())
    } else {
        ProgressBar::hidden()
    }
}

impl<'a> Run<'a> {
    fn new(setting: &'a CompletedRig, seed: u64) -> Self {
        let rig = &setting.rig;
        let recording = Recording {
            force: rig.contact.map(|_| Vec::new()),
            effort: rig.drive.map(|_| Vec::new()),
            reference: Some(Vec::new()),
            ..Recording::default()
        };
        Self {
            setting,
            surface: rig.surface(),
            encoder: QuantizedSensor { resolution: setting.position_resolution, noise: 0.0, zero: 0.0 },
            load_cell: QuantizedSensor {
                resolution: setting.force_resolution,
                noise: setting.force_noise,
                zero: setting.force_zero,
            },
            rng: ChaCha8Rng::seed_from_u64(seed),
            recording,
            motion: Default::default(),
            touched: false,
            limited: 0,
            command: None,
        }
    }

    /// Moves on to sample `row`.
    fn advance(&mut self, actuation: &mut Actuation<'_>, row: f64, rate: f64) {
        match actuation {
            Actuation::Prescribed(led) => led.advance(row / rate),
            Actuation::Driven(driven) => {
                let command = self.command;
                let aim = |time| self.surface + command.unwrap_or_else(|| self.setting.reference.at(time).0);
                let read = |position| self.encoder.read(position, &mut self.rng);
                driven.advance(row, rate, self.setting.control.rate_hz, aim, read);
            }
        }
    }

    fn record(&mut self, actuation: &mut Actuation<'_>, time: f64) {
        let reference = self.surface + self.command.unwrap_or_else(|| self.setting.reference.at(time).0);
        let state = actuation.state();
        let recording = &mut self.recording;
        recording.time.push(time);
        recording.position.push(self.encoder.read(state.position, &mut self.rng));
        if let (Some(contact), Some(forces)) = (self.setting.rig.contact, &mut recording.force) {
            let (force, acceleration) = actuation.now();
            self.touched |= contact.bilateral || state.position > contact.surface || force != 0.0;
            forces.push(force);
            let now = [state.position, state.velocity, acceleration];
            self.motion.iter_mut().zip(now).for_each(|(column, value)| column.push(value));
        }
        if let (Actuation::Driven(driven), Some(efforts)) = (actuation, &mut recording.effort) {
            self.limited += usize::from(driven.effort.abs() >= self.setting.control.effort_saturation);
            efforts.push(driven.effort);
        }
        if let Some(references) = &mut recording.reference {
            references.push(reference);
        }
    }

    /// Hands the pilot what the sensors show of the row that was just recorded.
    fn command(
        &mut self,
        source: &mut dyn CommandSource,
        time: f64,
        rng: &mut ChaCha8Rng,
        actuation: &mut Actuation<'_>,
    ) {
        let last = |column: &[f64]| column.last().copied().unwrap_or_default();
        let truth = self.recording.force.as_deref().map_or(0.0, last);
        let measurement = Measurement {
            time,
            position: last(&self.recording.position),
            force: self.load_cell.read(truth, rng),
            true_force: truth,
        };
        self.command = Some(source.command(&measurement));
        if let Actuation::Driven(driven) = actuation {
            driven.given_effort = source.effort(&measurement);
        }
    }

    /// From the true force to what the sensor shows: effects, then noise, then steps.
    ///
    /// Effects act on the rows. A delay of a part of a row is a cubic through the rows around, a lag is exact for a force
    /// that is straight between two rows: what a sensor sampled at this rate can show of a force without content beyond
    /// it. Only the corner of an impact is spread, over the row that it falls in.
    fn apply_sensors(&mut self) {
        let Some(force) = &mut self.recording.force else { return };
        let step = self.setting.simulation.rate_hz.recip();
        let [position, velocity, acceleration] = &self.motion;
        let mut actives = self.setting.actives();
        actives.retain(|active| active.effect.spec().place == Place::Sensor);
        actives.sort_by_key(crate::effects::ActiveEffect::stage);
        for active in actives {
            let mut reading = Reading { start: 0.0, step, filter_width: 0.0, position, velocity, acceleration, force };
            active.effect.act_on_reading(active.form, active.values, &mut reading);
        }
        force.iter_mut().for_each(|force| *force = self.load_cell.read(*force, &mut self.rng));
    }

    fn into_trial(self, origin: &str) -> Trial {
        let mut notices = self.setting.notices.clone();
        if self.setting.rig.contact.is_some() && !self.touched {
            let depth = self.setting.reference.contact_depth;
            let unit = self.setting.rig.coordinate.position_unit();
            let hint =
                format!("check contact_depth ({depth} {unit}), contact_s, duration_s and the controller's gains");
            notices.push(format!("warning: {origin}: the tool never touches the surface; {hint}"));
        }
        let share = self.limited as f64 / self.recording.time.len() as f64;
        if share > SATURATION_WARNING_FRACTION {
            let percent = 100.0 * share;
            notices.push(format!("warning: {origin}: the effort is at its limit for {percent:.0} % of the trial"));
        }
        Trial { recording: self.recording, notices }
    }
}
