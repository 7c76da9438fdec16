//! One instant of the contact, as effects see it and change it.

/// One instant of the contact. Depth is positive into the environment, force positive when the tool pushes.
///
/// A contact begins at a corner, which falls anywhere between two steps of an integrator: smoothed over a part of the step, it does not
/// show which. Depth is E max(0, x + v tau), tau normal with deviation `smoothing_width`, in closed form for a motion that is
/// straight across it, and the rate goes with it. Along a recorded motion the width is zero.
#[derive(Debug, Clone, Copy)]
pub struct ContactState {
    /// Seconds since the trial began.
    pub time: f64,
    /// Seconds since the last instant, zero at the first.
    pub step: f64,
    /// Tool position relative to the surface, negative in free space.
    pub position: f64,
    /// Rate of `position`.
    pub velocity: f64,
    /// Acceleration of the tool.
    pub acceleration: f64,
    /// Time over which corners are smoothed, s: standard deviation; zero along a recording.
    pub smoothing_width: f64,
    /// Force both ways.
    pub bilateral: bool,
    /// Depth of penetration.
    pub depth: f64,
    /// Rate of the depth.
    pub rate: f64,
    /// Share of the smoothing width that is in contact, 0 to 1.
    pub inside: f64,
    /// Stiffness K at this instant.
    pub stiffness: f64,
    /// Damping B.
    pub damping: f64,
    /// Force of the spring; effects of the law change it.
    pub spring: f64,
    /// Force beside spring and damper.
    pub extra: f64,
    /// The force on the tool, once the law has been summed and cut at zero.
    pub force: f64,
}

impl ContactState {
    /// Depth, rate and contact share from `position` and `velocity`.
    pub fn enter(&mut self) {
        if self.bilateral {
            (self.depth, self.rate, self.inside) = (self.position, self.velocity, 1.0);
            return;
        }
        let width = self.velocity.abs() * self.smoothing_width;
        self.inside = gate(self.position, width);
        self.depth = ramp(self.position, width);
        self.rate = self.velocity * self.inside;
    }

    /// The force of spring and damper before it is cut.
    #[must_use]
    pub fn borne(&self) -> f64 {
        self.spring + self.damping * self.rate + self.extra
    }

    /// Cuts the force at zero. `before` is what was borne an instant earlier: its slope makes a width in force of the width in time.
    pub fn cut(&mut self, before: f64) {
        let borne = self.borne();
        self.force = if self.bilateral {
            borne
        } else if self.velocity < 0.0 && self.step > 0.0 && self.inside > 0.0 {
            // The slope of a release is no steeper than the spring's and what the damper adds while the tool leaves.
            ramp(borne, ((borne - before) / self.step).abs() * self.smoothing_width)
        } else {
            borne.max(0.0)
        };
    }
}

/// E max(0, value + width n) for a standard normal n.
#[must_use]
pub fn ramp(value: f64, width: f64) -> f64 {
    if value.abs() >= 6.0 * width {
        return value.max(0.0);
    }
    let z = value / width;
    value * below(z) + width * (-0.5 * z * z).exp() / (std::f64::consts::TAU).sqrt()
}

/// `width ln(1 + exp(value / width))`: max(0, value) with its corner rounded over `width`.
#[must_use]
pub fn rounded(value: f64, width: f64) -> f64 {
    value.max(0.0) + width * (-value.abs() / width).exp().ln_1p()
}

/// The probability that value + width n is above zero.
#[must_use]
pub fn gate(value: f64, width: f64) -> f64 {
    if value.abs() >= 6.0 * width { f64::from(value > 0.0) } else { below(value / width) }
}

fn below(z: f64) -> f64 {
    0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2)
}
