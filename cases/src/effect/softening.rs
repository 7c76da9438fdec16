//! `time_varying_stiffness`: a spring that is not the same at the end.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::{Chance, sign};
use crate::physics::Physics;
use crate::scale::Unit;

/// How far the change has come.
#[derive(Debug, Clone, Copy)]
enum Course {
    Linear { duration: f64 },
    Exponential { time: f64 },
    Jump { at: f64, width: f64 },
}

/// A factor on the spring in time.
#[derive(Debug, Clone, Copy)]
pub struct Change {
    course: Course,
    relative: f64,
}

impl Change {
    /// The factor at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let done = match self.course {
            Course::Linear { duration } => t / duration,
            Course::Exponential { time } => 1.0 - (-t / time).exp(),
            Course::Jump { at, width } => ((t - at) / width + 0.5).clamp(0.0, 1.0),
        };
        1.0 + self.relative * done
    }
}

/// `time_varying_stiffness`; every trial starts afresh.
#[derive(Debug)]
pub struct Softening {
    course: Course,
    harder: bool,
    stiffness: f64,
}

impl Softening {
    /// Of any course.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let duration = scene.duration;
        let course = match chance.random_range(0..3) {
            0 => Course::Linear { duration },
            1 => Course::Exponential { time: duration * chance.random_range(0.1..0.5) },
            _ => Course::Jump { at: duration * chance.random_range(0.3..0.7), width: chance.random_range(0.01..0.3) },
        };
        Self { course, harder: sign(chance) > 0.0, stiffness: scene.nominal.stiffness }
    }

    fn relative(&self, size: f64) -> f64 {
        if self.harder { size } else { 1.0 / (1.0 + size) - 1.0 }
    }
}

impl Shape for Softening {
    fn form(&self) -> &'static str {
        match self.course {
            Course::Linear { .. } => "linear in time",
            Course::Exponential { .. } => "exponential in time",
            Course::Jump { .. } => "a jump",
        }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(0.05, 2.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let change = self.stiffness * self.relative(size);
        let amount = Parameter::new("stiffness_change", change, Unit::Stiffness);
        match self.course {
            Course::Linear { duration } => vec![amount, Parameter::new("over", duration, Unit::Time)],
            Course::Exponential { time } => vec![amount, Parameter::new("time_constant", time, Unit::Time)],
            Course::Jump { at, .. } => vec![amount, Parameter::new("jump_time", at, Unit::Time)],
        }
    }
}

impl Acting for Softening {
    fn put(&self, size: f64, physics: &mut Physics) {
        physics.contact.change = Some(Change { course: self.course, relative: self.relative(size) });
    }
}
