//! The contact spring: linear, nonlinear, layered, or with a bump.

/// The spring of the contact, odd in the depth p.
#[derive(Debug, Clone, Copy)]
pub enum Spring {
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

impl Spring {
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

/// A second slope: `(K2 - K) w ln(1 + exp((p - d)/w))`, rounded over w.
#[derive(Debug, Clone, Copy)]
pub struct StiffnessLayer {
    pub(crate) depth: f64,
    pub(crate) width: f64,
    pub(crate) extra: f64,
}

impl StiffnessLayer {
    /// What the slope adds at depth `p`.
    #[must_use]
    pub fn force(&self, p: f64) -> f64 {
        let at = (p - self.depth) / self.width;
        // Beyond thirty widths the rounding has long ended, and the exponential overflows.
        let rounded = if at > 30.0 { at } else { at.exp().ln_1p() };
        self.extra * self.width * rounded
    }
}

/// A hump of force over the depth, whose far side has negative stiffness: `A exp(-((p - d)/w)^2)`.
#[derive(Debug, Clone, Copy)]
pub struct ForceBump {
    pub(crate) depth: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl ForceBump {
    /// What the hump adds at depth `p`.
    #[must_use]
    pub fn force(&self, p: f64) -> f64 {
        self.height * (-((p - self.depth) / self.width).powi(2)).exp()
    }
}
