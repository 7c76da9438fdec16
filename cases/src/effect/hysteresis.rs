//! `hysteresis`: a loop that no slowness closes.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::physics::Physics;
use crate::scale::Unit;

/// Springs of the bundle.
const BUNDLE: usize = 8;

/// A force that depends on the way, not on its speed.
#[derive(Debug, Clone)]
pub enum Loop {
    /// Bouc-Wen: `z' = (1 - |z|^n (1 + sign(z p'))/2) p'/d`, force `H z`.
    BoucWen {
        /// H, N
        height: f64,
        /// d, m
        distance: f64,
        /// n
        sharpness: f64,
        /// z
        state: f64,
        /// p of the last step
        last: f64,
    },
    /// Springs that each slip at a reach of their own.
    Bundle {
        /// Force of each when it slips, N.
        share: f64,
        /// Reach of each, m.
        reach: [f64; BUNDLE],
        /// Stretch of each, m.
        stretch: [f64; BUNDLE],
        /// p of the last step
        last: f64,
    },
}

impl Loop {
    /// Moves on to depth `p`; a surface that is left forgets.
    pub fn advance(&mut self, p: f64) {
        match self {
            Self::BoucWen { distance, sharpness, state, last, .. } => {
                let moved = (p - *last) / *distance;
                *last = p;
                let into = if moved * *state > 0.0 { state.abs().powf(*sharpness) } else { 0.0 };
                *state = if p == 0.0 { 0.0 } else { (*state + moved * (1.0 - into)).clamp(-1.0, 1.0) };
            }
            Self::Bundle { reach, stretch, last, .. } => {
                let moved = p - *last;
                *last = p;
                for (stretch, reach) in stretch.iter_mut().zip(reach) {
                    *stretch = if p == 0.0 { 0.0 } else { (*stretch + moved).clamp(-*reach, *reach) };
                }
            }
        }
    }

    /// N
    #[must_use]
    pub fn force(&self) -> f64 {
        match self {
            Self::BoucWen { height, state, .. } => height * state,
            Self::Bundle { share, reach, stretch, .. } => {
                share * stretch.iter().zip(reach).map(|(stretch, reach)| stretch / reach).sum::<f64>()
            }
        }
    }
}

/// `hysteresis`
#[derive(Debug)]
pub struct Hysteresis {
    bundle: bool,
    distance: f64,
    sharpness: f64,
    unit: f64,
}

impl Hysteresis {
    /// Of either form.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let distance = scene.depth * chance.random_range(0.02..0.1);
        let sharpness = chance.random_range(1.0..2.0);
        Self { bundle: chance.random_bool(0.5), distance, sharpness, unit: 0.02 * scene.force }
    }
}

impl Shape for Hysteresis {
    fn form(&self) -> &'static str {
        if self.bundle { "a bundle of springs that slip" } else { "Bouc-Wen" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 30.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![
            Parameter::new("amplitude", size * self.unit, Unit::Force),
            Parameter::new("yield_distance", self.distance, Unit::Length),
        ]
    }
}

impl Acting for Hysteresis {
    fn put(&self, size: f64, physics: &mut Physics) {
        let (height, distance, sharpness) = (size * self.unit, self.distance, self.sharpness);
        physics.contact.hysteresis = Some(if self.bundle {
            // From a third of the distance to three times it.
            let reach = std::array::from_fn(|at| distance * 9f64.powf(at as f64 / (BUNDLE - 1) as f64 - 0.5));
            Loop::Bundle { share: height / BUNDLE as f64, reach, stretch: [0.0; BUNDLE], last: 0.0 }
        } else {
            Loop::BoucWen { height, distance, sharpness, state: 0.0, last: 0.0 }
        });
    }
}
