//! The balance of the drive along a recorded motion: what is left of the effort.

use super::Model;
use super::index;
use crate::diagnose::signals::filtered_trial::FilteredTrial;
use crate::effects::{DriveState, EffectState, LoadSideSignals, Place, Stage};
use crate::rig::Drive;

impl Model {
    /// What is left of the drive's balance, the force on the tool being `force`.
    #[must_use]
    pub fn balance(
        &self,
        values: &[f64],
        trial: usize,
        filtered: &FilteredTrial,
        force: impl Fn(usize) -> f64,
    ) -> Vec<f64> {
        let (Some(effort), Some(rate)) = (&filtered.effort, &filtered.effort_rate) else { return Vec::new() };
        let drive = Drive { inertia: values[index::INERTIA], viscous: values[index::VISCOUS], encoder: None };
        let late = values[index::EFFORT_TIMING];
        let mut acting = self.at(Place::Drive, values, trial);
        acting.sort_by_key(|(term, _)| term.effect.spec().stage);
        let cut = self.effort_limit(values, trial).and_then(|limit| Some(filtered.command.as_ref()?.cut(limit)));
        let (effort, rate) = cut.as_ref().map_or((effort, rate), |[effort, rate]| (effort, rate));
        let mut memories: Vec<EffectState> = vec![EffectState::default(); acting.len()];
        let borne: Vec<f64> = (0..filtered.len()).map(&force).collect();
        let driven: Vec<f64> = effort.iter().zip(rate).map(|(effort, rate)| effort - late * rate).collect();
        let side = side(filtered, drive, &driven, &borne);
        let ahead: Vec<Option<Vec<f64>>> =
            acting.iter().map(|(term, values)| term.effect.transmission_loss(term.form, values, &side)).collect();
        let (mut commanded, mut transmitted) = (0.0, 0.0);
        let mut residual: Vec<f64> = (0..filtered.len())
            .map(|at| {
                let mut push = instant(filtered, at, drive, borne[at], [driven[at], rate[at]]);
                for (((term, values), memory), ahead) in acting.iter().zip(&mut memories).zip(&ahead) {
                    match ahead {
                        Some(taken) => push.resistance += taken[at],
                        None => term.effect.act_on_drive(term.form, values, memory, &mut push),
                    }
                }
                commanded += effort[at] * effort[at];
                transmitted += push.effort * push.effort;
                push.balance_residual()
            })
            .collect();
        if acting.iter().any(|(term, _)| term.effect.spec().stage == Stage::Transmission) {
            // A drive that transmits nothing to a tool that weighs nothing balances perfectly. What is left is counted in
            // shares of what is transmitted, and that is no way out.
            let share = (commanded / f64::max(transmitted, f64::MIN_POSITIVE)).sqrt();
            residual.iter_mut().for_each(|residual| *residual *= share);
        }
        residual
    }
}

/// All of `filtered`, of which `driven` reaches the tool and `borne` acts on it, for effects that look ahead.
fn side<'a>(filtered: &'a FilteredTrial, drive: Drive, driven: &'a [f64], borne: &'a [f64]) -> LoadSideSignals<'a> {
    LoadSideSignals {
        step: filtered.step,
        filter_width: filtered.filter_width,
        inertia: drive.inertia,
        viscous: drive.viscous,
        velocity: &filtered.velocity,
        acceleration: &filtered.acceleration,
        effort: driven,
        force: borne,
        noise: [filtered.velocity_noise, filtered.acceleration_noise, filtered.force_noise],
    }
}

/// Row `at` of `filtered`, with the force on the tool, the effort that reaches it, and its rate.
fn instant(
    filtered: &FilteredTrial,
    at: usize,
    drive: Drive,
    force: f64,
    [effort, effort_rate]: [f64; 2],
) -> DriveState {
    let rate = |of: &Option<Vec<f64>>| of.as_ref().map_or(0.0, |column| column[at]);
    DriveState {
        time: at as f64 * filtered.step,
        step: if at == 0 { 0.0 } else { filtered.step },
        position: filtered.position[at],
        velocity: filtered.velocity[at],
        acceleration: filtered.acceleration[at],
        jerk: filtered.jerk[at],
        snap: filtered.snap[at],
        crackle: filtered.crackle[at],
        filter_width: filtered.filter_width,
        velocity_noise: filtered.velocity_noise,
        at_rest: filtered.at_rest[at],
        force,
        force_rate: rate(&filtered.force_rate),
        force_second_derivative: rate(&filtered.force_second_derivative),
        force_third_derivative: rate(&filtered.force_third_derivative),
        effort,
        effort_rate,
        inertia: drive.inertia,
        viscous: drive.viscous,
        resistance: 0.0,
    }
}
