//! From a recording to the words that the sensors of a drive would send.

use palpate_drive::{Calibration, Input, InputStatus, PositionSensor, Scale, ads8681, as5047p};

use crate::error::InputError;
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

/// Refuses a recording that leaves the one turn of an absolute encoder: beyond it the angle means another place.
///
/// # Errors
/// The first such row of `place`, the recording's file.
pub fn check_turn(
    recording: &Recording,
    place: &str,
    rig: &Rig,
    calibration: &Calibration,
    scale: &Scale,
) -> Result<(), InputError> {
    if calibration.position_sensor != PositionSensor::As5047p {
        return Ok(());
    }
    let surface = rig.contact.map_or(0.0, |contact| contact.surface);
    let ends = turn(calibration);
    let row = recording.position.iter().position(|position| !ends.contains(&counts(position - surface, scale)));
    let Some(row) = row else { return Ok(()) };
    let depth = |counts: i32| f64::from(counts) * f64::from(scale.position);
    let (one, other) = (depth(*ends.start()), depth(*ends.end()));
    Err(InputError::new(
        format!("{place}: position, row {}", row + 1),
        format!("a depth of {} m", recording.position[row] - surface),
        format!("{} to {} m, the one turn of the drive's encoder", one.min(other), one.max(other)),
    ))
}

/// Counts from the surface that the absolute encoder tells apart.
fn turn(calibration: &Calibration) -> std::ops::RangeInclusive<i32> {
    let half = i32::from(as5047p::COUNTS / 2);
    -half - calibration.surface..=half - 1 - calibration.surface
}

/// Casts saturate.
fn counts(depth: f64, scale: &Scale) -> i32 {
    (depth / f64::from(scale.position)).round() as i32
}

fn word(depth: f64, force: f64, calibration: &Calibration, scale: &Scale) -> Input {
    let depth = counts(depth, scale);
    let code = (force / f64::from(scale.force) + f64::from(scale.zero)).round() as i32 + 0x8000;
    let (angle, diagnostics) = match calibration.position_sensor {
        PositionSensor::As5047p => (
            {
                let turn = turn(calibration);
                as5047p::with_parity(calibration.angle_of(depth.clamp(*turn.start(), *turn.end())))
            },
            as5047p::with_parity(HEALTHY_DIAGNOSTICS),
        ),
        PositionSensor::Quadrature => ((depth.wrapping_add(calibration.surface) & 0xffff) as u16, 0),
    };
    let force = ads8681::word(code.clamp(0, 0xffff) as u16, calibration.range);
    Input { angle, diagnostics, force, elapsed: 1, status: InputStatus::empty() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_beyond_the_encoders_turn_is_refused_and_never_another_place() {
        let (calibration, scale) = (Calibration::DEFAULT, Calibration::DEFAULT.scale());
        let rig = Rig::default();
        let recording = |depths: &[f64]| Recording {
            time: (0..depths.len()).map(|row| row as f64 * 1e-3).collect(),
            position: depths.to_vec(),
            ..Recording::default()
        };
        let check = |depths: &[f64]| check_turn(&recording(depths), "trial.csv", &rig, &calibration, &scale);
        assert_eq!(check(&[-0.04, 0.0, 0.0399]), Ok(()));
        let error = check(&[0.0, 0.041]).unwrap_err().to_string();
        assert!(error.contains("trial.csv") && error.contains("row 2") && error.contains("0.041"), "{error}");
        assert!(check(&[-0.041]).is_err());
        let depth = |fed: &Input| calibration.depth_of(fed.angle & 0x3fff);
        let fed = inputs(&recording(&[0.039, 0.05, -0.05]), &rig, &calibration, &scale);
        assert!(depth(&fed[0]) > 7000);
        assert_eq!([depth(&fed[1]), depth(&fed[2])], [8191, -8192]);
    }
}
