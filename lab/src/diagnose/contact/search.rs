//! What a search for the effects of a contact works on, and which laws it admits.

use super::circumstances::Circumstances;
use super::data::Data;
use super::fall::Fall;
use super::fit::Fit;
use super::in_step::{is_in_step, is_of_the_tool};
use super::model::ContactModel;

/// What a search works on.
pub struct Search<'a> {
    /// The trials, each row with its worth.
    pub data: Data<'a>,
    /// The same in means of several rows, which effects are looked for in.
    pub coarse: Data<'a>,
    /// The nominal law, refitted.
    pub nominal: Fit,
    /// What bounds it beside the recordings.
    pub circumstances: Circumstances,
}

/// Effects at most.
pub(super) const MOST_TERMS: usize = 4;

impl Search<'_> {
    /// Whether `fit` is a law that its effects stand for: no value at the end of what the recordings show, none by which an effect is not
    /// what it is called, no wave that has slid into step with the motion, and no spring whose force falls on the way in, unless the rig
    /// file has one or it is a pocket of an effect that may have one.
    pub(super) fn is_admissible(&self, fit: &Fit) -> bool {
        let falls = |fit: &Fit| match fit.model.fall(&fit.values) {
            Some(Fall::Pocket) => !fit.model.may_fall(),
            Some(Fall::ToTheEnd) => true,
            None => false,
        };
        let mut frequencies = fit.model.frequencies(&fit.values).into_iter();
        !fit.model.is_at_end(&fit.values)
            && fit.model.is_as_stated(&fit.values)
            && !frequencies.any(|frequency| is_in_step(&self.coarse, fit, frequency))
            && !is_of_the_tool(&self.coarse, fit)
            && (!falls(fit) || falls(&self.nominal))
    }

    /// Whether `fit` with so many effects `more` holds no more than [`MOST_TERMS`].
    pub(super) fn has_room(&self, fit: &Fit, more: usize) -> bool {
        fit.model.terms.len() + more <= MOST_TERMS + self.nominal.model.terms.len()
    }

    /// Whether the recordings cannot distinguish the laws of two sets of effects, whatever they leave: at one speed each way and
    /// without a hold a Maxwell branch, `branch_stiffness v relaxation_time (1 - exp(-t / relaxation_time))` after a reversal, is Dahl's
    /// loop over `v t`, and a force that is late by a time is that of a tip that lags by a way.
    #[must_use]
    pub fn is_one_law(&self, one: &ContactModel, other: &ContactModel) -> bool {
        let kinds = |model: &ContactModel| {
            let mut names: Vec<&str> =
                sorted_names(model).into_iter().map(|name| by_travel(name).unwrap_or(name)).collect();
            names.sort_unstable();
            names.dedup();
            names
        };
        self.circumstances.is_one_speed && kinds(one) == kinds(other)
    }

    /// Takes each row for what `best` makes of the motion's uncertainty, and for what it leaves: an inertia shows errors of the
    /// acceleration, a stiffer law more of the position's, and the better a law the more its finest rows are worth. Returns `best` under
    /// these weights.
    pub(super) fn weigh_by(&mut self, best: Fit) -> Fit {
        self.data = self.data.weighed(&best);
        self.coarse = self.coarse.weighed(&best);
        self.nominal = self.data.again(&self.nominal);
        self.data.again(&best)
    }
}

/// The law by a way that one by a time, `name`, is at one speed; `None` where it is none.
pub(super) fn by_travel(name: &str) -> Option<&'static str> {
    match name {
        "stress_relaxation" => Some("hysteresis"),
        "channel_delay" | "force_lag" => Some("lost_motion"),
        _ => None,
    }
}

/// Names of all effects, as often as each is there.
pub(super) fn sorted_names(model: &ContactModel) -> Vec<&'static str> {
    let mut names: Vec<&'static str> = model.terms.iter().map(crate::diagnose::term::Term::name).collect();
    names.sort_unstable();
    names
}

#[cfg(test)]
mod tests {
    use super::super::nominal::nominal_fit;
    use super::super::testing::TestContact;
    use super::*;
    use crate::diagnose::term::Term;

    #[test]
    fn beside_what_the_rig_file_holds_there_is_room_for_four_effects() {
        let trials = [TestContact::PLAIN.trial(1)];
        let data = || Data::new(&trials);
        let mut nominal = nominal_fit(&data(), &TestContact::nominal());
        let bias = Term { effect: crate::effects::find("force_bias").unwrap(), form: 0 };
        nominal.model = nominal.model.with(bias);
        let search =
            Search { nominal: nominal.clone(), data: data(), coarse: data(), circumstances: Circumstances::default() };
        let mut fit = nominal;
        for room in (0..=4).rev() {
            assert!(search.has_room(&fit, room) && !search.has_room(&fit, room + 1), "room for {room}");
            fit.model = fit.model.with(bias);
        }
    }
}
