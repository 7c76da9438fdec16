//! `time_varying_stiffness`: a spring that is not the same at the end.

use rand::RngExt;

use super::{EffectParameter, EffectShape, NominalMotion, SimulatedEffect, SizeRange};
use crate::physics::RigModel;
use crate::physics::time_varying_stiffness::{StiffnessFactor, TimeCourse};
use crate::rng::{CaseRng, sign};
use crate::scale::Unit;

/// `time_varying_stiffness`; every trial starts afresh.
#[derive(Debug)]
pub struct TimeVaryingStiffness {
    course: TimeCourse,
    harder: bool,
    stiffness: f64,
}

impl TimeVaryingStiffness {
    /// Of any course.
    #[must_use]
    pub fn draw(motion: &NominalMotion, rng: &mut CaseRng) -> Self {
        let duration = motion.duration;
        let course = match rng.random_range(0..3) {
            0 => TimeCourse::Linear { duration },
            1 => TimeCourse::Exponential { time: duration * rng.random_range(0.1..0.5) },
            _ => TimeCourse::Jump { at: duration * rng.random_range(0.3..0.7), width: rng.random_range(0.01..0.3) },
        };
        Self { course, harder: sign(rng) > 0.0, stiffness: motion.nominal.stiffness }
    }

    fn relative(&self, size: f64) -> f64 {
        if self.harder { size } else { 1.0 / (1.0 + size) - 1.0 }
    }
}

impl EffectShape for TimeVaryingStiffness {
    fn form(&self) -> &'static str {
        match self.course {
            TimeCourse::Linear { .. } => "linear in time",
            TimeCourse::Exponential { .. } => "exponential in time",
            TimeCourse::Jump { .. } => "a jump",
        }
    }

    fn size_range(&self) -> SizeRange {
        SizeRange::new(0.05, 2.0)
    }

    fn parameters(&self, size: f64) -> Vec<EffectParameter> {
        let change = self.stiffness * self.relative(size);
        let amount = EffectParameter::new("stiffness_change", change, Unit::Stiffness);
        match self.course {
            TimeCourse::Linear { duration } => vec![amount, EffectParameter::new("over", duration, Unit::Time)],
            TimeCourse::Exponential { time } => vec![amount, EffectParameter::new("time_constant", time, Unit::Time)],
            TimeCourse::Jump { at, .. } => vec![amount, EffectParameter::new("jump_time", at, Unit::Time)],
        }
    }
}

impl SimulatedEffect for TimeVaryingStiffness {
    fn apply(&self, size: f64, model: &mut RigModel) {
        model.contact.stiffness_factor = Some(StiffnessFactor { course: self.course, relative: self.relative(size) });
    }
}
