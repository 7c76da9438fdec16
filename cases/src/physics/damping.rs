//! Contact damping that depends on depth or on speed.

/// `alpha d (p/d)^n`, N s/m
#[derive(Debug, Clone, Copy)]
pub struct DepthDamping {
    pub(crate) alpha: f64,
    pub(crate) depth: f64,
    pub(crate) exponent: f64,
}

impl DepthDamping {
    /// The damping at depth `p`, none outside.
    #[must_use]
    pub fn at(&self, p: f64) -> f64 {
        self.alpha * self.depth * (p.max(0.0) / self.depth).powf(self.exponent)
    }
}

/// `c u^2 (|v|/u)^n`, against the motion
#[derive(Debug, Clone, Copy)]
pub struct SpeedDamping {
    pub(crate) coefficient: f64,
    pub(crate) speed: f64,
    pub(crate) exponent: f64,
}

impl SpeedDamping {
    /// N at velocity `v`.
    #[must_use]
    pub fn force(&self, v: f64) -> f64 {
        let force = self.coefficient * self.speed * self.speed * (v.abs() / self.speed).powf(self.exponent);
        force.copysign(v)
    }
}
