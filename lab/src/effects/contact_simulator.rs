//! The contact law along a motion: spring, damper and the contact effects in the order of their stages.

use super::{ContactState, Effect, EffectState, Place, Stage};
use crate::rig::Contact;

/// An effect at work: which one, by which of its laws, with which values.
#[derive(Clone, Copy)]
pub struct ActiveEffect<'a> {
    /// Which one.
    pub effect: &'static dyn Effect,
    /// Index of its form.
    pub form: usize,
    /// In the order of the form's parameters.
    pub values: &'a [f64],
}

impl ActiveEffect<'_> {
    /// When it acts among others of its place.
    #[must_use]
    pub fn stage(&self) -> Stage {
        self.effect.spec().stage
    }
}

/// An effect and what it carries from one instant to the next.
#[derive(Clone, Copy)]
struct Term<'a> {
    active: ActiveEffect<'a>,
    stage: Stage,
    memory: EffectState,
    kept: EffectState,
}

/// A contact that is walked through instant by instant.
///
/// F = max(0, K x + B v + effects), x = position - surface, in N (or N m), positive when the tool pushes; forces of both
/// signs where the contact is bilateral or an effect pulls. Without effects it is [`Contact::force`].
#[derive(Clone)]
pub struct ContactSimulator<'a> {
    contact: Contact,
    /// Sorted by stage.
    terms: Vec<Term<'a>>,
    /// What was borne an instant ago, before it was cut.
    borne: f64,
    kept: f64,
}

impl<'a> ContactSimulator<'a> {
    /// The law of `contact` with those of `actives` that act in the contact, at the start of a trial.
    ///
    /// Effects of one stage act in the order in which they are given.
    #[must_use]
    pub fn new(contact: Contact, actives: &[ActiveEffect<'a>]) -> Self {
        let mut terms: Vec<_> = actives
            .iter()
            .filter(|active| active.effect.spec().place == Place::Contact)
            .map(|active| Term {
                active: *active,
                stage: active.stage(),
                memory: EffectState::default(),
                kept: EffectState::default(),
            })
            .collect();
        terms.sort_by_key(|term| term.stage);
        Self { contact, terms, borne: 0.0, kept: 0.0 }
    }

    /// Marks this instant, for [`ContactSimulator::rewind`].
    pub fn keep(&mut self) {
        self.terms.iter_mut().for_each(|term| term.kept = term.memory);
        self.kept = self.borne;
    }

    /// Takes back every step since the last [`ContactSimulator::keep`].
    pub fn rewind(&mut self) {
        self.terms.iter_mut().for_each(|term| term.memory = term.kept);
        self.borne = self.kept;
    }

    /// The force on the tool at the next instant.
    ///
    /// `time` is in seconds since the trial began, `step` since the last instant (zero at the first); `position` is the
    /// tool's as the sensor counts it, `smoothing_width` the time in seconds over which corners are smoothed.
    pub fn step(
        &mut self,
        time: f64,
        step: f64,
        position: f64,
        velocity: f64,
        acceleration: f64,
        smoothing_width: f64,
    ) -> f64 {
        let contact = &self.contact;
        let mut touch = ContactState {
            time,
            step,
            position: position - contact.surface,
            velocity,
            acceleration,
            smoothing_width,
            bilateral: contact.bilateral,
            depth: 0.0,
            rate: 0.0,
            inside: 0.0,
            stiffness: contact.stiffness,
            damping: contact.damping,
            spring: 0.0,
            extra: 0.0,
            force: 0.0,
        };
        let mut terms = self.terms.iter_mut().peekable();
        let mut act = |last: Stage, touch: &mut ContactState| {
            while let Some(term) = terms.next_if(|term| term.stage <= last) {
                term.active.effect.act_on_contact(term.active.form, term.active.values, &mut term.memory, touch);
            }
        };
        act(Stage::Geometry, &mut touch);
        touch.enter();
        act(Stage::Depth, &mut touch);
        touch.spring = touch.stiffness * touch.depth;
        act(Stage::Memory, &mut touch);
        touch.cut(self.borne);
        self.borne = touch.borne();
        act(Stage::Limit, &mut touch);
        touch.force
    }
}
