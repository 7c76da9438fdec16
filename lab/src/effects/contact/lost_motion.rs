//! Play between the position sensor and the surface.

use crate::effects::contact_state::{gate, ramp};
use crate::effects::{
    ContactState, Effect, EffectSpec, EffectState, ExcitationStats, Form, Limit, Parameter, Place, Stage, Start,
    geometric,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct LostMotion;

static SPEC: EffectSpec = EffectSpec {
    name: "lost_motion",
    place: Place::Contact,
    stage: Stage::Geometry,
    max_instances: 1,
    statement: "After each reversal the sensor moves a little way before the tip does",
    forms: &[Form {
        name: "play",
        equation: "the tip follows the sensor only beyond +-play/2; the contact law takes the tip's depth and rate",
        parameters: &[Parameter::new("play", Word::new("m", "rad"), "whole width of the play", 0.0, f64::INFINITY)
            .within(Limit::ResolvableLength)],
    }],
    excited_by: "small and large reversals in contact",
    resembles: &["hysteresis", "plastic_set"],
    source: "the play operator: M. A. Krasnosel'skii, A. V. Pokrovskii, Systems with Hysteresis, 1989",
};

impl Effect for LostMotion {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        if !scene.has_unloading() {
            return Vec::new();
        }
        geometric(0.003 * scene.depth, 0.8 * scene.depth, 8).iter().map(|play| Start::at(&[*play])).collect()
    }

    fn act_on_contact(&self, _form: usize, values: &[f64], state: &mut EffectState, touch: &mut ContactState) {
        // state: tip position, whether it is known, sensor position an instant ago, where the tip last rested, velocity an
        // instant ago.
        let half = 0.5 * values[0];
        if state[1] == 0.0 {
            (state[0], state[1], state[2], state[3]) = (touch.position, 1.0, touch.position, touch.position);
        }
        let before = state[0];
        state[0] = before.max(touch.position - half).min(touch.position + half);
        let whole = touch.position - state[2];
        state[2] = touch.position;
        if state[0] == before || touch.velocity * state[4] < 0.0 {
            state[3] = state[0];
        }
        state[4] = touch.velocity;
        if touch.smoothing_width > 0.0 {
            follow(half, state[3], touch);
            return;
        }
        // A motion that takes up the play within one step follows for the rest of it. Both are ways over the step: against
        // velocity times step a tip without play would fall short wherever the motion speeds up.
        let share = if whole != 0.0 { ((state[0] - before) / whole).clamp(0.0, 1.0) } else { 1.0 };
        touch.velocity *= share;
        touch.position = state[0];
    }
}

/// A tip that rested at `rest` until the play of `half` either way was taken up, its corner smoothed: the velocity does not
/// jump there but rises over the width. A width longer than the play takes is all of the play, so that none is off.
fn follow(half: f64, rest: f64, touch: &mut ContactState) {
    let width = (touch.velocity.abs() * touch.smoothing_width).min(half);
    let way = touch.velocity.signum();
    let taken = way * (touch.position - rest) - half;
    touch.position = rest + way * ramp(taken, width);
    touch.velocity *= gate(taken, width);
}
