//! What came of the real recordings.

use serde::{Deserialize, Serialize};

use super::entry::{Entry, names};
use super::judge::{self, Judgement};
use crate::challenge::row::UNKNOWN;
use crate::challenge::score::median;
use crate::challenge::told::Told;

/// All specimens, and how many came out how.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Recorded {
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
    pub rows: Vec<Row>,
}

/// One specimen, scored.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Row {
    /// "tissue_indentation/meat_FF".
    pub recording: String,
    /// What is known of it, in a few words.
    pub says: String,
    /// Effects that are known of it.
    pub known: Vec<String>,
    /// Names that are right as well.
    pub may: Vec<String>,
    /// The verdict, in its word.
    pub verdict: Option<String>,
    /// The answer.
    pub named: Vec<String>,
    /// What the answer says that the data do not tell from it.
    pub rivals: Vec<String>,
    /// Known effects that are not named.
    pub missing: Vec<String>,
    /// Named without being known.
    pub wrong: Vec<String>,
    /// What came of it.
    pub judgement: Judgement,
    /// Whether these data cannot tell dry friction from damping, and the answer says so.
    #[serde(default)]
    pub leaves_friction_open: bool,
    /// "N" or "N m".
    pub unit: String,
    /// What the sensors leave, by the diagnosis.
    pub floor: Option<f64>,
    /// Stretches of the trials that taught, each left by what the others taught, as the diagnosis tells it.
    pub stretches: Residual,
    /// Trials that no diagnosis saw, nothing fitted; none where the specimen cannot be parted.
    pub unseen: Option<Residual>,
    /// Files that taught.
    pub taught: Vec<String>,
    /// Files, or parts of files, that were kept back and scored.
    pub scored: Vec<String>,
    /// Why none was kept back.
    pub whole: Option<String>,
    /// From the command's start to its end.
    pub seconds: f64,
    /// Why there is no answer, or no score of the trials kept back.
    pub failure: Option<String>,
}

/// Root mean squares.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Residual {
    /// The nominal law, its values refitted.
    pub before: Option<f64>,
    /// With the named physics.
    pub after: Option<f64>,
}

impl Row {
    /// Holds what was `told` of `entry`, or why nothing was, against what is known of it.
    #[must_use]
    pub fn score(entry: &Entry, told: Result<Told, String>, seconds: f64) -> Self {
        let own = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let set = entry.set;
        let mut row = Self {
            recording: entry.name.clone(),
            says: set.says.to_owned(),
            known: own(set.has),
            may: own(set.may),
            verdict: None,
            named: Vec::new(),
            rivals: Vec::new(),
            missing: own(set.has),
            wrong: Vec::new(),
            judgement: Judgement::Missed,
            leaves_friction_open: false,
            unit: entry.rig.coordinate.force_unit().to_owned(),
            floor: None,
            stretches: Residual::default(),
            unseen: None,
            taught: own(&names(&entry.taught)),
            scored: own(&names(&entry.unseen)),
            whole: entry.whole.map(str::to_owned),
            seconds,
            failure: None,
        };
        match told {
            Err(failure) => row.failure = Some(failure),
            Ok(told) => {
                row.named = own(&judge::named(&told));
                row.rivals = own(&judge::rivals(&told));
                row.missing.retain(|name| !row.named.contains(name));
                row.wrong = own(&judge::wrong(set, &told));
                row.judgement = judge::judge(set, &told);
                row.leaves_friction_open = set.friction_is_open && judge::leaves_friction_open(&told);
                row.floor = told.fit.noise_floor;
                row.stretches = Residual { before: told.fit.refitted, after: told.fit.improved };
                row.verdict = Some(told.verdict);
            }
        }
        row
    }

    /// Whether the unknown is owned beside what is named.
    #[must_use]
    pub fn owns_rest(&self) -> bool {
        self.judgement == Judgement::Named && self.named.iter().any(|name| name == UNKNOWN)
    }

    /// The judgement in words, with what is behind it.
    #[must_use]
    pub fn words(&self) -> String {
        let mut words = match self.judgement {
            Judgement::Wrong if self.wrong.is_empty() => "wrong: claims what kind of friction".to_owned(),
            Judgement::Wrong => format!("wrong: {}", spaced(&self.wrong)),
            Judgement::Named if self.owns_rest() => "named, and the rest owned".to_owned(),
            other => other.words().to_owned(),
        };
        if self.judgement == Judgement::Named && !self.missing.is_empty() {
            words += &format!("; not {}", spaced(&self.missing));
        }
        if self.leaves_friction_open && self.judgement != Judgement::Undecidable {
            words += "; damping not told from dry friction, and said so";
        }
        words
    }

    /// Residual with the named physics over that of the refitted nominal law, on the trials kept back; none where nothing is
    /// named.
    #[must_use]
    pub fn left(&self) -> Option<f64> {
        let unseen = self.unseen.filter(|_| self.named.iter().any(|name| name != UNKNOWN))?;
        Some(unseen.after? / unseen.before?).filter(|left| left.is_finite())
    }

    /// For people who watch.
    #[must_use]
    pub fn line(&self) -> String {
        format!(
            "{} {:?} -> {}; unseen {}, {:.1} s{}",
            self.recording,
            self.named,
            self.words(),
            self.unseen.map_or_else(|| "none".to_owned(), |unseen| unseen.text(self.floor, &self.unit)),
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

impl Residual {
    /// "3.9e-3 to 5.3e-4 (2.1e-5) N"
    #[must_use]
    pub fn text(&self, floor: Option<f64>, unit: &str) -> String {
        let [before, after, floor] =
            [self.before, self.after, floor].map(|value| value.map_or("?".to_owned(), |value| format!("{value:.2e}")));
        format!("{before} to {after} ({floor}) {unit}")
    }
}

impl Recorded {
    /// The counts of `rows`.
    #[must_use]
    pub fn of(rows: Vec<Row>) -> Self {
        let count = |judgement| rows.iter().filter(|row| row.judgement == judgement).count();
        let left: Vec<f64> = rows.iter().filter_map(Row::left).collect();
        Self {
            n: rows.len(),
            named: count(Judgement::Named),
            rest_owned: rows.iter().filter(|row| row.owns_rest()).count(),
            owned: count(Judgement::Owned),
            undecidable: count(Judgement::Undecidable),
            wrong: count(Judgement::Wrong),
            missed: count(Judgement::Missed),
            held_back: left.len(),
            better: left.iter().filter(|left| **left < 1.0).count(),
            left_median: median(left.into_iter()),
            rows,
        }
    }
}
