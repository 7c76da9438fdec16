//! The rig without any concealed physics, at the size of a bench.

use rand::RngExt;
use serde::Serialize;

use crate::rng::{CaseRng, log_uniform};

/// The values of the nominal physics: `m a + b v = effort - F`, `F = max(0, K p + B v)` for `p = x - surface > 0`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct NominalParameters {
    /// Moving mass m, kg.
    pub mass: f64,
    /// Viscous friction b, N s/m.
    pub viscous: f64,
    /// Contact stiffness K, N/m.
    pub stiffness: f64,
    /// Contact damping B, N s/m.
    pub damping: f64,
    /// Where the tool begins to touch, m.
    pub surface: f64,
    /// Force both ways, with no free motion.
    pub bilateral: bool,
}

/// Position control, `effort = proportional e + derivative de/dt`, at 1 kHz on the encoder's reading.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PdGains {
    /// N/m
    pub proportional: f64,
    /// N s/m
    pub derivative: f64,
    /// Low-pass on the difference, Hz.
    pub filter_hz: f64,
}

impl NominalParameters {
    /// A rig as benches are, and the deepest contact that suits it, m.
    #[must_use]
    pub fn draw(rng: &mut CaseRng, bilateral: bool) -> (Self, f64) {
        let mass = log_uniform(rng, 0.3, 1.5);
        let stiffness = log_uniform(rng, 150.0, 3000.0);
        let ratio = log_uniform(rng, 0.05, 0.4);
        let damping = (2.0 * ratio * (stiffness * mass).sqrt()).clamp(2.0, 20.0);
        let viscous = rng.random_range(1.0..6.0);
        let surface = if rng.random_bool(0.4) { 0.0 } else { rng.random_range(-0.005..0.005) };
        let depth = (log_uniform(rng, 2.0, 12.0) / stiffness).clamp(0.0015, 0.015);
        (Self { mass, viscous, stiffness, damping, surface, bilateral }, depth)
    }
}

impl PdGains {
    /// Gains of a stable loop about `nominal`.
    #[must_use]
    pub fn draw(rng: &mut CaseRng, nominal: &NominalParameters) -> Self {
        let corner: f64 = rng.random_range(32.0..50.0);
        let proportional = nominal.mass * corner * corner;
        let derivative = 2.0 * rng.random_range(0.35..0.6) * nominal.mass * corner;
        Self { proportional, derivative, filter_hz: 100.0 }
    }
}
