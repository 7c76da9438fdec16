//! The balance of the drive along a recorded motion: what is left of the effort.

use super::Model;
use super::index;
use crate::diagnose::signals::filtered_trial::Track;
use crate::effects::{Memory, Place, Push, Side, Stage};
use crate::rig::Drive;

impl Model {
    /// What is left of the drive's balance, the force on the tool being `force`.
    #[must_use]
    pub fn balance(&self, values: &[f64], trial: usize, track: &Track, force: impl Fn(usize) -> f64) -> Vec<f64> {
        let (Some(effort), Some(rate)) = (&track.effort, &track.effort_rate) else { return Vec::new() };
        let drive = Drive { inertia: values[index::INERTIA], viscous: values[index::VISCOUS] };
        let late = values[index::EFFORT_TIMING];
        let mut acting = self.at(Place::Drive, values, trial);
        acting.sort_by_key(|(term, _)| term.effect.card().stage);
        let cut = self.effort_limit(values, trial).and_then(|limit| Some(track.command.as_ref()?.cut(limit)));
        let (effort, rate) = cut.as_ref().map_or((effort, rate), |[effort, rate]| (effort, rate));
        let mut memories: Vec<Memory> = vec![Memory::default(); acting.len()];
        let borne: Vec<f64> = (0..track.len()).map(&force).collect();
        let driven: Vec<f64> = effort.iter().zip(rate).map(|(effort, rate)| effort - late * rate).collect();
        let side = side(track, drive, &driven, &borne);
        let ahead: Vec<Option<Vec<f64>>> =
            acting.iter().map(|(term, values)| term.effect.ahead(term.form, values, &side)).collect();
        let (mut commanded, mut transmitted) = (0.0, 0.0);
        let mut rest: Vec<f64> = (0..track.len())
            .map(|at| {
                let mut push = instant(track, at, drive, borne[at], [driven[at], rate[at]]);
                for (((term, values), memory), ahead) in acting.iter().zip(&mut memories).zip(&ahead) {
                    match ahead {
                        Some(taken) => push.resistance += taken[at],
                        None => term.effect.push(term.form, values, memory, &mut push),
                    }
                }
                commanded += effort[at] * effort[at];
                transmitted += push.effort * push.effort;
                push.rest()
            })
            .collect();
        if acting.iter().any(|(term, _)| term.effect.card().stage == Stage::Transmission) {
            // A drive that transmits nothing to a tool that weighs nothing balances perfectly. What is left is counted in
            // shares of what is transmitted, and that is no way out.
            let share = (commanded / f64::max(transmitted, f64::MIN_POSITIVE)).sqrt();
            rest.iter_mut().for_each(|rest| *rest *= share);
        }
        rest
    }
}

/// All of `track`, of which `driven` reaches the tool and `borne` acts on it, for effects that look ahead.
fn side<'a>(track: &'a Track, drive: Drive, driven: &'a [f64], borne: &'a [f64]) -> Side<'a> {
    Side {
        step: track.step,
        blur: track.blur,
        inertia: drive.inertia,
        viscous: drive.viscous,
        velocity: &track.velocity,
        acceleration: &track.acceleration,
        effort: driven,
        force: borne,
        noise: [track.speed_noise, track.shake_noise, track.force_noise],
    }
}

/// Row `at` of `track`, with the force on the tool, the effort that reaches it, and its rate.
fn instant(track: &Track, at: usize, drive: Drive, force: f64, [effort, effort_rate]: [f64; 2]) -> Push {
    let rate = |of: &Option<Vec<f64>>| of.as_ref().map_or(0.0, |column| column[at]);
    Push {
        time: at as f64 * track.step,
        step: if at == 0 { 0.0 } else { track.step },
        position: track.position[at],
        velocity: track.velocity[at],
        acceleration: track.acceleration[at],
        jerk: track.jerk[at],
        snap: track.snap[at],
        crackle: track.crackle[at],
        blur: track.blur,
        speed_noise: track.speed_noise,
        still: track.still[at],
        force,
        force_rate: rate(&track.force_rate),
        force_bend: rate(&track.force_bend),
        force_jerk: rate(&track.force_jerk),
        effort,
        effort_rate,
        inertia: drive.inertia,
        viscous: drive.viscous,
        resistance: 0.0,
    }
}
