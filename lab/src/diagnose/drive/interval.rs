//! 95 % intervals of a fitted drive: from the curvature of likelihood and prior, and from leaving out stretches of the recordings.

use nalgebra::{DMatrix, DVector};

use super::fit::Fit;
use super::likelihood::Data;
use super::linearisation::Linearisation;
use super::model::index;
use super::outcome::Outcome;
use super::range::{Range, Step};
use crate::diagnose::interval::{Clusters, NORMAL_97_5, spread_over_own_width};
use crate::diagnose::jackknife::stretch_of_rows;
use crate::diagnose::linalg::dot;

/// Values whose ends are what is known of them, and not merely those of a search: beside a lag an effort acts within half a row of where it is recorded. The lag
/// does nearly the same, and beside a delay that could be any it would have no interval, however much it takes.
const CONFINED: [usize; 2] = [index::DELAY, index::AVERAGING];

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
    let rows = Clusters { stretch: &stretch, place: &[], rounding: &[] };
    let at = Linearisation::of(data, &fit.model, &fit.values, &fit.noise);
    let known = |(range, value): (&Range, &f64)| {
        range.prior.map_or(0.0, |prior| (range.slope(*value) / prior.deviation).powi(2))
    };
    let mut priors: Vec<f64> = ranges.iter().zip(&fit.values).map(known).collect();
    CONFINED.iter().for_each(|at| priors[*at] = priors[*at].max(ranges[*at].uniform_precision()));
    let found = spread_over_own_width(&priors, rows, |apart| at.over_width(&fit.values, apart));
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

/// Widens the intervals of `outcome` by what is not known of the force that it was given: `changes` are those of the force in the recorded
/// rows of each trial, for one deviation along each of independent directions. They move the values by a step of Gauss's and Newton's
/// method, as in an estimate in two steps (K. M. Murphy, R. H. Topel, *J. Bus. Econ. Stat.* 3, 1985, 370).
pub fn widen(outcome: &mut Outcome, changes: &[Vec<Vec<f64>>]) {
    let data = Data { trials: &outcome.trials, least_encoder_variance: 0.0 };
    let fit = &outcome.chosen;
    let at = Linearisation::of(&data, &fit.model, &fit.values, &fit.noise);
    let ranges = fit.model.ranges();
    let columns = at.columns(&fit.values, &(0..ranges.len()).collect::<Vec<_>>());
    let products = DMatrix::from_fn(ranges.len(), ranges.len(), |i, j| {
        dot(&columns[i], &columns[j]) + if i == j { f64::MIN_POSITIVE } else { 0.0 }
    });
    let Some(factors) = products.cholesky() else { return };
    let mut variances = vec![0.0; ranges.len()];
    for change in changes {
        let moved = at.under_force(change);
        let score = DVector::from_iterator(ranges.len(), columns.iter().map(|column| dot(column, &moved)));
        factors.solve(&score).iter().zip(&mut variances).for_each(|(step, variance)| *variance += step * step);
    }
    for (at, variance) in variances.into_iter().enumerate() {
        let (range, value) = (&ranges[at], fit.values[at]);
        let ends = &mut outcome.intervals[at];
        let wider = |end: f64, sign: f64| {
            let own = range.steps_between(value, end);
            range.moved(value, sign * own.hypot(NORMAL_97_5 * variance.sqrt()))
        };
        *ends = [wider(ends[0], -1.0).max(range.low), wider(ends[1], 1.0).min(range.high)];
    }
}

#[cfg(test)]
mod tests {
    use super::super::fit::{Effort, fit};
    use super::super::identification::identify;
    use super::super::term::Term;
    use super::super::testing::{TestDrive, nominal, search_over};
    use super::*;

    /// A second of a lag of 1.5 ms before an encoder of 0.3 mm: a delay and a lag of the same length are one to it, and a delay lies within half a row. So the
    /// lag is known to about a row, which is 1 ms, and not to everything that a search may try.
    #[test]
    fn a_lag_beside_a_delay_is_known_as_well_as_the_delay_is_confined() {
        let drive = TestDrive { effort_lag_s: 1.5e-3, encoder: 3e-4, ..TestDrive::PLAIN };
        let trials = [drive.trial(1.0, 6)];
        let search = search_over(&trials, &drive);
        let model = search.nominal.model.with(Term::EffortLag);
        let values = [0.8, 4.0, 0.0, 0.0, 1.5e-3];
        let lagged = fit(&search.data, &model, &values, search.nominal.noise, Effort::FULL);
        let own = intervals(&search.data, &lagged).ends[lagged.model.values_of(0).start];
        assert!(own[0] < 1.5e-3 && own[1] > 1.5e-3, "{own:?} {:?}", lagged.values);
        assert!(own[0] > 0.5e-3 && own[1] < 2.5e-3, "{own:?} {:?}", lagged.values);
    }

    /// A drive under a constant load of 1 N that is given a force whose zero is known to 0.1 N: so is the load then, and nothing else is known
    /// less for it.
    #[test]
    fn what_is_not_known_of_the_force_is_not_known_of_what_it_stands_for() {
        let drive = TestDrive { load: 1.0, ..TestDrive::PLAIN };
        let trials = vec![drive.trial(6.0, 131), drive.trial(6.0, 132)];
        let rig = nominal(0.8, 4.0);
        let mut outcome = identify(trials, &rig, 1, &|_| {}).expect("a drive that moves");
        assert_eq!(outcome.chosen.model.names(), ["gravity_load"]);
        let load = outcome.chosen.model.values_of(0).start;
        let width = |outcome: &Outcome, at: usize| outcome.intervals[at][1] - outcome.intervals[at][0];
        let before: Vec<f64> = (0..outcome.intervals.len()).map(|at| width(&outcome, at)).collect();
        let zero: Vec<Vec<f64>> = outcome.trials.iter().map(|trial| vec![0.1; trial.source_time.len()]).collect();
        widen(&mut outcome, &[zero]);
        let told = before[load].hypot(2.0 * NORMAL_97_5 * 0.1);
        assert!((width(&outcome, load) / told - 1.0).abs() < 1e-3, "{} {told}", width(&outcome, load));
        for at in (0..before.len()).filter(|at| *at != load) {
            assert!((width(&outcome, at) - before[at]).abs() <= 0.05 * before[at], "{at}: {:?}", outcome.intervals[at]);
        }
    }
}
