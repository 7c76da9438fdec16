//! The test bed with the effects of contact and drive: what [`Plant`] is to the nominal one.
//!
//! (m - motor) a + b v + resistance = effort at the tool - F, F along the contact law.
//!
//! Effects have memories, so that an instant can be walked through only once, in the order of time, and hold corners
//! anywhere. Therefore no Runge-Kutta: one evaluation a step, in its middle, where the state is had from the last
//! acceleration. It is of order two where the motion is smooth. A corner of the contact is spread over the step that
//! crosses it by the smoothing of the contact law, and costs no more than the rest. The effect of zero size comes out as the
//! nominal plant to some parts in a hundred thousand (a test holds it to ten).

use crate::effects::{ActiveEffect, ContactSimulator, Place};
use crate::plant::{MAX_STEPS, Plant, State};
use crate::rig::{Contact, Drive};

use super::drive_effects::{DriveEffects, DriveResponse, Instant};

/// Steps per fastest time constant.
const STEPS_PER_TIME_CONSTANT: f64 = 20.0;

/// Time over which corners of the contact law are smoothed, in steps: the least at which a corner's place between two steps does not show.
const CONTACT_SMOOTHING_STEPS: f64 = 0.5;

/// Refinements of an acceleration that the contact force depends on; two where that is linear.
const MAX_ITERATIONS: usize = 40;

/// Highest damping ratio of a link between motor and tool.
const MAX_LINK_DAMPING_RATIO: f64 = 0.3;

/// The moving part, its contact and its drive, with what they carry along.
pub struct RigDynamics<'a> {
    plant: Plant,
    along: Option<ContactSimulator<'a>>,
    chain: DriveEffects<'a>,
    /// Longest step, s.
    max_step_s: f64,
    /// A small part of the travel, for a look at the slope of the contact law.
    probe_distance: f64,
    time: f64,
    /// Last step.
    step: f64,
    last: DriveResponse,
}

/// A rig's drive and contact as stiff, damped and light as its effects can make it by their parameters alone.
///
/// A parameter in the unit of a stiffness is one, and so on: the cards need no flag for it. A motor's share is of what
/// the links before it leave of the inertia, and the damping of its link goes with it.
pub fn stiffest(drive: Drive, contact: Option<Contact>, actives: &[ActiveEffect<'_>]) -> Plant {
    let mut contact = contact.unwrap_or(Contact { surface: 0.0, stiffness: 0.0, damping: 0.0, bilateral: true });
    let (mut tool, mut lightest) = (drive.inertia, f64::INFINITY);
    for active in actives.iter().filter(|active| active.effect.spec().place != Place::Sensor) {
        let parameters = active.effect.spec().forms[active.form].parameters;
        let mut spring = 0.0;
        let mut motor = 0.0;
        for (parameter, value) in parameters.iter().zip(active.values) {
            match (parameter.name, parameter.unit.linear) {
                ("motor_share", _) => motor = value * tool,
                (_, "N/m") => spring += value.abs(),
                (_, "N s/m") => contact.damping += value.abs(),
                _ => {}
            }
        }
        contact.stiffness += spring;
        if motor > 0.0 {
            contact.damping += 2.0 * MAX_LINK_DAMPING_RATIO * (spring * motor).sqrt();
            tool -= motor;
            lightest = lightest.min(motor);
        }
    }
    Plant { drive: Drive { inertia: tool.min(lightest), ..drive }, contact: Some(contact) }
}

impl<'a> RigDynamics<'a> {
    /// At rest at `position`. `longest` is the longest step in seconds, `travel` the way of the reference.
    pub fn new(
        drive: Drive,
        contact: Option<Contact>,
        actives: &[ActiveEffect<'a>],
        position: f64,
        longest: f64,
        travel: f64,
    ) -> Self {
        let plant = stiffest(drive, contact, actives);
        let mut body = Self {
            plant,
            along: contact.map(|contact| ContactSimulator::new(contact, actives)),
            chain: DriveEffects::new(drive, actives),
            max_step_s: longest.min((plant.fastest_rate() * STEPS_PER_TIME_CONSTANT).recip()),
            probe_distance: 1e-4 * travel,
            time: 0.0,
            step: 0.0,
            last: DriveResponse { acceleration: 0.0, has_friction: false },
        };
        // The first instant: memories begin with where the tool is.
        let at = Instant { time: 0.0, step: 0.0, position, velocity: 0.0, effort: 0.0 };
        body.balance(at, 0.0);
        body
    }

    /// The state at time `until`, the effort held.
    pub fn advance(&mut self, mut state: State, effort: f64, until: f64) -> State {
        let span = until - self.time;
        let wanted = (span / self.max_step_s).max(span * self.local_rate(state, effort) * STEPS_PER_TIME_CONSTANT);
        // A slope across a jump of the force has no bound; the jump itself asks for no shorter steps.
        let steps = wanted.ceil().clamp(1.0, MAX_STEPS);
        // The effort has changed, and with it the acceleration that the next step begins with.
        self.last.acceleration = self.now(state, effort).1;
        let start = self.time;
        for number in 0..steps as usize {
            self.time = start + span * (number as f64 / steps);
            state = self.go(state, effort, span / steps);
        }
        self.time = until;
        state
    }

    /// The contact force and the acceleration at this very instant.
    pub fn now(&mut self, state: State, effort: f64) -> (f64, f64) {
        let at = self.instant(state, effort);
        self.save();
        let (force, pull) = self.balance(at, 0.0);
        self.rewind();
        (force, pull.acceleration)
    }

    fn instant(&self, state: State, effort: f64) -> Instant {
        Instant { time: self.time, step: 0.5 * self.step, position: state.position, velocity: state.velocity, effort }
    }

    /// One step.
    fn go(&mut self, state: State, effort: f64, step: f64) -> State {
        let mut velocity = state.velocity + 0.5 * step * self.last.acceleration;
        if self.last.has_friction && velocity * state.velocity < 0.0 {
            // Friction may bring the tool to rest within this step, and does not push it back.
            velocity = 0.5 * state.velocity;
        }
        let position = state.position + 0.25 * step * (state.velocity + velocity);
        let time = self.time + 0.5 * step;
        let at = Instant { time, step: 0.5 * (self.step + step), position, velocity, effort };
        let (_, pull) = self.balance(at, CONTACT_SMOOTHING_STEPS * step);
        (self.step, self.last) = (step, pull);
        let end = state.velocity + step * pull.acceleration;
        if pull.has_friction && end * state.velocity < 0.0 {
            self.last.acceleration = 0.0;
            let way = -0.5 * state.velocity * state.velocity / pull.acceleration;
            return State { position: state.position + way, velocity: 0.0 };
        }
        State { position: state.position + 0.5 * step * (state.velocity + end), velocity: end }
    }

    /// Contact force and acceleration that belong together.
    ///
    /// The force may depend on the acceleration (a mass that is carried along): a = p(F(a)), p falling with F and F
    /// rising with a, has one solution, between zero and p(F(0)).
    fn balance(&mut self, at: Instant, smoothing_width: f64) -> (f64, DriveResponse) {
        if self.along.is_none() {
            return (0.0, self.chain.pull(at, 0.0));
        }
        self.save();
        let (without, first) = self.attempt(at, 0.0, smoothing_width);
        self.rewind();
        let (force, pull) = self.attempt(at, first.acceleration, smoothing_width);
        if force == without {
            return (force, pull);
        }
        let small = 1e-12 * first.acceleration.abs();
        let (mut low, mut low_rest) = (0.0, -first.acceleration);
        let (mut high, mut high_rest) = (first.acceleration, first.acceleration - pull.acceleration);
        let mut found = (force, pull);
        for _ in 0..MAX_ITERATIONS {
            let guess = high - high_rest * (high - low) / (high_rest - low_rest);
            self.rewind();
            found = self.attempt(at, guess, smoothing_width);
            let rest = guess - found.1.acceleration;
            if rest.abs() <= small || !guess.is_finite() {
                break;
            }
            // Illinois: an end that stays for a second time counts half.
            if rest * high_rest < 0.0 {
                (low, low_rest) = (high, high_rest);
            } else {
                low_rest *= 0.5;
            }
            (high, high_rest) = (guess, rest);
        }
        found
    }

    fn attempt(&mut self, at: Instant, acceleration: f64, smoothing_width: f64) -> (f64, DriveResponse) {
        let step = |along: &mut ContactSimulator<'_>| {
            along.step(at.time, at.step, at.position, at.velocity, acceleration, smoothing_width)
        };
        let force = self.along.as_mut().map_or(0.0, step);
        (force, self.chain.pull(at, force))
    }

    /// The fastest rate of drive and contact by the slopes of the contact law here, 1/s: effects can make it stiffer
    /// with depth or speed than their parameters show.
    fn local_rate(&mut self, state: State, effort: f64) -> f64 {
        let at = self.instant(state, effort);
        let rate = self.plant.fastest_rate();
        let Some(along) = &mut self.along else { return rate };
        along.keep();
        let mut force = |position: f64, velocity: f64| {
            let force = along.step(at.time, at.step, at.position + position, at.velocity + velocity, 0.0, 0.0);
            along.rewind();
            force
        };
        let faster = self.probe_distance * rate;
        let (here, deeper, quicker) = (force(0.0, 0.0), force(self.probe_distance, 0.0), force(0.0, faster));
        let stiffness = ((deeper - here) / self.probe_distance).abs();
        let damping = ((quicker - here) / faster).abs();
        let contact = Contact { surface: 0.0, stiffness, damping, bilateral: true };
        let slope = Plant { contact: Some(contact), ..self.plant }.fastest_rate();
        if slope.is_finite() { slope.max(rate) } else { rate }
    }

    fn save(&mut self) {
        self.along.iter_mut().for_each(ContactSimulator::keep);
        self.chain.save();
    }

    fn rewind(&mut self) {
        self.along.iter_mut().for_each(ContactSimulator::rewind);
        self.chain.rewind();
    }
}
