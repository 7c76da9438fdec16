//! MJCF for MuJoCo 4.0: every effect that the language can say.

mod actuator;
mod sensor;
mod series_joint;

use super::found_effect::{FoundEffect, short};
use super::mjcf_model::MjcfModel;
use super::passive_force::{self, Bristles};
use super::xml_edit::{self, Changes, comment};
use super::{Export, Exported, Refused};
use crate::effects::waves;
use crate::error::InputError;

/// The user's model with the effects in it.
///
/// # Errors
/// No MJCF, no such joint, actuator or sensor, or an element that the model has already.
pub fn export(export: &Export<'_>, text: &str) -> Result<Exported, InputError> {
    let place = export.args.into.display().to_string();
    let document = xml_edit::parse(&place, text)?;
    let model = MjcfModel::of(place, &document, &export.args.joint, export.rig.coordinate)?;
    let mut writer = Writer {
        export,
        model: &model,
        changes: Changes::default(),
        passive: Vec::new(),
        refused: Vec::new(),
        notes: Vec::new(),
    };
    writer.nominal()?;
    for effect in &export.effects {
        writer.effect(effect)?;
    }
    writer.passive_actuators();
    let Writer { changes, refused, notes, .. } = writer;
    Ok(Exported { text: changes.apply(text), refused, notes })
}

/// Whether MJCF can say an effect, and why not.
pub fn refusal(effect: &FoundEffect) -> Option<&'static str> {
    Some(match (effect.name, effect.form) {
        ("coulomb_friction" | "gravity_load" | "cogging" | "backlash" | "transmission_compliance", _)
        | ("effort_lag" | "channel_delay", _)
        | ("effort_saturation", "symmetric")
        | ("stribeck_friction", "gaussian")
        | ("force_saturation", "symmetric") => return None,
        ("stribeck_friction", _) => "MuJoCo's bristles know the Gaussian decay only",
        ("sublinear_friction", _) => "MuJoCo's damping is a polynomial of the speed with whole powers",
        ("load_dependent_friction", _) => "no element makes a joint's friction depend on a contact force",
        ("effort_saturation", _) => "an actuator's limit has a sharp corner",
        ("force_saturation", _) => "a sensor's cutoff has a sharp corner",
        ("force_bias" | "force_drift" | "force_gain" | "force_lag" | "mains_hum", _) => {
            "a sensor has noise, delay and cutoff alone"
        }
        ("tool_inertia", _) => "it is mass beyond the sensor's site: move that mass in your model",
        ("parasitic_force", _) => {
            "a sensor of MuJoCo feels what acts in the model alone: model the cable, the hose or the water"
        }
        ("environment_mass", _) => "it is a body of your model that is touched: give it this mass",
        _ => "MuJoCo's contact is an impedance of the constraint solver, not a law of depth and rate",
    })
}

/// Part of the inertia by which the bodies of a model may be too heavy without a word more than a note. Chosen: nobody's bodies are known better.
const NEGLIGIBLE_INERTIA: f64 = 0.01;

struct Writer<'a> {
    export: &'a Export<'a>,
    model: &'a MjcfModel<'a>,
    changes: Changes,
    /// Elements for `<actuator>`, each with its comment.
    passive: Vec<String>,
    refused: Vec<Refused>,
    notes: Vec<String>,
}

impl Writer<'_> {
    /// The refitted viscous friction, and the inertia where it is known what it was before.
    fn nominal(&mut self) -> Result<(), InputError> {
        let Some(drive) = self.export.rig.drive else { return Ok(()) };
        let unit = self.export.rig.coordinate;
        let before = self.model.joint_number("damping");
        let words = format!("damping {} {} (before: {})", short(drive.viscous), unit.damping_unit(), short(before));
        self.note_at_joint(&words);
        // A polynomial keeps its higher powers.
        let damping = self.model.resolved(self.model.joint, "damping").unwrap_or_default();
        let rest: Vec<&str> = damping.split_whitespace().skip(1).collect();
        let value = std::iter::once(drive.viscous.to_string()).chain(rest.into_iter().map(str::to_owned));
        self.changes.set_attribute(self.model.joint, "damping", &value.collect::<Vec<_>>().join(" "));
        // With a play or a link the armature is the motor's.
        let has_link = self.export.effects.iter().any(|effect| effect.form_has("motor_share"));
        match self.export.nominal.as_ref().and_then(|rig| rig.drive).filter(|_| !has_link) {
            Some(before) => self.armature(drive.inertia, before.inertia),
            None => {
                let moved = format!("{} {}", short(drive.inertia), unit.inertia_unit());
                self.notes.push(format!(
                    "the recordings show an inertia of {moved} at joint {}; the model's bodies are left as they are (--nominal, with the \
                     rig file that was diagnosed, makes armature of what the recordings add)",
                    self.model.name
                ));
                Ok(())
            }
        }
    }

    /// What the recordings add to the inertia that the rig said, or take from it. The bodies may be those of several joints and stay as they are.
    fn armature(&mut self, fitted: f64, given: f64) -> Result<(), InputError> {
        let before = self.model.joint_number("armature");
        let after = before + fitted - given;
        let unit = self.export.rig.coordinate.inertia_unit();
        if after < 0.0 && -after < NEGLIGIBLE_INERTIA * fitted {
            self.notes.push(format!(
                "the recordings take {} {unit} away from the inertia at joint {}, more than its armature holds and less than a hundredth: \
                 it is left as it is",
                short(given - fitted),
                self.model.name
            ));
            return Ok(());
        }
        if after < 0.0 {
            let found =
                format!("armature {} {unit}, where the recordings take {} away", short(before), short(given - fitted));
            let expected = "bodies that are lighter by it: without --nominal they are left as they are";
            return Err(InputError::new(self.model.at(self.model.joint), found, expected));
        }
        self.note_at_joint(&format!(
            "armature {} {unit} (before: {}): inertia {}, given {}",
            short(after),
            short(before),
            short(fitted),
            short(given)
        ));
        self.changes.set_attribute(self.model.joint, "armature", &after.to_string());
        Ok(())
    }

    fn effect(&mut self, effect: &FoundEffect) -> Result<(), InputError> {
        if let Some(reason) = refusal(effect) {
            self.refused.push(Refused { name: effect.name, reason: reason.to_owned() });
            return Ok(());
        }
        match effect.name {
            "coulomb_friction" => self.coulomb(effect),
            "stribeck_friction" => self.stribeck(effect),
            "gravity_load" => {
                self.gravity(effect);
                Ok(())
            }
            "cogging" => {
                self.cogging(effect);
                Ok(())
            }
            "backlash" => self.play(effect),
            "transmission_compliance" => self.link(effect),
            "effort_saturation" => self.saturation(effect),
            "effort_lag" => self.lag(effect),
            "channel_delay" => self.delay(effect),
            _ => self.cutoff(effect),
        }
    }

    fn coulomb(&mut self, effect: &FoundEffect) -> Result<(), InputError> {
        let (mean, offset) = match effect.form {
            "symmetric" => (effect.value("level"), 0.0),
            _ => {
                let (forward, backward) = (effect.value("forward_level"), effect.value("backward_level"));
                (0.5 * (forward + backward), 0.5 * (forward - backward))
            }
        };
        self.refuse_dry_friction()?;
        self.note_at_joint(&effect.words);
        self.changes.set_attribute(self.model.joint, "frictionloss", &mean.to_string());
        // MuJoCo's friction creeps below a speed that grows with this time constant; two steps is the least that it takes.
        if self.model.resolved(self.model.joint, "solreffriction").is_none() {
            let constant = 2.0 * self.model.timestep();
            self.changes.set_attribute(self.model.joint, "solreffriction", &format!("{constant} 1"));
        }
        if offset != 0.0 {
            let words = format!("{}: the constant part of the asymmetry", effect.name);
            self.passive_force(&words, |joint| passive_force::constant(joint, "asymmetry", -offset));
        }
        Ok(())
    }

    /// Two dry frictions would add up.
    fn refuse_dry_friction(&self) -> Result<(), InputError> {
        let before = self.model.joint_number("frictionloss");
        if before == 0.0 {
            return Ok(());
        }
        let expected = "a joint without dry friction: state it in the rig file as [[effect]] coulomb_friction, then it is refitted, and take it from the model";
        Err(InputError::new(self.model.at(self.model.joint), format!("frictionloss {before}"), expected))
    }

    fn stribeck(&mut self, effect: &FoundEffect) -> Result<(), InputError> {
        self.refuse_dry_friction()?;
        let coulomb = effect.value("level");
        let law = Bristles {
            coulomb,
            breakaway: coulomb + effect.value("breakaway_excess"),
            stribeck_speed: effect.value("stribeck_speed"),
            inertia: self.export.rig.drive.map_or(1.0, |drive| drive.inertia),
        };
        self.passive_force(&effect.words, |joint| passive_force::bristles(joint, "friction", law));
        Ok(())
    }

    /// A load is positive against the joint.
    fn gravity(&mut self, effect: &FoundEffect) {
        let (sine, cosine, load) = (-effect.value("sine"), -effect.value("cosine"), -effect.value("load"));
        match effect.form {
            "constant" => self.passive_force(&effect.words, |joint| passive_force::constant(joint, "load", load)),
            "by_angle" => {
                self.passive_force(&effect.words, |joint| passive_force::wave(joint, "weight", 1.0, sine, cosine));
                self.passive_force(&effect.words, |joint| passive_force::constant(joint, "load", load));
            }
            _ => {
                let k = std::f64::consts::TAU / effect.value("length");
                self.passive_force(&effect.words, |joint| passive_force::wave(joint, "load", k, sine, cosine));
            }
        }
    }

    fn cogging(&mut self, effect: &FoundEffect) {
        let values: Vec<f64> = effect.values.iter().map(|(_, value)| *value).collect();
        for (at, [sine, cosine, k]) in waves(effect.form_index, &values).enumerate() {
            let name = if at == 0 { "cogging".to_owned() } else { format!("cogging_{}", at + 1) };
            self.passive_force(&effect.words, |joint| passive_force::wave(joint, &name, k, -sine, -cosine));
        }
    }

    fn passive_force(&mut self, words: &str, element: impl FnOnce(&str) -> String) {
        let line = comment(&format!("palpate: {words}; from {}", self.export.source));
        self.passive.push(line);
        self.passive.push(element(&self.model.name));
    }

    fn passive_actuators(&mut self) {
        if self.passive.is_empty() {
            return;
        }
        match self.model.root.children().rfind(|node| node.has_tag_name("actuator")) {
            Some(actuators) => self.changes.append(actuators, &self.passive),
            None => {
                let lines: Vec<String> = std::iter::once("<actuator>".to_owned())
                    .chain(self.passive.iter().map(|line| format!("  {line}")))
                    .chain(["</actuator>".to_owned()])
                    .collect();
                self.changes.append(self.model.root, &lines);
            }
        }
    }

    fn note_at_joint(&mut self, words: &str) {
        self.note_before(self.model.joint, words);
    }

    fn note_before(&mut self, node: roxmltree::Node<'_, '_>, words: &str) {
        self.changes.line_before(node, &comment(&format!("palpate: {words}; from {}", self.export.source)));
    }
}
