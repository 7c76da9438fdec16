//! One instant of the drive, as effects see it and change it.

/// One instant of the drive: inertia a + viscous v = effort - force - resistance.
///
/// The acceleration follows from it: what is left of the balance is the inertia times that.
#[derive(Debug, Clone, Copy)]
pub struct DriveState {
    /// Seconds since the last instant, zero at the first.
    pub step: f64,
    /// Tool position, as the sensor counts it.
    pub position: f64,
    /// Its rate.
    pub velocity: f64,
    /// Whether the tool stands still.
    pub at_rest: bool,
    /// Contact force on the tool, positive when the tool pushes.
    pub force: f64,
    /// What reaches the tool of the commanded effort.
    pub effort: f64,
    /// Inertia that the tool side moves.
    pub inertia: f64,
    /// Viscous friction.
    pub viscous: f64,
    /// What effects take from the effort.
    pub resistance: f64,
    /// The part of it that is weight: friction can grow with it.
    pub weight: f64,
}

impl DriveState {
    /// What is left of the balance: inertia times acceleration.
    #[must_use]
    pub fn balance_residual(&self) -> f64 {
        self.effort - self.viscous * self.velocity - self.force - self.resistance
    }

    /// Sign of the velocity: -1, 0 or 1.
    #[must_use]
    pub fn direction(&self) -> f64 {
        if self.velocity == 0.0 { 0.0 } else { self.velocity.signum() }
    }

    /// Adds dry friction that slides with `sliding` (signed) and holds up to `holding` where the tool stands still.
    ///
    /// Friction at rest is whatever the balance asks for, up to its limit: it is no function of the velocity.
    pub fn apply_dry_friction(&mut self, sliding: f64, holding: f64) {
        let held = self.balance_residual().max(-holding.abs()).min(holding.abs());
        self.resistance += if self.at_rest { held } else { sliding };
    }
}
