//! What joins motor and tool, where something gives or plays between them, followed step by step.

use crate::effects::cubic_segment::CubicSegment;
use crate::effects::{DriveState, EffectState, Parameter};
use crate::rig::Word;

/// What a motor and a tool share of one mass.
pub const MOTOR_SHARE: Parameter =
    Parameter::new("motor_share", Word::same("1"), "share of the inertia on the motor's side", 0.02, 0.8);

/// What they share of one viscous friction.
pub const FRICTION_SHARE: Parameter =
    Parameter::new("friction_share", Word::same("1"), "share of the viscous friction on the motor's side", 0.0, 1.0);

/// Motor and tool, coupled by a spring with a gap.
pub struct TwoMassLink {
    /// Of the spring.
    pub stiffness: f64,
    /// Beside the spring.
    pub damping: f64,
    /// Of the motor's side.
    pub inertia: f64,
    /// Viscous friction of the motor's side.
    pub viscous: f64,
    /// Whole width of the gap.
    pub gap: f64,
}

/// Most integration steps between two samples: beyond them the link is as good as rigid.
const MAX_SUBSTEPS: f64 = 64.0;

impl TwoMassLink {
    /// Runs the motor's side over the last step and replaces the effort by what the link transmits.
    pub fn carry(&self, state: &mut EffectState, push: &mut DriveState) {
        // state: motor position, its velocity, tool position, tool velocity, effort an instant ago, whether known.
        if self.stiffness <= 0.0 || self.inertia <= 0.0 {
            return;
        }
        let steps = (push.step * self.fastest() / 0.2).ceil();
        if steps > MAX_SUBSTEPS {
            return;
        }
        push.inertia -= self.inertia;
        push.viscous -= self.viscous;
        if state[5] == 0.0 {
            let stretch = push.effort / self.stiffness;
            let lead = stretch + 0.5 * self.gap * stretch.signum();
            let (position, velocity) = (push.position, push.velocity);
            state[..6].copy_from_slice(&[position + lead, velocity, position, velocity, push.effort, 1.0]);
        }
        let [mut motor, mut speed, tool, tool_speed, effort, ..] = **state;
        let part = steps.max(1.0).recip();
        let span = push.step * part;
        let lightness = span / self.inertia;
        let mix = |from: f64, to: f64, part: f64| from + part * (to - from);
        // The tool between two samples, by position and rate at both: a chord would leave k step^2 / 12 of false inertia.
        let way = CubicSegment::hermite([tool, tool_speed], [push.position, push.velocity], push.step);
        for step in 0..steps as usize {
            let start = step as f64 * part;
            let middle = start + 0.5 * part;
            // Half the way, the force there, the other half: motor and tool are compared at one instant, or a common
            // motion would be pushed on by k span / 2 times its speed.
            motor += 0.5 * span * speed;
            let pull = self.pull(motor - way.at(middle), speed - mix(tool_speed, push.velocity, start));
            speed += lightness * (mix(effort, push.effort, middle) - pull - self.viscous * speed);
            motor += 0.5 * span * speed;
        }
        state[..6].copy_from_slice(&[motor, speed, push.position, push.velocity, push.effort, 1.0]);
        push.effort = self.pull(motor - push.position, speed - push.velocity);
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
