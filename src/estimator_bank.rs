//! All estimators side by side on one stream: as `palpate replay` runs them on the host and the replay image on the device.

mod config;
mod laws;
mod method;
mod methods;
mod validated_config;
mod validated_laws;

pub use config::{BANK_WINDOW, EstimatorBankConfig};
pub use method::Method;
pub use methods::Methods;
pub use validated_config::ValidatedBankConfig;

use crate::contact::Sample;
use crate::error::ConfigError;
use crate::front_end::Rejection;
use crate::quality::Estimate;
use crate::stream::{Event, Stream};
use crate::window::Recent;
use laws::Laws;

/// One estimate a method of [`Method::ALL`]; [`Estimate::NO_CONTACT`] where the method does not run.
pub type BankEstimates = [Estimate; Method::ALL.len()];

/// All methods on one stream.
#[derive(Debug, Clone)]
pub struct EstimatorBank {
    methods: Methods,
    stream: Stream<BANK_WINDOW>,
    laws: Laws,
}

impl EstimatorBank {
    /// Checks all settings, also of methods that do not run.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: &EstimatorBankConfig) -> Result<Self, ConfigError> {
        Ok(Self::from_validated(&ValidatedBankConfig::new(config)?))
    }

    /// Infallible, so that a bank can be constructed in place: a second one does not fit every stack.
    pub fn from_validated(validated: &ValidatedBankConfig) -> Self {
        Self {
            methods: validated.methods,
            stream: Stream::from_validated(validated.stream),
            laws: Laws::new(&validated.laws),
        }
    }

    /// Replaces the settings in place and resets the state of the methods that run: bounded work, without a second bank.
    pub fn configure(&mut self, validated: &ValidatedBankConfig) {
        self.stream.configure(validated.stream);
        self.methods = validated.methods;
        for method in self.methods.iter() {
            self.laws.configure(method, &validated.laws);
        }
    }

    /// One sample through every method that runs.
    ///
    /// # Errors
    /// Why the sample was rejected; then nothing but the clock has moved.
    pub fn update(&mut self, sample: Sample) -> Result<BankEstimates, Rejection> {
        let event = self.stream.update(sample)?;
        let mut estimates = [Estimate::NO_CONTACT; Method::ALL.len()];
        for method in self.methods.iter() {
            if let Some(estimate) = estimates.get_mut(method as usize) {
                *estimate = self.laws.update(method, &self.stream, &event);
            }
        }
        Ok(estimates)
    }

    /// One sample through `method` alone, for a bank in which no other runs: the estimate that [`Self::update`] returns at its place,
    /// without the 384 bytes of all twelve. [`Estimate::NO_CONTACT`] where `method` does not run.
    ///
    /// # Errors
    /// As [`Self::update`].
    pub fn update_one(&mut self, method: Method, sample: Sample) -> Result<Estimate, Rejection> {
        let flags = match self.stream.update_in_contact(&sample) {
            Some(flags) => flags,
            None => {
                let event = self.stream.update(sample)?;
                if let Some(estimate) = self.settle(method, &event) {
                    return Ok(estimate);
                }
                event.flags
            }
        };
        if !self.methods.contains(method) {
            return Ok(Estimate::NO_CONTACT);
        }
        Ok(self.laws.learn(method, &self.stream, flags))
    }

    /// The estimate of an event that brings no row. Apart, so that a row does not pay for it.
    #[inline(never)]
    fn settle(&mut self, method: Method, event: &Event) -> Option<Estimate> {
        if !self.methods.contains(method) {
            return Some(Estimate::NO_CONTACT);
        }
        self.laws.settle(method, &self.stream, event)
    }

    /// Forgets everything but the settings: the next sample is the first. Bounded work, whatever the window.
    pub fn restart(&mut self) {
        self.stream.restart();
        for method in self.methods.iter() {
            self.laws.restart(method);
        }
    }

    /// The latest observations, in internal units.
    pub fn recent(&self) -> Recent<'_> {
        self.stream.recent()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::BlockConfig;
    use crate::stream::StreamConfig;

    fn config(window: u16, methods: Methods) -> EstimatorBankConfig {
        EstimatorBankConfig {
            block: BlockConfig::of(window),
            methods,
            ..EstimatorBankConfig::all_methods(StreamConfig::BENCH)
        }
    }

    /// In and out of contact, with a sample in every hundred that is refused.
    fn sample(k: u16) -> Sample {
        let triangle = f32::from(k % 40) - 20.0;
        let depth = if k % 300 < 200 { 0.01 + 1e-4 * triangle.abs() } else { -0.01 };
        let elapsed = if k % 100 == 99 { f32::NAN } else { 1e-3 };
        Sample { position: depth, force: 300.0 * depth.max(0.0) + 1e-3 * f32::from(k % 7), elapsed }
    }

    /// Whatever ran before with other settings, a method alone tells what it tells beside all others, to the bit.
    #[test]
    fn one_method_alone_tells_the_bits_that_it_tells_among_all() {
        for method in Method::ALL {
            let every = Method::ALL.into_iter().fold(Methods::default(), Methods::with);
            let new = |window, methods| EstimatorBank::new(&config(window, methods)).expect("sound settings");
            let (mut all, mut one) = (new(50, every), new(80, every));
            for k in 0..150 {
                let _ = one.update(sample(k));
            }
            let alone = config(50, Methods::default().with(method));
            one.configure(&ValidatedBankConfig::new(&alone).expect("sound settings"));
            for k in 0..700 {
                if k == 450 {
                    // A restart is as good as another bank.
                    all = new(50, every);
                    one.restart();
                }
                let (all, one) = (all.update(sample(k)), one.update_one(method, sample(k)));
                assert_eq!(all.is_err(), k % 100 == 99);
                assert_eq!(all.map(|all| all[method as usize]), one, "{} at {k}", method.name());
            }
        }
    }

    #[test]
    fn a_method_that_does_not_run_has_no_contact() {
        let mut bank = EstimatorBank::new(&config(50, Methods::default().with(Method::Rls))).expect("sound settings");
        for k in 0..99 {
            assert_eq!(bank.update_one(Method::Ewrls, sample(k)), Ok(Estimate::NO_CONTACT));
        }
    }
}
