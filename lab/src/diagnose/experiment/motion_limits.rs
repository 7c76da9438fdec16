//! What the recordings did, within which an experiment stays.

use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::model::{Model, index};
use crate::diagnose::signals::derivative_filter::DerivativeFilter;
use crate::diagnose::signals::filtered_trial::FilteredTrial;
use crate::diagnose::thresholds::experiment_motion_limits::{MIN_RANGE_FRACTION, PASSBAND_FRACTION, PEAK_NOISE_SIGMAS};

/// What the recordings did: an experiment that stays within it asks nothing of the rig that it has not borne.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionLimits {
    /// Where the first recording began, m or rad.
    pub start: f64,
    /// Least position reached.
    pub low: f64,
    /// Greatest position reached.
    pub high: f64,
    /// Where the contact begins; `None` where nothing was touched.
    pub surface: Option<f64>,
    /// Whether there is free space before the surface, or nothing but free space.
    pub free: bool,
    /// Greatest speed reached, m/s or rad/s.
    pub speed: f64,
    /// Greatest acceleration reached.
    pub acceleration: f64,
    /// Length of the longest recording, s.
    pub seconds: f64,
    /// Highest frequency that the analysis sees whole, Hz.
    pub band: f64,
}

impl MotionLimits {
    /// Of the recordings of `problem`, touching as `model` with `values` says; `None` where nothing moved.
    #[must_use]
    pub fn of(problem: &IdentificationProblem, model: &Model, values: &[f64]) -> Option<Self> {
        let trials = &problem.sampler.trials;
        let both = || trials.iter().flat_map(|trial| [&trial.contact, &trial.drive]);
        let (low, high) = both()
            .flat_map(positions)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), position| (low.min(position), high.max(position)));
        let noise = problem.sampler.uniform_trials.iter().map(|raw| raw.figures.position.noise).fold(0.0, f64::max);
        let reached = |pick: &dyn Fn(&FilteredTrial) -> &Vec<f64>, order: usize| {
            let sharp = |filter: &DerivativeFilter, filtered_trials: &mut dyn Iterator<Item = &FilteredTrial>| {
                let peak = filtered_trials.flat_map(|filtered| peaks(filtered, pick(filtered))).fold(0.0, f64::max);
                // What noise made of the peak is not what the rig bore.
                peak - PEAK_NOISE_SIGMAS * noise * filter.noise()[order]
            };
            let contact = sharp(&problem.sampler.contact_filter, &mut trials.iter().map(|trial| &trial.contact));
            contact.max(sharp(&problem.sampler.drive_filter, &mut trials.iter().map(|trial| &trial.drive)))
        };
        let first = trials.first()?.contact.position.first()?;
        let range = high - low;
        let surface = values[index::SURFACE];
        let touched = model.contact.is_some_and(|bilateral| bilateral || high - surface > MIN_RANGE_FRACTION * range);
        let seconds = trials.iter().map(|t| t.contact.len() as f64 * t.contact.step).fold(f64::MIN_POSITIVE, f64::max);
        // However noise hides them: the way was made in that time, and the speed reached within that way.
        let speed = reached(&|filtered| &filtered.velocity, 1).max(range / seconds);
        let acceleration = reached(&|filtered| &filtered.acceleration, 2).max(0.5 * speed * speed / range);
        let room = Self {
            start: first.clamp(low, high),
            low,
            high,
            surface: touched.then(|| surface.clamp(low, high)),
            free: !touched || (model.contact == Some(false) && surface - low > MIN_RANGE_FRACTION * range),
            speed,
            acceleration,
            seconds,
            band: PASSBAND_FRACTION * problem.sampler.contact_filter.cutoff_hz(),
        };
        (range > 0.0 && room.speed > 0.0 && room.acceleration > 0.0).then_some(room)
    }

    /// The same, to be gone through at `part` of the speed.
    #[must_use]
    pub fn eased(self, part: f64) -> Self {
        Self { speed: part * self.speed, acceleration: part * part * self.acceleration, ..self }
    }

    /// Position at `part` of the depth reached, zero at the surface; of the whole way where there is no corner to touch.
    #[must_use]
    pub fn depth(&self, part: f64) -> f64 {
        let from = self.surface.filter(|_| self.free).unwrap_or(self.low);
        from + part * (self.high - from)
    }

    /// Position at `part` of the free way, zero at its far end.
    #[must_use]
    pub fn away(&self, part: f64) -> f64 {
        self.low + part * (self.surface.unwrap_or(self.high) - self.low)
    }

    /// The highest frequency at which a sine of `amplitude` keeps within speed, acceleration and band.
    #[must_use]
    pub fn quickest(&self, amplitude: f64) -> f64 {
        let turn = (self.speed / amplitude).min((self.acceleration / amplitude).sqrt());
        // A few turns have to fit in, and growing from nothing asks for more than swinging on.
        (0.8 * turn / std::f64::consts::TAU).min(self.band).max(8.0 / self.seconds)
    }
}

fn positions(filtered: &FilteredTrial) -> impl Iterator<Item = f64> {
    filtered.position.iter().zip(&filtered.valid).filter(|(_, valid)| **valid).map(|(position, _)| *position)
}

fn peaks<'a>(filtered: &'a FilteredTrial, values: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    values.iter().zip(&filtered.valid).filter(|(_, valid)| **valid).map(|(value, _)| value.abs())
}
