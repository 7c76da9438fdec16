//! An effect of the improved rig with its values by name, and in words.

use crate::effects::{self, Place, Resolved, Stage, interval_key};
use crate::error::InputError;
use crate::rig::{self, Rig};

/// An effect with its values.
pub struct FoundEffect {
    /// "coulomb_friction".
    pub name: &'static str,
    /// Contact, drive or sensor.
    pub place: Place,
    /// When it acts among others of its place.
    pub stage: Stage,
    /// "symmetric"; the law's name.
    pub form: &'static str,
    /// Its place among the effect's forms.
    pub form_index: usize,
    /// By the parameter's name.
    pub values: Vec<(&'static str, f64)>,
    /// "coulomb_friction (symmetric): level 0.45 N (95 %: 0.44 to 0.46)".
    pub words: String,
}

impl FoundEffect {
    /// The value of a parameter of its form; not a number for one that the form does not have.
    pub fn value(&self, parameter: &str) -> f64 {
        self.values.iter().find(|(name, _)| *name == parameter).map_or(f64::NAN, |(_, value)| *value)
    }

    /// Whether its form has that parameter.
    pub fn form_has(&self, parameter: &str) -> bool {
        self.values.iter().any(|(name, _)| *name == parameter)
    }
}

/// The effects of `rig`.
///
/// # Errors
/// An effect that is unknown or lacks a value.
pub fn all(rig: &Rig, origin: &str) -> Result<Vec<FoundEffect>, InputError> {
    let resolved = effects::resolve_all(rig, origin)?;
    Ok(resolved.iter().zip(&rig.effects).map(|(resolved, table)| found(rig, resolved, table)).collect())
}

fn found(rig: &Rig, resolved: &Resolved, table: &rig::Effect) -> FoundEffect {
    let spec = resolved.effect.spec();
    let form = &spec.forms[resolved.form];
    let values = form.parameters.iter().map(|parameter| parameter.name).zip(resolved.values.iter().copied()).collect();
    let word = |(parameter, value): (&effects::Parameter, &f64)| {
        let unit = rig.coordinate.pick(parameter.unit);
        let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
        let ends = table.parameters.get(&interval_key(parameter, rig.coordinate)).and_then(toml::Value::as_array);
        let interval = ends.and_then(|ends| Some((ends.first()?.as_float()?, ends.get(1)?.as_float()?)));
        let interval =
            interval.map_or_else(String::new, |(low, high)| format!(" (95 %: {} to {})", short(low), short(high)));
        format!("{} {}{unit}{interval}", parameter.name, short(*value))
    };
    let parameters: Vec<String> = form.parameters.iter().zip(&resolved.values).map(word).collect();
    FoundEffect {
        name: spec.name,
        place: spec.place,
        stage: spec.stage,
        form: form.name,
        form_index: resolved.form,
        values,
        words: format!("{} ({}): {}", spec.name, form.name, parameters.join(", ")),
    }
}

/// Five significant digits, for a person.
pub fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = 4 - value.abs().log10().floor() as i32;
    if (0..12).contains(&digits) { format!("{value:.*}", digits as usize) } else { format!("{value:.4e}") }
}
