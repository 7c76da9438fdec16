//! The free values of a rig: what a refit may move.

use crate::effects::{Resolved, key_of};
use crate::rig::Rig;

/// Relative step of a finite difference.
const RELATIVE_STEP: f64 = 1e-2;

/// Share of the natural size of a value below which its step does not fall.
const LEAST_STEP: f64 = 1e-3;

/// One free value of a rig.
#[derive(Debug, Clone, PartialEq)]
pub enum Parameter {
    /// Contact stiffness.
    Stiffness,
    /// Contact damping.
    Damping,
    /// Where the contact begins.
    Surface,
    /// Moving inertia.
    Inertia,
    /// Viscous friction.
    Viscous,
    /// A value of an effect.
    OfEffect {
        /// Place of the effect in the rig.
        effect: usize,
        /// Key in its table.
        key: String,
        /// Its name.
        name: &'static str,
        /// Least value that is physical.
        low: f64,
        /// Greatest value that is physical.
        high: f64,
    },
}

/// Every free value of `rig`: the nominal ones of what it has, and those of its effects that are fitted.
#[must_use]
pub fn of(rig: &Rig) -> Vec<Parameter> {
    let mut all = Vec::new();
    if rig.contact.is_some() {
        all.extend([Parameter::Stiffness, Parameter::Damping, Parameter::Surface]);
    }
    if rig.drive.is_some() {
        all.extend([Parameter::Inertia, Parameter::Viscous]);
    }
    for (at, table) in rig.effects.iter().enumerate() {
        let Ok(resolved) = Resolved::read(table, rig.coordinate, "the rig") else { continue };
        let parameters = resolved.effect.spec().forms[resolved.form].parameters;
        all.extend(parameters.iter().filter(|parameter| !parameter.fixed).map(|parameter| Parameter::OfEffect {
            effect: at,
            key: key_of(parameter, rig.coordinate),
            name: parameter.name,
            low: parameter.low,
            high: parameter.high,
        }));
    }
    all
}

impl Parameter {
    /// Its value in `rig`.
    #[must_use]
    pub fn get(&self, rig: &Rig) -> Option<f64> {
        match self {
            Self::Stiffness => rig.contact.map(|contact| contact.stiffness),
            Self::Damping => rig.contact.map(|contact| contact.damping),
            Self::Surface => rig.contact.map(|contact| contact.surface),
            Self::Inertia => rig.drive.map(|drive| drive.inertia),
            Self::Viscous => rig.drive.map(|drive| drive.viscous),
            Self::OfEffect { effect, key, .. } => {
                let value = rig.effects.get(*effect)?.parameters.get(key)?;
                value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
            }
        }
    }

    /// `rig` with this value, held within its physical bounds.
    #[must_use]
    pub fn set(&self, rig: &Rig, value: f64) -> Rig {
        let mut rig = rig.clone();
        match self {
            Self::Stiffness => rig.contact.iter_mut().for_each(|contact| contact.stiffness = value.max(0.0)),
            Self::Damping => rig.contact.iter_mut().for_each(|contact| contact.damping = value.max(0.0)),
            Self::Surface => rig.contact.iter_mut().for_each(|contact| contact.surface = value),
            Self::Inertia => rig.drive.iter_mut().for_each(|drive| drive.inertia = value.max(f64::MIN_POSITIVE)),
            Self::Viscous => rig.drive.iter_mut().for_each(|drive| drive.viscous = value.max(0.0)),
            Self::OfEffect { effect, key, low, high, .. } => {
                if let Some(table) = rig.effects.get_mut(*effect) {
                    table.parameters.insert(key.clone(), value.clamp(*low, *high).into());
                }
            }
        }
        rig
    }

    /// A step for a finite difference; `travel` is the way of the motion. It goes towards larger values, or smaller ones where
    /// a bound is in the way.
    #[must_use]
    pub fn step(&self, rig: &Rig, travel: f64) -> Option<f64> {
        let value = self.get(rig)?;
        let contact = rig.contact.map_or(1.0, |contact| contact.stiffness);
        let size = match self {
            Self::Surface => return Some(LEAST_STEP * travel),
            Self::Damping => LEAST_STEP * contact,
            Self::Viscous => rig.drive.map_or(0.0, |drive| drive.inertia),
            _ => 0.0,
        };
        let step = (RELATIVE_STEP * value.abs()).max(LEAST_STEP * size);
        let high = if let Self::OfEffect { high, .. } = self { *high } else { f64::INFINITY };
        (step > 0.0).then_some(if value + step > high { -step } else { step })
    }

    /// Its name, as reports write it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Stiffness => "stiffness",
            Self::Damping => "damping",
            Self::Surface => "surface",
            Self::Inertia => "inertia",
            Self::Viscous => "viscous",
            Self::OfEffect { name, .. } => name,
        }
    }
}
