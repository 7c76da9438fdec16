//! The effects of a contact that are told: those that unseen rows confirm, and that no free curve does better than.

use super::confirmation::believed;
use super::crosstalk::{Crosstalk, crosstalk};
use super::fit::Fit;
use super::held_out::{Folds, HeldOut};
use super::judgement::{acts_at_a_distance, takes_too_little};
use super::rival_curves::Rival;
use super::search::Search;
use crate::diagnose::evidence::NamedTerm;

/// The names that are believed of what was chosen, and what else is said of it.
pub(super) struct Told {
    pub(super) fit: Fit,
    /// What it leaves of unseen rows.
    pub(super) improved: HeldOut,
    pub(super) named: Vec<NamedTerm>,
    pub(super) rivals: Vec<Rival>,
    pub(super) crosstalk: Option<Crosstalk>,
    /// Whether the mismatch is none of the list's effects, by what the force does.
    is_something_else: bool,
}

impl Told {
    /// What unseen rows confirm of `chosen`, but where the reading holds effort, or where what acts is another thing.
    pub(super) fn of(search: &Search<'_>, folds: &Folds, chosen: Fit) -> Self {
        let (mut fit, mut improved, mut named) = believed(search, folds, chosen);
        let crosstalk = crosstalk(search, &fit);
        let is_something_else =
            crosstalk.is_some() || takes_too_little(search, &fit, &named) || acts_at_a_distance(search, &fit, &named);
        if is_something_else {
            fit = search.nominal.clone();
            improved = folds.held_out(&search.data, &fit);
            named.clear();
        }
        Self { fit, improved, named, rivals: Vec::new(), crosstalk, is_something_else }
    }

    /// The same, each name held against free curves in its place.
    pub(super) fn against_curves(mut self, search: &Search<'_>, folds: &Folds) -> Self {
        let holds = search.is_told_as_a_law(&self.fit);
        while let Some((at, rival)) = search.rival(&self.fit, &self.named, holds) {
            // A curve that does better than one law of an effect is no evidence against another law of it.
            if let Some(other) = search.in_another_form(&self.fit, at) {
                self.believe(search, folds, other);
                continue;
            }
            // What a law leaves at the noise is nothing more, however surely a curve is likelier in the few rows where its effect acts.
            if !rival.is_refuted && search.is_at_noise(&self.fit) {
                break;
            }
            self.rivals.push(rival);
            if !rival.is_refuted {
                break;
            }
            self.believe(search, folds, search.without(&self.fit, at));
            while let Some(at) = search.not_needed_beside(rival.curve, &self.fit, &self.named) {
                self.believe(search, folds, search.without(&self.fit, at));
            }
        }
        if self.named.is_empty() && self.rivals.is_empty() && !self.is_something_else {
            self.rivals.extend(search.rival_of_nominal());
        }
        self
    }

    fn believe(&mut self, search: &Search<'_>, folds: &Folds, fit: Fit) {
        (self.fit, self.improved, self.named) = believed(search, folds, fit);
    }

    /// Whether there is more than the names say.
    pub(super) fn is_more_there(&self) -> bool {
        self.is_something_else || !self.rivals.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::identification::identify;
    use super::super::testing::{FORCE_NOISE, TestContact};
    use crate::diagnose::verdict::Verdict;

    /// A liquid bridge that pulls by a wave more and less than its law has it, of 1.25 or of 3 deviations of the sensor's noise. Where it leaves, in 6 % of the rows,
    /// either is sure; the smaller leaves 6 % more power than the noise on the whole, which nobody knows that well.
    #[test]
    fn what_is_left_at_the_noise_is_nothing_more() {
        let told = |deviations: f64| {
            let trial = |seed: u64| {
                let mut recording = TestContact::PLAIN.bridged(seed, 0.3, 1.2e-3);
                let position = recording.position.clone();
                for (row, force) in recording.force.as_mut().unwrap().iter_mut().enumerate().skip(1) {
                    let x = position[row];
                    let is_leaving = x < position[row - 1] && x < 0.0 && x > -1.2e-3;
                    let wave = (std::f64::consts::TAU * x / 6e-4).sin();
                    *force += if is_leaving { deviations * FORCE_NOISE * wave } else { 0.0 };
                }
                TestContact::seen(&recording)
            };
            let trials = || [1, 2].map(trial).to_vec();
            let found = identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {});
            let found = found.expect("a contact");
            (found.chosen.model.names(found.known_terms), found.verdict)
        };
        assert_eq!(told(1.25), (vec!["adhesion"], Verdict::Explained));
        assert_eq!(told(3.0), (vec!["adhesion"], Verdict::PartlyExplained));
    }
}
