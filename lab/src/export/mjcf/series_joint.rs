//! What lies between motor and tool: a second joint in series with the user's.

use super::Writer;
use crate::error::InputError;
use crate::export::found_effect::{FoundEffect, short};
use crate::rig::Coordinate;

impl Writer<'_> {
    pub(super) fn play(&mut self, effect: &FoundEffect) -> Result<(), InputError> {
        let half = 0.5 * effect.value("gap");
        let rotary = self.export.rig.coordinate == Coordinate::Rotary;
        self.note_friction_beyond(effect);
        let half = if rotary { half / self.model.angle_unit() } else { half };
        // The least that MuJoCo takes: as hard as the step allows.
        let hard = 2.0 * self.model.timestep();
        self.second_joint(
            effect,
            "play",
            &format!("limited=\"true\" range=\"{} {half}\" solreflimit=\"{hard} 1\"", -half),
        )
    }

    pub(super) fn link(&mut self, effect: &FoundEffect) -> Result<(), InputError> {
        let inertia = self.export.rig.drive.map_or(1.0, |drive| drive.inertia);
        let stiffness = effect.value("link_stiffness");
        let damping = 2.0 * effect.value("damping_ratio") * (stiffness * effect.value("motor_share") * inertia).sqrt();
        self.note_friction_beyond(effect);
        self.second_joint(effect, "link", &format!("stiffness=\"{stiffness}\" damping=\"{damping}\""))
    }

    /// Says how much of the damping lies beyond the transmission `effect`: the user's joint has one, which becomes the motor's.
    fn note_friction_beyond(&mut self, effect: &FoundEffect) {
        let viscous = self.export.rig.drive.map_or(0.0, |drive| drive.viscous);
        let share = if effect.form == "friction_on_both_sides" { effect.value("friction_share") } else { 0.0 };
        if share < 1.0 {
            let beyond = short((1.0 - share) * viscous);
            self.notes.push(format!(
                "{}: {beyond} of the damping acts beyond the link; all of it is at the motor here",
                effect.name
            ));
        }
    }

    /// A joint in series with the user's, which becomes the motor's; what the motor moves by itself is its armature.
    fn second_joint(&mut self, effect: &FoundEffect, name: &str, attributes: &str) -> Result<(), InputError> {
        let joint = self.model.joint;
        let new = format!("{}_{name}", self.model.name);
        if self.model.root.descendants().any(|node| node.has_tag_name("joint") && node.attribute("name") == Some(&new))
        {
            return Err(InputError::new(
                self.model.at(joint),
                format!("the joint {new} already"),
                "a model without it",
            ));
        }
        let copied: String = ["type", "axis"]
            .into_iter()
            .filter_map(|key| Some(format!(" {key}=\"{}\"", self.model.resolved(joint, key)?)))
            .collect();
        let copied = copied + &self.series_position();
        // Nothing of the user's defaults may reach the new joint.
        let plain = "armature=\"0\" frictionloss=\"0\" ref=\"0\"";
        let damping = if attributes.contains("damping") { "" } else { " damping=\"0\"" };
        let stiffness = if attributes.contains("stiffness") { "" } else { " stiffness=\"0\"" };
        self.note_at_joint(&effect.words);
        self.changes
            .line_after(joint, &format!("<joint name=\"{new}\"{copied} {plain}{damping}{stiffness} {attributes}/>"));
        let inertia = self.export.rig.drive.map_or(0.0, |drive| drive.inertia);
        let motor = effect.value("motor_share") * inertia;
        self.changes.set_attribute(joint, "armature", &motor.to_string());
        let unit = self.export.rig.coordinate.inertia_unit();
        self.notes.push(format!(
            "{} is the motor's side now, with an armature of {} {unit}; the bodies beyond it have to hold the other {} {unit}. The tool's \
             position is {} + {new}.",
            self.model.name,
            short(motor),
            short(inertia - motor),
            self.model.name
        ));
        Ok(())
    }

    /// `pos` of a joint in series with the user's.
    ///
    /// MuJoCo 4.0 takes the inertia of a body with two slide joints along one axis of its frame for diagonal where their `pos` is zero,
    /// and the second never moves. The `pos` of a slide joint has no other meaning than where it is drawn.
    fn series_position(&self) -> String {
        let position = self.model.resolved(self.model.joint, "pos");
        let numbers = || {
            position
                .into_iter()
                .flat_map(|text| text.split_whitespace())
                .filter_map(|number| number.parse::<f64>().ok())
        };
        let is_zero = numbers().all(|number| number == 0.0);
        match position {
            _ if is_zero && self.export.rig.coordinate == Coordinate::Linear => " pos=\"0.001 0 0\"".to_owned(),
            Some(position) => format!(" pos=\"{position}\""),
            None => String::new(),
        }
    }
}
