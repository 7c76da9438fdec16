//! A row of the table: one value of one rig.

use serde::Deserialize;

use super::worker::RigResult;
use crate::challenge::diagnosis_json::{DiagnosisJson, NominalJson, ParameterJson, PhysicsJson};

/// What stands in the column `effect` where the value is one of the rig file.
pub const NOMINAL: &str = "nominal";

/// A value of a rig, beside what holds for the whole rig. A rig without a value has one row without one.
///
/// Columns of the same name hold it in the table; text is empty and a number `None` where there is none.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct Row {
    /// Name of the rig.
    pub rig: String,
    /// Verdict of its diagnosis; empty where that failed.
    pub verdict: String,
    /// Effects that are named, in order of evidence.
    pub effects: String,
    /// Alternatives that the recordings do not distinguish from the answer.
    pub alternatives: String,
    /// The channel of the residuals: "force" or "effort".
    pub channel: String,
    /// Unit of the residuals: "N" or "N m".
    pub residual_unit: String,
    /// The residual that the sensors alone would leave, RMS.
    pub expected_noise: Option<f64>,
    /// That of the rig file as it stands, on data that no fit saw, RMS.
    pub residual_as_given: Option<f64>,
    /// With refitted values.
    pub residual_refitted: Option<f64>,
    /// With the named physics.
    pub residual_improved: Option<f64>,
    /// Share of the energy above the expected noise, that refitted values leave, which the named physics takes away.
    pub explained_share: Option<f64>,
    /// `residual_improved` over `expected_noise`.
    pub residual_over_noise: Option<f64>,
    /// Findings that cast doubt on the answer.
    pub grave_findings: Option<f64>,
    /// Why there is no diagnosis.
    pub error: String,
    /// One SHA-256 over rig file, recordings and seed.
    pub inputs_sha256: String,
    /// The effect that the value belongs to; [`NOMINAL`] where it is one of the rig file.
    pub effect: String,
    /// "contact", "drive" or "sensor".
    pub acts_in: String,
    /// Held-out gain of the effect.
    pub held_out_gain: Option<f64>,
    /// p-value of the effect.
    pub p_value: Option<f64>,
    /// Name of the value.
    pub parameter: String,
    /// Its unit.
    pub unit: String,
    /// What the rig file states, of its own values.
    pub given: Option<f64>,
    /// The estimate.
    pub value: Option<f64>,
    /// Lower end of the 95 % interval.
    pub ci95_low: Option<f64>,
    /// Upper end.
    pub ci95_high: Option<f64>,
}

impl Row {
    /// The rows of one rig: the values of its effects in order of evidence, then those of its rig file.
    #[must_use]
    pub fn all_of(result: &RigResult) -> Vec<Self> {
        let rig = Self { rig: result.name.clone(), inputs_sha256: result.inputs_sha256.clone(), ..Self::default() };
        let diagnosis = match &result.diagnosis {
            Ok(diagnosis) => diagnosis,
            Err(error) => return vec![Self { error: error.clone(), ..rig }],
        };
        let rig = rig.with_diagnosis(diagnosis);
        let mut rows: Vec<Self> = diagnosis.physics.iter().flat_map(|physics| rig.of_effect(physics)).collect();
        rows.extend(diagnosis.nominal.iter().map(|value| rig.of_nominal(value)));
        if rows.is_empty() { vec![rig] } else { rows }
    }

    fn with_diagnosis(self, diagnosis: &DiagnosisJson) -> Self {
        let fit = &diagnosis.fit;
        let alternatives = diagnosis.alternative_names().iter().map(|names| names.join(" + ")).collect::<Vec<_>>();
        Self {
            verdict: diagnosis.verdict.clone(),
            effects: diagnosis.names().join("; "),
            alternatives: alternatives.join("; "),
            channel: fit.channel.clone(),
            residual_unit: fit.unit.clone(),
            expected_noise: fit.noise_floor,
            residual_as_given: fit.as_given,
            residual_refitted: fit.refitted,
            residual_improved: fit.improved,
            explained_share: fit.explained_share,
            residual_over_noise: fit.over_floor(fit.improved),
            grave_findings: Some(diagnosis.findings.iter().filter(|finding| finding.grave).count() as f64),
            ..self
        }
    }

    fn of_effect(&self, physics: &PhysicsJson) -> Vec<Self> {
        let effect = Self {
            effect: physics.name.clone(),
            acts_in: physics.acts_in.clone(),
            held_out_gain: physics.evidence.held_out_gain,
            p_value: physics.evidence.p_value,
            ..self.clone()
        };
        let of_value = |value: &ParameterJson| Self {
            parameter: value.name.clone(),
            unit: value.unit.clone(),
            value: value.value,
            ci95_low: value.ci95[0],
            ci95_high: value.ci95[1],
            ..effect.clone()
        };
        if physics.parameters.is_empty() { vec![effect] } else { physics.parameters.iter().map(of_value).collect() }
    }

    fn of_nominal(&self, value: &NominalJson) -> Self {
        Self {
            effect: NOMINAL.to_owned(),
            parameter: value.name.clone(),
            unit: value.unit.clone(),
            given: value.given,
            value: value.fitted,
            ci95_low: value.ci95[0],
            ci95_high: value.ci95[1],
            ..self.clone()
        }
    }
}
