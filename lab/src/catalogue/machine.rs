//! The catalogue as JSON.

use serde::Serialize;

use crate::effects::{Effect, Form, Parameter, key_of};
use crate::rig::Coordinate;

#[derive(Serialize)]
struct Document {
    schema: &'static str,
    effects: Vec<Entry>,
}

#[derive(Serialize)]
struct Entry {
    name: &'static str,
    acts_in: &'static str,
    statement: &'static str,
    forms: Vec<Law>,
    excited_by: &'static str,
    resembles: &'static [&'static str],
    source: &'static str,
}

#[derive(Serialize)]
struct Law {
    name: &'static str,
    equation: &'static str,
    parameters: Vec<Value>,
}

#[derive(Serialize)]
struct Value {
    name: &'static str,
    meaning: &'static str,
    /// `null`: no bound.
    low: Option<f64>,
    high: Option<f64>,
    /// A convention that is chosen and not fitted.
    fixed: bool,
    linear: Spelling,
    rotary: Spelling,
}

/// How a coordinate spells a parameter.
#[derive(Serialize)]
struct Spelling {
    unit: &'static str,
    /// In a rig file.
    key: String,
}

/// The whole document, with a newline at its end.
pub fn document(effects: &[&'static dyn Effect]) -> serde_json::Result<String> {
    let effects = effects.iter().map(|effect| entry(*effect)).collect();
    Ok(serde_json::to_string_pretty(&Document { schema: "palpate.effects/1", effects })? + "\n")
}

fn entry(effect: &'static dyn Effect) -> Entry {
    let spec = effect.spec();
    Entry {
        name: spec.name,
        acts_in: spec.place.name(),
        statement: spec.statement,
        forms: spec.forms.iter().map(law).collect(),
        excited_by: spec.excited_by,
        resembles: spec.resembles,
        source: spec.source,
    }
}

fn law(form: &'static Form) -> Law {
    Law { name: form.name, equation: form.equation, parameters: form.parameters.iter().map(value).collect() }
}

fn value(parameter: &'static Parameter) -> Value {
    let bound = |value: f64| value.is_finite().then_some(value);
    let spelling =
        |coordinate: Coordinate| Spelling { unit: coordinate.pick(parameter.unit), key: key_of(parameter, coordinate) };
    Value {
        name: parameter.name,
        meaning: parameter.meaning,
        low: bound(parameter.low),
        high: bound(parameter.high),
        fixed: parameter.fixed,
        linear: spelling(Coordinate::Linear),
        rotary: spelling(Coordinate::Rotary),
    }
}
