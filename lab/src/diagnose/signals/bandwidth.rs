//! How sharply recordings are looked at: as their noise allows, and no more sharply than what is found stays what it is.

use super::derivative_filter::DerivativeFilter;
use super::filtered_trial::FilteredTrial;
use super::uniform_trial::UniformTrial;
use crate::diagnose::linalg::solve;
use crate::diagnose::thresholds::bandwidth::{BANDWIDTH_STEP, INERTIA_TOLERANCE, MIN_CUTOFF_PERIODS};
use crate::rig::Rig;

/// The filters for the contact and for the drive.
#[must_use]
pub fn analysis_filters(rig: &Rig, uniform_trials: &[UniformTrial]) -> (DerivativeFilter, DerivativeFilter) {
    let drive = DerivativeFilter::for_drive(rig, uniform_trials);
    let alone = rig.drive.is_some() && uniform_trials.iter().all(|raw| raw.force.is_none());
    (
        DerivativeFilter::for_contact(rig, uniform_trials),
        if alone { stable_inertia_filter(drive, uniform_trials) } else { drive },
    )
}

/// A filter behind which the inertia does not depend on how sharp it is: clocks that jitter and efforts that are told by a
/// current leave more in the balance than noise of the position would, and no force is there to say so.
fn stable_inertia_filter(sharpest: DerivativeFilter, uniform_trials: &[UniformTrial]) -> DerivativeFilter {
    let seconds: f64 = uniform_trials.iter().map(|raw| raw.len() as f64 * raw.period).sum();
    let mut filter = sharpest.clone();
    while filter.cutoff_hz() * seconds > MIN_CUTOFF_PERIODS {
        let with_lower_cutoff = filter.with_lower_cutoff(BANDWIDTH_STEP);
        match (inertia(uniform_trials, &filter), inertia(uniform_trials, &with_lower_cutoff)) {
            (Some(here), Some(there)) if (here - there).abs() > INERTIA_TOLERANCE * there.abs() => {
                filter = with_lower_cutoff
            }
            (Some(_), Some(_)) => return filter,
            _ => return sharpest,
        }
    }
    sharpest
}

/// The inertia that least squares give behind `filter`, beside viscous and dry friction, a weight that turns with the position,
/// and an offset; `None` where they cannot be told apart.
fn inertia(uniform_trials: &[UniformTrial], filter: &DerivativeFilter) -> Option<f64> {
    let mut columns: [Vec<f64>; 6] = Default::default();
    let mut efforts = Vec::new();
    for raw in uniform_trials {
        let filtered = FilteredTrial::of(raw, filter);
        for (at, effort) in filtered.effort.iter().flatten().enumerate().filter(|(at, _)| filtered.valid[*at]) {
            let (position, velocity) = (filtered.position[at], filtered.velocity[at]);
            let direction = if velocity.abs() <= filtered.velocity_noise { 0.0 } else { velocity.signum() };
            let row = [filtered.acceleration[at], velocity, direction, position.sin(), position.cos(), 1.0];
            columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
            efforts.push(*effort);
        }
    }
    let directions: Vec<(usize, Vec<f64>)> = columns.into_iter().enumerate().collect();
    solve(&directions, &efforts).map(|values| values[0]).filter(|inertia| inertia.is_finite())
}
