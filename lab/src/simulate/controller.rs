//! The drive's controller: proportional and derivative, held between two updates.

use crate::rig::Control;

/// What the controller remembers from one update to the next.
#[derive(Debug, Clone, Copy)]
pub struct Controller {
    control: Control,
    /// Share of a new difference that passes the derivative's low-pass.
    pass: f64,
    error: Option<f64>,
    slope: f64,
}

impl Controller {
    pub fn new(control: Control) -> Self {
        let corner = control.derivative_filter_hz.unwrap_or(0.1 * control.rate_hz);
        let pass = -(-std::f64::consts::TAU * corner / control.rate_hz).exp_m1();
        Self { control, pass, error: None, slope: 0.0 }
    }

    /// The effort until the next update.
    pub fn update(&mut self, reference: f64, reading: f64) -> f64 {
        let error = reference - reading;
        let difference = (error - self.error.unwrap_or(error)) * self.control.rate_hz;
        self.error = Some(error);
        self.slope += self.pass * (difference - self.slope);
        let effort = self.control.proportional * error + self.control.derivative * self.slope;
        effort.clamp(-self.control.effort_saturation, self.control.effort_saturation)
    }
}
