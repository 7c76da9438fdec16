//! The range of a value in a search, and what is known of it beforehand.

/// The range of a value in a search, and how a step along it is counted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
    /// A step of one: a factor of e, or so much.
    pub step: Step,
    /// What is known of it beforehand, where something is.
    pub prior: Option<Prior>,
}

/// A value that is known beforehand: a normal density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// Its mean.
    pub mean: f64,
    /// Its standard deviation.
    pub deviation: f64,
}

/// How a step along a value is counted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// By factors.
    Relative,
    /// By this much.
    Absolute(f64),
}

impl Range {
    /// Between two positive values, stepped by factors.
    #[must_use]
    pub const fn relative(low: f64, high: f64) -> Self {
        Self { low, high, step: Step::Relative, prior: None }
    }

    /// Between two values, stepped by `size`.
    #[must_use]
    pub const fn absolute(low: f64, high: f64, size: f64) -> Self {
        Self { low, high, step: Step::Absolute(size), prior: None }
    }

    /// The same with what is known of the value beforehand.
    #[must_use]
    pub const fn known(self, prior: Prior) -> Self {
        Self { prior: Some(prior), ..self }
    }

    /// ln of the prior density at `value`, but for a constant, nats.
    #[must_use]
    pub fn ln_prior(&self, value: f64) -> f64 {
        self.prior.map_or(0.0, |prior| -0.5 * ((value - prior.mean) / prior.deviation).powi(2))
    }

    /// `value` after `steps`, not bounded.
    #[must_use]
    pub fn moved(&self, value: f64, steps: f64) -> f64 {
        match self.step {
            Step::Relative => value * steps.exp(),
            Step::Absolute(size) => value + steps * size,
        }
    }

    /// Steps from `start` to `end`.
    #[must_use]
    pub fn steps_between(&self, start: f64, end: f64) -> f64 {
        match self.step {
            Step::Relative => (end / start).ln(),
            Step::Absolute(size) => (end - start) / size,
        }
    }

    /// d value / d steps.
    #[must_use]
    pub fn slope(&self, value: f64) -> f64 {
        match self.step {
            Step::Relative => value,
            Step::Absolute(size) => size,
        }
    }

    /// One over the variance, in squared steps, of a value of which its ends are all that is known: a uniform density. Zero where an end is infinite.
    #[must_use]
    pub fn uniform_precision(&self) -> f64 {
        12.0 / self.steps_between(self.low, self.high).powi(2)
    }

    /// Whether `value` lies at an end: what is found there is where the search ended, not what the recording shows.
    #[must_use]
    pub fn is_at_end(&self, value: f64) -> bool {
        const NEAR: f64 = 0.02;
        match self.step {
            Step::Relative => value < self.low * (1.0 + NEAR) || value > self.high / (1.0 + NEAR),
            Step::Absolute(size) => value <= self.low + 1e-9 * size || value >= self.high - 1e-9 * size,
        }
    }
}
