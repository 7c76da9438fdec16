//! What came of the real recordings.

use serde::{Deserialize, Serialize};

use super::grade::{self, Grade};
use super::specimen::{Specimen, names};
use crate::challenge::case_score::UNKNOWN;
use crate::challenge::challenge_score::median;
use crate::challenge::diagnosis_json::DiagnosisJson;

/// All specimens, and how many came out how.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RecordingScores {
    /// Specimens.
    pub n: usize,
    /// Stated physics is named, and nothing that is not known.
    pub named: usize,
    /// Of these, the unknown is owned beside it.
    pub rest_owned: usize,
    /// Nothing that is stated is named, nor anything that is not known; the unknown is owned.
    pub owned: usize,
    /// The data do not decide, and the answer says so.
    pub undecidable: usize,
    /// Something is named that is not known, or claimed as decided that is not.
    pub wrong: usize,
    /// Nothing that is stated is named, and no unknown owned.
    pub missed: usize,
    /// Specimens with trials that were kept back, of which physics is named.
    pub held_back: usize,
    /// On these, the residual with the named physics over that of the refitted nominal law, median.
    pub left_median: f64,
    /// On so many of these it is smaller.
    pub better: usize,
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
    /// Stretches of the trials that taught, each left by what the others taught, as the diagnosis tells it.
    #[serde(rename = "stretches")]
    pub cross_validated: ResidualPair,
    /// Trials that no diagnosis saw, nothing fitted; none where the specimen cannot be parted.
    #[serde(rename = "unseen")]
    pub held_out: Option<ResidualPair>,
    /// Files that taught.
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
    /// With the named physics.
    pub after: Option<f64>,
}

impl SpecimenScore {
    /// Holds what was `told` of `entry`, or why nothing was, against what is known of it.
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
                row.cross_validated = ResidualPair { before: diagnosis.fit.refitted, after: diagnosis.fit.improved };
                row.verdict = Some(diagnosis.verdict.clone());
            }
        }
        row
    }

    /// Whether the unknown is owned beside what is named.
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
            Grade::Named if self.owns_rest() => "named, and the rest owned".to_owned(),
            other => other.words().to_owned(),
        };
        if self.grade == Grade::Named && !self.missing.is_empty() {
            words += &format!("; not {}", spaced(&self.missing));
        }
        if self.leaves_friction_open && self.grade != Grade::Undecidable {
            words += "; damping not told from dry friction, and said so";
        }
        words
    }

    /// Residual with the named physics over that of the refitted nominal law, on the trials kept back; none where nothing is
    /// named.
    #[must_use]
    pub fn left(&self) -> Option<f64> {
        let unseen = self.held_out.filter(|_| self.named.iter().any(|name| name != UNKNOWN))?;
        Some(unseen.after? / unseen.before?).filter(|left| left.is_finite())
    }

    /// For people who watch.
    #[must_use]
    pub fn line(&self) -> String {
        format!(
            "{} {:?} -> {}; held out: {}, {:.1} s{}",
            self.recording,
            self.named,
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
    if names.is_empty() { "nothing".to_owned() } else { names.join(", ").replace('_', " ") }
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
            left_median: median(left.into_iter()),
            rows,
        }
    }
}
