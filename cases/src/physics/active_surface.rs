//! A surface that is alive: a periodic pulse of force, and a push back after each touch.

/// A sharp beat and a weaker echo, once a period, whenever the tool touches.
#[derive(Debug, Clone, Copy)]
pub struct PulseForce {
    pub(crate) height: f64,
    pub(crate) period: f64,
    pub(crate) start: f64,
}

impl PulseForce {
    /// N at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let phase = ((t + self.start) / self.period).fract();
        let hump = |at: f64, width: f64| (-((phase - at) / width).powi(2)).exp();
        self.height * (hump(0.2, 0.05) + 0.4 * hump(0.45, 0.07))
    }
}

/// A muscle that pushes back some time after each touch, and lets go again.
#[derive(Debug, Clone, Copy)]
pub struct ReflexForce {
    pub(crate) height: f64,
    pub(crate) wait: f64,
    pub(crate) rise: f64,
    pub(crate) touched: f64,
}

impl ReflexForce {
    /// N, a step `dt` after the last call.
    pub fn advance(&mut self, touching: bool, dt: f64) -> f64 {
        self.touched = if touching { self.touched + dt } else { 0.0 };
        let since = (self.touched - self.wait).max(0.0) / self.rise;
        // Rises to one at since = 1 and fades over the next few rises.
        self.height * since * (1.0 - since).exp()
    }
}
