//! An answer of the diagnosis, by its names.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use crate::investigate::record::State;

/// An answer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Answer {
    /// Names.
    pub named: Vec<String>,
    /// Sets of names that the data do not rule out.
    pub alternatives: Vec<Vec<String>>,
}

impl Answer {
    /// Of what a diagnosis came to.
    #[must_use]
    pub fn of(state: &State) -> Self {
        Self { named: state.physics.clone(), alternatives: state.alternatives.clone() }
    }

    /// Whether `truth` is named and nothing else.
    #[must_use]
    pub fn is_right(&self, truth: &[String]) -> bool {
        let set = |names: &[String]| names.iter().cloned().collect::<BTreeSet<String>>();
        set(&self.named) == set(truth)
    }

    /// The same, and no alternative is left.
    #[must_use]
    pub fn is_right_and_alone(&self, truth: &[String]) -> bool {
        self.is_right(truth) && self.alternatives.is_empty()
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Names as an answer holds them.
    pub fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    /// An answer, each alternative of one name.
    pub fn answer(named: &[&str], alternatives: &[&str]) -> Answer {
        Answer { named: names(named), alternatives: alternatives.iter().map(|name| names(&[name])).collect() }
    }

    #[test]
    fn an_answer_with_an_alternative_is_right_but_not_alone() {
        let truth = names(&["adhesion"]);
        let judged = |answer: Answer| (answer.is_right(&truth), answer.is_right_and_alone(&truth));
        assert_eq!(judged(answer(&["adhesion"], &[])), (true, true));
        assert_eq!(judged(answer(&["adhesion"], &["hysteresis"])), (true, false));
        assert_eq!(judged(answer(&["adhesion", "hysteresis"], &[])), (false, false));
        assert_eq!(judged(answer(&[], &["adhesion"])), (false, false));
    }
}
