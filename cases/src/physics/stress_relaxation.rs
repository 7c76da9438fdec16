//! Maxwell branches in parallel with the contact spring.

/// One Maxwell branch, `q' = k p' - q/tau`, exact for a depth that moves evenly through the step.
#[derive(Debug, Clone)]
pub struct MaxwellBranch {
    pub(crate) stiffness: f64,
    pub(crate) time: f64,
    pub(crate) last: Option<f64>,
    pub(crate) force: f64,
}

impl MaxwellBranch {
    /// At rest.
    #[must_use]
    pub fn new(stiffness: f64, time: f64) -> Self {
        Self { stiffness, time, last: None, force: 0.0 }
    }

    /// Moves on by `dt` to depth `p`.
    pub fn advance(&mut self, p: f64, dt: f64) {
        let moved = p - self.last.replace(p).unwrap_or(p);
        let kept = (-dt / self.time).exp();
        self.force = kept * self.force + self.stiffness * moved * (1.0 - kept) * self.time / dt;
    }

    /// q, N
    #[must_use]
    pub fn force(&self) -> f64 {
        self.force
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_held_branch_relaxes_as_its_closed_form() {
        let (stiffness, time, depth, dt) = (80.0, 0.3, 0.004, 5e-5);
        let mut branch = MaxwellBranch::new(stiffness, time);
        branch.advance(0.0, dt);
        // A ramp of 0.1 s: q = k u tau (1 - exp(-t/tau)); held for 0.5 s it decays by exp(-0.5/tau).
        for step in 1..=2000 {
            branch.advance(depth * f64::from(step) / 2000.0, dt);
        }
        let peak = stiffness * (depth / 0.1) * time * (1.0 - (-0.1 / time).exp());
        assert!((branch.force() - peak).abs() < 1e-9, "{} {peak}", branch.force());
        for _ in 0..10_000 {
            branch.advance(depth, dt);
        }
        let held = peak * (-0.5 / time).exp();
        assert!((branch.force() - held).abs() < 1e-9, "{} {held}", branch.force());
    }
}
