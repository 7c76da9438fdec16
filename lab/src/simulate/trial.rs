//! The run itself: plant, controller and sensors on one clock.

use std::io::IsTerminal as _;

use indicatif::{ProgressBar, ProgressDrawTarget};
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use super::Trial;
use super::bench::Setting;
use super::controller::Controller;
use super::gauge::Gauge;
use crate::error::InputError;
use crate::plant::{MOST_STEPS, Plant, State};
use crate::recording::Recording;

/// Integration steps from which a run takes long enough to be watched.
const LONG: f64 = 1e8;

/// Integration steps that nobody waits for: about an hour.
const MOST_WORK: f64 = 1e11;

/// Share of rows at the effort's limit from which a user should know.
const OFTEN: f64 = 0.2;

/// The tool as it moves: by a drive, or wherever the reference says.
enum Mover {
    Driven { plant: Plant, controller: Controller, state: State, effort: f64, time: f64, updates: f64 },
    Led,
}

struct Run<'a> {
    setting: &'a Setting,
    surface: f64,
    encoder: Gauge,
    load_cell: Gauge,
    chance: ChaCha8Rng,
    recording: Recording,
    touched: bool,
    limited: usize,
}

/// Runs a completed rig.
pub fn run(setting: &Setting, seed: u64, origin: &str) -> Result<Trial, InputError> {
    let mut mover = mover(setting, origin)?;
    let mut run = Run::new(setting, seed);
    let rate = setting.simulation.rate_hz;
    // Half a row of slack: 0.3 s at 10 Hz is 2.9999999999999996 rows.
    let rows = (setting.simulation.duration_s * rate + 0.5).floor() as usize;
    let bar = bar(setting, &mover, rows);
    for row in 0..rows {
        let time = row as f64 / rate;
        run.advance(&mut mover, row as f64, rate);
        if let Mover::Driven { state, .. } = &mover
            && !(state.position.is_finite() && state.velocity.is_finite())
        {
            let found = format!("a motion that grows without bound, at {time} s");
            let expected = "gains that suit the inertia and the rate_hz of [control]";
            return Err(InputError::new(format!("{origin}: [control]"), found, expected));
        }
        run.record(&mover, time);
        if row % 4096 == 0 {
            bar.set_position(row as u64);
        }
    }
    bar.finish_and_clear();
    Ok(run.into_trial(origin))
}

fn mover(setting: &Setting, origin: &str) -> Result<Mover, InputError> {
    let Some(drive) = setting.rig.drive else { return Ok(Mover::Led) };
    let plant = Plant { drive, contact: setting.rig.contact };
    let steps = plant.steps_for(setting.control.rate_hz.max(setting.simulation.rate_hz).recip());
    if steps > MOST_STEPS {
        let found = format!(
            "a fastest time constant of {:.1e} s, {steps:.0} integration steps a control period",
            plant.fastest_rate().recip()
        );
        let expected =
            format!("at most {MOST_STEPS:.0} of them: a higher rate_hz in [control], or a rig less stiff or damped");
        return Err(InputError::new(format!("{origin}: [drive] and [contact]"), found, expected));
    }
    let work = work(setting, &plant);
    if work > MOST_WORK {
        let found = format!("{work:.1e} integration steps in all");
        let expected = format!("at most {MOST_WORK:.0e}: a shorter duration_s or lower rate_hz");
        return Err(InputError::new(format!("{origin}: [simulation] and [control]"), found, expected));
    }
    let start = setting.rig.surface() + setting.reference.at(0.0).0;
    let state = State { position: start, velocity: 0.0 };
    Ok(Mover::Driven {
        plant,
        controller: Controller::new(setting.control),
        state,
        effort: 0.0,
        time: 0.0,
        updates: 0.0,
    })
}

/// Integration steps of the whole run.
fn work(setting: &Setting, plant: &Plant) -> f64 {
    let rate = setting.control.rate_hz.max(setting.simulation.rate_hz);
    plant.steps_for(rate.recip()) * rate * setting.simulation.duration_s
}

fn bar(setting: &Setting, mover: &Mover, rows: usize) -> ProgressBar {
    let work = match mover {
        Mover::Driven { plant, .. } => work(setting, plant),
        Mover::Led => rows as f64,
    };
    if work > LONG && std::io::stderr().is_terminal() {
        ProgressBar::with_draw_target(Some(rows as u64), ProgressDrawTarget::stderr())
    } else {
        ProgressBar::hidden()
    }
}

impl<'a> Run<'a> {
    fn new(setting: &'a Setting, seed: u64) -> Self {
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
            encoder: Gauge { resolution: setting.position_resolution, noise: 0.0, zero: 0.0 },
            load_cell: Gauge {
                resolution: setting.force_resolution,
                noise: setting.force_noise,
                zero: setting.force_zero,
            },
            chance: ChaCha8Rng::seed_from_u64(seed),
            recording,
            touched: false,
            limited: 0,
        }
    }

    /// Moves on to sample `row`, through every update of the controller up to and at that instant.
    fn advance(&mut self, mover: &mut Mover, row: f64, rate: f64) {
        let Mover::Driven { plant, controller, state, effort, time, updates } = mover else { return };
        let control_rate = self.setting.control.rate_hz;
        let mut go = |until: f64, state: &mut State, effort: f64| {
            let span = until - *time;
            if span > 0.0 {
                *state = plant.advance(*state, effort, span, plant.steps_for(span) as usize);
                *time = until;
            }
        };
        // Compared as products, not quotients: the clocks coincide exactly where their rates are whole numbers.
        while *updates * rate <= row * control_rate {
            let now = *updates / control_rate;
            go(now, state, *effort);
            let reading = self.encoder.read(state.position, &mut self.chance);
            *effort = controller.update(self.surface + self.setting.reference.at(now).0, reading);
            *updates += 1.0;
        }
        go(row / rate, state, *effort);
    }

    fn record(&mut self, mover: &Mover, time: f64) {
        let (depth, depth_rate) = self.setting.reference.at(time);
        let reference = self.surface + depth;
        let state = match mover {
            Mover::Driven { state, .. } => *state,
            Mover::Led => State { position: reference, velocity: depth_rate },
        };
        let recording = &mut self.recording;
        recording.time.push(time);
        recording.position.push(self.encoder.read(state.position, &mut self.chance));
        if let (Some(contact), Some(forces)) = (self.setting.rig.contact, &mut recording.force) {
            let force = contact.force(state);
            self.touched |= contact.bilateral || state.position > contact.surface;
            forces.push(self.load_cell.read(force, &mut self.chance));
        }
        if let (Mover::Driven { effort, .. }, Some(efforts)) = (mover, &mut recording.effort) {
            self.limited += usize::from(effort.abs() >= self.setting.control.effort_saturation);
            efforts.push(*effort);
        }
        if let Some(references) = &mut recording.reference {
            references.push(reference);
        }
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
        if share > OFTEN {
            let percent = 100.0 * share;
            notices.push(format!("warning: {origin}: the effort is at its limit for {percent:.0} % of the trial"));
        }
        Trial { recording: self.recording, notices }
    }
}
