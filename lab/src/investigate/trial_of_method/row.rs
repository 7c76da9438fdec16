//! One rig, scored.

use serde::{Deserialize, Serialize};

use super::answer::Answer;
use super::comparison::Comparison;

/// One rig, scored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Its place in the list of cases.
    pub index: u64,
    /// What it conceals; "unknown" where that is outside of the list.
    pub truth: Vec<String>,
    /// RMS residual of the refitted nominal model along the first recording, over the sensor's error.
    pub strength: f64,
    /// What the three ways came to.
    #[serde(flatten)]
    pub comparison: Comparison,
}

impl Row {
    /// For people who watch.
    #[must_use]
    pub fn line(&self) -> String {
        let mark = |answer: &Answer| match () {
            () if answer.is_right_and_alone(&self.truth) => "alone",
            () if answer.is_right(&self.truth) => "right",
            () => "no",
        };
        let Comparison { first, rounds, fixed, used, seconds, .. } = &self.comparison;
        let rounds: Vec<&str> = rounds.iter().map(mark).collect();
        let most = used.iter().fold(0.0, |most: f64, share| most.max(*share));
        format!(
            "{:4} {} ({:.2}): first {}, designed {}, fixed {}; limits used to {most:.2}, {seconds:.0} s; {}",
            self.index,
            self.truth.join(" and "),
            self.strength,
            mark(first),
            rounds.join(" "),
            mark(fixed),
            self.comparison.last().named.join(" and "),
        )
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::investigate::trial_of_method::answer::tests::names;

    /// A rig that conceals `truth` with a strength of 2.
    pub fn row(truth: &[&str], first: Answer, rounds: Vec<Answer>, fixed: Answer) -> Row {
        let comparison = Comparison {
            first,
            rounds,
            fixed,
            used: [0.5, 0.8, 0.1, 0.2],
            used_by_fixed: [0.9, 0.1, 0.1, 0.1],
            stopped: 1,
            recorded_s: [25.0, 25.0],
            outcome: String::new(),
            seconds: 1.0,
        };
        Row { index: 0, truth: names(truth), strength: 2.0, comparison }
    }
}
