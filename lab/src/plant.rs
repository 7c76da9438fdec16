//! The nominal test bed: an inertia with viscous friction against a Kelvin-Voigt surface.
//!
//! m a + b v = effort - F,  F = K x + B v  with x = position - surface.
//!
//! Integrated by the classical Runge-Kutta method of order four with the effort held. The contact law has a corner and, with
//! damping, a jump: a step that crosses it would be of order one. Therefore the regime (free or touching) is frozen within
//! a step, the step is cut at the crossing by bisection, and the rest runs in the other regime. The error stays of order
//! four in the step, contact or not.

use crate::rig::{Contact, Drive};

/// Steps per fastest time constant: a local error of 0.05^5/120, 3e-9 of the state.
const STEPS_PER_TIME_CONSTANT: f64 = 20.0;

/// Most steps that one hold of the effort may take.
pub const MAX_STEPS: f64 = 10_000.0;

/// Crossings that one step is cut at. More of them happen only where the tool grazes the surface, and change nothing.
const MAX_BISECTIONS: usize = 8;

/// Position and velocity of the tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// m or rad, positive into the environment.
    pub position: f64,
    /// Its rate.
    pub velocity: f64,
}

/// The moving part. Immutable; [`State`] is what changes.
#[derive(Debug, Clone, Copy)]
pub struct Plant {
    /// What moves.
    pub drive: Drive,
    /// What it touches, if anything.
    pub contact: Option<Contact>,
}

impl Contact {
    /// The force of a linear contact at `state`, whether or not the surface can bear it.
    fn free_force(&self, state: State) -> f64 {
        self.stiffness * (state.position - self.surface) + self.damping * state.velocity
    }

    /// Above zero where the tool touches.
    fn touch(&self, state: State) -> f64 {
        if self.bilateral { 1.0 } else { (state.position - self.surface).min(self.free_force(state)) }
    }

    /// The contact force: zero out of contact, never pulling unless bilateral.
    #[must_use]
    pub fn force(&self, state: State) -> f64 {
        if self.bilateral || state.position > self.surface {
            let force = self.free_force(state);
            if self.bilateral { force } else { force.max(0.0) }
        } else {
            0.0
        }
    }
}

impl Plant {
    /// Rate of the fastest motion that drive and contact have, 1/s: the largest modulus of their eigenvalues.
    #[must_use]
    pub fn fastest_rate(&self) -> f64 {
        let mass = self.drive.inertia;
        let (stiffness, damping) = self.contact.map_or((0.0, 0.0), |contact| (contact.stiffness, contact.damping));
        let loss = self.drive.viscous + damping;
        let half = 0.5 * loss / mass;
        let spring = stiffness / mass;
        if half * half > spring { half + (half * half - spring).sqrt() } else { spring.sqrt() }
    }

    /// Steps that `span` seconds need.
    #[must_use]
    pub fn steps_for(&self, span: f64) -> f64 {
        (span * self.fastest_rate() * STEPS_PER_TIME_CONSTANT).ceil().max(1.0)
    }

    /// The state `span` seconds later in `steps` equal steps, the effort held.
    #[must_use]
    pub fn advance(&self, state: State, effort: f64, span: f64, steps: usize) -> State {
        let step = span / steps as f64;
        (0..steps).fold(state, |state, _| self.step(state, effort, step))
    }

    /// One step, cut where the contact begins or ends.
    fn step(&self, mut state: State, effort: f64, span: f64) -> State {
        let mut left = span;
        for _ in 0..MAX_BISECTIONS {
            let touching = self.is_touching(state);
            let end = self.frozen(state, effort, left, touching);
            if self.holds(end, touching) {
                return end;
            }
            let cut = self.onset_time(state, effort, left, touching);
            state = self.frozen(state, effort, cut, touching);
            left -= cut;
            if left <= span * f64::EPSILON {
                return state;
            }
        }
        self.frozen(state, effort, left, self.is_touching(state))
    }

    fn is_touching(&self, state: State) -> bool {
        self.contact.is_some_and(|contact| contact.touch(state) > 0.0)
    }

    fn holds(&self, state: State, touching: bool) -> bool {
        self.is_touching(state) == touching
    }

    /// Seconds until the regime no longer holds, known to end before `span`; just beyond the edge.
    fn onset_time(&self, state: State, effort: f64, span: f64, touching: bool) -> f64 {
        let (mut before, mut after) = (0.0, span);
        while after - before > span * 1e-14 {
            let middle = 0.5 * (before + after);
            if middle <= before || middle >= after {
                break;
            }
            if self.holds(self.frozen(state, effort, middle, touching), touching) {
                before = middle
            } else {
                after = middle
            }
        }
        after
    }

    /// Runge-Kutta 4 in a given regime.
    fn frozen(&self, state: State, effort: f64, span: f64, touching: bool) -> State {
        let rate = |at: State| {
            let force = if touching { self.contact.map_or(0.0, |contact| contact.free_force(at)) } else { 0.0 };
            (at.velocity, (effort - force - self.drive.viscous * at.velocity) / self.drive.inertia)
        };
        let go =
            |(v, a): (f64, f64), t: f64| State { position: state.position + t * v, velocity: state.velocity + t * a };
        let one = rate(state);
        let two = rate(go(one, 0.5 * span));
        let three = rate(go(two, 0.5 * span));
        let four = rate(go(three, span));
        let mean = |a: f64, b: f64, c: f64, d: f64| (a + 2.0 * b + 2.0 * c + d) / 6.0;
        go((mean(one.0, two.0, three.0, four.0), mean(one.1, two.1, three.1, four.1)), span)
    }
}
