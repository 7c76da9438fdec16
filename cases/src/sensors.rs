//! What the sensors leave of a signal.

use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

use crate::rng::CaseRng;

/// How good the sensors are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SensorGrade {
    /// 0.1 mm; 0.05 N with 0.02 N of noise.
    Coarse,
    /// 5 um; 0.005 N with 0.01 N of noise.
    Fine,
}

/// The sensors of a case.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sensors {
    /// m
    pub position_step: f64,
    /// N
    pub force_step: f64,
    /// Standard deviation before rounding, N.
    pub force_noise: f64,
}

impl Sensors {
    /// Of `grade`, at the size of a bench.
    #[must_use]
    pub fn new(grade: SensorGrade) -> Self {
        match grade {
            SensorGrade::Coarse => Self { position_step: 1e-4, force_step: 0.05, force_noise: 0.02 },
            SensorGrade::Fine => Self { position_step: 5e-6, force_step: 0.005, force_noise: 0.01 },
        }
    }

    /// RMS error of a reading of the force, N: `sqrt(noise^2 + step^2/12)`.
    #[must_use]
    pub fn floor(&self) -> f64 {
        (self.force_noise.powi(2) + self.force_step.powi(2) / 12.0).sqrt()
    }

    /// A reading of `force`, N.
    pub fn read_force(&self, force: f64, rng: &mut CaseRng) -> f64 {
        let noise: f64 = StandardNormal.sample(rng);
        self.force_step * ((force + self.force_noise * noise) / self.force_step).round() + 0.0
    }
}
