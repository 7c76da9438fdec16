//! What a force sensor does to a reading: its delay and the end of its range.

use super::Writer;
use crate::error::InputError;
use crate::export::found_effect::FoundEffect;

impl Writer<'_> {
    pub(super) fn delay(&mut self, effect: &FoundEffect) -> Result<(), InputError> {
        let sensor = self.model.sensor(self.export.args.sensor.as_deref())?;
        let delay = effect.value("delay");
        self.refuse_attribute(sensor, "delay")?;
        self.note_before(sensor, &effect.words);
        let samples = (delay / self.model.timestep()).ceil() as usize + 2;
        self.changes.set_attribute(sensor, "delay", &delay.to_string());
        self.changes.set_attribute(sensor, "nsample", &samples.to_string());
        self.changes.set_attribute(sensor, "interp", "linear");
        Ok(())
    }

    pub(super) fn cutoff(&mut self, effect: &FoundEffect) -> Result<(), InputError> {
        let sensor = self.model.sensor(self.export.args.sensor.as_deref())?;
        self.refuse_attribute(sensor, "cutoff")?;
        self.note_before(sensor, &effect.words);
        self.changes.set_attribute(sensor, "cutoff", &effect.value("limit").to_string());
        Ok(())
    }

    fn refuse_attribute(&self, node: roxmltree::Node<'_, '_>, attribute: &str) -> Result<(), InputError> {
        match node.attribute(attribute) {
            None => Ok(()),
            Some(value) => Err(InputError::new(
                self.model.at(node),
                format!("{attribute} {value}"),
                format!("a sensor without {attribute}"),
            )),
        }
    }
}
