//! A drive that comes late.

use crate::effects::{Card, Effect, Form, Memory, Parameter, Place, Push, Scene, Stage, Start, geometric};
use crate::rig::Word;

/// See [`CARD`].
pub struct EffortLag;

static CARD: Card = Card {
    name: "effort_lag",
    place: Place::Drive,
    stage: Stage::Transmission,
    most: 1,
    statement: "The effort builds up later than commanded",
    forms: &[Form {
        name: "first_order",
        equation: "time_constant d(effort at the tool)/dt = commanded effort - effort at the tool",
        parameters: &[Parameter::new("time_constant", Word::same("s"), "of the drive", 0.0, f64::INFINITY)],
    }],
    excited_by: "quick changes of effort, two or more frequencies",
    resembles: &["transmission_compliance", "channel_delay"],
    source: "winding and current loop of a motor: L / R",
};

impl Effect for EffortLag {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        geometric(scene.sample, 30.0 * scene.step, 7).iter().map(|time| Start::at(&[*time])).collect()
    }

    fn push(&self, _form: usize, values: &[f64], memory: &mut Memory, push: &mut Push) {
        // memory: effort at the tool, command an instant ago, its rate, whether they are known.
        let time = values[0];
        if memory[3] == 0.0 || time <= 0.0 {
            (memory[0], memory[1], memory[2], memory[3]) = (push.effort, push.effort, push.effort_rate, 1.0);
            return;
        }
        let ratio = push.step / time;
        if ratio > 0.0 {
            memory[0] = push.effort_since([memory[1], memory[2]]).lagged(memory[0], ratio);
        }
        (memory[1], memory[2]) = (push.effort, push.effort_rate);
        push.effort_rate = (push.effort - memory[0]) / time;
        push.effort = memory[0];
    }
}
