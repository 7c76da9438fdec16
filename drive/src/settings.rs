//! Settings that can be changed while the drive runs.

use serde::{Deserialize, Serialize};

use crate::{Calibration, TICK_HZ};
use palpate::BlockConfig;
use palpate::ContactDetectorConfig;
use palpate::EwrlsConfig;
use palpate::GradientConfig;
use palpate::ResetRlsConfig;
use palpate::SensorResolution;
use palpate::SprlsConfig;
use palpate::Units;
use palpate::error::{ConfigError, require};
use palpate::{ContactLoss, StreamConfig};
use palpate::{EstimatorBankConfig, Method, Methods};
use palpate::{FrontEndConfig, Velocity};

/// Settings of a drive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// The estimator.
    pub method: Method,
    /// Window of the block methods and reset interval of `reset_rls`, 2 to 2048 samples.
    pub window: u16,
    /// Cut-off of the filter, 1 to 400 Hz.
    pub cutoff: f32,
    /// How the rate is computed.
    pub velocity: Velocity,
    /// What is discarded at a loss of contact.
    pub contact_loss: ContactLoss,
    /// Of `ewrls`.
    pub forgetting: f32,
    /// Of the recursive methods.
    pub initial_covariance: f32,
    /// Of `sprls`.
    pub perturbation_gain: f32,
    /// Of `sprls`.
    pub perturbation_sensitivity: f32,
    /// Ticks that an estimate is held without a good sample, before it is void: 1 to 1000.
    pub hold: u16,
    /// Ticks of silence after which the link is gone; 0: it may be silent.
    pub link_timeout: u16,
}

impl Default for Settings {
    /// The recommended law, [`palpate::CusumRls`], at 20 Hz, and 300 samples for methods on a window; held for 50 ms; the link may be
    /// silent.
    fn default() -> Self {
        let sprls = SprlsConfig::default();
        Self {
            method: Method::CusumRls,
            window: BlockConfig::default().window,
            cutoff: 20.0,
            velocity: Velocity::Matched,
            contact_loss: ContactLoss::Everything,
            forgetting: EwrlsConfig::default().forgetting_factor,
            initial_covariance: EwrlsConfig::default().initial_covariance,
            perturbation_gain: sprls.perturbation_gain,
            perturbation_sensitivity: sprls.perturbation_sensitivity,
            hold: 50,
            link_timeout: 0,
        }
    }
}

impl Settings {
    /// The configuration of the estimators: that of `palpate replay` for a recording of this drive.
    ///
    /// # Errors
    /// A setting that is out of its limits here; the estimators have more.
    pub fn bank_config(&self, calibration: &Calibration) -> Result<EstimatorBankConfig, ConfigError> {
        require((1.0..=400.0).contains(&self.cutoff), "cutoff", "1 to 400 Hz")?;
        require((1..=1_000).contains(&self.hold), "hold", "1 to 1000 ticks")?;
        let initial_covariance = self.initial_covariance;
        let covariance_limit = (100.0 * initial_covariance).clamp(1e6, 1e9);
        Ok(EstimatorBankConfig {
            stream: self.stream(calibration),
            methods: Methods::default().with(self.method),
            rls: EwrlsConfig { initial_covariance, covariance_limit, ..EwrlsConfig::rls() },
            ewrls: EwrlsConfig { initial_covariance, covariance_limit, forgetting_factor: self.forgetting },
            sprls: SprlsConfig {
                initial_covariance,
                covariance_limit,
                perturbation_gain: self.perturbation_gain,
                perturbation_sensitivity: self.perturbation_sensitivity,
            },
            reset_rls: ResetRlsConfig { initial_covariance, reset_interval: self.window },
            gradient: GradientConfig::default(),
            block: BlockConfig::of(self.window),
        })
    }

    fn stream(&self, calibration: &Calibration) -> StreamConfig {
        StreamConfig {
            front_end: FrontEndConfig {
                period: 1.0 / f32::from(TICK_HZ),
                surface: 0.0,
                cutoff: self.cutoff,
                velocity: self.velocity,
                bilateral: false,
                contact_detector: contact_detector(calibration),
                units: Units::SI,
            },
            sensors: SensorResolution {
                position_resolution: calibration.position_per_count().abs(),
                force_noise: calibration.force_noise,
            },
            contact_loss: self.contact_loss,
            movement_memory: self.window,
        }
    }
}

/// Contact begins above two and a half standard deviations, and ends below a half. In double precision as the host tool does
/// it, so that both have the same bits.
fn contact_detector(calibration: &Calibration) -> ContactDetectorConfig {
    let noise = f64::from(calibration.force_noise);
    ContactDetectorConfig { on_force: (2.5 * noise) as f32, off_force: (0.5 * noise) as f32, off_samples: 5 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_covariance_is_limited_to_a_hundred_times_its_start_within_two_bounds() {
        for (initial_covariance, limit) in [(10.0, 1e6), (1e5, 1e7), (1e8, 1e9)] {
            let settings = Settings { initial_covariance, ..Settings::default() };
            let config = settings.bank_config(&Calibration::DEFAULT).expect("sound settings");
            let limits = [config.rls.covariance_limit, config.ewrls.covariance_limit, config.sprls.covariance_limit];
            assert_eq!(limits, [limit; 3]);
            let starts = [config.rls, config.ewrls].map(|law| law.initial_covariance);
            assert_eq!((starts, config.sprls.initial_covariance), ([initial_covariance; 2], initial_covariance));
            assert_eq!(config.reset_rls.initial_covariance, initial_covariance);
        }
    }

    #[test]
    fn contact_begins_and_ends_by_the_noise_of_the_force() {
        let found = contact_detector(&Calibration { force_noise: 0.5, ..Calibration::DEFAULT });
        assert_eq!((found.on_force, found.off_force, found.off_samples), (1.25, 0.25, 5));
    }
}
