//! A Python module that steps MuJoCo with what MJCF cannot say.

use super::found_effect::FoundEffect;
use super::mjcf_model::MjcfModel;
use super::{Export, Exported, Refused, mjcf, xml_edit};
use crate::effects::Place;
use crate::error::InputError;
use crate::rig::{Contact, Rig};

/// The part that is the same for every joint.
const STEPPER: &str = include_str!("stepper.py");

/// Friction and effects of the sensor that the stepper has laws for. A contact's laws it asks the package `palpate` for.
const KNOWN: [&str; 11] = [
    "sublinear_friction",
    "stribeck_friction",
    "load_dependent_friction",
    "tool_inertia",
    "parasitic_force",
    "force_gain",
    "force_lag",
    "force_bias",
    "force_drift",
    "mains_hum",
    "force_saturation",
];

/// The module. What MJCF can say is left to it; the model is read to see that it has the joint.
///
/// # Errors
/// No MJCF, or no such joint.
pub fn export(export: &Export<'_>, text: &str) -> Result<Exported, InputError> {
    let place = export.args.into.display().to_string();
    let document = xml_edit::parse(&place, text)?;
    let model = MjcfModel::of(place, &document, &export.args.joint, export.rig.coordinate)?;
    let (mut stepped, mut refused, mut notes) = (Vec::new(), Vec::new(), Vec::new());
    for effect in &export.effects {
        match mjcf::refusal(effect) {
            None => notes.push(format!("{} is left to `--to mjcf`, which can say it", effect.name)),
            Some(_) if is_known(effect) => stepped.push(effect),
            Some(reason) => {
                refused.push(Refused { name: effect.name, reason: format!("not in the stepper either: {reason}") })
            }
        }
    }
    if stepped.iter().any(|effect| effect.name == "load_dependent_friction") {
        stepped.extend(export.effects.iter().filter(|effect| effect.name == "gravity_load"));
    }
    // A sensor's lag comes before its zero, and its zero before the end of its range.
    stepped.sort_by_key(|effect| effect.stage);
    let contact = stepped.iter().any(|effect| effect.place == Place::Contact);
    let contact = export.rig.contact.filter(|_| contact).map(|contact| contact_tables(export.rig, contact, &stepped));
    if contact.is_some() {
        notes.push("the module imports palpate, whose own engine has the contact's law; `Stepper(surface=...)` switches off the \
                    model's own contact with the geom of that name"
            .to_owned());
    }
    let entries: Vec<String> = stepped.iter().map(|effect| entry(effect)).collect();
    let head = format!(
        "\"\"\"Physics of joint {joint} that MJCF cannot say, for MuJoCo. Written by `palpate export --to python` from {source}.\"\"\"\n\n\
         JOINT = {joint:?}\n\n# Effect, form and values in SI units, in the order in which they act.\nEFFECTS = [\n{entries}]\n\n\
         # The contact as a rig file says it; None: the model's own.\nCONTACT = {contact}\n\n",
        joint = model.name,
        source = export.source,
        entries = entries.concat(),
        contact = contact.map_or_else(|| "None".to_owned(), |tables| format!("\"\"\"\n{tables}\"\"\"")),
    );
    Ok(Exported { text: head + STEPPER, refused, notes })
}

fn is_known(effect: &FoundEffect) -> bool {
    match effect.place {
        // A body that is carried along is one of the user's model, not a force.
        Place::Contact => effect.name != "environment_mass",
        Place::Drive | Place::Sensor => KNOWN.contains(&effect.name),
    }
}

/// A rig file of the contact alone, with its effects.
fn contact_tables(rig: &Rig, contact: Contact, stepped: &[&FoundEffect]) -> String {
    let acts = |name: &str| stepped.iter().any(|effect| effect.place == Place::Contact && effect.name == name);
    let effects = rig.effects.iter().filter(|table| acts(&table.name)).cloned();
    let alone = Rig {
        name: "contact".to_owned(),
        coordinate: rig.coordinate,
        contact: Some(contact),
        effects: effects.collect(),
        ..Rig::default()
    };
    alone.to_toml()
}

fn entry(effect: &FoundEffect) -> String {
    let values: Vec<String> = effect.values.iter().map(|(name, value)| format!("\"{name}\": {value:?}")).collect();
    format!("    # {}\n    (\"{}\", \"{}\", {{{}}}),\n", effect.words, effect.name, effect.form, values.join(", "))
}
