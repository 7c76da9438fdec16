//! From the commanded effort to the acceleration of the tool, through the effects of the drive.

use crate::effects::{ActiveEffect, DriveState, EffectState, Place, Stage};
use crate::rig::Drive;

/// Rounding of a balance, in units of its largest term: what is left below it is nothing.
const BALANCE_TOLERANCE: f64 = 8.0 * f64::EPSILON;

struct Term<'a> {
    active: ActiveEffect<'a>,
    memory: EffectState,
    kept: EffectState,
}

/// The drive's effects and what they carry from one instant to the next.
pub struct DriveEffects<'a> {
    drive: Drive,
    terms: Vec<Term<'a>>,
}

/// One instant of the drive.
#[derive(Debug, Clone, Copy)]
pub struct Instant {
    /// Seconds since the trial began.
    pub time: f64,
    /// Seconds since the last instant.
    pub step: f64,
    /// Position of the tool.
    pub position: f64,
    /// Its rate.
    pub velocity: f64,
    /// What is commanded.
    pub effort: f64,
}

/// What the drive does to the tool.
#[derive(Debug, Clone, Copy)]
pub struct DriveResponse {
    /// Of the tool.
    pub acceleration: f64,
    /// Whether dry friction takes part in it.
    pub has_friction: bool,
}

impl<'a> DriveEffects<'a> {
    /// Those of `actives` that act in the drive, in the order of their stages.
    pub fn new(drive: Drive, actives: &[ActiveEffect<'a>]) -> Self {
        let mut terms: Vec<_> = actives
            .iter()
            .filter(|active| active.effect.spec().place == Place::Drive)
            .map(|active| Term { active: *active, memory: EffectState::default(), kept: EffectState::default() })
            .collect();
        terms.sort_by_key(|term| term.active.stage());
        Self { drive, terms }
    }

    /// Marks this instant, for [`DriveEffects::rewind`].
    pub fn save(&mut self) {
        self.terms.iter_mut().for_each(|term| term.kept = term.memory);
    }

    /// Takes back every step since the last [`DriveEffects::save`].
    pub fn rewind(&mut self) {
        self.terms.iter_mut().for_each(|term| term.memory = term.kept);
    }

    /// The acceleration of the tool where the contact bears `force`.
    ///
    /// A tool that stands still is held by friction as long as friction can: its acceleration is then exactly zero.
    pub fn pull(&mut self, at: Instant, force: f64) -> DriveResponse {
        let mut push = DriveState {
            step: at.step,
            position: at.position,
            velocity: at.velocity,
            at_rest: at.velocity == 0.0,
            force,
            effort: at.effort,
            inertia: self.drive.inertia,
            viscous: self.drive.viscous,
            resistance: 0.0,
            weight: 0.0,
        };
        let (loads, frictions) = {
            let at = self.terms.partition_point(|term| term.active.stage() < Stage::Friction);
            self.terms.split_at_mut(at)
        };
        let act = |terms: &mut [Term<'_>], push: &mut DriveState| {
            for term in terms {
                term.active.effect.act_on_drive(term.active.form, term.active.values, &mut term.memory, push);
            }
        };
        act(loads, &mut push);
        let free = push.balance_residual();
        act(frictions, &mut push);
        let rest = push.balance_residual();
        let has_friction = rest != free;
        let size = push.effort.abs() + push.force.abs() + push.resistance.abs();
        let is_held = has_friction && push.at_rest && rest.abs() <= BALANCE_TOLERANCE * size;
        DriveResponse { acceleration: if is_held { 0.0 } else { rest / push.inertia }, has_friction }
    }
}
