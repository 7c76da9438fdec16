//! 95 % intervals of a fitted drive: from the curvature of the likelihood, and from leaving out stretches of the recordings.

use super::fit::Fit;
use super::likelihood::Data;
use super::linearisation::Linearisation;
use super::range::Step;
use crate::diagnose::interval::{Clusters, spread_over_own_width};
use crate::diagnose::jackknife::stretch_of_rows;

/// How far the values of a fit can be trusted.
#[derive(Debug, Clone)]
pub struct Uncertainty {
    /// Both ends of the 95 % interval of each value.
    pub ends: Vec<[f64; 2]>,
    /// Covariance of the values by the curvature of the fit, in their own units; zero for values that were not fitted, empty where it is not
    /// known.
    pub covariance: Vec<Vec<f64>>,
    /// How many times the variance by the curvature each value's own is: one where innovations are white, about the rows that say the same
    /// where they are not, as those of a coarse encoder that stands still.
    pub inflations: Vec<f64>,
}

/// The interval of each value of `fit`. The distance to the optimum of the likelihood as it is over the interval, where single maxima no longer
/// count, is part of it.
#[must_use]
pub fn intervals(data: &Data<'_>, fit: &Fit) -> Uncertainty {
    let ranges = fit.model.ranges();
    let counts: Vec<Vec<bool>> = data.scored_rows().map(|rows| vec![true; rows]).collect();
    let stretch = stretch_of_rows(&counts);
    let rows = Clusters { stretch: &stretch, place: &[] };
    let at = Linearisation::of(data, &fit.model, &fit.values, &fit.noise);
    let found = spread_over_own_width(ranges.len(), rows, |apart| at.over_width(&fit.values, apart));
    let each = fit.values.iter().enumerate().map(|(at, value)| {
        let range = &ranges[at];
        let steps = found.half_widths[at].hypot(found.remaining[at]);
        let [low, high] = match range.step {
            Step::Relative => {
                let factor = steps.min(50.0).exp();
                [value / factor, value * factor]
            }
            Step::Absolute(size) => [value - size * steps, value + size * steps],
        };
        [low.max(range.low), high.min(range.high)]
    });
    let all: Vec<usize> = (0..fit.values.len()).collect();
    let slopes: Vec<f64> = ranges.iter().zip(&fit.values).map(|(range, value)| range.slope(*value)).collect();
    let covariance = found.covariance_of(all.len(), &all, &slopes);
    Uncertainty { ends: each.collect(), covariance, inflations: found.inflations }
}
