//! What the simulation says of a recorded motion: the nominal rig and the effects added to it.

pub mod contact_phase;
mod drive_balance;
pub mod excitation;
pub mod residual;
pub mod term;

use crate::diagnose::signals::filtered_trial::{AnalysisTrial, FilteredTrial};
use crate::effects::contact_simulator::{ActiveEffect, ContactSimulator};
use crate::effects::{Effect, Place, Reading};
use crate::rig::Contact;
pub use residual::{Channels, Residual};
pub use term::Term;

/// Index of the nominal values in a parameter vector.
pub mod index {
    /// Stiffness.
    pub const STIFFNESS: usize = 0;
    /// Damping of the contact.
    pub const DAMPING: usize = 1;
    /// Surface.
    pub const SURFACE: usize = 2;
    /// Force late against position, s: within a quarter of a sample, what no clock settles.
    pub const FORCE_TIMING: usize = 3;
    /// Inertia.
    pub const INERTIA: usize = 4;
    /// Viscous friction of the drive.
    pub const VISCOUS: usize = 5;
    /// Effort late against position, s: within half a sample, what its hold leaves open.
    pub const EFFORT_TIMING: usize = 6;
    /// Nominal values that all trials share.
    pub const SHARED: usize = 7;
}

/// The structure of a simulation. Its values are a vector: the nominal ones, then those of each term in turn.
#[derive(Debug, Clone)]
pub struct Model {
    /// Whether there is a force channel with a contact to predict it, and whether that pulls.
    pub contact: Option<bool>,
    /// Whether there is an effort channel with a drive to predict it.
    pub drive: bool,
    /// Stiffness of the rig file.
    pub given_stiffness: f64,
    /// Inertia of the rig file: the fit stays within a factor of four of it, or physics that is missing empties it.
    pub given_inertia: f64,
    /// What the force sensor shows at rest by the rig file.
    pub force_zero: f64,
    /// How far the surface may lie elsewhere in each trial after the first: an encoder starts anywhere within its step.
    pub surface_shifts: Vec<f64>,
    /// Effects.
    pub terms: Vec<Term>,
}

impl Model {
    /// The same with one more effect.
    #[must_use]
    pub fn with(&self, term: Term) -> Self {
        let mut terms = self.terms.clone();
        terms.push(term);
        Self { terms, ..self.clone() }
    }

    /// Length of the nominal values.
    #[must_use]
    pub fn nominal_count(&self) -> usize {
        index::SHARED + self.surface_shifts.len()
    }

    /// Trials.
    #[must_use]
    pub fn trials(&self) -> usize {
        1 + self.surface_shifts.len()
    }

    /// Surface of trial `trial`.
    #[must_use]
    pub fn surface(&self, values: &[f64], trial: usize) -> f64 {
        values[index::SURFACE] + if trial == 0 { 0.0 } else { values[index::SHARED + trial - 1] }
    }

    /// Where the values of term `at` begin.
    #[must_use]
    pub fn first_value_of(&self, at: usize) -> usize {
        let trials = self.trials();
        self.nominal_count() + self.terms[..at].iter().map(|term| term.all_parameters(trials).len()).sum::<usize>()
    }

    /// The channels that an effect at `place` reaches.
    #[must_use]
    pub fn affected_channels(&self, place: Place) -> Channels {
        match place {
            Place::Contact => Channels { force: self.contact.is_some(), effort: false },
            Place::Drive => Channels { force: false, effort: self.drive },
            Place::Sensor => Channels { force: self.contact.is_some(), effort: self.drive && self.contact.is_some() },
        }
    }

    /// Whether there is anything for an effect at `place` to act on.
    #[must_use]
    pub fn takes(&self, place: Place) -> bool {
        let reach = self.affected_channels(place);
        reach.force || reach.effort
    }

    /// What the model with `values` leaves of `trial`.
    #[must_use]
    pub fn residual(&self, values: &[f64], trial: &AnalysisTrial, channels: Channels) -> Residual {
        let (force, effort) = (channels.force, channels.effort && self.drive);
        let number = trial.number;
        let of = |wanted: bool, filtered: &FilteredTrial, law: &dyn Fn(&FilteredTrial) -> Vec<f64>| {
            if wanted { filtered.apply_law(law) } else { Vec::new() }
        };
        let force = of(force, &trial.contact, &|filtered| self.force_residual(values, number, filtered));
        let effort = of(effort, &trial.drive, &|filtered| self.effort_residual(values, number, filtered));
        Residual { force, effort }
    }

    fn force_residual(&self, values: &[f64], trial: usize, filtered: &FilteredTrial) -> Vec<f64> {
        let (Some(bilateral), Some(measured), Some(rate)) = (self.contact, &filtered.force, &filtered.force_rate)
        else {
            return Vec::new();
        };
        let reading = self.reading(values, trial, filtered, &self.contact_force(values, trial, filtered, bilateral));
        // A fraction of a sample: its first order is all of it, and leaves the band as it is.
        let late = values[index::FORCE_TIMING];
        let measured = measured.iter().zip(rate).map(|(force, rate)| force + late * rate);
        measured.zip(&reading).map(|(measured, reading)| measured - reading).collect()
    }

    fn effort_residual(&self, values: &[f64], trial: usize, filtered: &FilteredTrial) -> Vec<f64> {
        let Some(measured) = &filtered.force else { return self.balance(values, trial, filtered, |_| 0.0) };
        // What the sensor makes of the force on the tool is taken off the reading to get at that force.
        let bilateral = self.contact.filter(|_| self.has_sensor_effect());
        let distortion = bilateral.map(|bilateral| {
            let borne = self.contact_force(values, trial, filtered, bilateral);
            let reading = self.reading(values, trial, filtered, &borne);
            reading.iter().zip(&borne).map(|(reading, borne)| reading - borne).collect::<Vec<f64>>()
        });
        let taken = |at: usize| distortion.as_ref().map_or(self.force_zero, |taken| taken[at]);
        self.balance(values, trial, filtered, |at| measured[at] - taken(at))
    }

    /// Whether `effect` is among the terms already and cannot be there twice. Relaxation can: it has as many times as it likes.
    #[must_use]
    pub fn holds(&self, effect: &dyn Effect) -> bool {
        let same = |term: &&Term| term.name() == effect.spec().name;
        self.terms.iter().filter(same).count() >= effect.spec().max_instances
    }

    /// Whether an effect of the sensor is among the terms.
    #[must_use]
    pub fn has_sensor_effect(&self) -> bool {
        self.terms.iter().any(|term| term.effect.spec().place == Place::Sensor)
    }

    /// Force between tool and environment along the motion.
    #[must_use]
    pub fn contact_force(&self, values: &[f64], trial: usize, filtered: &FilteredTrial, bilateral: bool) -> Vec<f64> {
        let contact = Contact {
            surface: self.surface(values, trial),
            stiffness: values[index::STIFFNESS],
            damping: values[index::DAMPING],
            bilateral,
        };
        let acting = self.at(Place::Contact, values, trial);
        let actives: Vec<ActiveEffect<'_>> = acting.iter().map(active).collect();
        let mut along = ContactSimulator::new(contact, &actives);
        (0..filtered.len())
            .map(|at| {
                let step = if at == 0 { 0.0 } else { filtered.step };
                let (position, velocity) = (filtered.position[at], filtered.velocity[at]);
                along.step(
                    at as f64 * filtered.step,
                    step,
                    position,
                    velocity,
                    filtered.acceleration[at],
                    filtered.filter_width,
                )
            })
            .collect()
    }

    /// What the sensor shows of `borne`.
    #[must_use]
    pub fn reading(&self, values: &[f64], trial: usize, filtered: &FilteredTrial, borne: &[f64]) -> Vec<f64> {
        self.sensed(values, trial, filtered, borne, filtered.filter_width)
    }

    /// The rows that a sensor writes down, before any filter, of `borne` that is smooth.
    #[must_use]
    pub fn rows(&self, values: &[f64], trial: usize, filtered: &FilteredTrial, borne: &[f64]) -> Vec<f64> {
        self.sensed(values, trial, filtered, borne, 0.0)
    }

    fn sensed(
        &self,
        values: &[f64],
        trial: usize,
        filtered: &FilteredTrial,
        borne: &[f64],
        added_filter_width: f64,
    ) -> Vec<f64> {
        let mut force = borne.to_vec();
        let acceleration = &filtered.acceleration;
        let (step, filter_width) = (filtered.step, filtered.filter_width);
        let mut reading =
            Reading { start: 0.0, step, filter_width, added_filter_width, acceleration, force: &mut force };
        let mut sensors = self.at(Place::Sensor, values, trial);
        sensors.sort_by_key(|(term, _)| term.effect.spec().stage);
        for (term, values) in &sensors {
            term.effect.act_on_reading(term.form, values, &mut reading);
        }
        force.iter_mut().for_each(|force| *force += self.force_zero);
        force
    }

    /// The greatest effort that the drive gives in trial `trial`, where a term says so.
    #[must_use]
    pub fn effort_limit(&self, values: &[f64], trial: usize) -> Option<f64> {
        let acting = self.at(Place::Drive, values, trial);
        acting.iter().filter_map(|(term, values)| term.effect.effort_limit(term.form, values)).reduce(f64::min)
    }

    /// The terms at `place` with their values in trial `trial`.
    #[must_use]
    pub fn at(&self, place: Place, values: &[f64], trial: usize) -> Vec<(Term, Vec<f64>)> {
        let here = self.terms.iter().enumerate().filter(|(_, term)| term.effect.spec().place == place);
        here.map(|(at, term)| (*term, term.in_trial(&values[self.first_value_of(at)..], trial))).collect()
    }
}

fn active((term, values): &(Term, Vec<f64>)) -> ActiveEffect<'_> {
    ActiveEffect { effect: term.effect, form: term.form, values }
}
