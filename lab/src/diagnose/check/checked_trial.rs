//! A trial as the checks see it: its rows, and its motion smoothed until the speed stands out of the noise.

use crate::diagnose::quantile::quantile;
use crate::diagnose::signals::derivative_filter::DerivativeFilter;
use crate::diagnose::signals::uniform_trial::UniformTrial;
use crate::diagnose::thresholds::check_checked_trial::{
    MAX_SPEED_NOISE_FRACTION, MAX_WIDTH_FRACTION, MIN_WIDTH_PERIODS,
};
use crate::recording::Recording;
use crate::rig::{Coordinate, Rig};

/// A trial under the checks. The smoothed columns are of equal length.
pub struct CheckedTrial<'a> {
    /// As recorded.
    pub recording: &'a Recording,
    /// On an even clock.
    pub raw: &'a UniformTrial,
    /// "m" or "rad".
    pub length: &'static str,
    /// "N" or "N m".
    pub push: &'static str,
    /// Seconds between smoothed rows.
    pub step: f64,
    /// Depth beyond the rig's surface.
    pub depth: Vec<f64>,
    /// Speed.
    pub speed: Vec<f64>,
    /// Acceleration.
    pub bend: Vec<f64>,
    /// Force reading.
    pub force: Option<Vec<f64>>,
    /// Effort.
    pub effort: Option<Vec<f64>>,
    /// What noise leaves in depth, speed and force.
    pub noise: [f64; 3],
}

impl<'a> CheckedTrial<'a> {
    /// Looks at a trial.
    pub fn new(rig: &Rig, recording: &'a Recording, raw: &'a UniformTrial) -> Self {
        let period = raw.period;
        let shaken = raw.figures.position.noise;
        let usual = travel(&raw.position) / (raw.len().max(2) as f64 * period);
        let mut filter_width = (MIN_WIDTH_PERIODS * period).value();
        let lens = loop {
            let stride = (filter_width / (2.0 * period)).round().max(1.0) as usize;
            let lens = DerivativeFilter::new(filter_width, period, stride);
            if lens.noise()[1] * shaken <= MAX_SPEED_NOISE_FRACTION * usual
                || 2.0 * filter_width > MAX_WIDTH_FRACTION * raw.len() as f64 * period
            {
                break lens;
            }
            filter_width *= 2.0;
        };
        let surface = rig.surface();
        let [level, slope, _] = lens.noise();
        let (length, push) = match rig.coordinate {
            Coordinate::Linear => ("m", "N"),
            Coordinate::Rotary => ("rad", "N m"),
        };
        Self {
            recording,
            raw,
            length,
            push,
            step: lens.step(),
            depth: lens.smooth(&raw.position).into_iter().map(|position| position - surface).collect(),
            speed: lens.first_derivative(&raw.position),
            bend: lens.second_derivative(&raw.position),
            force: raw.force.as_ref().map(|force| lens.smooth(force)),
            effort: raw.effort.as_ref().map(|effort| lens.smooth_held(effort)),
            noise: [level * shaken, slope * shaken, level * raw.figures.force.map_or(0.0, |force| force.noise)],
        }
    }

    /// File name.
    pub fn name(&self) -> &str {
        &self.recording.name
    }

    /// Smoothed rows of contact by the rig's surface: all of them where it is bilateral, none in a rig without contact.
    pub fn touching(&self, rig: &Rig) -> Vec<bool> {
        let all = rig.contact.is_some_and(|contact| contact.bilateral);
        self.depth.iter().map(|depth| rig.contact.is_some() && (all || *depth > 0.0)).collect()
    }

    /// What the force reads where nothing touches: by the rig file, else in front of the surface, else unknown.
    pub fn zero(&self, rig: &Rig) -> Option<f64> {
        let free = || {
            let rows = self.depth.iter().zip(self.force.as_ref()?).filter(|(depth, _)| **depth < -self.noise[0]);
            middle(rows.map(|(_, force)| *force).collect())
        };
        rig.sensors.force_zero.or_else(free)
    }
}

/// Sum of all ways, less what noise adds by going to and fro: over stretches of a hundredth.
fn travel(values: &[f64]) -> f64 {
    let stride = (values.len() / 100).max(1);
    let picked: Vec<f64> = values.iter().step_by(stride).copied().collect();
    picked.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum()
}

/// The median.
pub fn middle(values: Vec<f64>) -> Option<f64> {
    quantile(values, 0.5)
}

/// Lowest and highest.
pub fn bounds(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)))
}

/// Highest less lowest, leaving out a hundredth at either end.
pub fn range(values: &[f64]) -> f64 {
    match (quantile(values.to_vec(), 0.01), quantile(values.to_vec(), 0.99)) {
        (Some(low), Some(high)) => high - low,
        _ => 0.0,
    }
}

/// Correlation of two columns; 0 where one does not vary.
pub fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let rows = a.len().min(b.len()).max(1) as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / rows;
    let (middle_a, middle_b) = (mean(a), mean(b));
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (a, b) in a.iter().zip(b) {
        let (a, b) = (a - middle_a, b - middle_b);
        (ab, aa, bb) = (ab + a * b, aa + a * a, bb + b * b);
    }
    if aa > 0.0 && bb > 0.0 { ab / (aa.sqrt() * bb.sqrt()) } else { 0.0 }
}
