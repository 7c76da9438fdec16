//! The measures of a set of trials, as a model sees them.

use crate::diagnose::model::{Model, index};
use crate::diagnose::signals::filtered_trial::{AnalysisTrial, FilteredTrial};
use crate::effects::ExcitationStats;

/// Passes inwards of at least `least`.
fn approaches(filtered: &FilteredTrial, surface: f64, bilateral: bool, least: f64) -> usize {
    let depth = |position: f64| if bilateral { position } else { position.max(surface) };
    let (mut low, mut count, mut inward) = (f64::INFINITY, 0, false);
    let mut high = f64::NEG_INFINITY;
    for position in filtered.position.iter().map(|position| depth(*position)) {
        if inward {
            high = high.max(position);
            if position < high - least {
                (inward, low) = (false, position);
            }
        } else {
            low = low.min(position);
            if position > low + least {
                (inward, high) = (true, position);
                count += 1;
            }
        }
    }
    count
}

/// Farthest way back out from the deepest place before, over all the way in.
fn unloading_fraction(filtered: &FilteredTrial, surface: f64, bilateral: bool) -> f64 {
    let depth = |position: &f64| if bilateral { *position } else { position.max(surface) };
    let (mut deepest, mut shallowest) = (f64::NEG_INFINITY, f64::INFINITY);
    let back = filtered.position.iter().map(depth).fold(0.0, |most: f64, depth| {
        (deepest, shallowest) = (deepest.max(depth), shallowest.min(depth));
        most.max(deepest - depth)
    });
    if deepest > shallowest { back / (deepest - shallowest) } else { 0.0 }
}

/// Moments at which the contact ends.
fn releases(filtered: &FilteredTrial, surface: f64, bilateral: bool) -> usize {
    let inside = |position: f64| !bilateral && position > surface;
    filtered.position.windows(2).filter(|pair| inside(pair[0]) && !inside(pair[1])).count()
}

/// Share of the time from the first row without contact to the last.
fn free_time_fraction(filtered: &FilteredTrial, surface: f64, bilateral: bool) -> f64 {
    let free = |position: &f64| !bilateral && *position <= surface;
    let first = filtered.position.iter().position(free);
    let last = filtered.position.iter().rposition(free);
    first.zip(last).map_or(0.0, |(first, last)| (last - first) as f64 / filtered.len().max(1) as f64)
}

/// The measures of `trials` as `model` with `values` sees them; `sample` is the period of a raw row.
#[must_use]
pub fn excitation_stats(
    trials: &[AnalysisTrial],
    model: &Model,
    values: &[f64],
    sample: f64,
    is_rotary: bool,
) -> ExcitationStats {
    let bilateral = model.contact.unwrap_or(false);
    let surface = values[index::SURFACE];
    let filtered_trials =
        || trials.iter().map(|trial| if model.contact.is_some() { &trial.contact } else { &trial.drive });
    let rows = || {
        filtered_trials()
            .flat_map(|filtered| (0..filtered.len()).filter(|&at| filtered.valid[at]).map(move |at| (filtered, at)))
    };
    let touching = |filtered: &FilteredTrial, at: usize| bilateral || filtered.position[at] > surface;
    let mean_square = |pick: &dyn Fn(&FilteredTrial, usize) -> Option<f64>| {
        let (mut sum, mut count) = (0.0, 0.0f64);
        rows().filter_map(|(filtered, at)| pick(filtered, at)).for_each(|value| {
            sum += value * value;
            count += 1.0;
        });
        (sum / count.max(1.0)).sqrt()
    };
    let range = |pick: &dyn Fn(&FilteredTrial, usize) -> Option<f64>| {
        let all = rows().filter_map(|(filtered, at)| pick(filtered, at));
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    let size = |(low, high): (f64, f64)| if low <= high { high.max(-low) } else { 0.0 };
    let travel = range(&|filtered, at| Some(filtered.position[at]));
    let force_range = range(&|filtered, at| filtered.force.as_ref().map(|force| force[at]));
    let behind = || trials.iter().map(|trial| trial.drive.law_input());
    let effort = size(range(&|filtered, at| filtered.effort.as_ref().map(|effort| effort[at])));
    let depth = if bilateral { (travel.1 - surface).max(surface - travel.0) } else { travel.1 - surface };
    let moving = mean_square(&|filtered, at| touching(filtered, at).then(|| filtered.velocity[at]));
    let all = mean_square(&|filtered, at| Some(filtered.velocity[at]));
    ExcitationStats {
        depth: if model.contact.is_some() { depth.max(1e-3 * (travel.1 - travel.0)) } else { 0.0 },
        way_back: filtered_trials()
            .map(|filtered| unloading_fraction(filtered, surface, bilateral))
            .fold(0.0, f64::max),
        speed: if model.contact.is_some() && moving > 0.0 { moving } else { all },
        acceleration: mean_square(&|filtered, at| Some(filtered.acceleration[at])),
        force: size(force_range),
        effort,
        travel,
        duration: filtered_trials().map(|filtered| filtered.len() as f64 * filtered.step).fold(0.0, f64::max),
        step: filtered_trials().next().map_or(1.0, |filtered| filtered.step),
        drive_step: trials.first().map_or(1.0, |trial| trial.drive.step),
        one_step_speed: behind().map(|filtered| filtered.one_step_speed).fold(0.0, f64::max),
        resolution: behind().map(|filtered| filtered.one_step_speed * filtered.filter_width).fold(0.0, f64::max),
        sample,
        stiffness: values[index::STIFFNESS],
        inertia: values[index::INERTIA],
        visits: filtered_trials().map(|filtered| approaches(filtered, surface, bilateral, 0.2 * depth)).sum(),
        releases: filtered_trials().map(|filtered| releases(filtered, surface, bilateral)).sum(),
        free_span: filtered_trials()
            .map(|filtered| free_time_fraction(filtered, surface, bilateral))
            .fold(0.0, f64::max),
        given_inertia: model.given_inertia,
        given_stiffness: model.given_stiffness,
        has_force: filtered_trials().any(|filtered| filtered.force.is_some()),
        has_effort: model.drive,
        is_rotary,
        is_bilateral: bilateral,
    }
}
