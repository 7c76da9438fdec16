//! A Python module that steps MuJoCo with what MJCF cannot say.

use super::found_effect::FoundEffect;
use super::mjcf_model::MjcfModel;
use super::{Export, Exported, Refused, mjcf, xml_edit};
use crate::error::InputError;

/// The part that is the same for every joint.
const STEPPER: &str = include_str!("stepper.py");

/// Effects that the stepper knows, where MJCF does not.
const KNOWN: [&str; 6] =
    ["sublinear_friction", "stribeck_friction", "load_dependent_friction", "force_gain", "force_lag", "force_bias"];

/// The module. What MJCF can say is left to it; the model is read to see that it has the joint.
///
/// # Errors
/// No MJCF, or no such joint.
pub fn export(export: &Export<'_>, text: &str) -> Result<Exported, InputError> {
    let place = export.args.into.display().to_string();
    let document = xml_edit::parse(&place, text)?;
    let model = MjcfModel::of(place, &document, &export.args.joint, export.rig.coordinate)?;
    let (mut lines, mut refused, mut notes) = (Vec::new(), Vec::new(), Vec::new());
    for effect in &export.effects {
        match mjcf::refusal(effect) {
            None => notes.push(format!("{} is left to `--to mjcf`, which can say it", effect.name)),
            Some(_) if KNOWN.contains(&effect.name) => lines.push(entry(effect)),
            Some(reason) => {
                refused.push(Refused { name: effect.name, reason: format!("not in the stepper either: {reason}") })
            }
        }
    }
    let head = format!(
        "\"\"\"Physics of joint {joint} that MJCF cannot say, for MuJoCo. Written by `palpate export --to python` from {source}.\"\"\"\n\n\
         JOINT = {joint:?}\n\n# Values, SI units.\nEFFECTS = [\n{entries}]\n\n",
        joint = model.name,
        source = export.source,
        entries = lines.concat()
    );
    Ok(Exported { text: head + STEPPER, refused, notes })
}

fn entry(effect: &FoundEffect) -> String {
    let values: Vec<String> = effect.values.iter().map(|(name, value)| format!("\"{name}\": {value:?}")).collect();
    format!("    # {}\n    (\"{}\", {{{}}}),\n", effect.words, effect.name, values.join(", "))
}
