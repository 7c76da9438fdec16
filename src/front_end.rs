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
mod tests {
    use super::*;

    fn paper() -> FrontEnd {
        let config = FrontEndConfig { velocity: Velocity::Paper, bilateral: true, ..FrontEndConfig::BENCH };
        FrontEnd::new(config).expect("sound settings")
    }

    fn sample(position: f32, elapsed: f32) -> Sample {
        Sample { position, force: 1.0, elapsed }
    }

    #[test]
    fn the_rate_is_kept_within_the_range_in_both_directions() {
        for direction in [1.0, -1.0] {
            let (front_end, mut state) = (paper(), FrontEndState::default());
            front_end.update(&mut state, sample(0.0, 1e-3)).expect("a sample");
            // A metre in a nanosecond, taken by filters that begin with it.
            let reading = front_end.update(&mut state, sample(direction, 1e-9)).expect("a sample");
            let rate = reading.observation.rate;
            assert!((rate / (direction * FrontEnd::MAX_MAGNITUDE) - 1.0).abs() < 1e-6, "{rate}");
        }
    }

    #[test]
    fn the_rate_of_a_held_tool_ends_at_zero_and_never_in_subnormal_numbers() {
        let (front_end, mut state) = (paper(), FrontEndState::default());
        let mut smallest = f32::INFINITY;
        let mut last = f32::NAN;
        for k in 0..2_000_u16 {
            let position = 1e-3 * f32::from(k.min(50));
            last = front_end.update(&mut state, sample(position, 1e-3)).expect("a sample").observation.rate.abs();
            assert!(last == 0.0 || last >= FrontEnd::MIN_RATE, "{last:e} at {k}");
            if last > 0.0 {
                smallest = last.min(smallest);
            }
        }
        assert_eq!(last, 0.0);
        assert!(smallest < 1e-17, "it died away, down to {smallest:e}");
    }

    /// Units of powers of two, so that every conversion is exact.
    fn scaled(velocity: Velocity, bilateral: bool) -> FrontEnd {
        let units = Units { penetration: 0.25, rate: 0.5, force: 2.0 };
        let config = FrontEndConfig { surface: 1.0, velocity, bilateral, units, ..FrontEndConfig::BENCH };
        FrontEnd::new(config).expect("sound settings")
    }

    #[test]
    fn a_sample_is_taken_from_the_surface_in_internal_units() {
        let front_end = scaled(Velocity::Paper, true);
        assert_eq!(front_end.internal(&Sample { position: 1.5, force: 3.0, elapsed: 1e-3 }), (2.0, 1.5));
        assert_eq!(front_end.internal(&Sample { position: 0.5, force: -3.0, elapsed: 1e-3 }), (-2.0, -1.5));
    }

    #[test]
    fn a_row_is_the_mean_and_the_slope_of_two_samples() {
        let previous = PreviousSample { position: 1.0, force: 3.0 };
        let now = PreviousSample { position: 4.0, force: 6.0 };
        let row = scaled(Velocity::Matched, false).unfiltered_row(&previous, &now, 0.125);
        // One internal unit of penetration a second is half one of rate.
        assert_eq!(row, Observation { penetration: 2.5, rate: 3.0 / 0.125 * 0.5, force: 4.5 });
    }

    #[test]
    fn the_rate_is_that_of_the_tool_in_the_paper_s_filter_and_that_of_the_depth_in_the_matched_one() {
        for (velocity, bilateral, position, depth) in [
            (Velocity::Paper, false, -2.0, 0.0),
            (Velocity::Matched, false, 0.0, 0.0),
            (Velocity::Paper, true, -2.0, -2.0),
            (Velocity::Matched, true, -2.0, -2.0),
        ] {
            let (now, found, _) = scaled(velocity, bilateral).touch(&mut FrontEndState::default(), -2.0, 1.0);
            assert_eq!((now.position, found), (position, depth), "{velocity:?} {bilateral}");
        }
    }

    #[test]
    fn a_period_is_the_nominal_one_within_a_ten_thousandth() {
        let front_end = paper();
        for (elapsed, nominal) in
            [(1e-3, true), (1.00009e-3, true), (0.99991e-3, true), (1.0002e-3, false), (0.9998e-3, false)]
        {
            assert_eq!(front_end.is_nominal(elapsed), nominal, "{elapsed}");
        }
    }

    #[test]
    fn samples_in_a_row_are_worth_one_by_the_bandwidth_of_the_filter() {
        for (cutoff, worth) in [(20.0, 22.507_907), (40.0, 11.253_954), (400.0, 1.125_395_4), (450.0, f32::NAN)] {
            let front_end = FrontEnd::new(FrontEndConfig { cutoff, ..FrontEndConfig::BENCH });
            // 1000 / (2 * 1.110721 * cutoff), the noise bandwidth of a second-order Butterworth filter.
            match front_end {
                Ok(front_end) => assert!((front_end.correlated_samples() / worth - 1.0).abs() < 1e-5, "{cutoff}"),
                Err(error) => assert_eq!((cutoff, error.parameter), (450.0, "cutoff")),
            }
        }
    }

    /// The short way of the usual sample against the long way of any, on samples with every kind of disturbance.
    #[test]
    fn the_short_way_and_the_long_way_tell_the_same_bits() {
        for velocity in [Velocity::Paper, Velocity::Matched] {
            for bilateral in [false, true] {
                let front_end = scaled(velocity, bilateral);
                let [mut shortest, mut short, mut long] = [FrontEndState::default(); 3];
                let mut in_contact = 0;
                for k in 0..400_u16 {
                    // In and out of the surface; within it none to six samples in a row below the threshold, of which five end a contact.
                    let phase = f32::from(k % 50) / 50.0 - 0.2;
                    let force = if k % 11 < k / 50 % 7 { 0.0 } else { 1.0 + phase };
                    let mut sample = Sample { position: 1.0 + 0.01 * phase, force, elapsed: 1e-3 };
                    match k % 37 {
                        5 => sample.position = f32::NAN,
                        11 => sample.position = 3e6,
                        13 => sample.force = 3e6,
                        17 => sample.force = f32::INFINITY,
                        19 => sample.elapsed = 2e-3,
                        23 => sample.elapsed = 1e-3 * 1.5,
                        29 => sample.elapsed = 0.0,
                        31 if k > 200 => sample.elapsed = 10.0,
                        _ => {}
                    }
                    let expected = front_end.update_unusual(&mut long, &sample);
                    assert_eq!(front_end.update(&mut short, sample), expected, "{velocity:?} {bilateral} {k}");
                    let found = match front_end.update_in_contact(&mut shortest, &sample) {
                        Some(observation) => {
                            in_contact += 1;
                            Ok(Reading { observation, contact: true, restarted: false })
                        }
                        None => front_end.update(&mut shortest, sample),
                    };
                    assert_eq!(found, expected, "in contact, {velocity:?} {bilateral} {k}");
                }
                assert!(in_contact > 150, "{in_contact}");
            }
        }
    }

    #[test]
    fn the_time_of_a_rejected_sample_belongs_to_the_next() {
        let (front_end, mut state) = (paper(), FrontEndState::default());
        front_end.update(&mut state, sample(0.0, 1e-3)).expect("a sample");
        assert!(front_end.update(&mut state, sample(f32::NAN, 2e-3)).is_err());
        assert!(front_end.update(&mut state, sample(f32::NAN, f32::NAN)).is_err());
        assert!(front_end.update(&mut state, sample(f32::NAN, -1.0)).is_err());
        // 4 mm in 2 + 2 ms, by filters that begin with this row.
        let rate = front_end.update(&mut state, sample(4e-3, 2e-3)).expect("a sample").observation.rate;
        assert!((rate - 1.0).abs() < 1e-5, "{rate}");
    }

    #[test]
    fn a_bilateral_contact_is_always_one() {
        for (bilateral, contact) in [(true, true), (false, false)] {
            let (front_end, mut state) = (scaled(Velocity::Matched, bilateral), FrontEndState::default());
            let reading = front_end.update(&mut state, Sample { position: 0.5, force: 0.0, elapsed: 1e-3 });
            let reading = reading.expect("a sample");
            assert_eq!(
                (reading.contact, reading.observation.penetration),
                (contact, if bilateral { -2.0 } else { 0.0 })
            );
        }
    }
}
