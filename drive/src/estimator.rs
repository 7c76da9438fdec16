//! The estimator of a drive, selected by its settings.

use crate::{Calibration, Settings};
use palpate::Estimate;
use palpate::Rejection;
use palpate::Sample;
use palpate::error::ConfigError;
use palpate::{EstimatorBank, Method, ValidatedBankConfig};

/// The estimator selected by [`Settings`]. It holds the state of all methods, 28 kB, so that a change needs neither allocation nor a
/// second one.
#[derive(Debug, Clone)]
pub struct Estimator {
    bank: EstimatorBank,
    method: Method,
    hold: u16,
    revision: u8,
}

/// Validated settings with the derived constants: prepared in the idle loop, applied by the interrupt.
#[derive(Debug, Clone, Copy)]
pub struct ValidatedSettings {
    bank_config: ValidatedBankConfig,
    method: Method,
    hold: u16,
    revision: u8,
}

impl ValidatedSettings {
    /// Checks the settings; `revision` comes back with every estimate.
    ///
    /// # Errors
    /// The first setting that is out of range.
    pub fn new(settings: &Settings, calibration: &Calibration, revision: u8) -> Result<Self, ConfigError> {
        let bank_config = ValidatedBankConfig::new(&settings.bank_config(calibration)?)?;
        Ok(Self { bank_config, method: settings.method, hold: settings.hold, revision })
    }
}

impl Estimator {
    /// Checks the settings; `revision` comes back with every estimate.
    ///
    /// # Errors
    /// The first setting that is out of range.
    pub fn new(settings: &Settings, calibration: &Calibration, revision: u8) -> Result<Self, ConfigError> {
        let ValidatedSettings { bank_config, method, hold, revision } =
            ValidatedSettings::new(settings, calibration, revision)?;
        Ok(Self { bank: EstimatorBank::from_validated(&bank_config), method, hold, revision })
    }

    /// Replaces the settings in place and resets all state: bounded work, for the interrupt itself.
    pub fn apply(&mut self, settings: &ValidatedSettings) {
        self.bank.configure(&settings.bank_config);
        (self.method, self.hold, self.revision) = (settings.method, settings.hold, settings.revision);
    }

    /// One sample.
    ///
    /// # Errors
    /// Why it was rejected.
    pub fn update(&mut self, sample: Sample) -> Result<Estimate, Rejection> {
        self.bank.update_one(self.method, sample)
    }

    /// Forgets everything but the settings.
    pub fn restart(&mut self) {
        self.bank.restart();
    }

    /// Ticks that an estimate is held.
    pub fn hold(&self) -> u16 {
        self.hold
    }

    /// The number of its settings.
    pub fn revision(&self) -> u8 {
        self.revision
    }
}
