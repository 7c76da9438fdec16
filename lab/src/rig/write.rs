//! From a [`Rig`] to the text of a rig file. By hand: the tables keep the order in which a person reads them.

use super::coordinate::{Coordinate, Word};
use super::{Effect, Rig, words};

/// See [`Rig::to_toml`].
pub fn text(rig: &Rig) -> String {
    let mut page = Page { text: String::new(), coordinate: rig.coordinate };
    page.table(
        "rig",
        &[(words::NAME, Some(quoted(&rig.name))), (words::COORDINATE, Some(quoted(rig.coordinate.name())))],
    );
    columns(&mut page, rig);
    nominal(&mut page, rig);
    trial(&mut page, rig);
    for effect in &rig.effects {
        page.effect(effect);
    }
    page.text
}

fn columns(page: &mut Page, rig: &Rig) {
    let columns = &rig.columns;
    let name = |key, name: &Option<String>| (Word::same(key), name.as_deref().map(quoted));
    page.table(
        "columns",
        &[
            name("time", &columns.time),
            name("position", &columns.position),
            name("velocity", &columns.velocity),
            name("force", &columns.force),
            name("effort", &columns.effort),
            name("reference", &columns.reference),
            name("load", &columns.load),
        ],
    );
}

fn nominal(page: &mut Page, rig: &Rig) {
    if let Some(drive) = rig.drive {
        page.table(
            "drive",
            &[
                (words::INERTIA, number(drive.inertia)),
                (words::VISCOUS, number(drive.viscous)),
                (words::ENCODER, drive.encoder.map(|side| quoted(side.name()))),
                (words::LOAD_SCALE, Some(drive.load_scale).filter(|scale| *scale != 1.0).and_then(number)),
            ],
        );
    }
    if let Some(law) = &rig.effort {
        let column = law.input().map(|(_, column)| quoted(column));
        let constants = law.constants().map(|(key, value)| (key, value.and_then(number)));
        let rows = [(words::MODEL, Some(quoted(law.name()))), (words::COLUMN, column)];
        page.table("effort", &rows.into_iter().chain(constants).collect::<Vec<_>>());
    }
    if let Some(contact) = rig.contact {
        page.table(
            "contact",
            &[
                (words::MODEL, Some(quoted("kelvin_voigt"))),
                (words::SURFACE, number(contact.surface)),
                (words::STIFFNESS, number(contact.stiffness)),
                (words::DAMPING, number(contact.damping)),
                (words::BILATERAL, Some(contact.bilateral.to_string())),
            ],
        );
    }
    page.table(
        "sensors",
        &[
            (words::POSITION_RESOLUTION, rig.sensors.position_resolution.and_then(number)),
            (words::FORCE_RESOLUTION, rig.sensors.force_resolution.and_then(number)),
            (words::FORCE_NOISE, rig.sensors.force_noise.and_then(number)),
            (words::FORCE_ZERO, rig.sensors.force_zero.and_then(number)),
        ],
    );
}

fn trial(page: &mut Page, rig: &Rig) {
    if let Some(control) = rig.control {
        page.table(
            "control",
            &[
                (words::PROPORTIONAL, number(control.proportional)),
                (words::DERIVATIVE, number(control.derivative)),
                (words::DERIVATIVE_FILTER, control.derivative_filter_hz.and_then(number)),
                // An absent key is how the file says "no limit".
                (
                    words::EFFORT_SATURATION,
                    number(control.effort_saturation).filter(|_| control.effort_saturation.is_finite()),
                ),
                (words::RATE, number(control.rate_hz)),
            ],
        );
    }
    if let Some(reference) = rig.reference {
        page.table(
            "reference",
            &[
                (words::FREE_DEPTH, number(reference.free_depth)),
                (words::CONTACT_DEPTH, number(reference.contact_depth)),
                (words::PERIOD, number(reference.period_s)),
                (words::CONTACT_TIME, number(reference.contact_s)),
                (words::SMOOTHING, number(reference.smoothing_s)),
                (words::SINE_AMPLITUDE, number(reference.sine_amplitude)),
                (words::SINE_FREQUENCY, number(reference.sine_frequency_hz)),
            ],
        );
    }
    let simulation =
        [(words::DURATION, number(rig.simulation.duration_s)), (words::RATE, number(rig.simulation.rate_hz))];
    page.table("simulation", &simulation);
}

struct Page {
    text: String,
    coordinate: Coordinate,
}

impl Page {
    /// A table with the keys that have a value; nothing at all where none has.
    fn table(&mut self, name: &str, rows: &[(Word, Option<String>)]) {
        let lines: String = rows
            .iter()
            .filter_map(|(key, value)| Some(format!("{} = {}\n", self.coordinate.pick(*key), value.as_ref()?)))
            .collect();
        if !lines.is_empty() {
            let gap = if self.text.is_empty() { "" } else { "\n" };
            self.text += &format!("{gap}[{name}]\n{lines}");
        }
    }

    fn effect(&mut self, effect: &Effect) {
        self.text += &format!("\n[[effect]]\nname = {}\n", quoted(&effect.name));
        for (key, value) in &effect.parameters {
            // Every value on its own line: a table of its own would end this one.
            self.text += &format!("{} = {value}\n", quoted(key));
        }
    }
}

fn number(value: f64) -> Option<String> {
    // TOML wants a digit on both sides of a decimal point, and whole numbers would read back as integers.
    let text =
        if value == 0.0 || (1e-4..1e9).contains(&value.abs()) { format!("{value:?}") } else { format!("{value:e}") };
    Some(text)
}

fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}
