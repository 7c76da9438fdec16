//! What the sensors leave: their step and their noise, from the rig file where it says so, else from the recording.
//!
//! Nothing here compares against an absolute size: a nanonewton on micrometres is judged as a kilonewton on metres.

mod noise;
mod quantum;

pub use noise::white_noise;
pub use quantum::quantum;

use crate::recording::Recording;
use crate::rig::Rig;

/// One measured channel, in the channel's own unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Channel {
    /// The step of the reading; 0 where it is continuous.
    pub resolution: f64,
    /// Standard deviation of the reading about the smooth truth, rounding included: at least `resolution / sqrt(12)`.
    pub noise: f64,
}

/// The measured channels of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    /// Position.
    pub position: Channel,
    /// Contact force, where it was recorded.
    pub force: Option<Channel>,
    /// Drive effort, where it was recorded.
    pub effort: Option<Channel>,
}

impl Figures {
    /// The figures that `rig` gives; those that it leaves out are estimated from `recording`.
    #[must_use]
    pub fn of(rig: &Rig, recording: &Recording) -> Self {
        let sensors = rig.sensors;
        let channel = |values: &Vec<f64>, step, noise| Channel::of(&recording.time, values, step, noise);
        Self {
            position: channel(&recording.position, sensors.position_resolution, None),
            force: recording.force.as_ref().map(|force| channel(force, sensors.force_resolution, sensors.force_noise)),
            effort: recording.effort.as_ref().map(|effort| channel(effort, None, None)),
        }
    }
}

/// Steps of noise from which rounding is as good as noise: Gaussian noise of half a step leaves less than two per cent of
/// the rounding's error tied to where the truth lies in the step.
pub const DITHER_FRACTION: f64 = 0.5;

impl Channel {
    /// The channel that reads `values` at `time`, with the `resolution` and `noise` that are given and the rest measured. A given noise is that before rounding, a
    /// measured one already contains it.
    #[must_use]
    pub fn of(time: &[f64], values: &[f64], resolution: Option<f64>, noise: Option<f64>) -> Self {
        let resolution = resolution.unwrap_or_else(|| quantum(values));
        let rounding = resolution / 12f64.sqrt();
        let noise = match noise {
            Some(given) => given.hypot(rounding),
            None => white_noise(time, values).max(rounding),
        };
        Self { resolution, noise }
    }
}
