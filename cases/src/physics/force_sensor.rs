//! The force sensor: what becomes of the contact force on its way to the reading.

use super::delay::DelayLine;
use super::force_offset::ForceOffset;
use super::force_range::ForceRange;
use super::force_resonance::SensorResonance;
use super::loose_contact::Glitches;
use super::mains_hum::MainsTone;
use super::periodic_force_error::PositionRipple;
use super::thermal_wander::ZeroWander;

/// State of the rig at one instant, as far as the force sensor depends on it.
#[derive(Debug, Clone, Copy)]
pub struct SensorInput {
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
pub struct ForceSensor {
    /// Mass beyond the sensor, kg.
    pub inertia: f64,
    /// Relative error of the gain.
    pub gain_error: f64,
    /// Its zero, moving or not.
    pub offset: Option<ForceOffset>,
    /// The mains.
    pub mains_tone: Option<MainsTone>,
    /// Time constant of its amplifier, s.
    pub lag_time_constant_s: f64,
    /// Pure delay.
    pub delay: Option<DelayLine>,
    /// Where it ends.
    pub range: Option<ForceRange>,
    /// It rings.
    pub ringing: Option<SensorResonance>,
    /// Its zero walks at random.
    pub zero_wander: Option<ZeroWander>,
    /// Effort steps seen by its wires, as N per N.
    pub crosstalk: f64,
    /// An error periodic in position.
    pub ripple: Option<PositionRipple>,
    /// A loose contact.
    pub glitches: Option<Glitches>,
    lagging: f64,
    spike: f64,
    last_effort: f64,
}

impl ForceSensor {
    /// The reading, before noise and rounding, a step `dt` after the last one.
    pub fn read(&mut self, input: SensorInput, dt: f64) -> f64 {
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
        if let Some(hum) = &self.mains_tone {
            force += hum.at(input.t);
        }
        if self.lag_time_constant_s > 0.0 {
            self.lagging += (force - self.lagging) * -(-dt / self.lag_time_constant_s).exp_m1();
            force = self.lagging;
        }
        if let Some(delay) = &mut self.delay {
            force = delay.pass(force);
        }
        if let Some(wander) = &self.zero_wander {
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
