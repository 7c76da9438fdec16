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

    /// Whether `names` are named and nothing else, in whatever order.
    #[must_use]
    pub fn names_exactly(&self, names: &[String]) -> bool {
        let set = |names: &[String]| names.iter().cloned().collect::<BTreeSet<String>>();
        set(&self.named) == set(names)
    }

    /// Whether no alternative is left.
    #[must_use]
    pub fn is_alone(&self) -> bool {
        self.alternatives.is_empty()
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
    fn names_are_a_set() {
        let both = answer(&["adhesion", "hysteresis"], &[]);
        assert!(both.names_exactly(&names(&["hysteresis", "adhesion"])));
        assert!(!both.names_exactly(&names(&["adhesion"])));
        assert!(answer(&[], &["adhesion"]).names_exactly(&[]) && !answer(&[], &["adhesion"]).is_alone());
    }
}
