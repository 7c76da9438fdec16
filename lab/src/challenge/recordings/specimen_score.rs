//! What came of the real recordings.

use crate::page::effect_name::effect_name;
use serde::{Deserialize, Serialize};

use super::grade::{self, Grade};
use super::specimen::{Specimen, names};
use crate::challenge::diagnosis_json::DiagnosisJson;
use crate::challenge::scored_case::UNKNOWN;
use crate::challenge::statistics::median;

/// All specimens, and how many came out how.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RecordingScores {
    /// Specimens.
    pub n: usize,
    /// Stated physics is named, and nothing that is not known.
    pub named: usize,
    /// Of these, the unknown is reported beside it.
    pub rest_owned: usize,
    /// Nothing that is stated is named, nor anything that is not known; the unknown is reported.
    pub owned: usize,
    /// The data do not decide, and the answer says so.
    pub undecidable: usize,
    /// Something is named that is not known, or claimed as decided that is not.
    pub wrong: usize,
    /// Nothing that is stated is named, and no unknown reported.
    pub missed: usize,
    /// Specimens with held-out trials, or held-out stretches.
    pub held_back: usize,
    /// On these, the residual of the improved model over that of the refitted nominal law, median.
    pub left_median: f64,
    /// On so many of these it is smaller.
    pub better: usize,
    /// On so many it is less than half.
    #[serde(default)]
    pub halved: Option<usize>,
    /// Every specimen.
    pub rows: Vec<SpecimenScore>,
}

/// One specimen, scored.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SpecimenScore {
    /// "tissue_indentation/meat_FF".
    pub recording: String,
    /// What is known of it, in a few words.
    #[serde(rename = "says")]
    pub description: String,
    /// Effects that are known of it.
    pub known: Vec<String>,
    /// Names that are right as well.
    #[serde(rename = "may")]
    pub allowed: Vec<String>,
    /// The verdict, in its word.
    pub verdict: Option<String>,
    /// The answer.
    pub named: Vec<String>,
    /// What the answer says that the data do not tell from it.
    #[serde(rename = "rivals")]
    pub alternatives: Vec<String>,
    /// Known effects that are not named.
    pub missing: Vec<String>,
    /// Named without being known.
    pub wrong: Vec<String>,
    /// What came of it.
    #[serde(rename = "judgement")]
    pub grade: Grade,
    /// Whether these data cannot tell dry friction from damping, and the answer says so.
    #[serde(default)]
    pub leaves_friction_open: bool,
    /// "N" or "N m".
    pub unit: String,
    /// What the sensors leave, by the diagnosis.
    #[serde(rename = "floor")]
    pub noise_rms: Option<f64>,
    /// Stretches of the training trials, each predicted by the others, as the diagnosis reports it.
    #[serde(rename = "stretches")]
    pub cross_validated: ResidualPair,
    /// Trials that no diagnosis saw, nothing fitted but what belongs to a trial; none where the specimen cannot be parted.
    #[serde(rename = "unseen")]
    pub held_out: Option<ResidualPair>,
    /// Training files.
    #[serde(rename = "taught")]
    pub training: Vec<String>,
    /// Files, or parts of files, that were kept back and scored.
    pub scored: Vec<String>,
    /// Why none was kept back.
    #[serde(rename = "whole")]
    pub no_split_reason: Option<String>,
    /// From the command's start to its end.
    pub seconds: f64,
    /// Why there is no answer, or no score of the trials kept back.
    pub failure: Option<String>,
}

/// Root mean squares.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ResidualPair {
    /// The nominal law, its values refitted.
    pub before: Option<f64>,
    /// With the named physics, and what was learned beside it.
    pub after: Option<f64>,
}

impl SpecimenScore {
    /// Compares the diagnosis of `entry`, or why there is none, with what is known of it.
    #[must_use]
    pub fn score(entry: &Specimen, diagnosis: Result<&DiagnosisJson, &str>, seconds: f64) -> Self {
        let own = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let set = entry.set;
        let mut row = Self {
            recording: entry.name.clone(),
            description: set.description.to_owned(),
            known: own(set.stated),
            allowed: own(set.allowed),
            verdict: None,
            named: Vec::new(),
            alternatives: Vec::new(),
            missing: own(set.stated),
            wrong: Vec::new(),
            grade: Grade::Missed,
            leaves_friction_open: false,
            unit: entry.rig.coordinate.force_unit().to_owned(),
            noise_rms: None,
            cross_validated: ResidualPair::default(),
            held_out: None,
            training: own(&names(&entry.training)),
            scored: own(&names(&entry.held_out)),
            no_split_reason: entry.no_split_reason.map(str::to_owned),
            seconds,
            failure: None,
        };
        match diagnosis {
            Err(failure) => row.failure = Some(failure.to_owned()),
            Ok(diagnosis) => {
                row.named = own(&grade::named(diagnosis));
                row.alternatives = own(&grade::alternatives(diagnosis));
                row.missing.retain(|name| !row.named.contains(name));
                row.wrong = own(&grade::wrong(set, diagnosis));
                row.grade = grade::grade(set, diagnosis);
                row.leaves_friction_open = set.friction_is_open && grade::leaves_friction_open(diagnosis);
                row.noise_rms = diagnosis.fit.noise_floor;
                row.cross_validated = ResidualPair {
                    before: diagnosis.fit.refitted,
                    after: diagnosis.fit.learned.or(diagnosis.fit.improved),
                };
                row.verdict = Some(diagnosis.verdict.clone());
            }
        }
        row
    }

    /// Whether the unknown is reported beside what is named.
    #[must_use]
    pub fn owns_rest(&self) -> bool {
        self.grade == Grade::Named && self.named.iter().any(|name| name == UNKNOWN)
    }

    /// The judgement in words, with what is behind it.
    #[must_use]
    pub fn words(&self) -> String {
        let mut words = match self.grade {
            Grade::Wrong if self.wrong.is_empty() => "wrong: claims what kind of friction".to_owned(),
            Grade::Wrong => format!("wrong: {}", spaced(&self.wrong)),
            Grade::Named if self.owns_rest() => "named, and the rest reported as unknown".to_owned(),
            other => other.words().to_owned(),
        };
        if self.grade == Grade::Named && !self.missing.is_empty() {
            words += &format!("; not {}", spaced(&self.missing));
        }
        if self.leaves_friction_open && self.grade != Grade::Undecidable {
            words += "; damping not distinguished from dry friction, and said so";
        }
        words
    }

    /// Residual of the improved model over that of the refitted nominal law, on the trials kept back, or on the stretches that did not
    /// teach.
    #[must_use]
    pub fn left(&self) -> Option<f64> {
        let unseen = self.held_out.unwrap_or(self.cross_validated);
        Some(unseen.after? / unseen.before?).filter(|left| left.is_finite())
    }

    /// For people who watch.
    #[must_use]
    pub fn line(&self) -> String {
        format!(
            "{} {} -> {}; held out: {}, {:.1} s{}",
            self.recording,
            spaced(&self.named),
            self.words(),
            self.held_out.map_or_else(|| "none".to_owned(), |unseen| unseen.text(self.noise_rms, &self.unit)),
            self.seconds,
            self.failure.as_ref().map(|why| format!(": {why}")).unwrap_or_default()
        )
    }
}

/// Names as a person writes them.
#[must_use]
pub fn spaced(names: &[String]) -> String {
    if names.is_empty() { "nothing".to_owned() } else { effect_name(&names.join(", ")) }
}

impl ResidualPair {
    /// "3.9e-3 to 5.3e-4 (2.1e-5) N"
    #[must_use]
    pub fn text(&self, floor: Option<f64>, unit: &str) -> String {
        let [before, after, floor] =
            [self.before, self.after, floor].map(|value| value.map_or("?".to_owned(), |value| format!("{value:.2e}")));
        format!("{before} to {after} ({floor}) {unit}")
    }
}

impl RecordingScores {
    /// The counts of `rows`.
    #[must_use]
    pub fn of(rows: Vec<SpecimenScore>) -> Self {
        let count = |judgement| rows.iter().filter(|row| row.grade == judgement).count();
        let left: Vec<f64> = rows.iter().filter_map(SpecimenScore::left).collect();
        Self {
            n: rows.len(),
            named: count(Grade::Named),
            rest_owned: rows.iter().filter(|row| row.owns_rest()).count(),
            owned: count(Grade::Owned),
            undecidable: count(Grade::Undecidable),
            wrong: count(Grade::Wrong),
            missed: count(Grade::Missed),
            held_back: left.len(),
            better: left.iter().filter(|left| **left < 1.0).count(),
            halved: Some(left.iter().filter(|left| **left < 0.5).count()),
            left_median: median(left.into_iter()),
            rows,
        }
    }
}

#[cfg(test)]
pub(in crate::challenge) mod tests {
    use super::*;
    use crate::challenge::case_score::tests::diagnosis;
    use crate::challenge::recordings::known_physics::RECORDING_SETS;
    use crate::rig::Rig;

    /// A specimen of the set in `folder`, without trials.
    pub fn specimen(folder: &str, name: &str) -> Specimen {
        let text = "[rig]\nname = \"arm\"\n[drive]\nmass_kg = 1.0\nviscous_n_s_m = 2.0\n";
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        Specimen {
            name: name.to_owned(),
            set: RECORDING_SETS.iter().find(|set| set.folder == folder).unwrap(),
            rig: Rig::read(file.path()).unwrap(),
            rig_file: file.path().to_owned(),
            training: Vec::new(),
            held_out: Vec::new(),
            no_split_reason: None,
        }
    }

    #[test]
    fn a_score_holds_the_answer_against_what_is_known() {
        let arm = specimen("dfki_pendulum", "arm/one");
        let found = SpecimenScore::score(&arm, Ok(&diagnosis(&["gravity_load", "cogging"], &["viscous_damping"])), 2.5);
        assert_eq!((found.recording.as_str(), found.seconds, found.unit.as_str()), ("arm/one", 2.5, "N"));
        assert_eq!(
            (found.missing.as_slice(), found.wrong.as_slice()),
            (&["coulomb_friction".to_owned()][..], &["cogging".to_owned()][..])
        );
        assert_eq!((found.grade, found.leaves_friction_open), (Grade::Wrong, false));
        assert_eq!((found.noise_rms, found.cross_validated.before), (Some(0.5), Some(2.0)));
        // Only where the recordings leave friction open can an answer leave it open.
        let piston = specimen("pneumatic_seal_friction", "piston/one");
        let open = |alternatives: &[&str]| {
            SpecimenScore::score(&piston, Ok(&diagnosis(&["hysteresis"], alternatives)), 1.0).leaves_friction_open
        };
        assert!(open(&["viscous_damping"]) && !open(&["adhesion"]));
        let broke = SpecimenScore::score(&arm, Err("it stopped"), 1.0);
        assert_eq!(
            (broke.grade, broke.failure.as_deref(), broke.missing.len()),
            (Grade::Missed, Some("it stopped"), 2)
        );
    }

    pub fn row(grade: Grade, named: &[&str], held_out: Option<[f64; 2]>) -> SpecimenScore {
        let own = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        SpecimenScore {
            recording: "arm/one".to_owned(),
            description: String::new(),
            known: own(&["gravity_load"]),
            allowed: Vec::new(),
            verdict: None,
            named: own(named),
            alternatives: Vec::new(),
            missing: Vec::new(),
            wrong: Vec::new(),
            grade,
            leaves_friction_open: false,
            unit: "N".to_owned(),
            noise_rms: Some(0.5),
            cross_validated: ResidualPair::default(),
            held_out: held_out.map(|[before, after]| ResidualPair { before: Some(before), after: Some(after) }),
            training: Vec::new(),
            scored: Vec::new(),
            no_split_reason: None,
            seconds: 1.0,
            failure: None,
        }
    }

    #[test]
    fn the_unknown_is_owned_beside_a_name_only() {
        assert!(row(Grade::Named, &["gravity_load", UNKNOWN], None).owns_rest());
        assert!(!row(Grade::Named, &["gravity_load"], None).owns_rest());
        assert!(!row(Grade::Owned, &[UNKNOWN], None).owns_rest());
    }

    #[test]
    fn what_is_left_is_the_residual_with_the_physics_over_that_without() {
        assert_eq!(row(Grade::Named, &["gravity_load"], Some([4.0, 1.0])).left(), Some(0.25));
        assert_eq!(row(Grade::Named, &["gravity_load", UNKNOWN], Some([4.0, 1.0])).left(), Some(0.25));
        assert_eq!(row(Grade::Owned, &[UNKNOWN], Some([4.0, 1.0])).left(), Some(0.25), "learned, not named");
        let stretches = ResidualPair { before: Some(4.0), after: Some(3.0) };
        let whole = SpecimenScore { cross_validated: stretches, ..row(Grade::Named, &["gravity_load"], None) };
        assert_eq!(whole.left(), Some(0.75), "stretches stand in where no trial was kept back");
        let both =
            SpecimenScore { cross_validated: stretches, ..row(Grade::Named, &["gravity_load"], Some([4.0, 1.0])) };
        assert_eq!(both.left(), Some(0.25), "and nowhere else");
        assert_eq!(row(Grade::Named, &["gravity_load"], Some([0.0, 1.0])).left(), None);
        assert_eq!(row(Grade::Named, &["gravity_load"], None).left(), None);
    }

    #[test]
    fn every_count_is_the_one_that_is_counted_by_hand() {
        let score = RecordingScores::of(vec![
            row(Grade::Named, &["gravity_load"], Some([4.0, 1.0])),
            row(Grade::Named, &["gravity_load", UNKNOWN], Some([4.0, 4.0])),
            row(Grade::Named, &["gravity_load"], Some([4.0, 6.0])),
            row(Grade::Named, &["gravity_load"], Some([4.0, 2.0])),
            row(Grade::Owned, &[UNKNOWN], Some([4.0, 1.0])),
            row(Grade::Undecidable, &["hysteresis"], None),
            row(Grade::Undecidable, &["hysteresis"], None),
            row(Grade::Wrong, &["cogging"], None),
            row(Grade::Missed, &[], None),
        ]);
        assert_eq!((score.n, score.named, score.rest_owned, score.owned), (9, 4, 1, 1));
        assert_eq!((score.undecidable, score.wrong, score.missed), (2, 1, 1));
        // 0.25, 1, 1.5, 0.5, 0.25: half is not less than half.
        assert_eq!((score.held_back, score.better, score.halved, score.left_median), (5, 3, Some(2), 0.5));
    }

    #[test]
    fn a_row_says_what_came_of_it() {
        let of = |grade, named: &[&str]| row(grade, named, None);
        assert_eq!(of(Grade::Named, &["gravity_load"]).words(), "named");
        assert_eq!(of(Grade::Named, &["gravity_load", UNKNOWN]).words(), "named, and the rest reported as unknown");
        let partly =
            SpecimenScore { missing: vec!["coulomb_friction".to_owned()], ..of(Grade::Named, &["gravity_load"]) };
        assert_eq!(partly.words(), "named; not Coulomb friction");
        let missed = SpecimenScore { missing: vec!["coulomb_friction".to_owned()], ..of(Grade::Missed, &[]) };
        assert_eq!(missed.words(), "missed");
        let open = |grade| SpecimenScore { leaves_friction_open: true, ..of(grade, &["hysteresis"]) };
        let claims = "wrong: claims what kind of friction; damping not distinguished from dry friction, and said so";
        assert_eq!(open(Grade::Wrong).words(), claims);
        assert_eq!(open(Grade::Undecidable).words(), "undecidable and said so");
        let wrong = SpecimenScore { wrong: vec!["cogging".to_owned()], ..of(Grade::Wrong, &["cogging"]) };
        assert_eq!(wrong.words(), "wrong: cogging");
        assert_eq!(spaced(&[]), "nothing");
        let line = row(Grade::Named, &["gravity_load"], Some([4.0, 1.0])).line();
        assert!(
            line.starts_with("arm/one gravity load -> named; held out: 4.00e0 to 1.00e0 (5.00e-1) N, 1.0 s"),
            "{line}"
        );
    }
}
