//! A recording as the contact's model sees it: the smoothed motion of the tool and the force beside it.

use crate::diagnose::signals::outliers::interpolate_outliers;
use crate::motion::{self, encoder_readings::EncoderReadings};
use crate::recording::Recording;
use crate::sensors::{DITHER_FRACTION, Figures};

/// One trial. All columns are of equal length.
#[derive(Debug, Clone)]
pub struct ContactTrial {
    /// File name of the recording.
    pub name: String,
    /// Time of the first row of the recording, s.
    pub origin_s: f64,
    /// Seconds since the first row of the recording.
    pub time: Vec<f64>,
    /// Usual time between rows, s.
    pub step_s: f64,
    /// Usual time between the rows of the recording, s.
    pub source_step_s: f64,
    /// m or rad.
    pub position: Vec<f64>,
    /// m/s or rad/s.
    pub velocity: Vec<f64>,
    /// m/s^2 or rad/s^2.
    pub acceleration: Vec<f64>,
    /// Variance of the position.
    pub position_variance: Vec<f64>,
    /// Variance of the velocity.
    pub velocity_variance: Vec<f64>,
    /// Variance of the acceleration.
    pub acceleration_variance: Vec<f64>,
    /// Force reading, N or N m.
    pub force: Vec<f64>,
    /// Effort of the drive, N or N m, where it is recorded.
    pub effort: Option<Vec<f64>>,
    /// Variance of a row of the force by the sensor alone.
    pub force_variance: f64,
    /// Whether a row is a measurement.
    pub counts: Vec<bool>,
    /// Number of the encoder's step that each row was read in; empty where the reading is continuous.
    pub encoder_steps: Vec<i64>,
    /// What the sensors leave.
    pub figures: Figures,
}

impl ContactTrial {
    /// The trial of `recording`, means of `every` rows each; `None` where it has no force.
    #[must_use]
    pub fn new(recording: &Recording, figures: Figures, every: usize) -> Option<Self> {
        let (mut force, mut position) = (recording.force.clone()?, recording.position.clone());
        let channel = figures.force?;
        let mut counts = vec![true; force.len()];
        for column in [&mut position, &mut force] {
            interpolate_outliers(&recording.time, column).into_iter().for_each(|row| counts[row] = false);
        }
        let origin = recording.time.first().copied()?;
        let since: Vec<f64> = recording.time.iter().map(|time| time - origin).collect();
        let encoder_steps = encoder_steps(&position, figures.position.resolution, every.max(1));
        let smooth = motion::smoothed(&EncoderReadings::of(&since, &position, figures.position));
        let every = every.max(1);
        let mean = |values: &[f64]| -> Vec<f64> {
            values.chunks_exact(every).map(|rows| rows.iter().sum::<f64>() / every as f64).collect()
        };
        let source_step_s = recording.period();
        let force_variance = channel.noise.max(f64::MIN_POSITIVE).powi(2) / every as f64;
        // Rounding that noise does not shake is no less in a mean.
        let rounding = channel.resolution / 12f64.sqrt();
        let coarse = channel.noise < DITHER_FRACTION * channel.resolution;
        Some(Self {
            name: recording.name.clone(),
            origin_s: origin,
            time: mean(&since),
            step_s: source_step_s * every as f64,
            source_step_s,
            position: mean(&smooth.position),
            velocity: mean(&smooth.velocity),
            acceleration: mean(&smooth.acceleration),
            position_variance: mean(&smooth.position_variance),
            velocity_variance: mean(&smooth.velocity_variance),
            acceleration_variance: mean(&smooth.acceleration_variance),
            force: mean(&force),
            effort: recording.effort.as_deref().map(mean),
            force_variance: if coarse { force_variance.max(rounding * rounding) } else { force_variance },
            counts: counts.chunks_exact(every).map(|rows| rows.iter().all(|counts| *counts)).collect(),
            encoder_steps,
            figures,
        })
    }

    /// Rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Seconds from the first row to the last.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.time.last().unwrap_or(&0.0) - self.time.first().unwrap_or(&0.0)
    }
}

/// The encoder's step of every `every`th of `readings`; empty where there are no steps.
fn encoder_steps(readings: &[f64], resolution: f64, every: usize) -> Vec<i64> {
    if resolution <= 0.0 {
        return Vec::new();
    }
    readings.chunks_exact(every).map(|rows| (rows[0] / resolution).round() as i64).collect()
}
