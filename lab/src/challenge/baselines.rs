//! What others make of the same files, by the same score.

use std::collections::BTreeSet;
use std::path::Path;

use palpate_cases::baselines::{Baseline, BaselineResult};
use palpate_cases::python::Python;
use palpate_cases::truth::CaseKind;
use serde::{Deserialize, Serialize};

use super::bic;
use super::case_score::CaseScore;
use super::statistics::median;

/// What another found in one case.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct BaselineScore {
    /// "bic", "pysindy" or "sysidentpy".
    pub who: String,
    /// Effects that it names.
    pub named: Vec<String>,
    /// RMS on unseen data over that of the refitted nominal law on the same.
    pub left: Option<f64>,
    /// What it took.
    pub seconds: f64,
    /// Why there is no answer.
    pub failure: Option<String>,
}

/// How another did over all cases.
#[derive(Debug, Clone, PartialEq)]
pub struct BaselineSummary {
    /// Who.
    pub who: String,
    /// Cases with nothing missing, and those of them in which it names something.
    pub alarms: (usize, usize),
    /// Single effects at least as large as the expected noise, and those of them named, and nothing else.
    pub right: (usize, usize),
    /// RMS left of single effects at least as large as the expected noise, over that of the refitted nominal law, median.
    pub left: f64,
    /// Median.
    pub seconds: f64,
    /// Cases without an answer.
    pub failed: usize,
}

/// Has all of them look at the case in `folder`; those that need `python` only where it is there.
#[must_use]
pub fn run_all(folder: &Path, python: Option<&Python>) -> Vec<BaselineScore> {
    let mut others = vec![BaselineScore::of("bic", bic::answer(folder))];
    if let Some(python) = python {
        others.extend(Baseline::ALL.map(|baseline| BaselineScore::of(baseline.name(), baseline.run(python, folder))));
    }
    others
}

impl BaselineScore {
    fn of(who: &str, found: anyhow::Result<BaselineResult>) -> Self {
        let other = |named, left, seconds, failure| Self { who: who.to_owned(), named, left, seconds, failure };
        match found {
            Ok(found) => {
                let left = Some(found.held_out / found.refitted).filter(|left| left.is_finite());
                other(found.named, left, found.seconds, None)
            }
            Err(error) => other(Vec::new(), None, 0.0, Some(format!("{error:#}"))),
        }
    }
}

/// The standing of the diagnosis itself, and of all others that analysed `rows`.
#[must_use]
pub fn summaries(rows: &[CaseScore]) -> Vec<BaselineSummary> {
    let who: BTreeSet<&str> = rows.iter().flat_map(|row| &row.baselines).map(|other| other.who.as_str()).collect();
    let ours = |row: &CaseScore| {
        let left = row.answer.after.zip(row.answer.before).map(|(after, before)| after / before);
        BaselineScore {
            who: "palpate".to_owned(),
            named: row.answer.named.clone(),
            left,
            seconds: row.seconds,
            failure: row.failure.clone(),
        }
    };
    let own = summarize("palpate", &rows.iter().map(|row| (row, ours(row))).collect::<Vec<_>>());
    let of = |who: &str| {
        let looked = rows.iter().flat_map(|row| row.baselines.iter().map(move |other| (row, other.clone())));
        summarize(who, &looked.filter(|(_, other)| other.who == who).collect::<Vec<_>>())
    };
    std::iter::once(own).chain(who.into_iter().map(of)).collect()
}

fn summarize(who: &str, looked: &[(&CaseScore, BaselineScore)]) -> BaselineSummary {
    let none: Vec<_> = looked.iter().filter(|(row, _)| row.kind == CaseKind::None).collect();
    let large: Vec<_> = looked.iter().filter(|(row, _)| row.is_large()).collect();
    let right = |(row, other): &&&(&CaseScore, BaselineScore)| row.truth.iter().eq(&other.named);
    BaselineSummary {
        who: who.to_owned(),
        alarms: (none.iter().filter(|(_, other)| !other.named.is_empty()).count(), none.len()),
        right: (large.iter().filter(right).count(), large.len()),
        left: median(large.iter().filter_map(|(_, other)| other.left)),
        seconds: median(looked.iter().map(|(_, other)| other.seconds)),
        failed: looked.iter().filter(|(_, other)| other.failure.is_some()).count(),
    }
}
