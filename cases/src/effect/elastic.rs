//! Springs that are not straight: `nonlinear_stiffness`, `layered_stiffness`, and a bump that buckles.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::{Chance, sign};
use crate::physics::Physics;
use crate::scale::Unit;

/// The spring of the contact, odd in the depth p.
#[derive(Debug, Clone, Copy)]
pub enum Elastic {
    /// `K p`
    Linear,
    /// `K d (p/d)^n`
    Power {
        /// d, m
        depth: f64,
        /// n
        exponent: f64,
    },
    /// `K p (1 + (p/d)^2)`
    Cubic {
        /// d, m
        depth: f64,
    },
    /// `K d (exp(p/d) - 1)`, as skin stiffens
    Exponential {
        /// d, m
        depth: f64,
    },
}

impl Elastic {
    /// Force at `depth` of a spring that is `stiffness` where it is linear.
    #[must_use]
    pub fn force(self, stiffness: f64, p: f64) -> f64 {
        match self {
            Self::Linear => stiffness * p,
            Self::Power { depth, exponent } => stiffness * depth * (p.abs() / depth).powf(exponent).copysign(p),
            Self::Cubic { depth } => stiffness * p * (1.0 + (p / depth).powi(2)),
            Self::Exponential { depth } => (stiffness * depth * (p.abs() / depth).exp_m1()).copysign(p),
        }
    }
}

/// `nonlinear_stiffness`
#[derive(Debug)]
pub struct Nonlinear {
    form: usize,
    depth: f64,
    stiffness: f64,
    harder: bool,
}

impl Nonlinear {
    /// Of any form.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let depth = scene.depth * chance.random_range(0.4..0.8);
        Self { form: chance.random_range(0..3), depth, stiffness: scene.nominal.stiffness, harder: sign(chance) > 0.0 }
    }

    /// A power law.
    #[must_use]
    pub fn power(scene: &Scene, chance: &mut Chance) -> Self {
        Self { form: 0, ..Self::draw(scene, chance) }
    }

    fn exponent(&self, size: f64) -> f64 {
        if self.harder { 1.0 + size } else { 1.0 / (1.0 + size) }
    }
}

impl Shape for Nonlinear {
    fn form(&self) -> &'static str {
        ["power law", "cubic hardening", "exponential hardening"][self.form]
    }

    fn sizes(&self) -> Sizes {
        let largest = match (self.form, self.harder) {
            (0, true) => 1.2,
            (0, false) => 0.66,
            _ => 3.0,
        };
        Sizes::new(0.1, largest)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let (k, d) = (self.stiffness, self.depth);
        match self.form {
            0 => {
                let exponent = self.exponent(size);
                vec![
                    Parameter::new("exponent", exponent, Unit::One),
                    Parameter::new("reference_depth", d, Unit::Length),
                ]
            }
            1 => vec![Parameter::new("hardening", k * size / (d * d), Unit::Hardening)],
            _ => vec![Parameter::new("stiffening", size / d, Unit::PerLength)],
        }
    }
}

impl Acting for Nonlinear {
    fn put(&self, size: f64, physics: &mut Physics) {
        let depth = self.depth;
        physics.contact.elastic = match self.form {
            0 => Elastic::Power { depth, exponent: self.exponent(size) },
            1 => Elastic::Cubic { depth: depth / size.sqrt() },
            _ => Elastic::Exponential { depth: depth / size },
        };
    }
}

/// A second slope: `(K2 - K) w ln(1 + exp((p - d)/w))`, rounded over w.
#[derive(Debug, Clone, Copy)]
pub struct Layer {
    depth: f64,
    width: f64,
    extra: f64,
}

impl Layer {
    /// What the slope adds at depth `p`.
    #[must_use]
    pub fn force(&self, p: f64) -> f64 {
        let at = (p - self.depth) / self.width;
        // Beyond thirty widths the rounding has long ended, and the exponential overflows.
        let rounded = if at > 30.0 { at } else { at.exp().ln_1p() };
        self.extra * self.width * rounded
    }
}

/// `layered_stiffness`
#[derive(Debug)]
pub struct Layered {
    depth: f64,
    stiffness: f64,
    harder: bool,
}

impl Layered {
    /// At a depth that the trials pass.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let depth = scene.depth * chance.random_range(0.3..0.65);
        Self { depth, stiffness: scene.nominal.stiffness, harder: chance.random_bool(0.7) }
    }

    fn second(&self, size: f64) -> f64 {
        self.stiffness * if self.harder { 1.0 + size } else { 1.0 / (1.0 + size) }
    }
}

impl Shape for Layered {
    fn form(&self) -> &'static str {
        "two slopes with a rounded knee"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(0.1, 5.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![
            Parameter::new("layer_depth", self.depth, Unit::Length),
            Parameter::new("second_stiffness", self.second(size), Unit::Stiffness),
        ]
    }
}

impl Acting for Layered {
    fn put(&self, size: f64, physics: &mut Physics) {
        let extra = self.second(size) - self.stiffness;
        physics.contact.layer = Some(Layer { depth: self.depth, width: 0.03 * self.depth, extra });
    }
}

/// A hump of force over the depth, whose far side has negative stiffness: `A exp(-((p - d)/w)^2)`.
#[derive(Debug, Clone, Copy)]
pub struct Bump {
    depth: f64,
    width: f64,
    height: f64,
}

impl Bump {
    /// What the hump adds at depth `p`.
    #[must_use]
    pub fn force(&self, p: f64) -> f64 {
        self.height * (-((p - self.depth) / self.width).powi(2)).exp()
    }
}

/// Outside of the list: a shell that buckles at a depth.
#[derive(Debug)]
pub struct Buckling {
    depth: f64,
    width: f64,
    unit: f64,
}

impl Buckling {
    /// At a depth that the trials pass.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let depth = scene.depth * chance.random_range(0.35..0.6);
        Self { depth, width: depth * chance.random_range(0.15..0.3), unit: 0.05 * scene.force }
    }
}

impl Shape for Buckling {
    fn form(&self) -> &'static str {
        "a hump of force over depth"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 12.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![
            Parameter::new("height", size * self.unit, Unit::Force),
            Parameter::new("depth", self.depth, Unit::Length),
            Parameter::new("width", self.width, Unit::Length),
        ]
    }
}

impl Acting for Buckling {
    fn put(&self, size: f64, physics: &mut Physics) {
        let (depth, width) = (self.depth, self.width);
        physics.contact.bump = Some(Bump { depth, width, height: size * self.unit });
    }
}
