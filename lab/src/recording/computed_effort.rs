//! The effort of a recording that holds none, as the rig's `[effort]` computes it.

use super::Recording;
use crate::motion::{self, encoder_readings::EncoderReadings};
use crate::rig::{EffortLaw, Rig};
use crate::sensors::Channel;

/// The effort by `law` of `rig`, row by row; `input` is what is recorded of the motor. `None` where a column that it needs is absent, or where it needs a velocity
/// that fewer than [`motion::FEWEST_ROWS`] rows do not tell.
///
/// A velocity that is not recorded is that of the smoothed motion behind the positions ([`motion::smoothed`]), and a reference's that behind its values: a window of
/// given width is too wide for a quick motion and too narrow for a slow one behind a coarse encoder.
pub fn effort(law: &EffortLaw, rig: &Rig, recording: &Recording, input: Option<&[f64]>) -> Option<Vec<f64>> {
    let (time, position) = (&recording.time, &recording.position);
    let rows = time.len();
    let velocity = match &recording.velocity {
        Some(velocity) => velocity.clone(),
        None if law.needs_velocity() => velocity(time, position, rig.sensors.position_resolution)?,
        None => vec![0.0; rows],
    };
    if law.input().is_some() {
        return Some(
            input?.iter().zip(&velocity).map(|(input, velocity)| law.effort(*input, *velocity, 0.0)).collect(),
        );
    }
    let reference = recording.reference.as_ref()?;
    let rates = self::velocity(time, reference, None)?;
    let row = |at: usize| law.effort(reference[at] - position[at], velocity[at], rates[at]);
    Some((0..rows).map(row).collect())
}

/// The velocity of the motion behind `values` that go in steps of `resolution`, where it is given.
fn velocity(time: &[f64], values: &[f64], resolution: Option<f64>) -> Option<Vec<f64>> {
    let channel = Channel::of(time, values, resolution, None);
    (time.len() >= motion::FEWEST_ROWS).then(|| motion::smoothed(&EncoderReadings::of(time, values, channel)).velocity)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng as _;
    use rand_distr::{Distribution as _, Normal};

    /// A servo at 500 Hz follows 0.8 mm at 9.5 Hz behind a noise of 8 um. Of such a velocity, white noise R and a third integral of it with the memory m = (R / q)^(1/6) rows leave
    /// some R^(1/2) / m^(3/2) per row, a tenth of the noise here; a parabola through 21 rows is off by a fifth of the motion itself.
    #[test]
    fn the_velocity_behind_a_servo_is_as_quick_as_its_motion() {
        let mut random = rand_chacha::ChaCha12Rng::seed_from_u64(8);
        let noise = Normal::new(0.0, 8e-6).unwrap();
        let time: Vec<f64> = (0..3000).map(|row| f64::from(row) * 2e-3).collect();
        let pulse = std::f64::consts::TAU * 9.5;
        let path = |size: f64, late: f64| {
            move |time: &f64| (size * (pulse * time - late).sin(), size * pulse * (pulse * time - late).cos())
        };
        let (moved, asked) = (path(6e-4, 0.4), path(8e-4, 0.0));
        let recording = Recording {
            position: time.iter().map(|time| moved(time).0 + noise.sample(&mut random)).collect(),
            reference: Some(time.iter().map(|time| asked(time).0).collect()),
            time: time.clone(),
            ..Recording::default()
        };
        let text = "[rig]\nname = \"table\"\ncoordinate = \"linear\"\n[drive]\nmass_kg = 70\nviscous_n_s_m = 200\n[effort]\nmodel = \"pd\"\nproportional_n_m = 8e4\nderivative_n_s_m = 4e3\n";
        let rig = Rig::parse(text, "table").unwrap();
        let law = rig.effort.clone().unwrap();
        let computed = effort(&law, &rig, &recording, None).unwrap();
        let (mut off, mut size) = (0.0, 0.0);
        for (at, time) in time.iter().enumerate().take(2900).skip(100) {
            // What the position's noise adds by itself is the servo's own.
            let known = 8e4 * (asked(time).0 - recording.position[at]) + 4e3 * (asked(time).1 - moved(time).1);
            off += (computed[at] - known).powi(2);
            size += (4e3 * moved(time).1).powi(2);
        }
        let part = f64::sqrt(off / size);
        assert!(part < 0.03, "{part} of the damping's effort");
    }
}
