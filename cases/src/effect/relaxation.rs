//! `stress_relaxation`: springs that lead into dampers.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::{Chance, log_uniform};
use crate::physics::Physics;
use crate::scale::Unit;

/// One Maxwell branch, `q' = k p' - q/tau`, exact for a depth that moves evenly through the step.
#[derive(Debug, Clone)]
pub struct Branch {
    stiffness: f64,
    time: f64,
    last: Option<f64>,
    force: f64,
}

impl Branch {
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

/// `stress_relaxation`, of one or two branches.
#[derive(Debug)]
pub struct Relaxation {
    times: Vec<f64>,
    shares: Vec<f64>,
    unit: f64,
}

impl Relaxation {
    /// With time constants that the holds of the trials can show.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let unit = 0.1 * scene.nominal.stiffness;
        let time = log_uniform(chance, 0.04, 2.0);
        if chance.random_bool(0.6) {
            return Self { times: vec![time], shares: vec![1.0], unit };
        }
        let share = chance.random_range(0.4..0.7);
        Self { times: vec![time, time * chance.random_range(5.0..10.0)], shares: vec![share, 1.0 - share], unit }
    }
}

impl Shape for Relaxation {
    fn form(&self) -> &'static str {
        if self.times.len() == 1 { "one Maxwell branch" } else { "two Maxwell branches" }
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 50.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let names = [("branch_stiffness", "time_constant"), ("second_branch_stiffness", "second_time_constant")];
        let branches = self.times.iter().zip(&self.shares).zip(names);
        branches
            .flat_map(|((time, share), (stiffness_name, time_name))| {
                let stiffness = size * self.unit * share;
                [
                    Parameter::new(stiffness_name, stiffness, Unit::Stiffness),
                    Parameter::new(time_name, *time, Unit::Time),
                ]
            })
            .collect()
    }
}

impl Acting for Relaxation {
    fn put(&self, size: f64, physics: &mut Physics) {
        let branches = self.times.iter().zip(&self.shares);
        physics.contact.branches = branches.map(|(time, share)| Branch::new(size * self.unit * share, *time)).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_held_branch_relaxes_as_its_closed_form() {
        let (stiffness, time, depth, dt) = (80.0, 0.3, 0.004, 5e-5);
        let mut branch = Branch::new(stiffness, time);
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
