//! 95 % intervals of a fitted contact: from the curvature of least squares, and from leaving out stretches of the recordings.

use super::change_point::jumps;
use super::data::Data;
use super::fit::Fit;
use super::model::index;
use super::range::Range;
use super::rest::Rest;
use crate::diagnose::interval::{Clusters, Intervals, Spread, spread};
use crate::diagnose::jackknife::stretch_of_rows;
use crate::diagnose::linalg::energy;

/// Squared deviations that a jump changes from its place to an end of its 95 % interval (J. Bai, *Rev. Econ. Stat.* 79, 1997, whose limit
/// is the place of the greatest value of a Brownian motion with drift).
const JUMP_95: f64 = 11.0;

/// Halvings in which an end is sought between the jump and the end of its range: a thousandth of a row of a million.
const HALVINGS: usize = 30;

/// The interval of each value of `fit`.
#[must_use]
pub fn intervals(data: &Data<'_>, fit: &Fit, rest: &Rest) -> Intervals {
    let ranges = fit.model.ranges(&fit.values);
    let jumps: Vec<usize> = jumps(fit).into_iter().map(|(at, _)| at).collect();
    let free: Vec<usize> = (0..fit.values.len()).filter(|at| ranges[*at].free && !jumps.contains(at)).collect();
    let mut all = intervals_of(data, fit, rest, &free);
    for at in jumps {
        all.ends[at] = [ranges[at].low, ranges[at].high].map(|bound| end_of_jump(data, fit, rest, at, bound));
    }
    all
}

/// The intervals of the values in `free`, all others being known.
pub(super) fn intervals_of(data: &Data<'_>, fit: &Fit, rest: &Rest, free: &[usize]) -> Intervals {
    let ranges = fit.model.ranges(&fit.values);
    let columns = data.columns(&fit.model, &fit.values, &ranges, free, &rest.rows);
    let priors = priors(&ranges, free);
    let stretch = stretches(data);
    // Rounding is a function of the place, the same in whatever trial and however long after.
    let is_stepped = data.trials.iter().all(|trial| trial.encoder_steps.len() == trial.len());
    let place: Vec<i64> =
        data.trials.iter().filter(|_| is_stepped).flat_map(|trial| trial.encoder_steps.iter().copied()).collect();
    let rounding = if place.is_empty() { Vec::new() } else { rounding(data, fit) };
    let rows = Clusters { stretch: &stretch, place: &place, rounding: &rounding };
    let found = spread(&rest.rows, &columns, &priors, rest.power, rows);
    in_values(fit, &ranges, free, &found)
}

/// One over the variance that each value in `free` is expected to have beforehand, in squared steps; zero where nothing is expected.
pub(super) fn priors(ranges: &[Range], free: &[usize]) -> Vec<f64> {
    free.iter().map(|at| ranges[*at].prior.map_or(0.0, |(_, sigma)| (ranges[*at].size / sigma).powi(2))).collect()
}

/// The stretch of the recordings that each row is in.
pub(super) fn stretches(data: &Data<'_>) -> Vec<usize> {
    let counts: Vec<Vec<bool>> =
        data.weights.iter().map(|trial| trial.iter().map(|weight| *weight > 0.0).collect()).collect();
    stretch_of_rows(&counts)
}

/// What was `found` of the values in `free`, in their own units; a value that was not fitted is what it is.
pub(super) fn in_values(fit: &Fit, ranges: &[Range], free: &[usize], found: &Spread) -> Intervals {
    let mut ends: Vec<[f64; 2]> = fit.values.iter().map(|value| [*value; 2]).collect();
    let slope = |at: &usize| if ranges[*at].by_factors { fit.values[*at] } else { ranges[*at].size };
    let covariance = found.covariance_of(fit.values.len(), free, &free.iter().map(slope).collect::<Vec<_>>());
    for (&at, steps) in free.iter().zip(&found.half_widths) {
        let (range, value) = (&ranges[at], fit.values[at]);
        let [low, high] = if range.by_factors {
            let factor = steps.min(50.0).exp();
            [value / factor, value * factor]
        } else {
            let half = range.size * steps;
            [value - half, value + half]
        };
        ends[at] = [low.max(range.low), high.min(range.high)];
    }
    Intervals { ends, covariance }
}

/// By how much one deviation of the position, as it is known, changes each row of the weighted residual of `fit`: by a surface that lies
/// elsewhere.
fn rounding(data: &Data<'_>, fit: &Fit) -> Vec<f64> {
    let step = 1e-3 * fit.model.scales.depth;
    let [below, above] = [-step, step].map(|moved| {
        let mut shifted = fit.values.clone();
        shifted[index::SURFACE] += moved;
        data.weighted_residual(&fit.model, &shifted)
    });
    let variances = data.trials.iter().flat_map(|trial| &trial.position_variance);
    let slopes = below.iter().zip(&above).map(|(below, above)| (above - below) / (2.0 * step));
    slopes.zip(variances).map(|(slope, variance)| slope * variance.sqrt()).collect()
}

/// The end of the interval of the jump `at`, an instant or a height, on the side of `bound`, no farther than that: where the rows that lie between have changed
/// by [`JUMP_95`] squared deviations.
///
/// A jump has no tangent in its place, and its place converges with the number of rows, faster than all other values and apart from
/// them: they are held. Rows that remember count as so many fewer. Where nothing is touched, nothing tells: a jump between two contacts
/// lies anywhere between them.
fn end_of_jump(data: &Data<'_>, fit: &Fit, rest: &Rest, at: usize, bound: f64) -> f64 {
    let changed = |there: f64| {
        let mut moved = fit.values.clone();
        moved[at] = there;
        let after = data.weighted_residual(&fit.model, &moved);
        let between: Vec<f64> = after.iter().zip(&rest.rows).map(|(after, before)| after - before).collect();
        energy(&between) / (rest.power * rest.correlated_rows)
    };
    let (mut within, mut beyond) = (fit.values[at], bound);
    if changed(beyond) < JUMP_95 {
        return bound;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (within + beyond);
        if changed(middle) < JUMP_95 { within = middle } else { beyond = middle }
    }
    beyond
}

#[cfg(test)]
mod tests {
    use super::super::testing::{FORCE_NOISE, RATE, TestContact};
    use super::*;

    /// K rises by a twelfth at the first row at which the tool is on its way in.
    #[test]
    fn the_instant_of_a_jump_is_known_as_well_as_the_rows_after_it_tell() {
        let instant = 4.0;
        let (model, values) = TestContact::PLAIN.law_with("time_varying_stiffness", 1, &[1.0 / 12.0, instant]);
        let trials = [TestContact::PLAIN.trial(1)];
        let data = Data::new(&trials);
        let at = values.len() - 1;
        let fit = Fit { model, values, energy: 0.0 };
        let rest = Rest {
            rows: data.weighted_residual(&fit.model, &fit.values),
            power: 1.0,
            over_sensors: 1.0,
            correlated_rows: 1.0,
        };
        let [low, high] = intervals(&data, &fit, &rest).ends[at];
        // By hand: what the jump adds to each row in contact, from the first after it on.
        let stiffness = fit.values[0] / 12.0;
        let told = |rows: Vec<usize>| {
            let mut sum = 0.0;
            rows.into_iter().find(|row| {
                sum += (stiffness * (trials[0].position[*row] - fit.values[2]).max(0.0) / FORCE_NOISE).powi(2);
                sum >= JUMP_95
            })
        };
        let first = (instant * RATE) as usize;
        let [after, before] = [(first + 1..trials[0].len()).collect(), (0..=first).rev().collect()]
            .map(|rows| told(rows).unwrap() as f64 / RATE);
        assert!(
            (high - after).abs() <= 1.5 / RATE && (low - before).abs() <= 1.5 / RATE,
            "{low} {high}, {before} {after}"
        );
        assert!(low < instant && instant < high);
    }
}
