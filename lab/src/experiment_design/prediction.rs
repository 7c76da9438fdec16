//! What a rig would record along a reference.

use super::loop_model::LoopModel;
use crate::error::InputError;
use crate::recording::Recording;
use crate::rig::{Reference, Rig, Sensors};
use crate::simulate::{CommandSource, Measurement, simulate_commanded};

/// The name that errors of a prediction give to the rig.
const ORIGIN: &str = "an explanation";

/// A reference, row by row, as the commands of a simulation.
struct Playback<'a> {
    reference: &'a [f64],
    surface: f64,
    row: usize,
}

impl CommandSource for Playback<'_> {
    fn command(&mut self, _measurement: &Measurement) -> f64 {
        self.row += 1;
        self.reference[self.row.min(self.reference.len() - 1)] - self.surface
    }
}

/// The trial that `rig` would record along `reference`, one position a row of `closed_loop`, by sensors without noise or steps. Where the
/// rig has no drive, that of `closed_loop` moves it, and no effort is recorded.
///
/// # Errors
/// As [`simulate_commanded`].
pub fn predict(rig: &Rig, closed_loop: &LoopModel, reference: &[f64]) -> Result<Recording, InputError> {
    let surface = rig.surface();
    let ideal = simulated(rig, closed_loop, reference);
    let mut source = Playback { reference, surface, row: 0 };
    let mut recording = simulate_commanded(&ideal, 1, ORIGIN, &mut source)?.recording;
    if rig.drive.is_none() {
        recording.effort = None;
    }
    recording.reference = Some(reference[..recording.time.len().min(reference.len())].to_vec());
    Ok(recording)
}

/// `rig` with ideal sensors in `closed_loop`, at rest where `reference` begins.
fn simulated(rig: &Rig, closed_loop: &LoopModel, reference: &[f64]) -> Rig {
    let mut ideal = rig.clone();
    ideal.sensors =
        Sensors { position_resolution: Some(0.0), force_resolution: Some(0.0), force_noise: Some(0.0), ..rig.sensors };
    ideal.drive = Some(rig.drive.unwrap_or(closed_loop.drive));
    ideal.control = Some(closed_loop.control);
    let surface = rig.surface();
    let first = reference.first().copied().unwrap_or(surface);
    let farthest =
        reference.iter().fold(first, |far, x| if (x - first).abs() > (far - first).abs() { *x } else { far });
    ideal.simulation.rate_hz = closed_loop.rate_hz;
    ideal.simulation.duration_s = reference.len() as f64 / closed_loop.rate_hz;
    // At rest until the commands begin; its travel sets the scale of the integration.
    let length = ideal.simulation.duration_s.max(1.0);
    ideal.reference = Some(Reference {
        free_depth: first - surface,
        contact_depth: farthest - surface,
        period_s: 10.0 * length,
        contact_s: length,
        smoothing_s: 0.1,
        sine_amplitude: 0.0,
        sine_frequency_hz: 1.0,
    });
    ideal
}
