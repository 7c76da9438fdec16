//! From sensor readings to rows of the regression: penetration, velocity, contact.

mod config;
mod contact_detector;
mod contact_model;
mod low_pass;
mod model_stream;
mod previous_sample;
mod reading;
mod rejection;
mod state;
mod units;
mod velocity;

pub use config::FrontEndConfig;
pub use contact_detector::{ContactDetectorConfig, ContactDetectorState};
pub use contact_model::{ContactModel, MAX_PARAMETERS, contact_plane};
pub use low_pass::{LowPass, LowPassState};
pub use model_stream::{ModelStream, RegressionRow};
pub use reading::Reading;
pub use rejection::{Field, Rejection};
pub use state::FrontEndState;
pub use units::Units;
pub use velocity::Velocity;

use crate::contact::{Observation, Sample};
use crate::error::{ConfigError, require, require_positive};
use crate::math::larger;
use previous_sample::PreviousSample;

/// The checked settings with what follows from them.
#[derive(Debug, Clone, Copy)]
pub struct FrontEnd {
    config: FrontEndConfig,
    nominal: LowPass,
    /// The contact thresholds in internal units.
    contact_detector: ContactDetectorConfig,
    /// Factors from SI to internal: of position, of force, and of internal penetration over seconds.
    to_penetration: f32,
    to_force: f32,
    to_rate: f32,
    /// Seconds within which a period is the nominal one.
    period_tolerance: f32,
    /// A contact of which a sample is deeper than the one and not below the other goes on, whatever came before: the surface and the
    /// lower threshold, or minus infinity where the contact is bilateral.
    inside_beyond: f32,
    touched_from: f32,
}

impl FrontEnd {
    /// Largest magnitude of position, force and rate, in internal units: its fourth power is far from overflow.
    pub const MAX_MAGNITUDE: f32 = 1e6;

    /// Rate, in internal units, that is no movement by any measure.
    const MIN_RATE: f32 = 1e-20;

    /// A period within this share of the nominal one is the nominal one (written times are rounded).
    const PERIOD_TOLERANCE: f32 = 1e-4;

    /// Checks the settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: FrontEndConfig) -> Result<Self, ConfigError> {
        require_positive(config.period, "period")?;
        require_positive(config.cutoff, "cutoff")?;
        let cycles = config.cutoff * config.period;
        require(cycles <= LowPass::LIMIT, "cutoff", "a cut-off of at most 0.4 over the sample period")?;
        require(cycles >= 1e-6, "cutoff", "a cut-off of at least 1e-6 over the sample period")?;
        require(config.surface.is_finite(), "surface", "a finite position")?;
        config.contact_detector.check()?;
        config.units.check()?;
        let units = config.units;
        Ok(Self {
            config,
            nominal: LowPass::new(cycles),
            contact_detector: ContactDetectorConfig {
                on_force: config.contact_detector.on_force / units.force,
                off_force: config.contact_detector.off_force / units.force,
                ..config.contact_detector
            },
            to_penetration: 1.0 / units.penetration,
            to_force: 1.0 / units.force,
            to_rate: units.penetration / units.rate,
            period_tolerance: Self::PERIOD_TOLERANCE * config.period,
            inside_beyond: if config.bilateral { f32::NEG_INFINITY } else { 0.0 },
            touched_from: if config.bilateral {
                f32::NEG_INFINITY
            } else {
                config.contact_detector.off_force / units.force
            },
        })
    }

    /// The settings.
    pub fn config(&self) -> &FrontEndConfig {
        &self.config
    }

    /// How many samples in a row one independent value of the filtered noise is worth: sample rate over twice the
    /// filter's noise bandwidth, at least 1.
    pub fn correlated_samples(&self) -> f32 {
        let cycles = self.config.cutoff * self.config.period;
        larger(1.0 / (2.0 * LowPass::NOISE_BANDWIDTH * cycles), 1.0)
    }

    /// Takes one sample.
    ///
    /// # Errors
    /// Why it was rejected; then only the elapsed time is taken over.
    // Inlined: as a call it hands its result over in memory, which is a tenth of its cost.
    #[inline(always)]
    pub fn update(&self, state: &mut FrontEndState, sample: Sample) -> Result<Reading, Rejection> {
        match self.usual(state, &sample) {
            Some((penetration, force)) => {
                let (now, depth, contact) = self.touch(state, penetration, force);
                let observation = self.advance(state, &self.nominal, now, depth, sample.elapsed);
                Ok(Reading { observation, contact, restarted: false })
            }
            None => self.update_unusual(state, &sample),
        }
    }

    /// Whether the latest sample that was taken is in contact.
    pub(crate) fn touches(&self, state: &FrontEndState) -> bool {
        state.contact_detector.is_closed() || self.config.bilateral && state.begun
    }

    /// The row of a usual sample in a contact that goes on, in the surface and above the lower threshold; `None`, and nothing has
    /// changed, for all others. For them [`Self::update`], which tells the same of these, too.
    #[inline(always)]
    pub(crate) fn update_in_contact(&self, state: &mut FrontEndState, sample: &Sample) -> Option<Observation> {
        let (penetration, force) = self.usual(state, sample)?;
        if !(state.contact_detector.is_closed() && penetration > self.inside_beyond && force >= self.touched_from) {
            return None;
        }
        state.contact_detector.stay();
        let now = PreviousSample { position: penetration, force };
        Some(self.advance(state, &self.nominal, now, penetration, sample.elapsed))
    }

    /// Penetration and force of a usual sample: within the range, a nominal period after the one before, filters running. One comparison
    /// each; what is no number compares false. All else goes the long way, which does the same.
    #[inline(always)]
    fn usual(&self, state: &FrontEndState, sample: &Sample) -> Option<(f32, f32)> {
        let (penetration, force) = self.internal(sample);
        // Each is within the range where their sum is.
        let usual =
            penetration.abs() + force.abs() <= Self::MAX_MAGNITUDE && self.is_nominal(sample.elapsed) && state.running;
        usual.then_some((penetration, force))
    }

    /// [`Self::update`] for any sample. Apart, so that the usual one does not pay for it.
    #[inline(never)]
    fn update_unusual(&self, state: &mut FrontEndState, sample: &Sample) -> Result<Reading, Rejection> {
        let reading = self.update_any(state, sample);
        state.running = state.begun && !state.filters_empty && state.skipped == 0.0;
        reading
    }

    fn update_any(&self, state: &mut FrontEndState, sample: &Sample) -> Result<Reading, Rejection> {
        let (penetration, force) = self.validated(sample).inspect_err(|_| {
            if sample.elapsed.is_finite() && sample.elapsed > 0.0 {
                state.skipped += sample.elapsed;
            }
        })?;
        let elapsed = sample.elapsed + state.skipped;
        state.skipped = 0.0;
        let (now, depth, contact) = self.touch(state, penetration, force);
        let (true, Some(filter)) = (state.begun, self.filter_for(elapsed)) else {
            state.previous = now;
            (state.begun, state.filters_empty) = (true, true);
            let observation = Observation { penetration: depth, rate: 0.0, force };
            return Ok(Reading { observation, contact, restarted: true });
        };
        if state.filters_empty {
            state.start_filters(&self.unfiltered_row(&state.previous, &now, elapsed));
        }
        let observation = self.advance(state, &filter, now, depth, elapsed);
        Ok(Reading { observation, contact, restarted: false })
    }

    /// A sample as the next one needs it, its depth below the surface, and whether the tool is in contact.
    #[inline(always)]
    fn touch(&self, state: &mut FrontEndState, penetration: f32, force: f32) -> (PreviousSample, f32, bool) {
        let depth = if self.config.bilateral { penetration } else { larger(penetration, 0.0) };
        let contact = self.contact_detector.update(&mut state.contact_detector, penetration, force);
        let position = match self.config.velocity {
            Velocity::Paper => penetration,
            Velocity::Matched => depth,
        };
        (PreviousSample { position, force }, depth, self.config.bilateral || contact)
    }

    /// The row behind the low-pass; penetration and force of the sample itself, of which `depth` is the depth, where the filter is not
    /// matched. It becomes the previous sample.
    #[inline(always)]
    fn advance(
        &self,
        state: &mut FrontEndState,
        filter: &LowPass,
        now: PreviousSample,
        depth: f32,
        elapsed: f32,
    ) -> Observation {
        let row = self.unfiltered_row(&state.previous, &now, elapsed);
        state.previous = now;
        let rate = filter.update(&mut state.rate, row.rate);
        // The rate of a held tool dies away for ever: below this it is zero, and not a subnormal that stalls a host.
        let rate = if rate.abs() < Self::MIN_RATE { 0.0 } else { rate };
        match self.config.velocity {
            Velocity::Paper => Observation { penetration: depth, rate, force: now.force },
            Velocity::Matched => Observation {
                penetration: filter.update(&mut state.penetration, row.penetration),
                rate,
                force: filter.update(&mut state.force, row.force),
            },
        }
    }

    /// The row between two samples, not yet filtered: means and the difference, which belong to one instant.
    #[inline(always)]
    fn unfiltered_row(&self, previous: &PreviousSample, now: &PreviousSample, elapsed: f32) -> Observation {
        let rate = (now.position - previous.position) / elapsed * self.to_rate;
        Observation {
            penetration: 0.5 * (now.position + previous.position),
            rate: if rate.abs() <= Self::MAX_MAGNITUDE { rate } else { limited(rate) },
            force: 0.5 * (now.force + previous.force),
        }
    }

    /// Penetration and force in internal units.
    #[inline(always)]
    fn internal(&self, sample: &Sample) -> (f32, f32) {
        ((sample.position - self.config.surface) * self.to_penetration, sample.force * self.to_force)
    }

    /// The same where the sample is not to be rejected.
    fn validated(&self, sample: &Sample) -> Result<(f32, f32), Rejection> {
        Rejection::unless_finite(sample)?;
        let (penetration, force) = self.internal(sample);
        Rejection::unless_in_range(penetration, force, sample.elapsed)?;
        Ok((penetration, force))
    }

    /// Whether a step of `elapsed` seconds is one of the nominal period.
    #[inline(always)]
    fn is_nominal(&self, elapsed: f32) -> bool {
        (elapsed - self.config.period).abs() <= self.period_tolerance
    }

    /// The filter for a step of `elapsed` seconds; `None` where the step is a gap that no filter can bridge.
    fn filter_for(&self, elapsed: f32) -> Option<LowPass> {
        if self.is_nominal(elapsed) {
            return Some(self.nominal);
        }
        let cycles = self.config.cutoff * elapsed;
        (cycles <= LowPass::LIMIT).then(|| LowPass::new(cycles))
    }
}

/// A rate beyond the range, at its end. Apart, for it takes ten instructions where a look takes four.
#[cold]
#[inline(never)]
fn limited(rate: f32) -> f32 {
    rate.clamp(-FrontEnd::MAX_MAGNITUDE, FrontEnd::MAX_MAGNITUDE)
}

#[cfg(test)]
mod tests;
