//! A trial as the analysis sees it: smoothed motion, force and effort at even steps.

use super::lens::Lens;
use super::raw::Raw;

/// A smoothed trial. All columns are of equal length.
#[derive(Debug, Clone)]
pub struct Track {
    /// Seconds between rows.
    pub step: f64,
    /// Width of the smoothing filter, s.
    pub blur: f64,
    /// Tool position.
    pub position: Vec<f64>,
    /// Its rate.
    pub velocity: Vec<f64>,
    /// Its acceleration.
    pub acceleration: Vec<f64>,
    /// Whether the tool stands still as far as can be seen, 0 or 1.
    pub still: Vec<f64>,
    /// What of the velocity is noise.
    pub speed_noise: f64,
    /// Force reading.
    pub force: Option<Vec<f64>>,
    /// Its rate.
    pub force_rate: Option<Vec<f64>>,
    /// Effort, held from its row to the next.
    pub effort: Option<Vec<f64>>,
    /// Rate of the effort.
    pub effort_rate: Option<Vec<f64>>,
    /// Whether a row was seen whole: not at an end, not beside a gap.
    pub seen: Vec<bool>,
}

/// A trial through both lenses: the contact is looked at as sharply as its force allows, the drive as its acceleration does.
#[derive(Debug, Clone)]
pub struct Trial {
    /// Which of the trials.
    pub number: usize,
    /// For the force reading.
    pub contact: Track,
    /// For the drive's balance.
    pub drive: Track,
}

impl Trial {
    /// The track of a channel.
    #[must_use]
    pub fn track(&self, effort: bool) -> &Track {
        if effort { &self.drive } else { &self.contact }
    }
}

/// Deviations of noise within which a velocity counts as none.
const STILL: f64 = 3.0;

impl Track {
    /// Looks at `raw` through `lens`.
    #[must_use]
    pub fn of(raw: &Raw, lens: &Lens) -> Self {
        let [_, slope_noise, bend_noise] = lens.noise();
        let noise = raw.figures.position.noise;
        let (speed_noise, shake_noise) = (noise * slope_noise, noise * bend_noise);
        let (velocity, acceleration) = (lens.slope(&raw.position), lens.bend(&raw.position));
        let still = velocity
            .iter()
            .zip(&acceleration)
            .map(|(speed, shake)| f64::from(speed.abs() <= STILL * speed_noise && shake.abs() <= STILL * shake_noise));
        Self {
            step: lens.step(),
            blur: lens.blur,
            position: lens.level(&raw.position),
            still: still.collect(),
            velocity,
            acceleration,
            speed_noise,
            force: raw.force.as_ref().map(|force| lens.level(force)),
            force_rate: raw.force.as_ref().map(|force| lens.slope(force)),
            effort: raw.effort.as_ref().map(|effort| lens.held(effort)),
            effort_rate: raw.effort.as_ref().map(|effort| lens.held_slope(effort)),
            seen: seen(raw, lens),
        }
    }

    /// Rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }
}

fn seen(raw: &Raw, lens: &Lens) -> Vec<bool> {
    let reach = lens.reach();
    let rows = raw.len();
    // Bad rows up to each row, so that a stretch is looked up in two steps.
    let mut sum = vec![0usize; rows + 1];
    for (at, good) in raw.good.iter().enumerate() {
        sum[at + 1] = sum[at] + usize::from(!good);
    }
    (0..rows)
        .step_by(lens.stride)
        .map(|at| at >= reach && at + reach < rows && sum[at + reach + 1] == sum[at - reach])
        .collect()
}
