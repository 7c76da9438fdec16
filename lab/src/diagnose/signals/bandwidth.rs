//! How sharply recordings are looked at: as their noise allows, and no more sharply than what is found stays what it is.

use super::derivative_filter::Lens;
use super::filtered_trial::Track;
use super::uniform_trial::Raw;
use crate::diagnose::linalg::solve;
use crate::rig::Rig;

/// How much less sharply the drive is looked at once more, and the share by which its inertia may differ then.
const CALMER: f64 = 1.4;
const ASTRAY: f64 = 0.05;

/// Periods of the -3 dB frequency that all trials together have at the least: fewer tell no inertia.
const LEAST_TURNS: f64 = 10.0;

/// The filters for the contact and for the drive.
#[must_use]
pub fn lenses(rig: &Rig, raws: &[Raw]) -> (Lens, Lens) {
    let drive = Lens::for_drive(rig, raws);
    let alone = rig.drive.is_some() && raws.iter().all(|raw| raw.force.is_none());
    (Lens::for_contact(rig, raws), if alone { settled(drive, raws) } else { drive })
}

/// A filter behind which the inertia does not depend on how sharp it is: clocks that jitter and efforts that are told by a
/// current leave more in the balance than noise of the position would, and no force is there to say so.
fn settled(sharpest: Lens, raws: &[Raw]) -> Lens {
    let seconds: f64 = raws.iter().map(|raw| raw.len() as f64 * raw.period).sum();
    let mut lens = sharpest.clone();
    while lens.corner() * seconds > LEAST_TURNS {
        let calmer = lens.calmer(CALMER);
        match (inertia(raws, &lens), inertia(raws, &calmer)) {
            (Some(here), Some(there)) if (here - there).abs() > ASTRAY * there.abs() => lens = calmer,
            (Some(_), Some(_)) => return lens,
            _ => return sharpest,
        }
    }
    sharpest
}

/// The inertia that least squares give behind `lens`, beside viscous and dry friction, a weight that turns with the position,
/// and an offset; `None` where they cannot be told apart.
fn inertia(raws: &[Raw], lens: &Lens) -> Option<f64> {
    let mut columns: [Vec<f64>; 6] = Default::default();
    let mut efforts = Vec::new();
    for raw in raws {
        let track = Track::of(raw, lens);
        for (at, effort) in track.effort.iter().flatten().enumerate().filter(|(at, _)| track.seen[*at]) {
            let (position, velocity) = (track.position[at], track.velocity[at]);
            let direction = if velocity.abs() <= track.speed_noise { 0.0 } else { velocity.signum() };
            let row = [track.acceleration[at], velocity, direction, position.sin(), position.cos(), 1.0];
            columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
            efforts.push(*effort);
        }
    }
    let directions: Vec<(usize, Vec<f64>)> = columns.into_iter().enumerate().collect();
    solve(&directions, &efforts).map(|values| values[0]).filter(|inertia| inertia.is_finite())
}
