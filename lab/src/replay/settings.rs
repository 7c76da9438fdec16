//! From a rig, a recording and the command line to what the estimators are fed.

use std::path::Path;

use anyhow::Result;
use clap::{Args, ValueEnum};
use palpate::{
    BENCH_WINDOW, Bench, BenchConfig, BlockConfig, ConfigError, ContactLoss, EwrlsConfig, FrontEndConfig, GateConfig,
    GradientConfig, LowPass, Method, Methods, Observation, ResetRlsConfig, Sample, Sensors, SprlsConfig, StreamConfig,
    Units, Velocity,
};

use crate::error::{InputError, UsageError};
use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;

/// The estimators' settings, as the command line gives them.
#[derive(Debug, Clone, Args)]
pub struct Options {
    /// Estimators, separated by commas
    #[arg(long = "method", value_name = "NAME,...", value_delimiter = ',', default_value = "ewrls,sprls,bls,blmf", value_parser = method)]
    pub methods: Vec<Method>,
    /// Window of the block methods and reset interval of reset_rls, in samples
    #[arg(long, value_name = "N", default_value_t = Self::default().window, value_parser = clap::value_parser!(u16).range(2..=BENCH_WINDOW as i64))]
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
    Method::ALL.into_iter().find(|method| method.name() == name).ok_or_else(|| {
        let names = Method::ALL.map(Method::name);
        format!("found `{name}`, expected one of {}", names.join(", "))
    })
}

impl Options {
    /// Cut-off in Hz where the recording allows it.
    const CUTOFF: f64 = 20.0;

    /// Label and value of each setting, for the reader of a report.
    #[must_use]
    pub fn in_words(&self) -> Vec<(String, String)> {
        let velocity = match self.velocity {
            VelocityChoice::Paper => "low-passed difference of the position alone (paper)",
            VelocityChoice::Matched => "position, velocity and force through the same filter (matched)",
        };
        [
            ("window of the block methods", format!("{} samples", self.window)),
            ("forgetting factor of ewrls", self.forgetting.to_string()),
            ("initial covariance", self.initial_covariance.to_string()),
            ("sprls gain and sensitivity", format!("{} and {}", self.sprls_beta, self.sprls_gamma)),
            ("velocity", velocity.to_owned()),
        ]
        .map(|(label, value)| (label.to_owned(), value))
        .into()
    }

    /// A setting that the library refused, as the option that set it.
    fn fault(&self, error: ConfigError) -> UsageError {
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
    fn cutoff(&self, period: f64) -> Result<(f64, Option<String>), UsageError> {
        let limit = f64::from(LowPass::LIMIT) / period;
        if let Some(asked) = self.velocity_cutoff {
            let fits = asked > 0.0 && asked <= limit;
            let expected = format!("a cut-off above 0 and at most {limit:.4} Hz, 0.4 of the sample rate");
            return if fits { Ok((asked, None)) } else { Err(UsageError::new("--velocity-cutoff", asked, expected)) };
        }
        let lowered = 0.2 / period;
        if lowered >= Self::CUTOFF {
            return Ok((Self::CUTOFF, None));
        }
        let rate = 1.0 / period;
        Ok((
            lowered,
            Some(format!("{rate:.4} samples a second: the velocity filter was lowered from 20 to {lowered:.4} Hz")),
        ))
    }
}

/// What the estimators are fed, and what the reader should know about it.
pub struct Plan {
    /// Settings of the bench.
    pub config: BenchConfig,
    /// The methods that run, in the order asked for.
    pub methods: Vec<Method>,
    /// Depth below the surface, force above its zero, time since the sample before.
    pub samples: Vec<Sample>,
    /// What a reader should know.
    pub notices: Vec<String>,
}

impl Plan {
    /// Settles everything that the rig and the command line leave open.
    ///
    /// # Errors
    /// The rig has no contact, the recording no force, or a setting is out of range.
    pub fn new(rig: &Rig, rig_path: &Path, recording: &Recording, options: &Options) -> Result<Self> {
        let contact = rig.contact.ok_or_else(|| {
            InputError::new(
                rig_path.display(),
                "no [contact] table",
                "one with surface_m, stiffness_n_m and damping_n_s_m",
            )
        })?;
        let force = recording.force.as_ref().ok_or_else(|| {
            InputError::new(&recording.name, "a recording without contact force", "a force (or torque) column")
        })?;
        let period = recording.period();
        let (cutoff, lowered) = options.cutoff(period)?;
        let zero = rig.sensors.force_zero.unwrap_or(0.0);
        // The surface and the zero are taken off in double precision: a single keeps seven digits of what is left.
        let depth: Vec<f64> = recording.position.iter().map(|x| x - contact.surface).collect();
        let force: Vec<f64> = force.iter().map(|f| f - zero).collect();
        let figures = Figures::of(rig, recording);
        let range = range(&depth, &force, period, cutoff, contact.bilateral);
        let units = Units::for_range(range);
        let mut notices: Vec<String> = lowered.into_iter().collect();
        if units != Units::SI {
            notices.push(format!(
                "settings act in units of {:.3e} {}, {:.3e} {} and {:.3e} {}, in which this rig has the paper's proportions",
                units.penetration,
                rig.coordinate.position_unit(),
                units.rate,
                rig.coordinate.velocity_unit(),
                units.force,
                rig.coordinate.force_unit()
            ));
        }
        let front_end = FrontEndConfig {
            period: period as f32,
            surface: 0.0,
            cutoff: cutoff as f32,
            velocity: match options.velocity {
                VelocityChoice::Paper => Velocity::Paper,
                VelocityChoice::Matched => Velocity::Matched,
            },
            bilateral: contact.bilateral,
            gate: gate(&figures),
            units,
        };
        let config = bench(front_end, &figures, options);
        Bench::new(&config).map_err(|error| options.fault(error))?;
        Ok(Self {
            config,
            methods: in_order(&options.methods),
            samples: samples(&depth, &force, &recording.time, period),
            notices,
        })
    }
}

fn in_order(asked: &[Method]) -> Vec<Method> {
    let mut methods = Vec::new();
    for method in asked {
        if !methods.contains(method) {
            methods.push(*method);
        }
    }
    methods
}

fn samples(depth: &[f64], force: &[f64], time: &[f64], period: f64) -> Vec<Sample> {
    let before = std::iter::once(time[0] - period).chain(time.iter().copied());
    depth
        .iter()
        .zip(force)
        .zip(time.iter().zip(before))
        .map(|((&x, &f), (&t, before))| Sample { position: x as f32, force: f as f32, elapsed: (t - before) as f32 })
        .collect()
}

/// Thresholds from what the sensor resolves and how it is noisy: on the paper's bench (0.05 N a count, 0.09 N of noise)
/// 0.23 N and 0.05 N.
fn gate(figures: &Figures) -> GateConfig {
    let (count, noise) = figures.force.map_or((0.0, 0.0), |force| (force.resolution, force.noise));
    GateConfig {
        on_force: (4.0 * count).max(2.5 * noise) as f32,
        off_force: count.max(0.5 * noise) as f32,
        off_samples: 5,
    }
}

/// Full scale of the contact: what all but one in a hundred samples stay below. The rate is a difference over a quarter
/// of the filter's period, so that the position's rounding does not set it.
fn range(depth: &[f64], force: &[f64], period: f64, cutoff: f64, bilateral: bool) -> Observation {
    let inside = |x: f64| if bilateral { x.abs() } else { x.max(0.0) };
    let lag = ((0.25 / (cutoff * period)) as usize).clamp(1, depth.len().saturating_sub(1).max(1));
    let rates =
        depth.iter().zip(depth.iter().skip(lag)).map(|(a, b)| (inside(*b) - inside(*a)).abs() / (lag as f64 * period));
    Observation {
        penetration: percentile(depth.iter().copied().map(inside)) as f32,
        rate: percentile(rates) as f32,
        force: percentile(force.iter().map(|f| f.abs())) as f32,
    }
}

/// The 99th percentile of the values above zero; zero where there are none.
fn percentile(values: impl Iterator<Item = f64>) -> f64 {
    let mut above: Vec<f64> = values.filter(|value| *value > 0.0).collect();
    if above.is_empty() {
        return 0.0;
    }
    let at = (above.len() - 1) * 99 / 100;
    *above.select_nth_unstable_by(at, f64::total_cmp).1
}

fn bench(front_end: FrontEndConfig, figures: &Figures, options: &Options) -> BenchConfig {
    let stream = StreamConfig {
        front_end,
        sensors: Sensors {
            position_resolution: figures.position.resolution as f32,
            force_noise: figures.force.map_or(0.0, |force| force.noise) as f32,
        },
        contact_loss: match options.contact_loss {
            LossChoice::Everything => ContactLoss::Everything,
            LossChoice::Memory => ContactLoss::Memory,
            LossChoice::Nothing => ContactLoss::Nothing,
        },
        movement_memory: options.window,
    };
    let initial_covariance = options.initial_covariance;
    // Room to grow from wherever it starts, within what the library takes.
    let covariance_limit = (100.0 * initial_covariance).clamp(1e6, 1e9);
    BenchConfig {
        stream,
        methods: options.methods.iter().fold(Methods::default(), |methods, method| methods.with(*method)),
        rls: EwrlsConfig { initial_covariance, covariance_limit, ..EwrlsConfig::rls() },
        ewrls: EwrlsConfig { initial_covariance, covariance_limit, forgetting_factor: options.forgetting },
        sprls: SprlsConfig {
            initial_covariance,
            covariance_limit,
            perturbation_gain: options.sprls_beta,
            perturbation_sensitivity: options.sprls_gamma,
        },
        reset_rls: ResetRlsConfig { initial_covariance, reset_interval: options.window },
        gradient: GradientConfig::default(),
        block: BlockConfig::of(options.window),
    }
}
