//! The force sensor: what becomes of the contact force on its way to the reading.

use crate::effect::delay::Delay;
use crate::effect::glitch::Glitches;
use crate::effect::hum::Hum;
use crate::effect::offset::Offset;
use crate::effect::range::Range;
use crate::effect::ringing::Ringing;
use crate::effect::ripple::Ripple;
use crate::effect::wander::Wander;

/// What the sensor is told at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Input {
    /// s
    pub t: f64,
    /// Contact force, N.
    pub force: f64,
    /// m/s^2
    pub acceleration: f64,
    /// m
    pub position: f64,
    /// Effort that the controller commands, N.
    pub effort: f64,
}

/// The sensor and its state; by default it passes the force on as it is.
#[derive(Debug, Clone, Default)]
pub struct Gauge {
    /// Mass beyond the sensor, kg.
    pub inertia: f64,
    /// Relative error of the gain.
    pub gain_error: f64,
    /// Its zero, moving or not.
    pub offset: Option<Offset>,
    /// The mains.
    pub hum: Option<Hum>,
    /// Time constant of its amplifier, s.
    pub lag_s: f64,
    /// Pure delay.
    pub delay: Option<Delay>,
    /// Where it ends.
    pub range: Option<Range>,
    /// It rings.
    pub ringing: Option<Ringing>,
    /// Its zero walks at random.
    pub wander: Option<Wander>,
    /// Effort steps seen by its wires, as N per N.
    pub crosstalk: f64,
    /// An error periodic in position.
    pub ripple: Option<Ripple>,
    /// A loose contact.
    pub glitches: Option<Glitches>,
    lagging: f64,
    spike: f64,
    last_effort: f64,
}

impl Gauge {
    /// The reading, before noise and rounding, a step `dt` after the last one.
    pub fn read(&mut self, input: Input, dt: f64) -> f64 {
        let mut force = input.force + self.inertia * input.acceleration;
        force += self.gain_error * force;
        if let Some(ringing) = &mut self.ringing {
            force = ringing.advance(force, dt);
        }
        if let Some(ripple) = &self.ripple {
            force += ripple.at(input.position);
        }
        if self.crosstalk != 0.0 {
            force += self.crosstalk * self.coupled(input.effort, dt);
        }
        if let Some(offset) = &self.offset {
            force += offset.at(input.t);
        }
        if let Some(hum) = &self.hum {
            force += hum.at(input.t);
        }
        if self.lag_s > 0.0 {
            self.lagging += (force - self.lagging) * -(-dt / self.lag_s).exp_m1();
            force = self.lagging;
        }
        if let Some(delay) = &mut self.delay {
            force = delay.pass(force);
        }
        if let Some(wander) = &self.wander {
            force += wander.at(input.t);
        }
        if let Some(glitches) = &self.glitches {
            force += glitches.at(input.t);
        }
        self.range.as_ref().map_or(force, |range| range.apply(force))
    }

    /// Steps of the effort through a capacity: each is seen at once and forgotten within two milliseconds.
    fn coupled(&mut self, effort: f64, dt: f64) -> f64 {
        self.spike = self.spike * (-dt / 0.002).exp() + effort - self.last_effort;
        self.last_effort = effort;
        self.spike
    }
}
