//! What a diagnosis leaves open, as questions to a design.

use crate::diagnose::Found;
use crate::diagnose::report::diagnosis::{Diagnosis, Value};
use crate::experiment_design::explanation::{Explanation, UNKNOWN};
use crate::experiment_design::parameters::{self, Parameter};
use crate::experiment_design::planner::Question;
use crate::page::effect_name::effect_name;

/// Relative half-width of a 95 % interval above which a value is still open.
pub const WIDE_INTERVAL: f64 = 0.1;

/// Everything that `found` leaves open and a design can look at, and the same in words.
#[must_use]
pub fn questions(found: &Found, explanations: &[Explanation]) -> Vec<(Question, String)> {
    let answer = &explanations[0];
    let named = if answer.physics.is_empty() { "nothing missing".to_owned() } else { words(&answer.physics) };
    let alternatives = explanations.iter().enumerate().skip(1);
    let mut all: Vec<(Question, String)> = alternatives
        .map(|(at, other)| (Question::Alternative(at), format!("{named} or {}", words(&other.physics))))
        .collect();
    all.extend(wide_intervals(&found.answer).filter_map(|(effect, value)| {
        let place = answer.rig.effects.iter().position(|table| table.name == effect)?;
        let is_it = |parameter: &Parameter| {
            matches!(parameter, Parameter::OfEffect { effect, name, .. } if *effect == place && **name == value.name)
        };
        let parameter = parameters::of(&answer.rig).into_iter().find(is_it)?;
        let share = relative_half_width(value);
        let known = if share < 10.0 { format!("known to {:.0} %", 100.0 * share) } else { "not known".to_owned() };
        let text = format!("{} of {}, {known}", spaced(&value.name), spaced(effect));
        Some((Question::Interval(parameter, half_width(value)), text))
    }));
    all
}

/// Values of named effects whose interval is wide: effect and value.
fn wide_intervals(answer: &Diagnosis) -> impl Iterator<Item = (&str, &Value)> {
    let of_effects = answer.physics.iter().filter(|physics| physics.name != UNKNOWN);
    let values = of_effects.flat_map(|physics| physics.parameters.iter().map(|value| (physics.name.as_str(), value)));
    values.filter(|(_, value)| relative_half_width(value) > WIDE_INTERVAL)
}

/// Whether structure is left that nothing explains.
#[must_use]
pub fn has_unknown(answer: &Diagnosis) -> bool {
    answer.physics.iter().any(|physics| physics.name == UNKNOWN)
}

fn half_width(value: &Value) -> f64 {
    0.5 * (value.ci95[1] - value.ci95[0])
}

/// Half-width of the interval over the value; infinite where either is none.
fn relative_half_width(value: &Value) -> f64 {
    let share = half_width(value) / value.value.abs();
    if share.is_nan() { f64::INFINITY } else { share }
}

/// "stress relaxation and hysteresis".
#[must_use]
pub fn words(physics: &[String]) -> String {
    if physics.is_empty() {
        return "nothing missing".to_owned();
    }
    physics.iter().map(|name| spaced(name)).collect::<Vec<_>>().join(" and ")
}

/// A name as a sentence has it.
fn spaced(name: &str) -> String {
    effect_name(name)
}
