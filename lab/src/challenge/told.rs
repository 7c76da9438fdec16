//! What the diagnosis told: the part of its JSON that is scored, read as anybody would read it.

use serde::Deserialize;

/// A diagnosis, `palpate.diagnosis/1`.
#[derive(Debug, Clone, Deserialize)]
pub struct Told {
    /// In a word.
    pub verdict: String,
    /// What is named.
    pub physics: Vec<Physics>,
    /// What the data do not tell from it.
    pub rivals: Vec<Rival>,
    /// How well the models fit.
    pub fit: Fit,
    /// What the recordings themselves showed, and what limits the answer.
    #[serde(default)]
    pub findings: Vec<Finding>,
}

/// Something to know.
#[derive(Debug, Clone, Deserialize)]
pub struct Finding {
    /// In words.
    pub text: String,
}

/// A named effect.
#[derive(Debug, Clone, Deserialize)]
pub struct Physics {
    /// Its name, or "unknown".
    pub name: String,
    /// Its parameters.
    pub parameters: Vec<Value>,
}

/// A parameter; what is no number is `None`.
#[derive(Debug, Clone, Deserialize)]
pub struct Value {
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
pub struct Rival {
    /// Effects.
    pub physics: Vec<String>,
}

/// Root mean squares on data that no fit saw.
#[derive(Debug, Clone, Deserialize)]
pub struct Fit {
    /// "N" or "N m".
    pub unit: String,
    /// What the sensors leave.
    pub noise_floor: Option<f64>,
    /// The nominal physics, values refitted.
    pub refitted: Option<f64>,
    /// With the named physics.
    pub improved: Option<f64>,
}

impl Fit {
    /// `rms` over the floor.
    #[must_use]
    pub fn over_floor(&self, rms: Option<f64>) -> Option<f64> {
        let floor = self.noise_floor.filter(|floor| *floor > 0.0)?;
        Some(rms? / floor)
    }
}
