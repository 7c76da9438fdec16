//! The true answer of a drawn case, as it is read from the committed line.

use palpate_cases::SimulatorKind;
use palpate_cases::excitation::Excitation;
use palpate_cases::sensors::SensorGrade;
use palpate_cases::truth::CaseKind;
use serde::Deserialize;

/// The part of [`palpate_cases::Truth`] that scores need.
#[derive(Debug, Clone, Deserialize)]
pub struct DrawnAnswer {
    /// The simulator that made it.
    pub source: SimulatorKind,
    /// Seed of the run.
    pub seed: u64,
    /// Place in the whole list.
    pub index: u64,
    /// How many effects, and of which list.
    pub kind: CaseKind,
    /// What it conceals.
    pub effects: Vec<ConcealedEffect>,
    /// Strength of all effects together.
    pub strength: f64,
    /// The columns besides time.
    pub channels: Vec<String>,
    /// Coarse or fine sensors.
    pub grade: SensorGrade,
    /// Rich or poor excitation.
    #[serde(rename = "reference")]
    pub excitation: Excitation,
}

/// A concealed effect.
#[derive(Debug, Clone, Deserialize)]
pub struct ConcealedEffect {
    /// By the list, or a name of its own outside of it.
    pub name: String,
    /// Its values.
    pub parameters: Vec<ConcealedParameter>,
    /// The strength that was asked for.
    pub strength_asked: f64,
}

/// A true value.
#[derive(Debug, Clone, Deserialize)]
pub struct ConcealedParameter {
    /// What it is.
    pub name: String,
    /// In the units of the case.
    pub value: f64,
    /// Such as "N s/m^2".
    pub unit: String,
}
