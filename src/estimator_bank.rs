//! All estimators side by side on one stream: as `palpate replay` runs them on the host and the replay image on the device.

use crate::block::BlockConfig;
use crate::block::BlockLeastMeanSquare;
use crate::block::BlockLeastSquares;
use crate::block::{AdaptiveWindow, AdaptiveWindowConfig};
use crate::block::{BlockLeastMeanFourth, Direction};
use crate::contact::Sample;
use crate::error::{ConfigError, require};
use crate::front_end::Rejection;
use crate::quality::{Estimate, Flags};
use crate::recursive::{CusumRls, CusumRlsConfig};
use crate::recursive::{DirectionalRls, DirectionalRlsConfig};
use crate::recursive::{Ewrls, EwrlsConfig};
use crate::recursive::{Gradient, GradientConfig};
use crate::recursive::{ResetRls, ResetRlsConfig};
use crate::recursive::{Sprls, SprlsConfig};
use crate::stream::{EstimatorState, Event, Stream, StreamConfig, ValidatedStreamConfig};
use crate::update_law::UpdateLaw;
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

    /// Those in it, in the order of [`Method::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Method> {
        Method::ALL.into_iter().filter(move |method| self.contains(*method))
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

/// One law of each kind with its state. The laws and states of methods that do not run are out of date: [`EstimatorBank::configure`]
/// renews those that will.
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

/// One law of each kind without its state.
#[derive(Debug, Clone, Copy)]
struct ValidatedLaws {
    rls: Ewrls,
    ewrls: Ewrls,
    sprls: Sprls,
    reset_rls: ResetRls,
    gradient: Gradient,
    bls: BlockLeastSquares,
    blms: BlockLeastMeanSquare,
    blmf: BlockLeastMeanFourth,
    newton_blmf: BlockLeastMeanFourth,
    cusum_rls: CusumRls,
    adaptive_bls: AdaptiveWindow,
    directional_rls: DirectionalRls,
}

/// Validated settings of an [`EstimatorBank`], without any state.
#[derive(Debug, Clone, Copy)]
pub struct ValidatedBankConfig {
    methods: Methods,
    stream: ValidatedStreamConfig,
    laws: ValidatedLaws,
}

impl ValidatedBankConfig {
    /// Checks all settings.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn new(config: &EstimatorBankConfig) -> Result<Self, ConfigError> {
        require(usize::from(config.block.window) <= BANK_WINDOW, "window", "at most 2048 samples")?;
        let fourth = |direction| BlockLeastMeanFourth::new(config.block, direction);
        let laws = ValidatedLaws {
            rls: Ewrls::new(config.rls)?,
            ewrls: Ewrls::new(config.ewrls)?,
            sprls: Sprls::new(config.sprls)?,
            reset_rls: ResetRls::new(config.reset_rls)?,
            gradient: Gradient::new(config.gradient)?,
            bls: BlockLeastSquares::new(config.block)?,
            blms: BlockLeastMeanSquare::new(config.block)?,
            blmf: fourth(Direction::SteepestDescent)?,
            newton_blmf: fourth(Direction::Newton)?,
            cusum_rls: CusumRls::new(CusumRlsConfig::default())?,
            adaptive_bls: AdaptiveWindow::new(AdaptiveWindowConfig::of(config.block.window))?,
            directional_rls: DirectionalRls::new(DirectionalRlsConfig::default())?,
        };
        Ok(Self { methods: config.methods, stream: ValidatedStreamConfig::new(config.stream)?, laws })
    }
}

/// What to do with the law of a method, whatever its type.
macro_rules! with_law {
    ($laws:expr, $method:expr, $law:ident => $todo:expr) => {
        with_law!(@ $laws, $method, $law, $todo, Rls rls, Ewrls ewrls, Sprls sprls, ResetRls reset_rls, Gradient gradient, Bls bls,
            Blms blms, Blmf blmf, NewtonBlmf newton_blmf, CusumRls cusum_rls, AdaptiveBls adaptive_bls,
            DirectionalRls directional_rls)
    };
    (@ $laws:expr, $method:expr, $law:ident, $todo:expr, $($name:ident $field:ident),+) => {
        match $method {
            $(Method::$name => {
                let $law = &mut $laws.$field;
                $todo
            })+
        }
    };
}

impl Laws {
    fn new(laws: &ValidatedLaws) -> Self {
        Self {
            rls: EstimatorState::new(laws.rls),
            ewrls: EstimatorState::new(laws.ewrls),
            sprls: EstimatorState::new(laws.sprls),
            reset_rls: EstimatorState::new(laws.reset_rls),
            gradient: EstimatorState::new(laws.gradient),
            bls: EstimatorState::new(laws.bls),
            blms: EstimatorState::new(laws.blms),
            blmf: EstimatorState::new(laws.blmf),
            newton_blmf: EstimatorState::new(laws.newton_blmf),
            cusum_rls: EstimatorState::new(laws.cusum_rls),
            adaptive_bls: EstimatorState::new(laws.adaptive_bls),
            directional_rls: EstimatorState::new(laws.directional_rls),
        }
    }

    /// Replaces the law of `method` and begins its state anew.
    fn configure(&mut self, method: Method, laws: &ValidatedLaws) {
        match method {
            Method::Rls => self.rls.configure(laws.rls),
            Method::Ewrls => self.ewrls.configure(laws.ewrls),
            Method::Sprls => self.sprls.configure(laws.sprls),
            Method::ResetRls => self.reset_rls.configure(laws.reset_rls),
            Method::Gradient => self.gradient.configure(laws.gradient),
            Method::Bls => self.bls.configure(laws.bls),
            Method::Blms => self.blms.configure(laws.blms),
            Method::Blmf => self.blmf.configure(laws.blmf),
            Method::NewtonBlmf => self.newton_blmf.configure(laws.newton_blmf),
            Method::CusumRls => self.cusum_rls.configure(laws.cusum_rls),
            Method::AdaptiveBls => self.adaptive_bls.configure(laws.adaptive_bls),
            Method::DirectionalRls => self.directional_rls.configure(laws.directional_rls),
        }
    }

    /// Begins the state of `method` anew.
    fn restart(&mut self, method: Method) {
        with_law!(self, method, law => law.restart());
    }

    fn update(&mut self, method: Method, stream: &Stream<BANK_WINDOW>, event: &Event) -> Estimate {
        with_law!(self, method, law => law.update(stream, event))
    }

    /// [`EstimatorState::settle`] of `method`.
    fn settle(&mut self, method: Method, stream: &Stream<BANK_WINDOW>, event: &Event) -> Option<Estimate> {
        with_law!(self, method, law => law.settle(stream, event))
    }

    /// [`EstimatorState::learn`] of `method`.
    fn learn(&mut self, method: Method, stream: &Stream<BANK_WINDOW>, flags: Flags) -> Estimate {
        with_law!(self, method, law => learn(law, stream, flags))
    }
}

/// Each law's own function: together they would all pay for the registers and the stack of the longest.
#[inline(never)]
fn learn<L: UpdateLaw>(law: &mut EstimatorState<L>, stream: &Stream<BANK_WINDOW>, flags: Flags) -> Estimate {
    law.learn(stream, flags)
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
    pub fn recent(&self) -> crate::Recent<'_> {
        self.stream.recent()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(window: u16, methods: Methods) -> EstimatorBankConfig {
        EstimatorBankConfig {
            block: BlockConfig::of(window),
            methods,
            ..EstimatorBankConfig::all_methods(StreamConfig::BENCH)
        }
    }

    #[test]
    fn a_window_longer_than_the_ring_is_refused() {
        let longest = BANK_WINDOW as u16;
        assert!(ValidatedBankConfig::new(&config(longest, Methods::default())).is_ok());
        let refused = ValidatedBankConfig::new(&config(longest + 1, Methods::default())).expect_err("too long");
        assert_eq!(refused.parameter, "window");
    }

    #[test]
    fn the_methods_of_a_set_come_in_their_order() {
        let set = Methods::default().with(Method::DirectionalRls).with(Method::Ewrls).with(Method::Bls);
        assert!(set.iter().eq([Method::Ewrls, Method::Bls, Method::DirectionalRls]));
        assert!(Methods::default().iter().eq([]));
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
