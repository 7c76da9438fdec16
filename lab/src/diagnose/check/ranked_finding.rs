//! What one check says of one trial, and how the trials are put together.

use super::finding::Finding;
use crate::recording::Recording;

/// What one check says of one trial.
#[derive(Debug)]
pub struct RankedFinding {
    /// Code of the finding, by kind and channel: of each there is one.
    pub code: &'static str,
    /// Whether it casts doubt on the answer.
    pub grave: bool,
    /// What it is about: file, channel, time; joined by commas.
    pub place: String,
    /// How bad it is: the worst trial of a kind is named.
    pub weight: f64,
    /// The finding and what to do about it.
    pub text: String,
}

impl RankedFinding {
    /// A note that does not cast doubt on the answer.
    pub fn mild(code: &'static str, place: impl Into<String>, weight: f64, text: impl Into<String>) -> Self {
        Self { code, grave: false, place: place.into(), weight, text: text.into() }
    }

    /// A note that does.
    pub fn grave(code: &'static str, place: impl Into<String>, weight: f64, text: impl Into<String>) -> Self {
        Self { grave: true, ..Self::mild(code, place, weight, text) }
    }
}

/// One finding a kind, the grave ones first, else in the order of the checks.
pub fn merge_findings(notes: Vec<RankedFinding>, recordings: &[Recording]) -> Vec<Finding> {
    let mut kinds: Vec<Vec<RankedFinding>> = Vec::new();
    for note in notes {
        match kinds.iter_mut().find(|kind| kind[0].code == note.code) {
            Some(kind) => kind.push(note),
            None => kinds.push(vec![note]),
        }
    }
    let mut findings: Vec<Finding> = kinds.into_iter().filter_map(|kind| merge(kind, recordings.len())).collect();
    findings.sort_by_key(|finding| !finding.grave);
    findings
}

/// The worst of a kind, and how many others there are.
fn merge(kind: Vec<RankedFinding>, trials: usize) -> Option<Finding> {
    let others = kind.len() - 1;
    let worst = kind
        .into_iter()
        .max_by(|a, b| (a.grave, a.weight).partial_cmp(&(b.grave, b.weight)).unwrap_or(std::cmp::Ordering::Equal))?;
    let also = match others {
        0 => String::new(),
        1 => " One other trial shows the same.".to_owned(),
        all if all + 1 == trials => " All other trials show the same.".to_owned(),
        some => format!(" {some} other trials show the same."),
    };
    Some(Finding { code: worst.code, grave: worst.grave, place: worst.place, text: worst.text + &also })
}
