//! From the text of a rig file to a [`Rig`].

use toml::de::DeTable;

use super::coordinate::{Coordinate, Word};
use super::table::{Range, Table, line_of};
use super::{Columns, Contact, Control, Drive, Effect, Reference, Rig, Sensors, Simulation, TransmissionSide, words};
use crate::error::InputError;

/// See [`Rig::parse`].
pub fn rig(text: &str, origin: &str) -> Result<Rig, InputError> {
    let entries = DeTable::parse(text).map_err(|error| not_toml(text, origin, &error))?;
    let root = Table::root(origin, text, entries.get_ref());
    let (name, coordinate) = head(&root)?;
    let table = |name| root.table(name, coordinate);
    let rig = Rig {
        name,
        coordinate,
        columns: columns(table("columns")?)?,
        drive: drive(table("drive")?)?,
        effort: super::effort_law::read(table("effort")?)?,
        contact: contact(table("contact")?)?,
        sensors: sensors(table("sensors")?)?,
        control: control(table("control")?)?,
        reference: reference(table("reference")?)?,
        simulation: simulation(table("simulation")?)?,
        effects: effects(text, origin)?,
    };
    root.know(Word::same("effect"));
    root.done()?;
    Ok(rig)
}

fn not_toml(text: &str, origin: &str, error: &toml::de::Error) -> InputError {
    let place = match error.span() {
        Some(span) => format!("{origin}:{}", line_of(text, span.start)),
        None => origin.to_owned(),
    };
    InputError::new(place, error.message().replace('\n', ", "), "a rig file in TOML")
}

fn head(root: &Table<'_>) -> Result<(String, Coordinate), InputError> {
    let table = root.table("rig", Coordinate::Linear)?;
    if !table.is_there() {
        return Err(root.missing(Word::same("rig"), "a table [rig] with name and coordinate"));
    }
    let name = table.text(words::NAME)?.ok_or_else(|| table.missing(words::NAME, "a text in quotes"))?;
    let choice = "\"linear\" or \"rotary\"";
    let coordinate = match table.text(words::COORDINATE)?.as_deref() {
        None | Some("linear") => Coordinate::Linear,
        Some("rotary") => Coordinate::Rotary,
        Some(other) => return Err(table.at(words::COORDINATE, format!("\"{other}\""), choice)),
    };
    table.done()?;
    Ok((name, coordinate))
}

fn columns(table: Table<'_>) -> Result<Columns, InputError> {
    let name = |key| table.text(Word::same(key));
    let columns = Columns {
        time: name("time")?,
        position: name("position")?,
        velocity: name("velocity")?,
        force: name("force")?,
        effort: name("effort")?,
        reference: name("reference")?,
        load: name("load")?,
    };
    table.done()?;
    Ok(columns)
}

fn drive(table: Table<'_>) -> Result<Option<Drive>, InputError> {
    if !table.is_there() {
        return Ok(None);
    }
    let drive = Drive {
        inertia: table.needed(words::INERTIA, Range::Positive)?,
        viscous: table.needed(words::VISCOUS, Range::NotNegative)?,
        encoder: encoder(&table)?,
        load_scale: table.number(words::LOAD_SCALE, Range::Positive)?.unwrap_or(1.0),
    };
    table.done()?;
    Ok(Some(drive))
}

fn encoder(table: &Table<'_>) -> Result<Option<TransmissionSide>, InputError> {
    let sides = [TransmissionSide::Motor, TransmissionSide::Load];
    let Some(given) = table.text(words::ENCODER)? else { return Ok(None) };
    let side = sides.into_iter().find(|side| side.name() == given);
    let unknown = || table.at(words::ENCODER, format!("\"{given}\""), "\"motor\" or \"load\"");
    side.ok_or_else(unknown).map(Some)
}

fn contact(table: Table<'_>) -> Result<Option<Contact>, InputError> {
    if !table.is_there() {
        return Ok(None);
    }
    if let Some(model) = table.text(words::MODEL)?.filter(|model| model != "kelvin_voigt") {
        return Err(table.at(words::MODEL, format!("\"{model}\""), "\"kelvin_voigt\""));
    }
    let contact = Contact {
        surface: table.needed(words::SURFACE, Range::Finite)?,
        stiffness: table.needed(words::STIFFNESS, Range::NotNegative)?,
        damping: table.needed(words::DAMPING, Range::NotNegative)?,
        bilateral: table.switch(words::BILATERAL)?.unwrap_or(false),
    };
    table.done()?;
    Ok(Some(contact))
}

fn sensors(table: Table<'_>) -> Result<Sensors, InputError> {
    let sensors = Sensors {
        position_resolution: table.number(words::POSITION_RESOLUTION, Range::NotNegative)?,
        force_resolution: table.number(words::FORCE_RESOLUTION, Range::NotNegative)?,
        force_noise: table.number(words::FORCE_NOISE, Range::NotNegative)?,
        force_zero: table.number(words::FORCE_ZERO, Range::Finite)?,
    };
    table.done()?;
    Ok(sensors)
}

fn control(table: Table<'_>) -> Result<Option<Control>, InputError> {
    if !table.is_there() {
        return Ok(None);
    }
    let control = Control {
        proportional: table.needed(words::PROPORTIONAL, Range::Positive)?,
        derivative: table.needed(words::DERIVATIVE, Range::NotNegative)?,
        derivative_filter_hz: table.number(words::DERIVATIVE_FILTER, Range::Positive)?,
        effort_saturation: table.number(words::EFFORT_SATURATION, Range::Positive)?.unwrap_or(f64::INFINITY),
        rate_hz: table.number(words::RATE, Range::Positive)?.unwrap_or(1000.0),
    };
    table.done()?;
    Ok(Some(control))
}

fn reference(table: Table<'_>) -> Result<Option<Reference>, InputError> {
    if !table.is_there() {
        return Ok(None);
    }
    let sine_amplitude = table.number(words::SINE_AMPLITUDE, Range::NotNegative)?.unwrap_or(0.0);
    let frequency = table.number(words::SINE_FREQUENCY, Range::NotNegative)?;
    if sine_amplitude > 0.0 && frequency.is_none() {
        return Err(table.missing(words::SINE_FREQUENCY, "the frequency of the sine whose amplitude is given"));
    }
    let reference = Reference {
        free_depth: table.needed(words::FREE_DEPTH, Range::Finite)?,
        contact_depth: table.needed(words::CONTACT_DEPTH, Range::Finite)?,
        period_s: table.needed(words::PERIOD, Range::Positive)?,
        contact_s: table.needed(words::CONTACT_TIME, Range::NotNegative)?,
        smoothing_s: table.needed(words::SMOOTHING, Range::Positive)?,
        sine_amplitude,
        sine_frequency_hz: frequency.unwrap_or(0.0),
    };
    if reference.contact_s > reference.period_s {
        let expected = format!("at most the period_s of {}", reference.period_s);
        return Err(table.at(words::CONTACT_TIME, reference.contact_s, expected));
    }
    table.done()?;
    Ok(Some(reference))
}

fn simulation(table: Table<'_>) -> Result<Simulation, InputError> {
    let usual = Simulation::default();
    let simulation = Simulation {
        duration_s: table.number(words::DURATION, Range::Positive)?.unwrap_or(usual.duration_s),
        rate_hz: table.number(words::RATE, Range::Positive)?.unwrap_or(usual.rate_hz),
    };
    table.done()?;
    Ok(simulation)
}

/// Just the effects, by serde: their keys are nobody's business here.
#[derive(serde::Deserialize)]
struct Effects {
    #[serde(default)]
    effect: Vec<toml::Spanned<toml::Table>>,
}

fn effects(text: &str, origin: &str) -> Result<Vec<Effect>, InputError> {
    let all: Effects = toml::from_str(text).map_err(|error| {
        let line = error.span().map_or(1, |span| line_of(text, span.start));
        InputError::new(format!("{origin}:{line}: effect"), error.message().replace('\n', ", "), "tables [[effect]]")
    })?;
    all.effect.into_iter().map(|entry| effect(text, origin, entry)).collect()
}

fn effect(text: &str, origin: &str, entry: toml::Spanned<toml::Table>) -> Result<Effect, InputError> {
    let line = line_of(text, entry.span().start);
    let place = |key: &str| format!("{origin}:{line}: [[effect]] {key}");
    let mut parameters = entry.into_inner();
    let name = match parameters.remove("name") {
        Some(toml::Value::String(name)) if !name.trim().is_empty() => name,
        Some(other) => return Err(InputError::new(place("name"), other, "the name of an effect in quotes")),
        None => return Err(InputError::new(place("name"), "nothing", "the name of an effect in quotes")),
    };
    match parameters.iter().find(|(_, value)| !is_finite(value)) {
        Some((key, value)) => Err(InputError::new(place(key), value, "finite numbers")),
        None => Ok(Effect { name, parameters }),
    }
}

fn is_finite(value: &toml::Value) -> bool {
    match value {
        toml::Value::Float(number) => number.is_finite(),
        toml::Value::Array(values) => values.iter().all(is_finite),
        toml::Value::Table(values) => values.values().all(is_finite),
        _ => true,
    }
}
