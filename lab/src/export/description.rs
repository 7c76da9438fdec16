//! URDF and SDFormat: damping, dry friction and effort limit of a joint, which is all that they know.

use roxmltree::Node;

use super::found_effect::{FoundEffect, short};
use super::xml_edit::{self, Changes, comment};
use super::{Export, Exported, Refused, Target};
use crate::error::InputError;
use crate::rig::{Coordinate, nearest};

/// The user's model with the values in it.
///
/// # Errors
/// No such format, no such joint, or friction that the model has already.
pub fn export(export: &Export<'_>, text: &str) -> Result<Exported, InputError> {
    let place = export.args.into.display().to_string();
    let document = xml_edit::parse(&place, text)?;
    let joint = joint(export, &place, document.root_element())?;
    let (mut changes, mut refused, mut words) = (Changes::default(), Vec::new(), Vec::new());
    let mut dynamics = Vec::new();
    let mut limit = None;
    if let Some(drive) = export.rig.drive {
        words.push(format!("damping {} {}", short(drive.viscous), export.rig.coordinate.damping_unit()));
        dynamics.push(("damping", drive.viscous));
    }
    for effect in &export.effects {
        match refusal(effect, export.args.to) {
            Some(reason) => refused.push(Refused { name: effect.name, reason: reason.to_owned() }),
            None if effect.name == "effort_saturation" => {
                words.push(effect.words.clone());
                limit = Some(effect.value("limit"));
            }
            None => {
                words.push(effect.words.clone());
                dynamics.push(("friction", effect.value("level")));
            }
        }
    }
    let writer = Writer { is_sdf: export.args.to == Target::Sdf, place: &place, joint };
    writer.group(&mut changes, "dynamics", &dynamics)?;
    writer.group(&mut changes, "limit", limit.map(|limit| ("effort", limit)).as_slice())?;
    for words in words {
        changes.line_before(joint, &comment(&format!("palpate: {words}; from {}", export.source)));
    }
    Ok(Exported { text: changes.apply(text), refused, notes: Vec::new() })
}

fn refusal(effect: &FoundEffect, target: Target) -> Option<&'static str> {
    match (effect.name, effect.form) {
        ("effort_saturation", "symmetric") => None,
        ("effort_saturation", _) => Some("a joint's effort limit has a sharp corner"),
        ("coulomb_friction", "symmetric") if target == Target::Drake => Some("Drake's joints have no dry friction"),
        ("coulomb_friction", "symmetric") => None,
        ("coulomb_friction", _) => Some("a joint's friction is the same both ways"),
        _ => Some("a joint has damping, dry friction and an effort limit alone"),
    }
}

fn joint<'a>(export: &Export<'_>, place: &str, root: Node<'a, 'a>) -> Result<Node<'a, 'a>, InputError> {
    let wanted = if export.args.to == Target::Sdf { "sdf" } else { "robot" };
    if !root.has_tag_name(wanted) {
        return Err(InputError::new(place, format!("<{}>", root.tag_name().name()), format!("<{wanted}>")));
    }
    let joints: Vec<_> =
        root.descendants().filter(|node| node.has_tag_name("joint") && node.has_attribute("type")).collect();
    let names: Vec<&str> = joints.iter().filter_map(|joint| joint.attribute("name")).collect();
    let name = export.args.joint.as_str();
    let Some(joint) = joints.iter().find(|joint| joint.attribute("name") == Some(name)).copied() else {
        let near = nearest(name, &names).map_or_else(String::new, |near| format!(" (perhaps {near} is meant)"));
        let found = format!("only the joints {}", names.join(", "));
        return Err(InputError::new(format!("{place}: joint {name}"), found, format!("a joint of this name{near}")));
    };
    let kind = joint.attribute("type").unwrap_or_default();
    let is_rotary = export.rig.coordinate == Coordinate::Rotary;
    let kinds: &[&str] = if is_rotary { &["revolute", "continuous"] } else { &["prismatic"] };
    if kinds.contains(&kind) {
        return Ok(joint);
    }
    let expected =
        format!("a {} joint, as the rig's coordinate is {}", kinds.join(" or "), export.rig.coordinate.name());
    Err(InputError::new(format!("{place}: joint {name}"), format!("a {kind} joint"), expected))
}

struct Writer<'a> {
    is_sdf: bool,
    place: &'a str,
    joint: Node<'a, 'a>,
}

impl Writer<'_> {
    /// Sets `values` in `<name>`: attributes in URDF, elements in SDF.
    fn group(&self, changes: &mut Changes, name: &str, values: &[(&str, f64)]) -> Result<(), InputError> {
        if values.is_empty() {
            return Ok(());
        }
        let child = |node: Node<'_, '_>, name: &str| {
            node.children().find(|child| child.has_tag_name(name)).map(|child| child.id())
        };
        let node = |id| self.joint.document().get_node(id);
        let parent = if self.is_sdf { child(self.joint, "axis").and_then(node) } else { Some(self.joint) };
        let Some(parent) = parent else {
            return Err(InputError::new(format!("{}: joint", self.place), "no <axis>", "a joint with an axis"));
        };
        let group = child(parent, name).and_then(node);
        for (key, value) in values.iter().filter(|(key, _)| *key == "friction") {
            let before = group.and_then(|group| self.value(group, key)).unwrap_or(0.0);
            if before != 0.0 {
                let expected = format!(
                    "a joint without dry friction, where {value} is to be written: state it in the rig file as [[effect]] coulomb_friction"
                );
                return Err(InputError::new(format!("{}: joint", self.place), format!("friction {before}"), expected));
            }
        }
        match (group, self.is_sdf) {
            (Some(group), false) => {
                values.iter().for_each(|(key, value)| changes.set_attribute(group, key, &value.to_string()))
            }
            (None, false) => {
                let attributes: String = values.iter().map(|(key, value)| format!(" {key}=\"{value}\"")).collect();
                changes.append(parent, &[format!("<{name}{attributes}/>")]);
            }
            (Some(group), true) => values.iter().for_each(|(key, value)| match child(group, key).and_then(node) {
                Some(element) => changes.set_text(element, &value.to_string()),
                None => changes.append(group, &[format!("<{key}>{value}</{key}>")]),
            }),
            (None, true) => {
                let elements: String = values.iter().map(|(key, value)| format!("<{key}>{value}</{key}>")).collect();
                changes.append(parent, &[format!("<{name}>{elements}</{name}>")]);
            }
        }
        Ok(())
    }

    fn value(&self, group: Node<'_, '_>, key: &str) -> Option<f64> {
        let text = if self.is_sdf {
            group.children().find(|child| child.has_tag_name(key))?.text()
        } else {
            group.attribute(key)
        };
        text?.trim().parse().ok()
    }
}
