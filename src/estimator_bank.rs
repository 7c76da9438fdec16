//! All estimators side by side on one stream: as `palpate replay` runs them on the host and the replay image on the device.

use crate::block::BlockConfig;
use crate::block::BlockLeastMeanSquare;
use crate::block::BlockLeastSquares;
use crate::block::{AdaptiveWindow, AdaptiveWindowConfig};
use crate::block::{BlockLeastMeanFourth, Direction};
use crate::contact::Sample;
use crate::error::{ConfigError, require};
use crate::front_end::Rejection;
use crate::quality::Estimate;
use crate::recursive::{CusumRls, CusumRlsConfig};
use crate::recursive::{DirectionalRls, DirectionalRlsConfig};
use crate::recursive::{Ewrls, EwrlsConfig};
use crate::recursive::{Gradient, GradientConfig};
use crate::recursive::{ResetRls, ResetRlsConfig};
use crate::recursive::{Sprls, SprlsConfig};
use crate::stream::{EstimatorState, Stream, StreamConfig, ValidatedStreamConfig};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// An estimator by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[repr(u8)]
pub enum Method {
    /// Recursive least squares.
    Rls,
    /// Exponentially weighted recursive least squares.
    Ewrls,
    /// Self-perturbing recursive least squares.
    Sprls,
    /// Recursive least squares with covariance resetting.
    ResetRls,
    /// Constant-gain gradient law.
    Gradient,
    /// Block least squares.
    Bls,
    /// Block least mean square.
    Blms,
    /// Block least mean fourth along the steepest descent.
    Blmf,
    /// Block least mean fourth along the Newton direction.
    NewtonBlmf,
    /// Recursive least squares that begins again at a change.
    CusumRls,
    /// Block least squares over a window that shrinks at a change.
    AdaptiveBls,
    /// Recursive least squares with directional forgetting.
    DirectionalRls,
}

impl Method {
    /// All of them, in the order of [`BankEstimates`].
    pub const ALL: [Self; 12] = [
        Self::Rls,
        Self::Ewrls,
        Self::Sprls,
        Self::ResetRls,
        Self::Gradient,
        Self::Bls,
        Self::Blms,
        Self::Blmf,
        Self::NewtonBlmf,
        Self::CusumRls,
        Self::AdaptiveBls,
        Self::DirectionalRls,
    ];

    /// The name on the command line and in file columns.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rls => "rls",
            Self::Ewrls => "ewrls",
            Self::Sprls => "sprls",
            Self::ResetRls => "reset_rls",
            Self::Gradient => "gradient",
            Self::Bls => "bls",
            Self::Blms => "blms",
            Self::Blmf => "blmf",
            Self::NewtonBlmf => "newton_blmf",
            Self::CusumRls => "cusum_rls",
            Self::AdaptiveBls => "adaptive_bls",
            Self::DirectionalRls => "directional_rls",
        }
    }

    /// The full name.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Rls => "recursive least squares",
            Self::Ewrls => "exponentially weighted recursive least squares",
            Self::Sprls => "self-perturbing recursive least squares",
            Self::ResetRls => "recursive least squares with covariance resetting",
            Self::Gradient => "constant-gain gradient law",
            Self::Bls => "block least squares",
            Self::Blms => "block least mean square",
            Self::Blmf => "block least mean fourth",
            Self::NewtonBlmf => "block least mean fourth, Newton direction",
            Self::CusumRls => "recursive least squares that begins again at a change",
            Self::AdaptiveBls => "block least squares, window shrinking at a change",
            Self::DirectionalRls => "recursive least squares with directional forgetting",
        }
    }

    const fn bit(self) -> u16 {
        1 << self as u8
    }
}

/// A set of methods.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Methods(u16);

impl Methods {
    /// With `method` in it.
    #[must_use]
    pub const fn with(self, method: Method) -> Self {
        Self(self.0 | method.bit())
    }

    /// How many are in it.
    pub const fn count(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether `method` is in it.
    pub const fn contains(self, method: Method) -> bool {
        self.0 & method.bit() != 0
    }
}

/// Settings of a [`EstimatorBank`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct EstimatorBankConfig {
    /// What all share.
    pub stream: StreamConfig,
    /// Which of them run.
    pub methods: Methods,
    /// Of `rls`.
    pub rls: EwrlsConfig,
    /// Of `ewrls`.
    pub ewrls: EwrlsConfig,
    /// Of `sprls`.
    pub sprls: SprlsConfig,
    /// Of `reset_rls`.
    pub reset_rls: ResetRlsConfig,
    /// Of `gradient`.
    pub gradient: GradientConfig,
    /// Of all block methods; the window, also the longest of `adaptive_bls`, is at most [`BANK_WINDOW`]. `cusum_rls` and
    /// `directional_rls` run with their defaults.
    pub block: BlockConfig,
}

impl EstimatorBankConfig {
    /// Every method at its own defaults behind `stream`.
    #[must_use]
    pub fn all_methods(stream: StreamConfig) -> Self {
        Self {
            stream,
            methods: Method::ALL.into_iter().fold(Methods::default(), Methods::with),
            rls: EwrlsConfig::rls(),
            ewrls: EwrlsConfig::default(),
            sprls: SprlsConfig::default(),
            reset_rls: ResetRlsConfig::default(),
            gradient: GradientConfig::default(),
            block: BlockConfig::default(),
        }
    }
}

/// Longest window of a [`EstimatorBank`], samples: 24 kB of the 128 kB of an STM32F405.
pub const BANK_WINDOW: usize = 2048;

/// One estimate a method of [`Method::ALL`]; [`Estimate::NO_CONTACT`] where the method does not run.
pub type BankEstimates = [Estimate; Method::ALL.len()];

/// All methods on one stream.
#[derive(Debug, Clone)]
pub struct EstimatorBank {
    methods: Methods,
    stream: Stream<BANK_WINDOW>,
    laws: Laws,
}

/// One of each.
#[derive(Debug, Clone)]
struct Laws {
    rls: EstimatorState<Ewrls>,
    ewrls: EstimatorState<Ewrls>,
    sprls: EstimatorState<Sprls>,
    reset_rls: EstimatorState<ResetRls>,
    gradient: EstimatorState<Gradient>,
    bls: EstimatorState<BlockLeastSquares>,
    blms: EstimatorState<BlockLeastMeanSquare>,
    blmf: EstimatorState<BlockLeastMeanFourth>,
    newton_blmf: EstimatorState<BlockLeastMeanFourth>,
    cusum_rls: EstimatorState<CusumRls>,
    adaptive_bls: EstimatorState<AdaptiveWindow>,
    directional_rls: EstimatorState<DirectionalRls>,
}

/// Validated settings of an [`EstimatorBank`]: all of it but its ring.
#[derive(Debug, Clone)]
pub struct ValidatedBankConfig {
    methods: Methods,
    stream: ValidatedStreamConfig,
    laws: Laws,
}

impl ValidatedBankConfig {
    /// Checks all settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: &EstimatorBankConfig) -> Result<Self, ConfigError> {
        require(usize::from(config.block.window) <= BANK_WINDOW, "window", "at most 2048 samples")?;
        let fourth = |direction| BlockLeastMeanFourth::new(config.block, direction);
        let laws = Laws {
            rls: EstimatorState::new(Ewrls::new(config.rls)?),
            ewrls: EstimatorState::new(Ewrls::new(config.ewrls)?),
            sprls: EstimatorState::new(Sprls::new(config.sprls)?),
            reset_rls: EstimatorState::new(ResetRls::new(config.reset_rls)?),
            gradient: EstimatorState::new(Gradient::new(config.gradient)?),
            bls: EstimatorState::new(BlockLeastSquares::new(config.block)?),
            blms: EstimatorState::new(BlockLeastMeanSquare::new(config.block)?),
            blmf: EstimatorState::new(fourth(Direction::SteepestDescent)?),
            newton_blmf: EstimatorState::new(fourth(Direction::Newton)?),
            cusum_rls: EstimatorState::new(CusumRls::new(CusumRlsConfig::default())?),
            adaptive_bls: EstimatorState::new(AdaptiveWindow::new(AdaptiveWindowConfig::of(config.block.window))?),
            directional_rls: EstimatorState::new(DirectionalRls::new(DirectionalRlsConfig::default())?),
        };
        Ok(Self { methods: config.methods, stream: ValidatedStreamConfig::new(config.stream)?, laws })
    }
}

impl EstimatorBank {
    /// Checks all settings, also of methods that do not run.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: &EstimatorBankConfig) -> Result<Self, ConfigError> {
        Ok(Self::from_validated(ValidatedBankConfig::new(config)?))
    }

    /// Infallible, so that a bank can be constructed in place: a second one does not fit every stack.
    pub fn from_validated(validated: ValidatedBankConfig) -> Self {
        Self { methods: validated.methods, stream: Stream::from_validated(validated.stream), laws: validated.laws }
    }

    /// Replaces the settings in place and resets all state: bounded work, without a second bank.
    pub fn configure(&mut self, validated: &ValidatedBankConfig) {
        self.stream.configure(validated.stream);
        self.methods = validated.methods;
        self.laws.clone_from(&validated.laws);
    }

    /// One sample through every method that runs.
    ///
    /// # Errors
    /// Why the sample was rejected; then nothing but the clock has moved.
    pub fn update(&mut self, sample: Sample) -> Result<BankEstimates, Rejection> {
        let event = self.stream.update(sample)?;
        let (stream, methods, laws) = (&self.stream, self.methods, &mut self.laws);
        Ok(Method::ALL.map(|method| {
            if !methods.contains(method) {
                return Estimate::NO_CONTACT;
            }
            match method {
                Method::Rls => laws.rls.update(stream, &event),
                Method::Ewrls => laws.ewrls.update(stream, &event),
                Method::Sprls => laws.sprls.update(stream, &event),
                Method::ResetRls => laws.reset_rls.update(stream, &event),
                Method::Gradient => laws.gradient.update(stream, &event),
                Method::Bls => laws.bls.update(stream, &event),
                Method::Blms => laws.blms.update(stream, &event),
                Method::Blmf => laws.blmf.update(stream, &event),
                Method::NewtonBlmf => laws.newton_blmf.update(stream, &event),
                Method::CusumRls => laws.cusum_rls.update(stream, &event),
                Method::AdaptiveBls => laws.adaptive_bls.update(stream, &event),
                Method::DirectionalRls => laws.directional_rls.update(stream, &event),
            }
        }))
    }

    /// Forgets everything but the settings: the next sample is the first. Bounded work, whatever the window.
    pub fn restart(&mut self) {
        self.stream.restart();
        self.laws.rls.restart();
        self.laws.ewrls.restart();
        self.laws.sprls.restart();
        self.laws.reset_rls.restart();
        self.laws.gradient.restart();
        self.laws.bls.restart();
        self.laws.blms.restart();
        self.laws.blmf.restart();
        self.laws.newton_blmf.restart();
        self.laws.cusum_rls.restart();
        self.laws.adaptive_bls.restart();
        self.laws.directional_rls.restart();
    }

    /// The latest observations, in internal units.
    pub fn recent(&self) -> crate::Recent<'_> {
        self.stream.recent()
    }
}
