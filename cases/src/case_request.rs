//! The request for a case; what it leaves open is drawn.

use crate::excitation::Excitation;
use crate::sensors::SensorGrade;

/// What a case conceals.
#[derive(Debug, Clone, PartialEq)]
pub enum EffectSelection {
    /// Nothing.
    Nothing,
    /// One effect of the list.
    Single {
        /// Which; any where left out.
        name: Option<String>,
        /// Its strength; log-uniform in 0.1 to 10 where left out.
        strength: Option<f64>,
    },
    /// Two effects of the list.
    Pair {
        /// Which; any where left out.
        names: Option<[String; 2]>,
        /// The strength of each.
        strength: Option<f64>,
    },
    /// One effect that the list does not hold.
    Outside {
        /// Which; any where left out.
        name: Option<String>,
        /// Its strength.
        strength: Option<f64>,
    },
}

impl EffectSelection {
    /// One effect by name, in or outside of the list.
    #[must_use]
    pub fn single(name: &str, strength: Option<f64>) -> Self {
        let listed = crate::effect::registry::find(name).is_none_or(|known| known.listed);
        let name = Some(name.to_owned());
        if listed { Self::Single { name, strength } } else { Self::Outside { name, strength } }
    }
}

/// Fixed choices; what is `None` is drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CaseRequest {
    /// What the case conceals.
    pub selection: Option<EffectSelection>,
    /// Coarse or fine sensors.
    pub sensors: Option<SensorGrade>,
    /// Rich or poor excitation.
    pub excitation: Option<Excitation>,
    /// Whether the effort is recorded.
    pub effort: Option<bool>,
    /// Radians and newton metres.
    pub rotary: Option<bool>,
    /// The tool is clamped to its environment.
    pub bilateral: Option<bool>,
    /// At the size of a bench, neither of cells nor of presses.
    pub bench: Option<bool>,
    /// The rig file's values are right.
    pub exact: Option<bool>,
}
