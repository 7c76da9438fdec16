//! What the actuator does to a command: its limit and its lag.

use super::Writer;
use crate::error::InputError;
use crate::export::found_effect::FoundEffect;
use crate::export::mjcf_model::FORCE_ACTUATORS;

impl Writer<'_> {
    pub(super) fn saturation(&mut self, effect: &FoundEffect) -> Result<(), InputError> {
        let actuator = self.model.actuator(self.export.args.actuator.as_deref())?;
        if let Some(range) = self.model.resolved(actuator, "forcerange") {
            let found = format!("forcerange {range}");
            return Err(InputError::new(
                self.model.at(actuator),
                found,
                "an actuator without a limit: state it in the rig file as [[effect]] effort_saturation",
            ));
        }
        let limit = effect.value("limit") / self.gear(actuator);
        self.note_before(actuator, &effect.words);
        self.changes.set_attribute(actuator, "forcerange", &format!("{} {limit}", -limit));
        self.changes.set_attribute(actuator, "forcelimited", "true");
        Ok(())
    }

    /// Force at the joint for one of the actuator.
    fn gear(&self, actuator: roxmltree::Node<'_, '_>) -> f64 {
        let gear = actuator.attribute("gear").and_then(|gear| gear.split_whitespace().next()?.parse::<f64>().ok());
        gear.filter(|gear| *gear != 0.0).map_or(1.0, f64::abs)
    }

    pub(super) fn lag(&mut self, effect: &FoundEffect) -> Result<(), InputError> {
        let actuator = self.model.actuator(self.export.args.actuator.as_deref())?;
        let kind = actuator.tag_name().name();
        let dynamics = self.model.resolved(actuator, "dyntype").filter(|kind| *kind != "none");
        if !FORCE_ACTUATORS.contains(&kind) || dynamics.is_some() {
            let found = dynamics.map_or_else(|| format!("a {kind} actuator"), |dynamics| format!("dyntype {dynamics}"));
            return Err(InputError::new(
                self.model.at(actuator),
                found,
                "a motor, or a general actuator without dynamics: the lag is one of the force",
            ));
        }
        self.note_before(actuator, &effect.words);
        if kind == "motor" {
            self.changes.rename(actuator, "general");
        }
        self.changes.set_attribute(actuator, "dyntype", "filterexact");
        self.changes.set_attribute(actuator, "dynprm", &effect.value("time_constant").to_string());
        Ok(())
    }
}
