//! The answer of a diagnosis: the part of its JSON that is scored or tabulated, read as any user would read it.

use serde::{Deserialize, Serialize};

/// The layout that is read.
pub const SCHEMA: &str = "palpate.diagnosis/1";

/// A diagnosis, `palpate.diagnosis/1`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct DiagnosisJson {
    /// [`SCHEMA`].
    pub schema: String,
    /// In a word.
    pub verdict: String,
    /// What is named.
    pub physics: Vec<PhysicsJson>,
    /// Alternatives that these data do not distinguish from the answer.
    #[serde(rename = "rivals")]
    pub alternatives: Vec<AlternativeJson>,
    /// How well the models fit.
    pub fit: FitJson,
    /// The values of the rig file, refitted.
    #[serde(default)]
    pub nominal: Vec<NominalJson>,
    /// What the recordings themselves showed, and what limits the answer.
    #[serde(default)]
    pub findings: Vec<FindingJson>,
}

/// A finding about the recordings or the answer.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FindingJson {
    /// What it is, for programs: "one_speed".
    #[serde(default)]
    pub code: String,
    /// Whether it casts doubt on the answer.
    #[serde(default)]
    pub grave: bool,
}

/// A named effect.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct PhysicsJson {
    /// Its name, or "unknown".
    pub name: String,
    /// "contact", "drive" or "sensor"; the channel where unknown.
    #[serde(default)]
    pub acts_in: String,
    /// Why one should believe it.
    #[serde(default)]
    pub evidence: EvidenceJson,
    /// Its parameters.
    pub parameters: Vec<ParameterJson>,
}

/// Why one should believe a named effect; what is no number is `None`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct EvidenceJson {
    /// Of the power above the expected noise that the law leaves without it on rows that no fit saw, the share that it takes away.
    pub held_out_gain: Option<f64>,
    /// Probability that chance alone does as much somewhere among all effects.
    pub p_value: Option<f64>,
}

/// A value of the rig file; what is no number is `None`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct NominalJson {
    /// Key of the rig file.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// In the rig file.
    pub given: Option<f64>,
    /// Refitted, with the named physics.
    pub fitted: Option<f64>,
    /// The 95 % interval; open where a side is `None`.
    pub ci95: [Option<f64>; 2],
}

/// A parameter; what is no number is `None`.
#[derive(Debug, Clone, Serialize, Deserialize)]
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

/// Alternatives that these data do not distinguish from the answer.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct AlternativeJson {
    /// Effects.
    pub physics: Vec<String>,
}

/// Root mean squares on data that no fit saw.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FitJson {
    /// "force" or "effort".
    #[serde(default)]
    pub channel: String,
    /// "N" or "N m".
    pub unit: String,
    /// Expected noise.
    pub noise_floor: Option<f64>,
    /// The rig file as it stands.
    #[serde(default)]
    pub as_given: Option<f64>,
    /// The nominal physics, values refitted.
    pub refitted: Option<f64>,
    /// With the named physics.
    pub improved: Option<f64>,
    /// With what was learned beside it, where something was.
    #[serde(default)]
    pub learned: Option<f64>,
    /// Share of the energy above the expected noise, that refitted values leave, which the named physics takes away.
    #[serde(default)]
    pub explained_share: Option<f64>,
}

impl DiagnosisJson {
    /// Names of the answer, in its order.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.physics.iter().map(|physics| physics.name.clone()).collect()
    }

    /// Names of each alternative.
    #[must_use]
    pub fn alternative_names(&self) -> Vec<Vec<String>> {
        self.alternatives.iter().map(|alternative| alternative.physics.clone()).collect()
    }
}

impl FitJson {
    /// `rms` over the expected noise.
    #[must_use]
    pub fn over_floor(&self, rms: Option<f64>) -> Option<f64> {
        let floor = self.noise_floor.filter(|floor| *floor > 0.0)?;
        Some(rms? / floor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_residual_is_held_against_an_expected_noise_above_zero() {
        let over = |floor, rms| {
            let json = serde_json::json!({"unit": "N", "noise_floor": floor, "refitted": null, "improved": null});
            serde_json::from_value::<FitJson>(json).unwrap().over_floor(rms)
        };
        assert_eq!(over(Some(0.5), Some(2.0)), Some(4.0));
        assert_eq!([over(Some(0.0), Some(2.0)), over(None, Some(2.0)), over(Some(0.5), None)], [None; 3]);
    }
}
