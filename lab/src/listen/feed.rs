//! From a recording to the words that the sensors of a drive would send.

use palpate_drive::{Calibration, Input, InputStatus, PositionSensor, Scale, ads8681, as5047p};

use crate::recording::Recording;
use crate::rig::Rig;

/// A sound answer to DIAAGC: loops ready, gain in the middle.
const HEALTHY_DIAGNOSTICS: u16 = 1 << 8 | 0x80;

/// One input a row, rounded to the sensors' counts. Depths and forces beyond what a word can hold stop at its ends, and
/// the drive tells of them.
#[must_use]
pub fn inputs(recording: &Recording, rig: &Rig, calibration: &Calibration, scale: &Scale) -> Vec<Input> {
    let surface = rig.contact.map_or(0.0, |contact| contact.surface);
    let zero = rig.sensors.force_zero.unwrap_or(0.0);
    let force = recording.force.iter().flatten().copied().chain(std::iter::repeat(zero));
    recording
        .position
        .iter()
        .zip(force)
        .map(|(position, force)| word(position - surface, force - zero, calibration, scale))
        .collect()
}

fn word(depth: f64, force: f64, calibration: &Calibration, scale: &Scale) -> Input {
    // Casts saturate.
    let depth = (depth / f64::from(scale.position)).round() as i32;
    let code = (force / f64::from(scale.force) + f64::from(scale.zero)).round() as i32 + 0x8000;
    let (angle, diagnostics) = match calibration.position_sensor {
        PositionSensor::As5047p => {
            (as5047p::with_parity(calibration.angle_of(depth)), as5047p::with_parity(HEALTHY_DIAGNOSTICS))
        }
        PositionSensor::Quadrature => ((depth.wrapping_add(calibration.surface) & 0xffff) as u16, 0),
    };
    let force = ads8681::word(code.clamp(0, 0xffff) as u16, calibration.range);
    Input { angle, diagnostics, force, elapsed: 1, status: InputStatus::empty() }
}
