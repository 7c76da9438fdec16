//! An answer held against what is known of its recording.

use serde::{Deserialize, Serialize};

use super::known_physics::RecordingSet;
use crate::challenge::diagnosis_json::DiagnosisJson;
use crate::challenge::scored_case::UNKNOWN;

/// Names of dry friction.
pub const DRY: [&str; 2] = ["hysteresis", "coulomb_friction"];

/// What came of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Grade {
    /// Stated physics is named, and nothing that is not known.
    Named,
    /// Nothing that is stated is named, nor anything else that is not known; the unknown is reported.
    Owned,
    /// The data do not decide, and the answer says so: an alternative to it names nothing but what is known, or dry friction is
    /// left open against damping.
    Undecidable,
    /// Something is named that is not known of it, or claimed as decided that is not.
    Wrong,
    /// Neither named nor reported as unknown.
    Missed,
}

impl Grade {
    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Named => "named",
            Self::Owned => "reported as unknown",
            Self::Undecidable => "undecidable and said so",
            Self::Wrong => "wrong",
            Self::Missed => "missed",
        }
    }
}

/// Names of the physics in the answer, each once.
#[must_use]
pub fn named(diagnosis: &DiagnosisJson) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for physics in &diagnosis.physics {
        if !names.contains(&physics.name.as_str()) {
            names.push(&physics.name);
        }
    }
    names
}

/// Names of what the answer says it cannot tell from it.
#[must_use]
pub fn alternatives(diagnosis: &DiagnosisJson) -> Vec<&str> {
    let mut names: Vec<&str> =
        diagnosis.alternatives.iter().flat_map(|rival| &rival.physics).map(String::as_str).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// Whether the answer itself says that these data do not tell dry friction from damping.
#[must_use]
pub fn leaves_friction_open(diagnosis: &DiagnosisJson) -> bool {
    alternatives(diagnosis).iter().any(|name| name.ends_with("damping"))
        || diagnosis.findings.iter().any(|finding| finding.code == "one_speed")
}

/// Names in the answer that `set` neither states nor allows.
#[must_use]
pub fn wrong<'a>(set: &RecordingSet, diagnosis: &'a DiagnosisJson) -> Vec<&'a str> {
    named(diagnosis).into_iter().filter(|name| !is_known(set, name) && *name != UNKNOWN).collect()
}

fn is_known(set: &RecordingSet, name: &str) -> bool {
    set.stated.contains(&name) || set.allowed.contains(&name)
}

/// Whether `names` hold something that is stated, and nothing that is not known.
fn is_right(set: &RecordingSet, names: &[String]) -> bool {
    names.iter().any(|name| set.stated.contains(&name.as_str()))
        && names.iter().all(|name| is_known(set, name) || name == UNKNOWN)
}

/// The grade of a diagnosis of a recording of `set`.
#[must_use]
pub fn grade(set: &RecordingSet, diagnosis: &DiagnosisJson) -> Grade {
    let (named, wrong) = (named(diagnosis), wrong(set, diagnosis));
    let claims_friction = set.friction_is_open && named.iter().any(|name| DRY.contains(name));
    match wrong.as_slice() {
        [_, ..] if diagnosis.alternatives.iter().any(|rival| is_right(set, &rival.physics)) => Grade::Undecidable,
        [_, ..] => Grade::Wrong,
        [] if claims_friction && leaves_friction_open(diagnosis) => Grade::Undecidable,
        [] if claims_friction => Grade::Wrong,
        [] if named.iter().any(|name| set.stated.contains(name)) => Grade::Named,
        [] if named.contains(&UNKNOWN) => Grade::Owned,
        [] => Grade::Missed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::recordings::known_physics::RECORDING_SETS;
    use serde_json::json;

    fn answer(named: &[&str], rivals: &[&str], finding: &str) -> DiagnosisJson {
        let physics: Vec<_> = named.iter().map(|name| json!({"name": name, "parameters": []})).collect();
        let rivals: Vec<_> =
            rivals.iter().map(|names| json!({"physics": names.split('+').collect::<Vec<_>>()})).collect();
        let fit = json!({"unit": "N", "noise_floor": 1.0, "refitted": 2.0, "improved": 1.0});
        let findings = json!([{"code": finding}]);
        let schema = crate::challenge::diagnosis_json::SCHEMA;
        let all = json!({
            "schema": schema, "verdict": "explained", "physics": physics, "rivals": rivals, "fit": fit, "findings": findings,
        });
        serde_json::from_value(all).unwrap()
    }

    #[test]
    fn each_answer_has_its_judgement() {
        let of = |folder: &str| RECORDING_SETS.iter().find(|set| set.folder == folder).unwrap();
        let (arm, piston) = (of("dfki_pendulum"), of("pneumatic_seal_friction"));
        let open = "one_speed";
        for (set, named, rivals, finding, expected) in [
            (arm, &["gravity_load", "coulomb_friction"][..], &[][..], "", Grade::Named),
            (arm, &["gravity_load", "unknown"], &[], "", Grade::Named),
            (arm, &["unknown"], &[], "", Grade::Owned),
            (arm, &[], &[], "", Grade::Missed),
            (arm, &["gravity_load", "cogging"], &[], "", Grade::Wrong),
            (arm, &["cogging"], &["gravity_load"], "", Grade::Undecidable),
            (arm, &["gravity_load", "cogging"], &["gravity_load+coulomb_friction"], "", Grade::Undecidable),
            (arm, &["gravity_load", "cogging"], &["gravity_load+backlash"], "", Grade::Wrong),
            (piston, &["hysteresis"], &[], "", Grade::Wrong),
            (piston, &["hysteresis"], &["adhesion"], "", Grade::Wrong),
            (piston, &["hysteresis"], &["quadratic_damping"], "", Grade::Undecidable),
            (piston, &["hysteresis"], &[], open, Grade::Undecidable),
            (piston, &["force_bias", "unknown"], &[], "", Grade::Owned),
            (piston, &["force_bias"], &[], "", Grade::Missed),
        ] {
            assert_eq!(grade(set, &answer(named, rivals, finding)), expected, "{named:?}");
        }
    }

    #[test]
    fn every_grade_has_its_words() {
        let all = [Grade::Named, Grade::Owned, Grade::Undecidable, Grade::Wrong, Grade::Missed];
        assert_eq!(
            all.map(Grade::words),
            ["named", "reported as unknown", "undecidable and said so", "wrong", "missed"]
        );
    }
}
