//! An answer held against what is known of its recording.

use serde::{Deserialize, Serialize};

use super::known::Set;
use crate::challenge::row::UNKNOWN;
use crate::challenge::told::Told;

/// Names of dry friction.
pub const DRY: [&str; 2] = ["hysteresis", "coulomb_friction"];

/// What came of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Judgement {
    /// Stated physics is named, and nothing that is not known.
    Named,
    /// Nothing that is stated is named, nor anything else that is not known; the unknown is owned.
    Owned,
    /// The data do not decide, and the answer says so: a rival of it names nothing but what is known, or dry friction is
    /// left open against damping.
    Undecidable,
    /// Something is named that is not known of it, or claimed as decided that is not.
    Wrong,
    /// Neither named nor owned.
    Missed,
}

impl Judgement {
    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Named => "named",
            Self::Owned => "owned",
            Self::Undecidable => "undecidable and said so",
            Self::Wrong => "wrong",
            Self::Missed => "missed",
        }
    }
}

/// Names of the physics in the answer, each once.
#[must_use]
pub fn named(told: &Told) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for physics in &told.physics {
        if !names.contains(&physics.name.as_str()) {
            names.push(&physics.name);
        }
    }
    names
}

/// Names of what the answer says it cannot tell from it.
#[must_use]
pub fn rivals(told: &Told) -> Vec<&str> {
    let mut names: Vec<&str> = told.rivals.iter().flat_map(|rival| &rival.physics).map(String::as_str).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// Whether the answer itself says that these data do not tell dry friction from damping.
#[must_use]
pub fn leaves_friction_open(told: &Told) -> bool {
    let says = |text: &str| text.contains("cannot be told from hysteresis") || text.contains("from dry friction");
    rivals(told).iter().any(|name| name.ends_with("damping")) || told.findings.iter().any(|finding| says(&finding.text))
}

/// Names in the answer that `set` neither states nor allows.
#[must_use]
pub fn wrong<'a>(set: &Set, told: &'a Told) -> Vec<&'a str> {
    named(told).into_iter().filter(|name| !is_known(set, name) && *name != UNKNOWN).collect()
}

fn is_known(set: &Set, name: &str) -> bool {
    set.has.contains(&name) || set.may.contains(&name)
}

/// Whether `names` hold something that is stated, and nothing that is not known.
fn is_right(set: &Set, names: &[String]) -> bool {
    names.iter().any(|name| set.has.contains(&name.as_str()))
        && names.iter().all(|name| is_known(set, name) || name == UNKNOWN)
}

/// What came of the answer `told` on a recording of `set`.
#[must_use]
pub fn judge(set: &Set, told: &Told) -> Judgement {
    let (named, wrong) = (named(told), wrong(set, told));
    let claims_friction = set.friction_is_open && named.iter().any(|name| DRY.contains(name));
    match wrong.as_slice() {
        _ if named.is_empty() => Judgement::Missed,
        [_, ..] if told.rivals.iter().any(|rival| is_right(set, &rival.physics)) => Judgement::Undecidable,
        [_, ..] => Judgement::Wrong,
        [] if claims_friction && leaves_friction_open(told) => Judgement::Undecidable,
        [] if claims_friction => Judgement::Wrong,
        [] if named.iter().any(|name| set.has.contains(name)) => Judgement::Named,
        [] if named.contains(&UNKNOWN) => Judgement::Owned,
        [] => Judgement::Missed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::recorded::known::SETS;
    use serde_json::json;

    fn told(named: &[&str], rivals: &[&str], finding: &str) -> Told {
        let physics: Vec<_> = named.iter().map(|name| json!({"name": name, "parameters": []})).collect();
        let rivals: Vec<_> =
            rivals.iter().map(|names| json!({"physics": names.split('+').collect::<Vec<_>>()})).collect();
        let fit = json!({"unit": "N", "noise_floor": 1.0, "refitted": 2.0, "improved": 1.0});
        let findings = json!([{"text": finding}]);
        let all =
            json!({"verdict": "explained", "physics": physics, "rivals": rivals, "fit": fit, "findings": findings});
        serde_json::from_value(all).unwrap()
    }

    #[test]
    fn each_answer_has_its_judgement() {
        let of = |folder: &str| SETS.iter().find(|set| set.folder == folder).unwrap();
        let (arm, piston) = (of("dfki_pendulum"), of("pneumatic_seal_friction"));
        let open = "damping cannot be told from hysteresis at one speed";
        for (set, named, rivals, finding, expected) in [
            (arm, &["gravity_load", "coulomb_friction"][..], &[][..], "", Judgement::Named),
            (arm, &["gravity_load", "unknown"], &[], "", Judgement::Named),
            (arm, &["unknown"], &[], "", Judgement::Owned),
            (arm, &[], &[], "", Judgement::Missed),
            (arm, &["gravity_load", "cogging"], &[], "", Judgement::Wrong),
            (arm, &["cogging"], &["gravity_load"], "", Judgement::Undecidable),
            (arm, &["gravity_load", "cogging"], &["gravity_load+coulomb_friction"], "", Judgement::Undecidable),
            (arm, &["gravity_load", "cogging"], &["gravity_load+backlash"], "", Judgement::Wrong),
            (piston, &["hysteresis"], &[], "", Judgement::Wrong),
            (piston, &["hysteresis"], &["adhesion"], "", Judgement::Wrong),
            (piston, &["hysteresis"], &["quadratic_damping"], "", Judgement::Undecidable),
            (piston, &["hysteresis"], &[], open, Judgement::Undecidable),
            (piston, &["force_bias", "unknown"], &[], "", Judgement::Owned),
            (piston, &["force_bias"], &[], "", Judgement::Missed),
        ] {
            assert_eq!(judge(set, &told(named, rivals, finding)), expected, "{named:?}");
        }
    }
}
