//! Whether the machine holds the force, rather than the place.

use super::checked_trial::{CheckedTrial, range};
use super::ranked_finding::RankedFinding;
use super::wording::quantity;
use crate::diagnose::thresholds::check_held_force::{HELD_BAND, HELD_RISE, MOST_CREEP_SPEED, NOISE_RANGE, WAY_THERE};
use crate::rig::Rig;

/// A force that stays while the tool, which pressed quickly until then, creeps on.
pub fn held(rig: &Rig, view: &CheckedTrial<'_>) -> Option<RankedFinding> {
    let hold = Hold::of(rig.contact.and(view.force.as_deref())?, view)?;
    let text = format!(
        "The machine holds the force: it stays within {} of {} while the tool creeps on by {}, over which it rose by {} on the way there. Whether the \
         force sensor ends there cannot be seen. Press on, past that force.",
        quantity(hold.band, view.push),
        quantity(hold.force, view.push),
        quantity(hold.creep, view.length),
        quantity(hold.rise, view.push),
    );
    Some(RankedFinding::mild("force_held", format!("{}, force", view.name()), hold.rise, text))
}

/// The stretch in which a force stays close to its greatest.
struct Hold {
    /// The greatest force, and within how much of it the force stays, N or N m.
    force: f64,
    band: f64,
    /// How far the tool goes on, m or rad.
    creep: f64,
    /// By how much the force rose over as much of the way there, N or N m.
    rise: f64,
}

impl Hold {
    /// That of the smoothed `force` of `view`; `None` where the force does not stay, the tool stays too, or goes on as quickly as it came.
    fn of(force: &[f64], view: &CheckedTrial<'_>) -> Option<Self> {
        let greatest = force.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let range = range(force);
        let band = (HELD_BAND * range).value() + (NOISE_RANGE * view.noise[2]).value();
        let first = force.iter().position(|force| *force >= greatest - band)?;
        // Once there it may waver about the band's end.
        let stays = force[first..].iter().take_while(|force| **force >= greatest - 2.0 * band).count();
        let last = first + stays - 1;
        let before = force[..first].iter().rposition(|force| *force < greatest - (WAY_THERE * range).value())?;
        let deepest = view.depth[first..=last].iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let [way, creep] = [view.depth[first] - view.depth[before], deepest - view.depth[first]];
        let slope = (force[first] - force[before]) / way;
        let speed = way / (first - before) as f64;
        let is_quick = |row: &usize| view.depth[*row] - view.depth[row - 1] > MOST_CREEP_SPEED.value() * speed;
        // On the way through the band, and for one row more on either side, it may be as quick as before.
        let crossing = 2.0 + band / (slope * speed);
        let quick = (first + 1..=last).filter(is_quick).count() as f64;
        let rise = slope * creep;
        (way > 0.0 && rise > HELD_RISE * band && quick <= crossing).then_some(Self {
            force: greatest,
            band,
            creep,
            rise,
        })
    }
}
