//! The contact's law of a rig, instant by instant, for simulators that have none of its effects.

use pyo3::prelude::*;

use palpate_lab::effects::{ContactSimulator, Resolved, resolve_all};
use palpate_lab::error::InputError;

use crate::{arguments, input_error};

/// See `palpate.ContactLaw`.
#[pyclass]
pub struct ContactLaw {
    law: ContactSimulator<'static>,
    /// When the last instant was, s.
    before: Option<f64>,
}

#[pymethods]
impl ContactLaw {
    #[new]
    fn new(rig: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (rig, origin) = arguments::rig(rig)?;
        let effects = resolve_all(&rig, &origin).map_err(input_error)?;
        let Some(contact) = rig.contact else {
            return Err(input_error(InputError::new(origin, "no [contact]", "a rig that touches something")));
        };
        // The simulator borrows its values, and an object of Python can borrow nothing: some hundred bytes stay for as long as the process.
        let effects: &'static [Resolved] = Vec::leak(effects);
        let actives: Vec<_> = effects.iter().map(Resolved::active).collect();
        Ok(Self { law: ContactSimulator::new(contact, &actives), before: None })
    }

    /// The force at `time`, which must not go back.
    fn force(&mut self, time: f64, position: f64, velocity: f64, acceleration: f64) -> PyResult<f64> {
        let given = [("time", time), ("position", position), ("velocity", velocity), ("acceleration", acceleration)];
        if let Some((name, value)) = given.into_iter().find(|(_, value)| !value.is_finite()) {
            return Err(input_error(InputError::new(name, value, "a finite number")));
        }
        let before = self.before.unwrap_or(time);
        if time < before {
            return Err(input_error(InputError::new(
                "time",
                format!("{time} s after {before} s"),
                "time that goes on",
            )));
        }
        self.before = Some(time);
        Ok(self.law.step(time, time - before, position, velocity, acceleration, 0.0))
    }
}
