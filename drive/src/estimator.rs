//! The one estimator of a drive, out of all.

use crate::{Calibration, Settings};
use palpate::Estimate;
use palpate::Rejection;
use palpate::Sample;
use palpate::error::ConfigError;
use palpate::{Bench, BenchParts, Method};

/// The estimator that [`Settings`] choose. It holds the state of all, 28 kB, so that a choice needs neither allocation nor a second
/// one.
#[derive(Debug, Clone)]
pub struct Estimator {
    bench: Bench,
    method: Method,
    hold: u16,
    revision: u8,
}

/// Settings that can be, with all that follows from them but the memory: what an idle loop works out and the interrupt takes.
#[derive(Debug, Clone)]
pub struct Choice {
    parts: BenchParts,
    method: Method,
    hold: u16,
    revision: u8,
}

impl Choice {
    /// Checks the settings; `revision` comes back with every estimate.
    ///
    /// # Errors
    /// The first setting that is out of range.
    pub fn of(settings: &Settings, calibration: &Calibration, revision: u8) -> Result<Self, ConfigError> {
        let parts = BenchParts::of(&settings.bench(calibration)?)?;
        Ok(Self { parts, method: settings.method, hold: settings.hold, revision })
    }
}

impl Estimator {
    /// Checks the settings; `revision` comes back with every estimate.
    ///
    /// # Errors
    /// The first setting that is out of range.
    pub fn new(settings: &Settings, calibration: &Calibration, revision: u8) -> Result<Self, ConfigError> {
        let Choice { parts, method, hold, revision } = Choice::of(settings, calibration, revision)?;
        Ok(Self { bench: Bench::of(parts), method, hold, revision })
    }

    /// Takes other settings in place and forgets everything: bounded work, for the interrupt itself.
    pub fn choose(&mut self, choice: &Choice) {
        self.bench.configure(&choice.parts);
        (self.method, self.hold, self.revision) = (choice.method, choice.hold, choice.revision);
    }

    /// One sample.
    ///
    /// # Errors
    /// Why it was rejected.
    pub fn update(&mut self, sample: Sample) -> Result<Estimate, Rejection> {
        let all = self.bench.update(sample)?;
        Ok(all.get(self.method as usize).copied().unwrap_or(Estimate::UNKNOWN))
    }

    /// Forgets everything but the settings.
    pub fn restart(&mut self) {
        self.bench.restart();
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
