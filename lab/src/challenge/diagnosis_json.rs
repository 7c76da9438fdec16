//! What the diagnosis diagnosis: the part of its JSON that is scored, read as anybody would read it.

use serde::Deserialize;

/// A diagnosis, `palpate.diagnosis/1`.
#[derive(Debug, Clone, Deserialize)]
pub struct DiagnosisJson {
    /// In a word.
    pub verdict: String,
    /// What is named.
    pub physics: Vec<PhysicsJson>,
    /// What the data do not tell from it.
    #[serde(rename = "rivals")]
    pub alternatives: Vec<AlternativeJson>,
    /// How well the models fit.
    pub fit: FitJson,
    /// What the recordings themselves showed, and what limits the answer.
    #[serde(default)]
    pub findings: Vec<FindingJson>,
}

/// Something to know.
#[derive(Debug, Clone, Deserialize)]
pub struct FindingJson {
    /// What it is, for programs: "one_speed".
    #[serde(default)]
    pub code: String,
}

/// A named effect.
#[derive(Debug, Clone, Deserialize)]
pub struct PhysicsJson {
    /// Its name, or "unknown".
    pub name: String,
    /// Its parameters.
    pub parameters: Vec<ParameterJson>,
}

/// A parameter; what is no number is `None`.
#[derive(Debug, Clone, Deserialize)]
pub struct ParameterJson {
    /// Its name.
    pub name: String,
    /// The estimate.
    pub value: Option<f64>,
    /// Its unit.
    pub unit: String,
    /// The 95 % interval; open where a side is `None`.
    pub ci95: [Option<f64>; 2],
}

/// What the data do not tell from the answer.
#[derive(Debug, Clone, Deserialize)]
pub struct AlternativeJson {
    /// Effects.
    pub physics: Vec<String>,
}

/// Root mean squares on data that no fit saw.
#[derive(Debug, Clone, Deserialize)]
pub struct FitJson {
    /// "N" or "N m".
    pub unit: String,
    /// What the sensors leave.
    pub noise_floor: Option<f64>,
    /// The nominal physics, values refitted.
    pub refitted: Option<f64>,
    /// With the named physics.
    pub improved: Option<f64>,
}

impl FitJson {
    /// `rms` over the floor.
    #[must_use]
    pub fn over_floor(&self, rms: Option<f64>) -> Option<f64> {
        let floor = self.noise_floor.filter(|floor| *floor > 0.0)?;
        Some(rms? / floor)
    }
}
