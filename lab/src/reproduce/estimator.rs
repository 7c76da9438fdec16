//! The estimators of the study, each with its settings and its name on the page.

use anyhow::{Result, anyhow};
use palpate::{
    AdaptiveWindow, AdaptiveWindowConfig, BlockConfig, BlockLeastMeanFourth, BlockLeastSquares, ConfigError, CusumRls,
    Direction, DirectionalRls, Estimate, EstimatorState, Ewrls, EwrlsConfig, FrontEndConfig, Prior, Rejection, Sample,
    Sprls, SprlsConfig, Stream, StreamConfig, UpdateLaw, Velocity,
};

/// Longest window of the study.
pub const LONGEST: usize = 300;

/// A law with its settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Estimator {
    /// Forgetting with a horizon of `window` samples, from `covariance` times the identity.
    Ewrls {
        /// 1 / (1 - lambda).
        window: u16,
        /// P(0).
        covariance: f32,
    },
    /// The same with what is left of its start taken off.
    UnbiasedEwrls,
    /// Self-perturbing, beta 100.
    Sprls {
        /// Sensitivity.
        gamma: f32,
        /// P(0).
        covariance: f32,
    },
    /// Least squares over a window.
    Bls(u16),
    /// The same from the second sample on, with a prior.
    RidgeBls(u16),
    /// Mean fourth along the steepest descent.
    Blmf(u16),
    /// Mean fourth along Newton's direction.
    NewtonBlmf(u16),
    /// A window that shrinks at a change.
    Adaptive,
    /// Recursive, begins again at a change.
    Cusum,
    /// Directional forgetting.
    Directional,
}

/// Cut-off of the matched filter, Hz.
pub const MATCHED_CUTOFF: f32 = 40.0;
/// The paper's P(0).
pub const PAPER_COVARIANCE: f32 = 10.0;
/// The paper's gamma.
pub const PAPER_GAMMA: f32 = 2.0;

impl Estimator {
    /// The paper's four on a window of `window` samples.
    pub fn paper(window: u16) -> [Self; 4] {
        [
            Self::Ewrls { window, covariance: PAPER_COVARIANCE },
            Self::Sprls { gamma: PAPER_GAMMA, covariance: PAPER_COVARIANCE },
            Self::Bls(window),
            Self::Blmf(window),
        ]
    }

    /// For the reader.
    pub fn name(self) -> String {
        match self {
            Self::Ewrls { .. } => "EWRLS".into(),
            Self::UnbiasedEwrls => "EWRLS without its start".into(),
            Self::Sprls { .. } => "SPRLS".into(),
            Self::Bls(_) => "BLS".into(),
            Self::RidgeBls(_) => "BLS with a prior".into(),
            Self::Blmf(_) => "BLMF".into(),
            Self::NewtonBlmf(_) => "Newton BLMF".into(),
            Self::Adaptive => "shrinking window".into(),
            Self::Cusum => "CUSUM-reset RLS".into(),
            Self::Directional => "directional forgetting".into(),
        }
    }

    /// Name and window in the budget of the device.
    pub fn update(self) -> (&'static str, Option<u16>) {
        match self {
            Self::Ewrls { .. } | Self::UnbiasedEwrls => ("ewrls", None),
            Self::Sprls { .. } => ("sprls", None),
            Self::Bls(window) => ("bls", Some(window)),
            Self::RidgeBls(window) => ("ridge_bls", Some(window)),
            Self::Blmf(window) => ("blmf", Some(window)),
            Self::NewtonBlmf(window) => ("newton_blmf", Some(window)),
            Self::Adaptive => ("adaptive_bls", Some(300)),
            Self::Cusum => ("cusum_rls", None),
            Self::Directional => ("directional_rls", None),
        }
    }

    /// What it makes of `samples`.
    ///
    /// # Errors
    /// A setting is out of range, or a sample is rejected; neither happens to a simulated trial.
    pub fn run(self, config: StreamConfig, samples: &[Sample]) -> Result<Vec<Estimate>> {
        let mut running = Running::new(self, config)?;
        let estimates = samples.iter().map(|sample| running.update(*sample));
        estimates.collect::<Result<_, _>>().map_err(|why| anyhow!("{}: a sample was rejected: {why:?}", self.name()))
    }
}

/// An estimator at work, one sample after the other.
pub struct Running(Box<dyn FnMut(Sample) -> Result<Estimate, Rejection> + Send>);

impl Running {
    /// At the start.
    ///
    /// # Errors
    /// A setting is out of range.
    pub fn new(estimator: Estimator, config: StreamConfig) -> Result<Self> {
        let made = match estimator {
            Estimator::Ewrls { window, covariance } => Self::of(config, ewrls(window, covariance)),
            Estimator::UnbiasedEwrls => Self::without_start(config),
            Estimator::Sprls { gamma, covariance } => Self::of(config, sprls(gamma, covariance)),
            Estimator::Bls(window) => Self::of(config, BlockLeastSquares::new(BlockConfig::of(window))),
            Estimator::RidgeBls(window) => Self::of(config, BlockLeastSquares::new(ridge(window))),
            Estimator::Blmf(window) => {
                Self::of(config, BlockLeastMeanFourth::new(BlockConfig::of(window), Direction::SteepestDescent))
            }
            Estimator::NewtonBlmf(window) => {
                Self::of(config, BlockLeastMeanFourth::new(BlockConfig::of(window), Direction::Newton))
            }
            Estimator::Adaptive => Self::of(config, AdaptiveWindow::new(AdaptiveWindowConfig::default())),
            Estimator::Cusum => Self::of(config, CusumRls::new(Default::default())),
            Estimator::Directional => Self::of(config, DirectionalRls::new(Default::default())),
        };
        made.map_err(|error| anyhow!("{}: {error}", estimator.name()))
    }

    fn of<L: UpdateLaw + Send + 'static>(config: StreamConfig, law: Result<L, ConfigError>) -> Result<Self, ConfigError>
    where
        L::State: Send,
    {
        let mut stream = Stream::<LONGEST>::new(config)?;
        let mut tracker = EstimatorState::new(law?);
        let update = move |sample| {
            let event = stream.update(sample)?;
            Ok(tracker.update(&stream, &event))
        };
        Ok(Self(Box::new(update)))
    }

    /// The paper's EWRLS, its start taken off each estimate; in SI units, in which the bench is.
    fn without_start(config: StreamConfig) -> Result<Self, ConfigError> {
        let mut stream = Stream::<1>::new(config)?;
        let mut tracker = EstimatorState::new(ewrls(300, PAPER_COVARIANCE)?);
        let update = move |sample| {
            let event = stream.update(sample)?;
            let estimate = tracker.update(&stream, &event);
            let settled = if event.reading.contact { tracker.state().without_start() } else { None };
            Ok(Estimate { impedance: settled.unwrap_or(estimate.impedance), ..estimate })
        };
        Ok(Self(Box::new(update)))
    }

    /// Takes one sample.
    ///
    /// # Errors
    /// Why it was rejected.
    pub fn update(&mut self, sample: Sample) -> Result<Estimate, Rejection> {
        (self.0)(sample)
    }
}

fn ewrls(window: u16, covariance: f32) -> Result<Ewrls, ConfigError> {
    // The paper prints 0.9967 for 300 samples.
    let forgetting_factor = if window == 300 { 0.9967 } else { 1.0 - 1.0 / f32::from(window) };
    Ewrls::new(EwrlsConfig { forgetting_factor, initial_covariance: covariance, ..EwrlsConfig::default() })
}

fn sprls(gamma: f32, covariance: f32) -> Result<Sprls, ConfigError> {
    let perturbation = SprlsConfig { perturbation_sensitivity: gamma, ..SprlsConfig::default() };
    Sprls::new(SprlsConfig { initial_covariance: covariance, ..perturbation })
}

fn ridge(window: u16) -> BlockConfig {
    BlockConfig { minimum_fill: 2, prior: Some(Prior::default()), ..BlockConfig::of(window) }
}

/// The front end of the paper, at a sample period in seconds: its velocity low-passed at 20 Hz and nothing else.
pub fn as_the_paper(period: f32) -> StreamConfig {
    let front_end = FrontEndConfig { period, velocity: Velocity::Paper, ..FrontEndConfig::BENCH };
    StreamConfig { front_end, ..StreamConfig::BENCH }
}

/// The matched filter at 40 Hz and 1 kHz.
pub fn matched() -> StreamConfig {
    StreamConfig {
        front_end: FrontEndConfig { cutoff: MATCHED_CUTOFF, ..FrontEndConfig::BENCH },
        ..StreamConfig::BENCH
    }
}
