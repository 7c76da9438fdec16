//! The motor and what it moves: one mass, or two with a transmission between them.

use super::actuator::{EffortLimit, FirstOrderLag};
use super::cogging::CoggingForce;
use super::contact::{Contact, Reaction};
use super::external_push::PushForce;
use super::friction::DryFriction;
use super::gravity::GravityForce;
use super::position_dependent_friction::PositionDamping;
use super::transmission::Transmission;
use crate::nominal::NominalParameters;

/// A body's position and velocity, m and m/s.
#[derive(Debug, Clone, Copy, Default)]
pub struct Body {
    /// m
    pub position: f64,
    /// m/s
    pub velocity: f64,
}

/// The drive's physics and its state.
#[derive(Debug, Clone)]
pub struct Drive {
    nominal: NominalParameters,
    /// What holds it while it stands and brakes it while it moves.
    pub friction: DryFriction,
    /// Weight.
    pub gravity: Option<GravityForce>,
    /// A force periodic in position.
    pub cogging: Option<CoggingForce>,
    /// Damping that depends on the position.
    pub position_damping: Option<PositionDamping>,
    /// Pushes on the tool by a person.
    pub pushes: Option<PushForce>,
    /// The effort comes late.
    pub effort_lag: Option<FirstOrderLag>,
    /// The effort has an end.
    pub effort_limit: Option<EffortLimit>,
    /// Between motor and tool.
    pub transmission: Option<Transmission>,
    /// The body that touches and whose position is measured.
    pub tool: Body,
    /// The motor, where a transmission parts it from the tool.
    pub motor: Body,
    effort: f64,
    reaction: Reaction,
    acceleration: f64,
    force: f64,
}

impl Drive {
    /// One mass with viscous friction.
    #[must_use]
    pub fn new(nominal: NominalParameters) -> Self {
        Self {
            nominal,
            friction: DryFriction::default(),
            gravity: None,
            cogging: None,
            position_damping: None,
            pushes: None,
            effort_lag: None,
            effort_limit: None,
            transmission: None,
            tool: Body::default(),
            motor: Body::default(),
            effort: 0.0,
            reaction: Reaction { force: 0.0, mass: 0.0, least: 0.0 },
            acceleration: 0.0,
            force: 0.0,
        }
    }

    /// Puts everything at rest at `position`.
    pub fn rest_at(&mut self, position: f64, contact: &mut Contact, dt: f64) {
        self.tool = Body { position, velocity: 0.0 };
        self.motor = self.tool;
        contact.advance(position, 0.0, dt);
        self.reaction = contact.react(0.0);
        self.force = self.reaction.at(0.0);
    }

    /// The contact force, N, and the tool's acceleration, m/s^2, at the present instant.
    #[must_use]
    pub fn felt(&self) -> (f64, f64) {
        (self.force, self.acceleration)
    }

    /// One step of velocity Verlet from `t`, in which the controller commands `effort`. Damping is taken at a predicted
    /// velocity, which keeps the second order; dry friction closes each half kick as a set-valued law.
    pub fn step(&mut self, effort: f64, contact: &mut Contact, t: f64, dt: f64) {
        let half = 0.5 * dt;
        let before = (self.tool.velocity, self.motor.velocity);
        self.effort = self.effort_lag.as_mut().map_or(effort, |lag| lag.advance(effort, dt));
        self.kick(before, t, half);
        let middle = (self.tool.velocity, self.motor.velocity);
        self.tool.position += dt * self.tool.velocity;
        self.motor.position += dt * self.motor.velocity;
        let ahead = (2.0 * middle.0 - before.0, 2.0 * middle.1 - before.1);
        contact.advance(self.tool.position, t + dt, dt);
        self.reaction = contact.react(ahead.0);
        self.kick(ahead, t + dt, half);
        self.acceleration = (self.tool.velocity - middle.0) / half;
        self.reaction = contact.react(self.tool.velocity);
        self.force = self.reaction.at(self.acceleration);
    }

    fn clipped(&self) -> f64 {
        self.effort_limit.as_ref().map_or(self.effort, |clip| clip.apply(self.effort))
    }

    /// Changes the velocities over `h` by the forces at the velocities `at` of tool and motor.
    fn kick(&mut self, at: (f64, f64), t: f64, h: f64) {
        let mut load = self.clipped();
        if let Some(gravity) = &self.gravity {
            load -= gravity.force(self.motor.position);
        }
        if let Some(cogging) = &self.cogging {
            load -= cogging.force(self.motor.position);
        }
        if let Some(eddy) = &self.position_damping {
            load -= eddy.force(self.motor.position, at.1);
        }
        let pushed = self.pushes.as_ref().map_or(0.0, |pushes| pushes.at(t));
        let brake = self.friction.brake(self.motor.position, at.1, self.force);
        let NominalParameters { mass, viscous, .. } = self.nominal;
        let Some(transmission) = &mut self.transmission else {
            load += pushed - viscous * at.0;
            self.tool.velocity = touching(self.tool.velocity, load, mass, self.reaction, brake, h);
            self.motor = self.tool;
            return;
        };
        let light = transmission.tool_share();
        let gap = Body { position: self.motor.position - self.tool.position, velocity: at.1 - at.0 };
        let passed = transmission.force(gap);
        let (tool_load, motor_load) = (passed + pushed - light * viscous * at.0, load - passed);
        let motor_load = motor_load - (1.0 - light) * viscous * at.1;
        let velocity = self.tool.velocity;
        self.tool.velocity = touching(velocity, tool_load, light * mass, self.reaction, (0.0, 0.0), h);
        self.motor.velocity = braked(self.motor.velocity, motor_load, (1.0 - light) * mass, brake, h);
    }
}

/// Velocity after `h` of a body of `mass` under `load` with dry friction: it comes to rest, exactly, where the friction
/// can hold it. `brake` is the friction against motion forward and backward, N.
#[must_use]
pub fn braked(velocity: f64, load: f64, mass: f64, brake: (f64, f64), h: f64) -> f64 {
    let free = velocity + h * load / mass;
    let (forward, backward) = (h * brake.0 / mass, h * brake.1 / mass);
    if free > forward {
        free - forward
    } else if free < -backward {
        free + backward
    } else {
        0.0
    }
}

/// As [`braked`], with a surface that answers; it does not pull beyond what holds it.
fn touching(velocity: f64, load: f64, mass: f64, reaction: Reaction, brake: (f64, f64), h: f64) -> f64 {
    let next = braked(velocity, load - reaction.force, mass + reaction.mass, brake, h);
    let force = reaction.force + reaction.mass * (next - velocity) / h;
    if force >= reaction.least { next } else { braked(velocity, load - reaction.least, mass, brake, h) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Friction of 1 N against motion forward and 0.5 N backward.
    const FRICTION_N: (f64, f64) = (1.0, 0.5);

    #[test]
    fn a_load_below_the_friction_moves_nothing() {
        assert_eq!(braked(0.0, 0.99, 0.4, (1.0, 0.5), 1e-4), 0.0);
        assert_eq!(braked(0.0, -0.49, 0.4, (1.0, 0.5), 1e-4), 0.0);
        assert!(braked(0.0, 1.01, 0.4, (1.0, 0.5), 1e-4) > 0.0);
        assert!(braked(0.0, -0.51, 0.4, (1.0, 0.5), 1e-4) < 0.0);
    }

    #[test]
    fn friction_takes_its_impulse_from_the_motion_and_never_turns_it() {
        let (mass, dt) = (0.4, 1e-4);
        let next = |velocity: f64, load: f64| braked(velocity, load, mass, FRICTION_N, dt);
        // m dv = (load - friction) dt, with the friction of the direction of motion.
        assert!((next(0.1, 0.3) - (0.1 + (0.3 - 1.0) * dt / mass)).abs() < 1e-15);
        assert!((next(-0.1, 0.3) - (-0.1 + (0.3 + 0.5) * dt / mass)).abs() < 1e-15);
        // What is slower than the friction of one step stops in it, exactly, and is not pushed back.
        for velocity in [1e-4, 2.4e-4, -1e-4, -1.2e-4] {
            assert_eq!(next(velocity, 0.0), 0.0, "{velocity}");
        }
    }

    #[test]
    fn friction_takes_the_kinetic_energy_of_a_coasting_body_and_no_more() {
        let (mass, dt, level) = (0.4, 1e-4, 0.7);
        let (mut velocity, mut position) = (0.3, 0.0);
        let before = 0.5 * mass * velocity * velocity;
        while velocity != 0.0 {
            let next = braked(velocity, 0.0, mass, (level, level), dt);
            position += 0.5 * dt * (velocity + next);
            velocity = next;
            assert!(velocity >= 0.0);
        }
        assert!((level * position / before - 1.0).abs() < 1e-3, "{} J of {before} J", level * position);
    }

    #[test]
    fn a_surface_does_not_pull_beyond_what_holds_it() {
        let reaction = Reaction { force: -2.0, mass: 0.0, least: -0.5 };
        // The surface asks for a pull of 2 N and may have 0.5 N.
        let next = touching(0.0, 0.0, 0.4, reaction, (0.0, 0.0), 1e-4);
        assert!((next - 0.5e-4 / 0.4).abs() < 1e-15, "{next}");
        let pushing = Reaction { force: 2.0, mass: 0.6, least: 0.0 };
        // A surface with a mass of its own: (m + mass) dv = -force dt.
        let next = touching(1.0, 0.0, 0.4, pushing, (0.0, 0.0), 1e-4);
        assert!((next - (1.0 - 2e-4)).abs() < 1e-15, "{next}");
    }
}
