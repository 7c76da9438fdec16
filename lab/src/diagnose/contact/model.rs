//! The contact's law with the effects added to it: what the force sensor shows along a motion.

use super::scales::Scales;
use super::trial::ContactTrial;
use crate::diagnose::term::Term;
use crate::effects::contact_simulator::{ActiveEffect, ContactSimulator};
use crate::effects::{Limit, Parameter, Place, Reading, Stage};
use crate::rig::Contact;

/// Places of the nominal values.
pub mod index {
    /// Stiffness K.
    pub const STIFFNESS: usize = 0;
    /// Damping B.
    pub const DAMPING: usize = 1;
    /// Position of the surface in the first trial.
    pub const SURFACE: usize = 2;
    /// Force late against position, s: a part of a recorded row, which no clock settles.
    pub const TIMING: usize = 3;
    /// How many all trials share.
    pub const SHARED: usize = 4;
}

/// What every trial may have for itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OwnValues {
    /// The surface lies elsewhere in each trial, by more than an encoder's start within its step.
    pub surface: bool,
    /// The force sensor's zero is another one in each trial.
    pub zero: bool,
    /// Another spot of the same body: all contact forces are greater or less by one factor.
    pub scale: bool,
}

impl OwnValues {
    /// None of them.
    pub const NONE: Self = Self { surface: false, zero: false, scale: false };
}

/// The structure of the contact's law. Its values are a vector: the nominal ones, those of each trial, and those of each term in turn.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactModel {
    /// Force both ways.
    pub bilateral: bool,
    /// Reading of the sensor without a force, by the rig file.
    pub force_zero: f64,
    /// Trials.
    pub trials: usize,
    /// What each trial has for itself.
    pub own: OwnValues,
    /// Effects.
    pub terms: Vec<Term>,
    /// Sizes of the recordings.
    pub scales: Scales,
}

/// How one value may move.
#[derive(Debug, Clone, Copy)]
pub struct Range {
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
    /// A change that matters; of a value that moves by factors, none.
    pub size: f64,
    /// Whether it moves by factors: a size above zero that may be of any order.
    pub by_factors: bool,
    /// Whether it moves at all.
    pub free: bool,
    /// Value and deviation that are expected before anything was seen.
    pub prior: Option<(f64, f64)>,
}

impl Range {
    const fn linear(low: f64, high: f64, size: f64) -> Self {
        Self { low, high, size, by_factors: false, free: true, prior: None }
    }

    /// `value` moved by `steps` of its size.
    #[must_use]
    pub fn moved(&self, value: f64, steps: f64) -> f64 {
        if self.by_factors { value * steps.exp() } else { value + steps * self.size }
    }
}

/// Deviation of a trial's own surface where it lies elsewhere, of the greatest depth.
const SURFACE_PRIOR: f64 = 0.3;

/// Deviation of a trial's own zero, of the greatest force.
const ZERO_PRIOR: f64 = 0.1;

/// Part of the force's range from which a spring's force falls, and points of the way that it is looked at in.
const LEAST_FALL: f64 = 0.02;
const PATH_POINTS: usize = 60;

/// A force that falls on the way in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fall {
    /// And goes on falling, or stays low, as far in as the tool went.
    ToTheEnd,
    /// And rises again: a pocket.
    Pocket,
}

/// The largest fall along `path`, if it is more than `least`: a pocket where the force rises again by as much.
fn fall_along(path: &[f64], least: f64) -> Option<Fall> {
    let (mut highest, mut most, mut bottom) = (f64::NEG_INFINITY, 0.0, 0);
    for (at, force) in path.iter().enumerate() {
        highest = force.max(highest);
        if highest - force > most {
            (most, bottom) = (highest - force, at);
        }
    }
    let rises = path[bottom..].iter().any(|force| force - path[bottom] > least);
    (most > least).then_some(if rises { Fall::Pocket } else { Fall::ToTheEnd })
}

/// Deviation of the logarithm of a trial's own factor: spots of one body differ by factors of 1.2 to 1.7.
const SCALE_PRIOR: f64 = 0.4;

impl ContactModel {
    /// The same with one more effect.
    #[must_use]
    pub fn with(&self, term: Term) -> Self {
        let mut more = self.clone();
        more.terms.push(term);
        more
    }

    /// Values that are no effect's.
    #[must_use]
    pub fn nominal_count(&self) -> usize {
        let each = usize::from(self.own.zero) + usize::from(self.own.scale);
        index::SHARED + self.trials.saturating_sub(1) * (1 + each)
    }

    /// Where the values of term `at` begin.
    #[must_use]
    pub fn first_value_of(&self, at: usize) -> usize {
        self.nominal_count() + self.terms[..at].iter().map(|term| self.count_of(term)).sum::<usize>()
    }

    /// Values of `term`.
    #[must_use]
    pub fn count_of(&self, term: &Term) -> usize {
        term.all_parameters(self.trials).len()
    }

    /// How many values there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.first_value_of(self.terms.len())
    }

    /// Values that are fitted and no trial's own place within an encoder's step.
    #[must_use]
    pub fn free_count(&self) -> usize {
        self.ranges(&vec![1.0; self.count()]).iter().filter(|range| range.free).count()
    }

    fn own_value(&self, values: &[f64], trial: usize, nth: usize) -> f64 {
        let others = self.trials - 1;
        if trial == 0 { 0.0 } else { values[index::SHARED + nth * others + trial - 1] }
    }

    /// Position of the surface in trial `trial`.
    #[must_use]
    pub fn surface(&self, values: &[f64], trial: usize) -> f64 {
        values[index::SURFACE] + self.own_value(values, trial, 0)
    }

    /// Zero of the sensor in trial `trial`, beside that of the rig file.
    #[must_use]
    pub fn zero(&self, values: &[f64], trial: usize) -> f64 {
        if self.own.zero { self.own_value(values, trial, 1) } else { 0.0 }
    }

    /// Factor of the contact's force in trial `trial`.
    #[must_use]
    pub fn scale(&self, values: &[f64], trial: usize) -> f64 {
        if self.own.scale { self.own_value(values, trial, 1 + usize::from(self.own.zero)).exp() } else { 1.0 }
    }

    /// The trial that value `at` belongs to alone; `None` where it is shared.
    #[must_use]
    pub fn owner(&self, at: usize) -> Option<usize> {
        let others = self.trials - 1;
        if at < index::SHARED || others == 0 {
            return None;
        }
        if at < self.nominal_count() {
            return Some(1 + (at - index::SHARED) % others);
        }
        let term = (0..self.terms.len()).rev().find(|term| at >= self.first_value_of(*term))?;
        let (first, own) = (self.first_value_of(term), self.terms[term].parameters());
        let offset = at - first;
        let each = own.iter().filter(|parameter| parameter.each_trial).count();
        if offset < own.len() {
            return own[offset].each_trial.then_some(0);
        }
        Some(1 + (offset - own.len()) / each)
    }

    /// How each value may move.
    #[must_use]
    pub fn ranges(&self, values: &[f64]) -> Vec<Range> {
        let scales = &self.scales;
        let stiff = scales.stiffness();
        let late = 0.5 * scales.source_step_s;
        let place = 0.05 * scales.depth;
        let mut ranges = vec![
            Range::linear(0.0, 1e3 * stiff, values[index::STIFFNESS].abs().max(1e-3 * stiff)),
            Range::linear(0.0, f64::INFINITY, values[index::DAMPING].abs().max(0.02 * scales.force / scales.speed)),
            Range::linear(f64::NEG_INFINITY, f64::INFINITY, place),
            Range::linear(-late, late, late),
        ];
        let others = self.trials - 1;
        let within_step = 0.5 * scales.resolution;
        for _ in 0..others {
            ranges.push(if self.own.surface {
                let prior = Some((0.0, SURFACE_PRIOR * scales.depth));
                Range { prior, ..Range::linear(f64::NEG_INFINITY, f64::INFINITY, place) }
            } else {
                let prior = Some((0.0, within_step.max(f64::MIN_POSITIVE)));
                Range { free: within_step > 0.0, prior, ..Range::linear(-within_step, within_step, within_step) }
            });
        }
        let mut each = |is_there: bool, deviation: f64| {
            let range = Range {
                prior: Some((0.0, deviation)),
                ..Range::linear(f64::NEG_INFINITY, f64::INFINITY, 0.1 * deviation)
            };
            ranges.extend(std::iter::repeat_n(range, if is_there { others } else { 0 }));
        };
        each(self.own.zero, ZERO_PRIOR * scales.force);
        each(self.own.scale, SCALE_PRIOR);
        for (at, term) in self.terms.iter().enumerate() {
            let start = self.first_value_of(at);
            for (offset, parameter) in term.all_parameters(self.trials).iter().enumerate() {
                ranges.push(self.term_range(parameter, values[start + offset]));
            }
        }
        ranges
    }

    fn term_range(&self, parameter: &Parameter, value: f64) -> Range {
        let scales = &self.scales;
        let (mut low, mut high) = (parameter.low, parameter.high);
        match parameter.limit {
            Limit::ResolvableTime => low = low.max(2.0 * scales.step_s),
            Limit::ReachedRange => {
                low = low.max(0.15 * scales.force).max(scales.reached_force - self.force_zero.abs());
            }
            Limit::RepeatedCycles => low = low.max(1.8 / scales.duration_s),
            Limit::ResolvableLength => low = low.max(scales.resolution),
            Limit::VisitedDepth => high = high.min(self.longest_way()),
            Limit::BoundsOnly => {}
        }
        let by_factors = parameter.low >= 0.0 && parameter.high.is_infinite() && value > 0.0;
        let size = if value == 0.0 { 1e-3 } else { value.abs() };
        let prior = None;
        Range { low, high, size, by_factors, free: !parameter.fixed, prior }
    }

    /// Longest way between two reversals that the recordings can hold, m or rad: a clamped tool goes to and fro on both sides of the
    /// surface, another one from there inwards.
    fn longest_way(&self) -> f64 {
        if self.bilateral { self.scales.travel() } else { self.scales.depth }
    }

    /// How the spring's force falls on the way in, where it does by more than a fiftieth of its range: as over a click, or where a column
    /// buckles. A spring that hardens, softens or lies on another does not.
    #[must_use]
    pub fn fall(&self, values: &[f64]) -> Option<Fall> {
        let all = self.acting(Place::Contact, values, 0);
        let held: Vec<ActiveEffect<'_>> =
            all.iter().map(active).filter(|active| active.stage() == Stage::Law).collect();
        if held.is_empty() {
            return None;
        }
        let contact =
            Contact { surface: 0.0, stiffness: values[index::STIFFNESS], damping: 0.0, bilateral: self.bilateral };
        let mut law = ContactSimulator::new(contact, &held);
        let depth = self.deepest(values);
        let path: Vec<f64> = (0..PATH_POINTS)
            .map(|point| law.step(point as f64, 1.0, depth * point as f64 / (PATH_POINTS - 1) as f64, 0.0, 0.0, 0.0))
            .collect();
        let least = LEAST_FALL * path.iter().fold(0.0f64, |most, force| most.max(*force));
        fall_along(&path, least)
    }

    /// Whether some effect of it may let the force fall.
    #[must_use]
    pub fn may_fall(&self) -> bool {
        self.terms.iter().any(|term| term.effect.may_fall(term.form))
    }

    /// Frequencies of the waves that its effects hold, Hz.
    #[must_use]
    pub fn frequencies(&self, values: &[f64]) -> Vec<f64> {
        let terms = self.terms.iter().enumerate();
        let waves = terms.flat_map(|(nth, term)| values[self.first_value_of(nth)..].iter().zip(term.parameters()));
        waves.filter(|(_, parameter)| parameter.limit == Limit::RepeatedCycles).map(|(value, _)| *value).collect()
    }

    /// Frequency of term `nth`, Hz, where it is a line of the spectrum.
    #[must_use]
    pub fn line(&self, values: &[f64], nth: usize) -> Option<f64> {
        let named = self.terms[nth].parameters().iter().position(|parameter| parameter.name == "frequency")?;
        let is_line = !self.terms[nth].effect.lines().is_empty();
        is_line.then(|| values[self.first_value_of(nth) + named])
    }

    /// Whether a value of an effect ended at an end of what the recordings can show.
    #[must_use]
    pub fn is_at_end(&self, values: &[f64]) -> bool {
        let ranges = self.ranges(values);
        self.terms.iter().enumerate().any(|(nth, term)| {
            let start = self.first_value_of(nth);
            term.all_parameters(self.trials).iter().enumerate().any(|(offset, parameter)| {
                let (range, value) = (&ranges[start + offset], values[start + offset]);
                let near = |end: f64| end.is_finite() && end != 0.0 && (value - end).abs() <= 1e-6 * end.abs();
                parameter.limit != Limit::BoundsOnly && (near(range.low) || near(range.high))
            })
        })
    }

    /// Deepest that the tool went below the surface, or farthest from it where it is clamped, m or rad.
    fn deepest(&self, values: &[f64]) -> f64 {
        let [low, high] = self.scales.positions.map(|position| position - values[index::SURFACE]);
        if self.bilateral { high.max(-low) } else { high }
    }

    /// Whether each effect's values are what its statement says.
    #[must_use]
    pub fn is_as_stated(&self, values: &[f64]) -> bool {
        self.terms.iter().enumerate().all(|(nth, term)| {
            let start = self.first_value_of(nth);
            term.effect.is_itself(term.form, &values[start..start + self.count_of(term)], self.deepest(values))
        })
    }

    /// Force that the sensor shows along `trial`, whose number is `number`.
    #[must_use]
    pub fn predicted(&self, values: &[f64], trial: &ContactTrial, number: usize) -> Vec<f64> {
        let contact = Contact {
            surface: self.surface(values, number),
            stiffness: values[index::STIFFNESS],
            damping: values[index::DAMPING],
            bilateral: self.bilateral,
        };
        let held = self.acting(Place::Contact, values, number);
        let actives: Vec<ActiveEffect<'_>> = held.iter().map(active).collect();
        let mut law = ContactSimulator::new(contact, &actives);
        let scale = self.scale(values, number);
        let mut before = trial.time.first().copied().unwrap_or(0.0);
        let mut force: Vec<f64> = (0..trial.len())
            .map(|row| {
                let step = trial.time[row] - before;
                before = trial.time[row];
                let (position, velocity) = (trial.position[row], trial.velocity[row]);
                scale * law.step(trial.time[row], step, position, velocity, trial.acceleration[row], 0.0)
            })
            .collect();
        self.sense(values, trial, number, &mut force);
        force
    }

    /// What the sensor makes of the force on the tool.
    fn sense(&self, values: &[f64], trial: &ContactTrial, number: usize, force: &mut [f64]) {
        shift(force, values[index::TIMING], trial.step_s);
        let mut sensors = self.acting(Place::Sensor, values, number);
        sensors.sort_by_key(|held| held.0.effect.spec().stage);
        // A row that is a mean has passed a window, which is narrower than what any effect of the sensor tells.
        let width = if trial.step_s > 1.5 * trial.source_step_s { trial.step_s / 12f64.sqrt() } else { 0.0 };
        for (term, own) in &sensors {
            let mut reading = Reading {
                start: trial.time.first().copied().unwrap_or(0.0),
                step: trial.step_s,
                filter_width: width,
                acceleration: &trial.acceleration,
                force,
            };
            term.effect.act_on_reading(term.form, own, &mut reading);
        }
        let zero = self.force_zero + self.zero(values, number);
        force.iter_mut().for_each(|force| *force += zero);
    }

    fn acting(&self, place: Place, values: &[f64], trial: usize) -> Vec<(Term, Vec<f64>)> {
        let terms = self.terms.iter().enumerate().filter(|(_, term)| term.effect.spec().place == place);
        terms
            .map(|(at, term)| {
                let start = self.first_value_of(at);
                (*term, term.in_trial(&values[start..start + self.count_of(term)], trial))
            })
            .collect()
    }

    /// How often an effect of that name is held.
    #[must_use]
    pub fn times(&self, name: &str) -> usize {
        self.terms.iter().filter(|term| term.name() == name).count()
    }

    /// The names of its terms from number `first` on, each once.
    #[must_use]
    pub fn names(&self, first: usize) -> Vec<&'static str> {
        let mut names: Vec<&'static str> = self.terms[first.min(self.terms.len())..].iter().map(Term::name).collect();
        names.sort_unstable();
        names.dedup();
        names
    }
}

fn active(held: &(Term, Vec<f64>)) -> ActiveEffect<'_> {
    ActiveEffect { effect: held.0.effect, form: held.0.form, values: &held.1 }
}

/// `force` later by `late`, which is a part of a row: its first order is all of it.
fn shift(force: &mut [f64], late: f64, step: f64) {
    if late == 0.0 || force.len() < 2 {
        return;
    }
    let part = 0.5 * late / step;
    let mut before = force[0];
    for row in 0..force.len() {
        let here = force[row];
        let after = force.get(row + 1).copied().unwrap_or(here);
        force[row] = here - part * (after - before);
        before = here;
    }
}

#[cfg(test)]
mod tests {
    use super::super::fit::Data;
    use super::super::nominal::nominal_fit;
    use super::super::testing::TestContact;
    use super::*;
    use crate::effects;

    /// The law of the test's contact with `name` by its form `form`, and its values with `own` for the effect.
    fn law(name: &str, form: usize, own: &[f64]) -> (ContactModel, Vec<f64>) {
        let trials = [TestContact::PLAIN.trial(1)];
        let plain = nominal_fit(&Data::new(&trials), &TestContact::nominal());
        let model = plain.model.with(Term { effect: effects::find(name).unwrap(), form });
        (model, plain.values.iter().chain(own).copied().collect())
    }

    #[test]
    fn a_loop_yields_within_the_depth_that_was_visited() {
        let (model, values) = law("hysteresis", 3, &[1.0, 1e-3]);
        let yields = model.first_value_of(0) + 1;
        let deepest = model.ranges(&values)[yields].high;
        // Ten millimetres deep at the most.
        assert!((deepest - model.scales.depth).abs() < 1e-12 && (5e-3..11e-3).contains(&deepest), "{deepest}");
        let with = |value: f64| {
            let mut values = values.clone();
            values[yields] = value;
            model.is_at_end(&values)
        };
        assert!(!with(0.5 * deepest) && with(deepest), "a search that ends at the bound is refused");
        // A clamped tool goes to and fro on both sides: its longest way is the whole travel, however far away its preload lies.
        let clamped = ContactModel { bilateral: true, ..model };
        assert_eq!(clamped.ranges(&values)[yields].high, clamped.scales.travel());
    }

    #[test]
    fn a_spring_that_falls_on_the_way_in_is_told_from_one_that_softens_and_a_pocket_from_both() {
        // 300 N/m, by 250 N/m less from 4 mm on, and by 500 N/m less: there the force falls.
        let falls = |added: f64| {
            let (model, values) = law("layered_stiffness", 0, &[added, 4e-3]);
            (model.fall(&values), model.may_fall())
        };
        assert_eq!(falls(-250.0), (None, false));
        assert_eq!(falls(-500.0), (Some(Fall::ToTheEnd), false));
        assert_eq!(falls(900.0), (None, false));
        let (model, values) = law("layered_stiffness", 2, &[-500.0, 3e-3, 900.0, 5e-3]);
        assert_eq!((model.fall(&values), model.may_fall()), (Some(Fall::Pocket), true));
    }
}
