//! What moves the tool: a drive under its controller, or nothing but the reference.

use super::completed_rig::CompletedRig;
use super::controller::Controller;
use super::prescribed_motion::PrescribedMotion;
use super::rig_dynamics::{RigDynamics, stiffest};
use crate::error::InputError;
use crate::plant::{MAX_STEPS, Plant, State};

/// Integration steps that nobody waits for: about an hour.
const MAX_INTEGRATION_STEPS: f64 = 1e11;

/// Nominal steps that one of the steps with effects takes as long as.
const EFFECT_STEP_COST: f64 = 20.0;

/// Least steps a row, and a control period, where there are effects.
const MIN_STEPS_PER_PERIOD: f64 = 16.0;

/// The tool as it moves.
pub enum Actuation<'a> {
    /// By a drive.
    Driven(Box<DrivenTool<'a>>),
    /// Wherever the reference says.
    Prescribed(PrescribedMotion<'a>),
}

/// A driven tool.
pub struct DrivenTool<'a> {
    motion: Dynamics<'a>,
    controller: Controller,
    pub state: State,
    pub effort: f64,
    /// The effort in the place of the controller's, where somebody else controls the drive.
    pub given_effort: Option<f64>,
    time: f64,
    updates: f64,
}

/// How the state goes on.
enum Dynamics<'a> {
    /// As the rig's equations say.
    Nominal(Plant),
    /// With effects.
    WithEffects(RigDynamics<'a>),
}

impl Dynamics<'_> {
    fn advance(&mut self, state: State, effort: f64, from: f64, until: f64) -> State {
        match self {
            Self::Nominal(plant) => {
                let span = until - from;
                plant.advance(state, effort, span, plant.steps_for(span) as usize)
            }
            Self::WithEffects(body) => body.advance(state, effort, until),
        }
    }

    fn now(&mut self, state: State, effort: f64) -> (f64, f64) {
        match self {
            Self::Nominal(plant) => {
                let force = plant.contact.map_or(0.0, |contact| contact.force(state));
                (force, (effort - force - plant.drive.viscous * state.velocity) / plant.drive.inertia)
            }
            Self::WithEffects(body) => body.now(state, effort),
        }
    }
}

impl DrivenTool<'_> {
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
            self.effort = self.given_effort.unwrap_or_else(|| self.controller.update(aim(now), reading));
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

impl Actuation<'_> {
    /// Where the tool is.
    pub fn state(&self) -> State {
        match self {
            Self::Driven(driven) => driven.state,
            Self::Prescribed(led) => led.state(),
        }
    }

    /// The contact force and the tool's acceleration there.
    pub fn now(&mut self) -> (f64, f64) {
        match self {
            Self::Driven(driven) => driven.motion.now(driven.state, driven.effort),
            Self::Prescribed(led) => led.now(),
        }
    }
}

/// The mover of a completed rig.
///
/// # Errors
/// A rig too stiff or too long to integrate.
pub fn actuation_of<'a>(setting: &'a CompletedRig, origin: &str) -> Result<Actuation<'a>, InputError> {
    let actives = setting.actives();
    let rig = &setting.rig;
    let Some(drive) = rig.drive else {
        return Ok(Actuation::Prescribed(PrescribedMotion::new(setting.reference, rig.contact, &actives)));
    };
    refuse_too_long(setting, origin)?;
    let start = rig.surface() + setting.reference.at(0.0).0;
    let motion = if setting.has_motion_effects() {
        let longest = (clock(setting) * MIN_STEPS_PER_PERIOD).recip();
        Dynamics::WithEffects(RigDynamics::new(drive, rig.contact, &actives, start, longest, travel(setting)))
    } else {
        Dynamics::Nominal(Plant { drive, contact: rig.contact })
    };
    Ok(Actuation::Driven(Box::new(DrivenTool {
        motion,
        controller: Controller::new(setting.control),
        state: State { position: start, velocity: 0.0 },
        effort: 0.0,
        given_effort: None,
        time: 0.0,
        updates: 0.0,
    })))
}

/// The way that the reference goes.
fn travel(setting: &CompletedRig) -> f64 {
    let reference = setting.reference;
    let way = (reference.contact_depth - reference.free_depth).abs() + 2.0 * reference.sine_amplitude;
    if way > 0.0 { way } else { reference.contact_depth.abs().max(f64::MIN_POSITIVE) }
}

/// The faster of the two clocks.
fn clock(setting: &CompletedRig) -> f64 {
    setting.control.rate_hz.max(setting.simulation.rate_hz)
}

/// The plant whose rates set the steps.
fn stiffest_plant(setting: &CompletedRig) -> Option<Plant> {
    let (drive, contact) = (setting.rig.drive?, setting.rig.contact);
    let nominal = Plant { drive, contact };
    Some(if setting.has_motion_effects() { stiffest(drive, contact, &setting.actives()) } else { nominal })
}

/// Integration steps of the whole run, in nominal ones.
pub fn integration_steps(setting: &CompletedRig) -> f64 {
    let rate = clock(setting);
    let rows = setting.simulation.rate_hz * setting.simulation.duration_s;
    let Some(plant) = stiffest_plant(setting) else { return rows };
    let steps = plant.steps_for(rate.recip());
    let each = if setting.has_motion_effects() { steps.max(MIN_STEPS_PER_PERIOD) * EFFECT_STEP_COST } else { steps };
    each * rate * setting.simulation.duration_s
}

fn refuse_too_long(setting: &CompletedRig, origin: &str) -> Result<(), InputError> {
    let Some(plant) = stiffest_plant(setting) else { return Ok(()) };
    let steps = plant.steps_for(clock(setting).recip());
    if steps > MAX_STEPS {
        let found = format!(
            "a fastest time constant of {:.1e} s, {steps:.0} integration steps a control period",
            plant.fastest_rate().recip()
        );
        let expected =
            format!("at most {MAX_STEPS:.0} of them: a higher rate_hz in [control], or a rig less stiff or damped");
        return Err(InputError::new(format!("{origin}: [drive] and [contact]"), found, expected));
    }
    let work = integration_steps(setting);
    if work > MAX_INTEGRATION_STEPS {
        let found = format!("{work:.1e} integration steps in all");
        let expected = format!("at most {MAX_INTEGRATION_STEPS:.0e}: a shorter duration_s or lower rate_hz");
        return Err(InputError::new(format!("{origin}: [simulation] and [control]"), found, expected));
    }
    Ok(())
}
