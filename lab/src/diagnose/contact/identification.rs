//! From the trials of a contact to what is told of it: the search for effects, a force of free motion taken off, and the judgement.

use super::alternative::alternatives;
use super::beside_force::BesideForce;
use super::circumstances::Circumstances;
use super::data::Data;
use super::fit::{Effort, Fit};
use super::free_curve::Curve;
use super::held_out::{Folds, rms};
use super::interval::intervals;
use super::judgement::{is_notable, verdict};
use super::learned::{Learned, learned};
use super::learned_damping::learned_damping;
use super::model::index;
use super::nominal::{NominalContact, law_of, nominal_fit};
use super::outcome::Outcome;
use super::parasitic_force::ParasiticForce;
use super::rest::Rest;
use super::search::Search;
use super::selection::Chosen;
use super::told::Told;
use super::trial::ContactTrial;
use super::wandering_zero::{beside_a_wandering_zero, wanders};
use crate::diagnose::verdict::Verdict;

/// Fewest rows that a contact is identified from.
const FEWEST_ROWS: usize = 16;

/// Identifies the contact of `trials`, and of `coarse`, means of more rows of the same; `None` where they show too little.
#[must_use]
pub fn identify(
    trials: Vec<ContactTrial>,
    coarse: &[ContactTrial],
    rig: &NominalContact,
    circumstances: Circumstances,
    say: &dyn Fn(&str),
) -> Option<Outcome> {
    let rows: usize = trials.iter().map(ContactTrial::len).sum();
    if rows < FEWEST_ROWS || trials.iter().any(|trial| trial.len() < 4) {
        return None;
    }
    let given = Given { rig, circumstances: &circumstances, say };
    let alone = given.searched(&trials, coarse);
    let (search, chosen) = &alone;
    // A law that lacks physics can put the surface behind all that touches it.
    let force = (!given.circumstances.is_never_free)
        .then(|| ParasiticForce::found(&search.data, [&chosen.fit, &search.nominal], rig))
        .flatten();
    let law = chosen.fit.clone();
    let outcome = given.concluded(alone);
    // Effort that couples into the reading is there in free motion, too, and is known by the effort.
    let force = force.filter(|_| outcome.crosstalk.is_none());
    let beside = force.and_then(|force| given.beside(force, [&trials, coarse], &law));
    Some(match beside {
        Some(beside) => beside.instead_of(outcome),
        None => outcome,
    })
}

/// What a contact is identified by beside its trials.
struct Given<'a> {
    rig: &'a NominalContact,
    circumstances: &'a Circumstances,
    say: &'a dyn Fn(&str),
}

impl Given<'_> {
    /// The effects that `trials` ask for, and the search that found them.
    fn searched<'a>(&self, trials: &'a [ContactTrial], coarse: &'a [ContactTrial]) -> (Search<'a>, Chosen) {
        (self.say)("the contact: nominal values");
        let first = nominal_fit(&Data::new(trials), self.rig);
        let data = Data::new(trials).weighed(&first);
        let nominal = data.fit(&first.model, &first.values, Effort::FULL);
        let coarse = Data::new(coarse).weighed(&nominal);
        let mut search = Search { data, coarse, nominal, circumstances: self.circumstances.clone() };
        let chosen = search.run(self.say);
        (search, chosen)
    }

    /// What is told beside the parasitic `force` of `trials` and of means of more rows of the same, where that is likelier than the law `alone`.
    fn beside(&self, force: ParasiticForce, trials: [&[ContactTrial]; 2], alone: &Fit) -> Option<BesideForce> {
        (self.say)("the contact: without the force of free motion");
        let without = trials.map(|trials| force.taken_off(trials));
        let found = self.searched(&without[0], &without[1]);
        let Some(other) = force.in_place_of_effects(&found.0, &found.1.fit, trials[0]) else {
            return self.concluded_beside(force, found, trials[0], alone);
        };
        let without = trials.map(|trials| other.taken_off(trials));
        self.concluded_beside(other, self.searched(&without[0], &without[1]), trials[0], alone)
    }

    fn concluded_beside(
        &self,
        force: ParasiticForce,
        found: (Search<'_>, Chosen),
        trials: &[ContactTrial],
        alone: &Fit,
    ) -> Option<BesideForce> {
        force
            .is_likelier(&found.0, &found.1.fit, trials, alone)
            .then(|| BesideForce { outcome: self.concluded(found), force })
    }

    /// What is told of what was found.
    fn concluded(&self, (mut search, chosen): (Search<'_>, Chosen)) -> Outcome {
        let trials = search.data.trials;
        let (_, start) = law_of(trials, self.rig);
        (self.say)("the contact: what is left");
        // Beside an effect the tool's free motion may hold what that effect does not say, as interference under an atomic force microscope.
        // What is left beside a zero that wanders is that zero's, where free motion holds as much of it.
        if chosen.fit.model == search.nominal.model || wanders(&chosen.fit) {
            search.data = search.data.heard_in_free_motion(&chosen.fit);
        }
        let mut outcome = judged(&search, chosen, &start);
        outcome.weights.clone_from(&search.data.weights);
        outcome.noise.clone_from(&search.data.noise);
        outcome.trials = trials.to_vec();
        outcome
    }
}

fn judged(search: &Search<'_>, chosen: Chosen, start: &[f64]) -> Outcome {
    let data = &search.data;
    let folds = Folds::of(data);
    let given = as_given(search, start);
    let refitted = folds.held_out(data, &search.nominal);
    let told = Told::of(search, &folds, chosen.fit.clone()).against_curves(search, &folds);
    let is_more_there = told.is_more_there();
    let Told { mut fit, improved, named, rivals, crosstalk, .. } = told;
    let rest = Rest::of(data, &fit);
    let given_residual = data.residuals(&given.model, &given.values);
    let verdict = match (is_more_there, named.is_empty()) {
        (false, _) => verdict(search, &fit, &named, rms(data, &given_residual), [&refitted, &improved]),
        (true, true) => Verdict::Unknown,
        (true, false) => Verdict::PartlyExplained,
    };
    // Beside names that stand for the mismatch, too: what a textbook's law leaves of a real thing is no less of use for being told.
    let is_left = is_more_there || is_notable(search, &fit, &rest);
    let learned = if is_left { learned_of(data, &fit) } else { None };
    let mut spread = intervals(data, &fit, &rest);
    let alternatives = alternatives(search, &folds, &fit, &chosen, &refitted);
    if verdict == Verdict::Explained
        && let Some(told) = beside_a_wandering_zero(data, &fit)
    {
        (fit, spread) = told;
    }
    Outcome {
        trials: Vec::new(),
        noise: Vec::new(),
        weights: Vec::new(),
        noise_memory: data.noise_memory(),
        verdict,
        crosstalk,
        rivals,
        learned,
        parasitic: None,
        nominal: search.nominal.clone(),
        known_terms: search.nominal.model.terms.len(),
        intervals: spread.ends,
        covariance: spread.covariance,
        alternatives,
        named,
        residuals: [given_residual, refitted.residual, improved.residual],
        expected_noise: data.expected_noise(),
        is_limited_by_rounding: data.is_limited_by_rounding(),
        chosen: fit,
    }
}

/// What is learned of what `fit` leaves: over depth and direction, or over the speed in contact, whichever takes more of unseen rows.
fn learned_of(data: &Data<'_>, fit: &Fit) -> Option<Learned> {
    let over_depth = learned(data, fit).map(|found| (found.held_out_share, Learned::OverDepth(found)));
    let over_speed = [Curve::Speed, Curve::SpeedTimesDepth].into_iter().filter_map(|curve| {
        learned_damping(data, fit, curve).map(|found| (found.held_out_share, Learned::OverSpeed(found)))
    });
    let best = over_depth.into_iter().chain(over_speed).max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    Some(best.1)
}

/// The rig file's values, with what no file can state: timing, and where each encoder starts within its step.
fn as_given(search: &Search<'_>, start: &[f64]) -> Fit {
    let mut given = search.nominal.clone();
    let moved = given.values[index::SURFACE] - start[index::SURFACE];
    let within = 0.5 * given.model.scales.resolution;
    given.values[..index::TIMING].copy_from_slice(&start[..index::TIMING]);
    given.values[index::SURFACE] += moved.clamp(-within, within);
    let first = given.model.nominal_count();
    given.values[first..].copy_from_slice(&start[first..]);
    given
}

#[cfg(test)]
mod tests {
    use super::super::testing::{FORCE_NOISE, TestContact};
    use super::*;

    fn found(contacts: [&TestContact; 2]) -> Outcome {
        found_at(contacts, false)
    }

    fn found_at(contacts: [&TestContact; 2], is_one_speed: bool) -> Outcome {
        let trials = || contacts.iter().zip(1u64..).map(|(contact, seed)| contact.trial(seed)).collect::<Vec<_>>();
        let circumstances = Circumstances { is_one_speed, ..Circumstances::default() };
        identify(trials(), &trials(), &TestContact::nominal(), circumstances, &|_| {}).unwrap()
    }

    fn names(outcome: &Outcome) -> Vec<&'static str> {
        outcome.chosen.model.names(outcome.known_terms)
    }

    #[test]
    fn where_nothing_is_missing_values_are_refitted_and_nothing_is_named() {
        let outcome = found([&TestContact::PLAIN; 2]);
        assert_eq!((names(&outcome), outcome.verdict), (vec![], Verdict::Parameters));
        for (at, truth) in [(index::STIFFNESS, 300.0), (index::DAMPING, 6.0), (index::SURFACE, 0.0)] {
            let ([low, high], value) = (outcome.intervals[at], outcome.chosen.values[at]);
            // 95 % intervals, widened by a half: three values of one draw.
            let slack = 0.5 * (high - low);
            assert!(low - slack < truth && truth < high + slack, "{at}: {value} {low} {high}");
        }
        // 6000 rows tell their power to 1.8 %; the encoder adds 0.6 mN.
        let data = Data {
            trials: &outcome.trials,
            noise: outcome.noise.clone(),
            weights: outcome.weights.clone(),
            noise_factor: 1.0,
        };
        let left = rms(&data, &outcome.residuals[2]);
        assert!((left / FORCE_NOISE - 1.0).abs() < 0.05 && (outcome.expected_noise / FORCE_NOISE - 1.0).abs() < 0.05);
    }

    #[test]
    fn a_branch_that_relaxes_is_named_with_its_values() {
        let outcome = found([&TestContact { branch: 60.0, ..TestContact::PLAIN }; 2]);
        assert_eq!((names(&outcome), outcome.verdict), (vec!["stress_relaxation"], Verdict::Explained));
        let first = outcome.chosen.model.first_value_of(0);
        let [stiffness, time] = [outcome.chosen.values[first], outcome.chosen.values[first + 1]];
        assert!((stiffness / 60.0 - 1.0).abs() < 0.1 && (time / 0.4 - 1.0).abs() < 0.1, "{stiffness} {time}");
        assert!(outcome.named[0].held_out_share > 0.9 && outcome.named[0].p_value < 1e-6);
    }

    #[test]
    fn a_memory_that_multiplies_a_bent_spring_is_named_with_it() {
        let outcome = found([&TestContact { exponent: 1.8, fading: 1.5, ..TestContact::PLAIN }; 2]);
        let mut told = names(&outcome);
        told.sort_unstable();
        assert_eq!((told, outcome.verdict), (vec!["nonlinear_stiffness", "stress_relaxation"], Verdict::Explained));
        let model = &outcome.chosen.model;
        let value = |name: &str, parameter: usize| {
            let at = model.terms.iter().position(|term| term.name() == name).unwrap();
            outcome.chosen.values[model.first_value_of(at) + parameter]
        };
        for (found, truth) in [
            (value("stress_relaxation", 0), 1.5),
            (value("stress_relaxation", 1), 0.4),
            (value("nonlinear_stiffness", 0), 1.8),
        ] {
            assert!((found / truth - 1.0).abs() < 0.05, "{found} for {truth}");
        }
    }

    #[test]
    fn at_one_speed_a_loop_stays_beside_a_memory_as_an_alternative() {
        let relaxing = TestContact { branch: 200.0, ..TestContact::PLAIN };
        let loops =
            |outcome: &Outcome| outcome.alternatives.iter().filter(|other| other.names == ["hysteresis"]).count();
        let [decided, open] = [false, true].map(|is_one_speed| found_at([&relaxing; 2], is_one_speed));
        assert_eq!((names(&decided), loops(&decided)), (vec!["stress_relaxation"], 0));
        assert_eq!((names(&open), loops(&open)), (vec!["stress_relaxation"], 1));
    }

    #[test]
    fn what_one_trial_alone_shows_is_not_confirmed_by_the_other() {
        let outcome = found([&TestContact { zero: 0.4, ..TestContact::PLAIN }, &TestContact::PLAIN]);
        // Told as a zero of each trial, or not at all; a bias that both share would leave half of it in either.
        assert!(!names(&outcome).contains(&"force_bias"), "{:?}", names(&outcome));
        let both = found([&TestContact { zero: 0.4, ..TestContact::PLAIN }; 2]);
        assert_eq!(names(&both), ["force_bias"]);
        let value = both.chosen.values[both.chosen.model.first_value_of(0)];
        assert!((value - 0.4).abs() < 0.01, "{value}");
    }

    /// A spring whose force saturates as x / (1 + x / length). A layer that gave way all the way down would follow it nearly, and is none.
    #[test]
    fn a_spring_that_softens_all_the_way_is_no_layer() {
        let length = 12e-3;
        let more = |x: f64| 300.0 * x.max(0.0) * (1.0 / (1.0 + x.max(0.0) / length) - 1.0);
        let trials = || [1, 2].map(|seed| TestContact::PLAIN.trial_with(seed, more)).to_vec();
        let outcome =
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
        assert_eq!((names(&outcome), outcome.verdict), (vec!["nonlinear_stiffness"], Verdict::Explained));
        let (at, ranges) = (outcome.chosen.model.first_value_of(0), &outcome.intervals);
        let ([low, high], softening) = (ranges[at], outcome.chosen.values[at]);
        // A 95 % interval, widened by a half: one value of one draw.
        let slack = 0.5 * (high - low);
        assert!(low - slack < 1.0 / length && 1.0 / length < high + slack, "{softening} 1/m, {low} to {high}");
        assert!((softening * length - 1.0).abs() < 0.05, "{softening} 1/m");
    }

    /// A foam that yields in the middle of its way and stiffens beyond it: no power and no exponential does both, and layers would be three.
    #[test]
    fn a_spring_that_softens_before_it_hardens_is_one_spring() {
        let (way, [quadratic, cubic]) = (8e-3, [-1.6, 1.0]);
        let bend = |x: f64| 300.0 * x.max(0.0) * (quadratic + cubic * x / way) * x / way;
        let trials = || [1, 2].map(|seed| TestContact::PLAIN.trial_with(seed, bend)).to_vec();
        let outcome =
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
        assert_eq!((names(&outcome), outcome.verdict), (vec!["nonlinear_stiffness"], Verdict::Explained));
        let at = outcome.chosen.model.first_value_of(0);
        for (place, truth) in [(at, 300.0 * quadratic / way), (at + 1, 300.0 * cubic / way.powi(2))] {
            let ([low, high], value) = (outcome.intervals[place], outcome.chosen.values[place]);
            // A 95 % interval, widened by a half: values of one draw.
            let slack = 0.5 * (high - low);
            assert!(low - slack < truth && truth < high + slack, "{value} for {truth}: {low} to {high}");
            assert!((value / truth - 1.0).abs() < 0.05, "{value} for {truth}");
        }
    }

    #[test]
    fn a_surface_that_breathes_is_one_effect_and_no_stiffness_that_varies() {
        // A breath of 0.35 Hz and 2 mm as the fourth power of a cosine, in a phase of its own in each trial; the tool goes at 0.64 Hz.
        let breath =
            |phase: f64| move |t: f64| 2e-3 * ((std::f64::consts::PI * 0.35 * t + phase).cos().powi(4) - 0.375);
        let trials = || {
            let trial = |(seed, phase): (u64, f64)| {
                let mut trial = TestContact::PLAIN.trial(seed);
                let surface = breath(phase);
                for row in 0..trial.len() {
                    let time = trial.time[row];
                    let rate = (surface(time + 1e-5) - surface(time - 1e-5)) / 2e-5;
                    let law =
                        |depth: f64, speed: f64| if depth > 0.0 { (300.0 * depth + 6.0 * speed).max(0.0) } else { 0.0 };
                    let (x, v) = (trial.position[row], trial.velocity[row]);
                    trial.force[row] += law(x - surface(time), v - rate) - law(x, v);
                }
                trial
            };
            [(1, 0.4), (2, 1.9)].map(trial).to_vec()
        };
        let outcome =
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
        assert_eq!((names(&outcome), outcome.verdict), (vec!["surface_motion"], Verdict::Explained));
        let values = &outcome.chosen.values[outcome.chosen.model.first_value_of(0)..];
        // The second harmonic is a quarter of the first, whatever the phase, and the frequency is told to a thousandth of a turn a second.
        let part = |at: usize| values[at].hypot(values[at + 1]);
        assert!((part(0) / 1e-3 - 1.0).abs() < 0.05 && (part(2) / 0.25e-3 - 1.0).abs() < 0.1, "{values:?}");
        assert!((values[6] - 0.35).abs() < 2e-3, "{values:?}");
    }

    /// Means of so many rows that a capillary, or a capillary and layers, are likelier by them than what acts. By every row a curve does better than the capillary
    /// and none than the bridge, and beside the bridge no layers are needed.
    #[test]
    fn a_bridge_that_means_of_rows_do_not_show_is_told_by_the_rows() {
        for (pull, length, every) in [(0.15, 1.2e-3, 24), (0.15, 0.6e-3, 16), (0.1, 2e-3, 4)] {
            let recordings = [1, 2].map(|seed| TestContact::PLAIN.bridged(seed, pull, length));
            let seen =
                |every: usize| recordings.each_ref().map(|recording| TestContact::seen_in_means(recording, every));
            let (rows, means) = (seen(1).to_vec(), seen(every));
            let outcome = identify(rows, &means, &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
            assert_eq!(
                (names(&outcome), outcome.verdict),
                (vec!["adhesion"], Verdict::Explained),
                "{pull} N over {length} m, {every} rows: {:?}",
                outcome.rivals
            );
        }
    }

    #[test]
    fn what_no_effect_explains_is_unknown() {
        let ripple = |x: f64| if x > 0.0 { 0.16 * (std::f64::consts::TAU * x / 2.5e-3).sin() } else { 0.0 };
        let trials = || [1, 2].map(|seed| TestContact::PLAIN.trial_with(seed, ripple)).to_vec();
        let outcome =
            identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
        assert_eq!((names(&outcome), outcome.verdict), (vec![], Verdict::Unknown));
    }

    /// Twenty pairs of trials of nothing: of an alarm in a hundred, one of twenty would be rare, and of one in five none is one in eighty.
    #[test]
    fn nothing_is_named_where_nothing_is_missing_draw_after_draw() {
        for seed in 100..120 {
            let trials = || [seed, seed + 50].map(|seed| TestContact::PLAIN.trial(seed)).to_vec();
            let outcome =
                identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap();
            assert_eq!((names(&outcome), outcome.verdict), (vec![], Verdict::Parameters), "seed {seed}");
        }
    }
}
