//! From a rig, a recording and the command line to what the estimators are fed.

use std::path::Path;

use anyhow::Result;
use palpate::{
    BlockConfig, ContactDetectorConfig, ContactLoss, EstimatorBank, EstimatorBankConfig, EwrlsConfig, FrontEndConfig,
    GradientConfig, Method, Methods, Observation, ResetRlsConfig, Sample, SensorResolution, SprlsConfig, StreamConfig,
    Units, Velocity,
};

use super::options::{LossChoice, Options, VelocityChoice};
use crate::error::InputError;
use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;

/// What the estimators are fed, and what the reader should know about it.
pub struct Plan {
    /// Settings of the bench.
    pub config: EstimatorBankConfig,
    /// The methods that run, in the order asked for.
    pub methods: Vec<Method>,
    /// What a reader should know.
    pub notices: Vec<String>,
    surface: f64,
    force_zero: f64,
    period: f64,
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
        let figures = Figures::of(rig, recording);
        let depth = |row: usize| recording.position[row] - contact.surface;
        let force = force.iter().map(|force| force - zero);
        let units = Units::for_range(range(depth, force, period, cutoff, contact.bilateral));
        let notices = lowered.into_iter().chain(rescaled(units, rig)).collect();
        let front_end = FrontEndConfig {
            period: period as f32,
            surface: 0.0,
            cutoff: cutoff as f32,
            velocity: match options.velocity {
                VelocityChoice::Paper => Velocity::Paper,
                VelocityChoice::Matched => Velocity::Matched,
            },
            bilateral: contact.bilateral,
            contact_detector: contact_detector(&figures),
            units,
        };
        let config = bench(front_end, &figures, options);
        EstimatorBank::new(&config).map_err(|error| options.fault(error))?;
        Ok(Self {
            config,
            methods: in_order(&options.methods),
            notices,
            surface: contact.surface,
            force_zero: zero,
            period,
        })
    }

    /// The samples of the recording that was planned for: depth below the surface, force above its zero, time since the sample before.
    ///
    /// The surface and the zero are taken off in double precision: a single keeps seven digits of what is left.
    pub fn samples<'a>(&'a self, recording: &'a Recording) -> impl ExactSizeIterator<Item = Sample> + 'a {
        let force = recording.force.as_deref().unwrap_or_default();
        let time = &recording.time;
        (0..time.len().min(force.len())).map(move |row| {
            let before = if row == 0 { time[0] - self.period } else { time[row - 1] };
            Sample {
                position: (recording.position[row] - self.surface) as f32,
                force: (force[row] - self.force_zero) as f32,
                elapsed: (time[row] - before) as f32,
            }
        })
    }
}

/// A word where the settings do not mean what the paper prints.
fn rescaled(units: Units, rig: &Rig) -> Option<String> {
    let coordinate = rig.coordinate;
    (units != Units::SI).then(|| {
        format!(
            "settings act in units of {:.3e} {}, {:.3e} {} and {:.3e} {}, in which this rig has the paper's proportions",
            units.penetration,
            coordinate.position_unit(),
            units.rate,
            coordinate.velocity_unit(),
            units.force,
            coordinate.force_unit()
        )
    })
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

/// Thresholds from what the sensor resolves and how it is noisy: on the paper's bench (0.05 N a count, 0.09 N of noise)
/// 0.23 N and 0.05 N.
fn contact_detector(figures: &Figures) -> ContactDetectorConfig {
    let (count, noise) = figures.force.map_or((0.0, 0.0), |force| (force.resolution, force.noise));
    ContactDetectorConfig {
        on_force: (4.0 * count).max(2.5 * noise) as f32,
        off_force: count.max(0.5 * noise) as f32,
        off_samples: 5,
    }
}

/// Full scale of the contact: what all but one in a hundred samples stay below. The rate is a difference over a quarter
/// of the filter's period, so that the position's rounding does not set it.
fn range(
    depth: impl Fn(usize) -> f64,
    force: impl ExactSizeIterator<Item = f64>,
    period: f64,
    cutoff: f64,
    bilateral: bool,
) -> Observation {
    let rows = force.len();
    let inside = |row: usize| if bilateral { depth(row).abs() } else { depth(row).max(0.0) };
    let lag = ((0.25 / (cutoff * period)) as usize).clamp(1, rows.saturating_sub(1).max(1));
    let rates = (lag..rows).map(|row| (inside(row) - inside(row - lag)).abs() / (lag as f64 * period));
    Observation {
        penetration: percentile((0..rows).map(inside)) as f32,
        rate: percentile(rates) as f32,
        force: percentile(force.map(f64::abs)) as f32,
    }
}

/// The 99th percentile of the values above zero; zero where there are none.
fn percentile(values: impl Iterator<Item = f64>) -> f64 {
    // The room at once: a vector that grows holds what it had beside what it gets.
    let mut above = Vec::with_capacity(values.size_hint().1.unwrap_or(0));
    above.extend(values.filter(|value| *value > 0.0));
    if above.is_empty() {
        return 0.0;
    }
    let at = (above.len() - 1) * 99 / 100;
    *above.select_nth_unstable_by(at, f64::total_cmp).1
}

fn bench(front_end: FrontEndConfig, figures: &Figures, options: &Options) -> EstimatorBankConfig {
    let stream = StreamConfig {
        front_end,
        sensors: SensorResolution {
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
    EstimatorBankConfig {
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
