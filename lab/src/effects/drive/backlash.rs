//! Play between motor and tool.

use crate::effects::{Card, Course, Effect, Form, Memory, Parameter, Place, Push, Scene, Stage, Start, geometric};
use crate::rig::Word;

/// See [`CARD`].
pub struct Backlash;

static CARD: Card = Card {
    name: "backlash",
    place: Place::Drive,
    stage: Stage::Transmission,
    most: 1,
    statement: "Between motor and tool there is play: after a reversal the motor runs free before it takes the tool along",
    forms: &[Form {
        name: "two_masses",
        equation: "m1 d2y/dt2 = effort - T, m1 = motor_share m; T = 0 while |y - x| < gap/2, a stiff damped link beyond; (m - m1) a + b v = T - F",
        parameters: &[
            Parameter::new("gap", Word::new("m", "rad"), "whole width of the play", 0.0, f64::INFINITY),
            Parameter::new("motor_share", Word::same("1"), "share of the inertia on the motor's side", 0.02, 0.8),
            Parameter::fixed(
                "link_stiffness",
                Word::new("N/m", "N m/rad"),
                "of the flanks: as stiff as the analysis resolves",
            ),
        ],
    }],
    excited_by: "reversals of the effort, in free motion and in contact",
    resembles: &["coulomb_friction", "transmission_compliance", "lost_motion"],
    source: "M. Nordin, P.-O. Gutman, Automatica 38 (2002) 1633",
};

/// Motor and tool, coupled by a spring with a gap.
pub struct Link {
    /// Of the spring.
    pub stiffness: f64,
    /// Beside the spring.
    pub damping: f64,
    /// Of the motor's side.
    pub inertia: f64,
    /// Whole width of the gap.
    pub gap: f64,
}

/// Most integration steps between two samples: beyond them the link is as good as rigid.
const MOST_STEPS: f64 = 64.0;

impl Link {
    /// Runs the motor's side over the last step and replaces the effort by what the link transmits.
    pub fn carry(&self, memory: &mut Memory, push: &mut Push) {
        // memory: motor position, its velocity, tool position, tool velocity, effort an instant ago, its rate, whether known.
        push.inertia -= self.inertia;
        if self.stiffness <= 0.0 || self.inertia <= 0.0 {
            push.inertia += self.inertia.max(0.0);
            return;
        }
        let steps = (push.step * self.fastest() / 0.2).ceil();
        if steps > MOST_STEPS {
            push.inertia += self.inertia;
            return;
        }
        if memory[6] == 0.0 {
            let stretch = push.effort / self.stiffness;
            let lead = stretch + 0.5 * self.gap * stretch.signum();
            let (position, velocity) = (push.position, push.velocity);
            *memory = [position + lead, velocity, position, velocity, push.effort, push.effort_rate, 1.0];
        }
        let [mut motor, mut speed, tool, tool_speed, effort, effort_rate, _] = *memory;
        let part = steps.max(1.0).recip();
        let span = push.step * part;
        let lightness = span / self.inertia;
        let mix = |from: f64, to: f64, part: f64| from + part * (to - from);
        // The tool between two samples, by position and rate at both: a chord would leave k step^2 / 12 of false inertia.
        let way = Course::smooth([tool, tool_speed], [push.position, push.velocity], push.step);
        let effort = push.effort_since([effort, effort_rate]);
        for step in 0..steps as usize {
            let start = step as f64 * part;
            let middle = start + 0.5 * part;
            // Half the way, the force there, the other half: motor and tool are compared at one instant, or a common
            // motion would be pushed on by k span / 2 times its speed.
            motor += 0.5 * span * speed;
            let pull = self.pull(motor - way.at(middle), speed - mix(tool_speed, push.velocity, start));
            speed += lightness * (effort.at(middle) - pull);
            motor += 0.5 * span * speed;
        }
        *memory = [motor, speed, push.position, push.velocity, push.effort, push.effort_rate, 1.0];
        push.effort = self.pull(motor - push.position, speed - push.velocity);
        push.effort_rate = self.stiffness * (speed - push.velocity);
    }

    fn fastest(&self) -> f64 {
        (self.stiffness / self.inertia).sqrt().max(self.damping / self.inertia)
    }

    fn pull(&self, lead: f64, speed: f64) -> f64 {
        let half = 0.5 * self.gap;
        let beyond = lead - lead.max(-half).min(half);
        if self.gap > 0.0 && beyond == 0.0 { 0.0 } else { self.stiffness * beyond + self.damping * speed }
    }
}

impl Effect for Backlash {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        let way = scene.travel.1 - scene.travel.0;
        // Without a force sensor nothing but the noise of the acceleration stands against a hidden motor.
        if !scene.has_force {
            return Vec::new();
        }
        let mut starts = Vec::new();
        for gap in geometric(0.0005 * way, 0.2 * way, 8) {
            for share in [0.2, 0.6] {
                let motor = share * scene.inertia;
                let pulse = 1.1 * scene.link_rate();
                starts.push(Start::at(&[gap, share, motor * pulse * pulse]));
            }
        }
        starts
    }

    fn push(&self, _form: usize, values: &[f64], memory: &mut Memory, push: &mut Push) {
        // Flanks that ring three times.
        let motor = values[1] * push.inertia;
        let damping = 0.6 * (values[2] * motor).max(0.0).sqrt();
        Link { stiffness: values[2], damping, inertia: motor, gap: values[0] }.carry(memory, push);
    }
}
