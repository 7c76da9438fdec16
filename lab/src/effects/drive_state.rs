//! One instant of the drive, as effects see it and change it.

use super::cubic_segment::CubicSegment;

/// One instant of the drive: inertia a + viscous v = effort - force - resistance.
///
/// Along a recording all of it is measured, and what is left of the balance is the residual; in a simulation the
/// acceleration follows from it.
#[derive(Debug, Clone, Copy)]
pub struct DriveState {
    /// Seconds since the trial began.
    pub time: f64,
    /// Seconds since the last instant, zero at the first.
    pub step: f64,
    /// Tool position, as the sensor counts it.
    pub position: f64,
    /// Its rate.
    pub velocity: f64,
    /// Its acceleration; zero in a simulation, where it is what is asked for.
    pub acceleration: f64,
    /// Rate of the acceleration; zero in a simulation.
    pub jerk: f64,
    /// Rate of the jerk; zero in a simulation.
    pub snap: f64,
    /// Rate of the snap; zero in a simulation.
    pub crackle: f64,
    /// Width of the smoothing filter, s; zero in a simulation.
    pub filter_width: f64,
    /// What of the velocity is noise, m/s.
    pub velocity_noise: f64,
    /// Whether the tool stands still as far as can be seen: 0 to 1.
    pub at_rest: f64,
    /// Contact force on the tool, positive when the tool pushes.
    pub force: f64,
    /// Rate of the contact force; zero in a simulation.
    pub force_rate: f64,
    /// Its second derivative; zero in a simulation.
    pub force_second_derivative: f64,
    /// Its third; zero in a simulation.
    pub force_third_derivative: f64,
    /// What reaches the tool of the commanded effort.
    pub effort: f64,
    /// Rate of the effort as it is seen through the filter; not used in a simulation, where an effort is held.
    pub effort_rate: f64,
    /// Inertia that the tool side moves.
    pub inertia: f64,
    /// Viscous friction.
    pub viscous: f64,
    /// What effects take from the effort.
    pub resistance: f64,
}

impl DriveState {
    /// What is left of the balance.
    #[must_use]
    pub fn balance_residual(&self) -> f64 {
        self.effort - self.inertia * self.acceleration - self.viscous * self.velocity - self.force - self.resistance
    }

    /// The effort since the last instant, where it and its rate were `before`.
    #[must_use]
    pub fn effort_since(&self, before: [f64; 2]) -> CubicSegment {
        if self.filter_width > 0.0 {
            CubicSegment::smooth(before, [self.effort, self.effort_rate], self.step)
        } else {
            CubicSegment::straight(before[0], self.effort)
        }
    }

    /// Mean of the sign of the velocity over the blur, and over what noise leaves undecided.
    #[must_use]
    pub fn direction(&self) -> f64 {
        let width = ((self.acceleration * self.filter_width).powi(2) + self.velocity_noise.powi(2)).sqrt();
        if self.velocity.abs() >= 6.0 * width {
            return if self.velocity == 0.0 { 0.0 } else { self.velocity.signum() };
        }
        libm::erf(self.velocity / width * std::f64::consts::FRAC_1_SQRT_2)
    }

    /// Adds dry friction that slides with `sliding` (signed) and holds up to `holding` where the tool stands still.
    ///
    /// Friction at rest is whatever the balance asks for, up to its limit: it is no function of the velocity.
    pub fn apply_dry_friction(&mut self, sliding: f64, holding: f64) {
        let held = self.balance_residual().max(-holding.abs()).min(holding.abs());
        self.resistance += (1.0 - self.at_rest) * sliding + self.at_rest * held;
    }
}
