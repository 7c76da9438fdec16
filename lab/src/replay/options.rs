//! The estimators' settings on the command line.

use anyhow::Result;
use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use clap::{Args, ValueEnum};
use palpate::{BANK_WINDOW, BlockConfig, ConfigError, EwrlsConfig, LowPass, Method, SprlsConfig};

use crate::error::UsageError;

/// The estimators' settings, as the command line gives them.
#[derive(Debug, Clone, Args)]
pub struct Options {
    /// Estimators, separated by commas
    #[arg(long = "method", value_name = "NAME,...", value_delimiter = ',', default_value = "cusum_rls,ewrls,sprls,bls,blmf", value_parser = PossibleValuesParser::new(Method::ALL.map(Method::name)).try_map(|name| method(&name)))]
    pub methods: Vec<Method>,
    /// Window of the block methods and reset interval of reset_rls, in samples
    #[arg(long, value_name = "N", default_value_t = Self::default().window, value_parser = clap::value_parser!(u16).range(2..=BANK_WINDOW as i64))]
    pub window: u16,
    /// Forgetting factor of ewrls
    #[arg(long, value_name = "LAMBDA", default_value_t = Self::default().forgetting)]
    pub forgetting: f32,
    /// Initial covariance of the recursive methods, for a rig of the paper's proportions
    #[arg(long, value_name = "P0", default_value_t = Self::default().initial_covariance)]
    pub initial_covariance: f32,
    /// Perturbation gain of sprls
    #[arg(long, value_name = "BETA", default_value_t = Self::default().sprls_beta)]
    pub sprls_beta: f32,
    /// Perturbation sensitivity of sprls
    #[arg(long, value_name = "GAMMA", default_value_t = Self::default().sprls_gamma)]
    pub sprls_gamma: f32,
    /// Cut-off of the velocity filter in Hz; 20, or a fifth of the sample rate where that is less
    #[arg(long, value_name = "HZ")]
    pub velocity_cutoff: Option<f64>,
    /// How the velocity is had
    #[arg(long, value_enum, default_value_t)]
    pub velocity: VelocityChoice,
    /// What a loss of contact makes forgotten
    #[arg(long, value_enum, default_value_t)]
    pub contact_loss: LossChoice,
}

impl Default for Options {
    /// The paper's settings, its four methods, matched filtering.
    fn default() -> Self {
        Self {
            methods: vec![Method::Ewrls, Method::Sprls, Method::Bls, Method::Blmf],
            window: BlockConfig::default().window,
            forgetting: EwrlsConfig::default().forgetting_factor,
            initial_covariance: EwrlsConfig::default().initial_covariance,
            sprls_beta: SprlsConfig::default().perturbation_gain,
            sprls_gamma: SprlsConfig::default().perturbation_sensitivity,
            velocity_cutoff: None,
            velocity: VelocityChoice::default(),
            contact_loss: LossChoice::default(),
        }
    }
}

/// How the velocity is had.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum VelocityChoice {
    /// The low-passed difference of x alone
    Paper,
    /// x, v and F through the same filter
    #[default]
    Matched,
}

/// What a loss of contact makes forgotten.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum LossChoice {
    /// Estimate, covariance and window
    #[default]
    Everything,
    /// Covariance and window
    Memory,
    /// Nothing
    Nothing,
}

fn method(name: &str) -> Result<Method, String> {
    Method::ALL.into_iter().find(|method| method.name() == name).ok_or_else(|| format!("`{name}` is no estimator"))
}

impl Options {
    /// Cut-off in Hz where the recording allows it.
    const VELOCITY_CUTOFF_HZ: f64 = 20.0;

    /// Label and value of each setting, for the reader of a report.
    #[must_use]
    pub fn in_words(&self) -> Vec<(String, String)> {
        let velocity = match self.velocity {
            VelocityChoice::Paper => "low-passed difference of the position alone (paper)",
            VelocityChoice::Matched => "position, velocity and force through the same filter (matched)",
        };
        let cutoff = self.velocity_cutoff.map_or_else(
            || format!("{} Hz, or a fifth of the sample rate where that is less", Self::VELOCITY_CUTOFF_HZ),
            |given| format!("{given} Hz"),
        );
        let forgotten = match self.contact_loss {
            LossChoice::Everything => "estimate, covariance and window",
            LossChoice::Memory => "covariance and window",
            LossChoice::Nothing => "nothing",
        };
        [
            ("window of the block methods", format!("{} samples", self.window)),
            ("forgetting factor of ewrls", self.forgetting.to_string()),
            ("initial covariance", self.initial_covariance.to_string()),
            ("sprls gain and sensitivity", format!("{} and {}", self.sprls_beta, self.sprls_gamma)),
            ("velocity", velocity.to_owned()),
            ("cut-off of the velocity filter", cutoff),
            ("forgotten at a loss of contact", forgotten.to_owned()),
        ]
        .map(|(label, value)| (label.to_owned(), value))
        .into()
    }

    /// A setting that the library refused, as the option that set it.
    pub(super) fn fault(&self, error: ConfigError) -> UsageError {
        let (option, found) = match error.parameter {
            "forgetting_factor" => ("--forgetting", self.forgetting),
            "initial_covariance" => ("--initial-covariance", self.initial_covariance),
            "perturbation_gain" => ("--sprls-beta", self.sprls_beta),
            "perturbation_sensitivity" => ("--sprls-gamma", self.sprls_gamma),
            other => return UsageError::new(other, "a setting that does not fit the recording", error.expected),
        };
        UsageError::new(option, found, error.expected)
    }

    /// The cut-off for a sample period, and a word where it had to be lowered.
    pub(super) fn cutoff(&self, period: f64) -> Result<(f64, Option<String>), UsageError> {
        let limit = f64::from(LowPass::LIMIT) / period;
        if let Some(asked) = self.velocity_cutoff {
            let fits = asked > 0.0 && asked <= limit;
            let expected = format!("a cut-off above 0 and at most {limit:.4} Hz, 0.4 of the sample rate");
            return if fits { Ok((asked, None)) } else { Err(UsageError::new("--velocity-cutoff", asked, expected)) };
        }
        let lowered = 0.2 / period;
        if lowered >= Self::VELOCITY_CUTOFF_HZ {
            return Ok((Self::VELOCITY_CUTOFF_HZ, None));
        }
        let rate = 1.0 / period;
        Ok((
            lowered,
            Some(format!("{rate:.4} samples a second: the velocity filter was lowered from 20 to {lowered:.4} Hz")),
        ))
    }
}
