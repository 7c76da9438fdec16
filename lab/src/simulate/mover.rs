//! What moves the tool: a drive under its controller, or nothing but the reference.

use super::bench::Setting;
use super::body::{Body, stiffest};
use super::controller::Controller;
use super::led::Led;
use crate::error::InputError;
use crate::plant::{MOST_STEPS, Plant, State};

/// Integration steps that nobody waits for: about an hour.
const MOST_WORK: f64 = 1e11;

/// Nominal steps that one of the steps with effects takes as long as.
const LABOUR: f64 = 20.0;

/// Least steps a row, and a control period, where there are effects.
const LEAST_STEPS: f64 = 16.0;

/// The tool as it moves.
pub enum Mover<'a> {
    /// By a drive.
    Driven(Box<Driven<'a>>),
    /// Wherever the reference says.
    Led(Led<'a>),
}

/// A driven tool.
pub struct Driven<'a> {
    motion: Motion<'a>,
    controller: Controller,
    pub state: State,
    pub effort: f64,
    time: f64,
    updates: f64,
}

/// How the state goes on.
enum Motion<'a> {
    /// As the rig's equations say.
    Nominal(Plant),
    /// With effects.
    Beyond(Body<'a>),
}

impl Motion<'_> {
    fn advance(&mut self, state: State, effort: f64, from: f64, until: f64) -> State {
        match self {
            Self::Nominal(plant) => {
                let span = until - from;
                plant.advance(state, effort, span, plant.steps_for(span) as usize)
            }
            Self::Beyond(body) => body.advance(state, effort, until),
        }
    }

    fn now(&mut self, state: State, effort: f64) -> (f64, f64) {
        match self {
            Self::Nominal(plant) => {
                let force = plant.contact.map_or(0.0, |contact| contact.force(state));
                (force, (effort - force - plant.drive.viscous * state.velocity) / plant.drive.inertia)
            }
            Self::Beyond(body) => body.now(state, effort),
        }
    }
}

impl Driven<'_> {
    /// Moves on to sample `row` through every update of the controller up to and at that instant. `aim` is the
    /// commanded position at a time, `read` what the position sensor shows.
    pub fn advance(
        &mut self,
        row: f64,
        rate: f64,
        control_rate: f64,
        aim: impl Fn(f64) -> f64,
        mut read: impl FnMut(f64) -> f64,
    ) {
        // Compared as products, not quotients: the clocks coincide exactly where their rates are whole numbers.
        while self.updates * rate <= row * control_rate {
            let now = self.updates / control_rate;
            self.go(now);
            let reading = read(self.state.position);
            self.effort = self.controller.update(aim(now), reading);
            self.updates += 1.0;
        }
        self.go(row / rate);
    }

    fn go(&mut self, until: f64) {
        if until > self.time {
            self.state = self.motion.advance(self.state, self.effort, self.time, until);
            self.time = until;
        }
    }
}

impl Mover<'_> {
    /// Where the tool is.
    pub fn state(&self) -> State {
        match self {
            Self::Driven(driven) => driven.state,
            Self::Led(led) => led.state(),
        }
    }

    /// The contact force and the tool's acceleration there.
    pub fn now(&mut self) -> (f64, f64) {
        match self {
            Self::Driven(driven) => driven.motion.now(driven.state, driven.effort),
            Self::Led(led) => led.now(),
        }
    }
}

/// The mover of a completed rig.
///
/// # Errors
/// A rig too stiff or too long to integrate.
pub fn mover<'a>(setting: &'a Setting, origin: &str) -> Result<Mover<'a>, InputError> {
    let actives = setting.actives();
    let rig = &setting.rig;
    let Some(drive) = rig.drive else { return Ok(Mover::Led(Led::new(setting.reference, rig.contact, &actives))) };
    refuse_endless(setting, origin)?;
    let start = rig.surface() + setting.reference.at(0.0).0;
    let motion = if setting.moves_otherwise() {
        let longest = (clock(setting) * LEAST_STEPS).recip();
        Motion::Beyond(Body::new(drive, rig.contact, &actives, start, longest, travel(setting)))
    } else {
        Motion::Nominal(Plant { drive, contact: rig.contact })
    };
    Ok(Mover::Driven(Box::new(Driven {
        motion,
        controller: Controller::new(setting.control),
        state: State { position: start, velocity: 0.0 },
        effort: 0.0,
        time: 0.0,
        updates: 0.0,
    })))
}

/// The way that the reference goes.
fn travel(setting: &Setting) -> f64 {
    let reference = setting.reference;
    let way = (reference.contact_depth - reference.free_depth).abs() + 2.0 * reference.sine_amplitude;
    if way > 0.0 { way } else { reference.contact_depth.abs().max(f64::MIN_POSITIVE) }
}

/// The faster of the two clocks.
fn clock(setting: &Setting) -> f64 {
    setting.control.rate_hz.max(setting.simulation.rate_hz)
}

/// The plant whose rates set the steps.
fn hardest(setting: &Setting) -> Option<Plant> {
    let (drive, contact) = (setting.rig.drive?, setting.rig.contact);
    let nominal = Plant { drive, contact };
    Some(if setting.moves_otherwise() { stiffest(drive, contact, &setting.actives()) } else { nominal })
}

/// Integration steps of the whole run, in nominal ones.
pub fn work(setting: &Setting) -> f64 {
    let rate = clock(setting);
    let rows = setting.simulation.rate_hz * setting.simulation.duration_s;
    let Some(plant) = hardest(setting) else { return rows };
    let steps = plant.steps_for(rate.recip());
    let each = if setting.moves_otherwise() { steps.max(LEAST_STEPS) * LABOUR } else { steps };
    each * rate * setting.simulation.duration_s
}

fn refuse_endless(setting: &Setting, origin: &str) -> Result<(), InputError> {
    let Some(plant) = hardest(setting) else { return Ok(()) };
    let steps = plant.steps_for(clock(setting).recip());
    if steps > MOST_STEPS {
        let found = format!(
            "a fastest time constant of {:.1e} s, {steps:.0} integration steps a control period",
            plant.fastest_rate().recip()
        );
        let expected =
            format!("at most {MOST_STEPS:.0} of them: a higher rate_hz in [control], or a rig less stiff or damped");
        return Err(InputError::new(format!("{origin}: [drive] and [contact]"), found, expected));
    }
    let work = work(setting);
    if work > MOST_WORK {
        let found = format!("{work:.1e} integration steps in all");
        let expected = format!("at most {MOST_WORK:.0e}: a shorter duration_s or lower rate_hz");
        return Err(InputError::new(format!("{origin}: [simulation] and [control]"), found, expected));
    }
    Ok(())
}
