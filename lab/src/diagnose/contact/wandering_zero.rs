//! The values of a contact's law beside a force sensor's zero that wanders.
//!
//! The zero's own law is straight lines between a few instants, and beside them a real one wanders on: rows share that error with those near by.
//! Least squares takes it for as many errors as there are rows, its values follow it, and nothing tells how far. A. C. Aitken's generalised
//! least squares (*Proc. R. Soc. Edinburgh* 55, 1936) takes rows and derivatives as the innovations of a local level: what a row tells that
//! those before it did not.

use super::data::Data;
use super::fit::{Effort, Fit, Normal};
use super::interval::{in_values, intervals_of, priors, stretches};
use super::range::Range;
use super::rest::Rest;
use crate::diagnose::interval::{Clusters, Intervals, spread};
use crate::diagnose::linalg::energy;
use crate::diagnose::local_level::LocalLevel;

/// Rounds of levels and values at the most; the search ends before where a step no longer counts.
const ROUNDS: usize = 8;

/// Part of the squares below which a step no longer counts.
const NEGLIGIBLE_PART: f64 = 1e-6;

/// `fit` with the values of generalised least squares, the zero's own values beside these, and the intervals of all. `None` where no wandering zero is
/// told, where the rows do not pay for a level in each trial (G. Schwarz, *Ann. Statist.* 6, 1978), or where the encoder's rounding is most of the
/// noise: rows of one place share that, and no level says so.
pub(super) fn beside_a_wandering_zero(data: &Data<'_>, fit: &Fit) -> Option<(Fit, Intervals)> {
    if data.is_limited_by_rounding() {
        return None;
    }
    let of_zero = values_of_zero(fit);
    let (now, rows) = generalised(data, fit)?;
    let mut all = rows.intervals(data, &now);
    let now = data.fit_holding(&now.model, &now.values, Effort::FULL, &|at| !of_zero.contains(&at));
    let own = intervals_of(data, &now, &Rest::of(data, &now), &of_zero);
    of_zero.iter().for_each(|at| all.ends[*at] = own.ends[*at]);
    Some((now, all))
}

/// Log likelihood of `fit` with the values of generalised least squares beside a zero that wanders, nats; `None` where none is told.
pub(super) fn likelihood_beside_a_wandering_zero(data: &Data<'_>, fit: &Fit) -> Option<f64> {
    generalised(data, fit).map(|(_, rows)| rows.log_likelihood())
}

/// `fit` with the values of generalised least squares, but for the zero's own, which stay.
fn generalised(data: &Data<'_>, fit: &Fit) -> Option<(Fit, Rows)> {
    if !wanders(fit) {
        return None;
    }
    let of_zero = values_of_zero(fit);
    let plain = unweighted(data);
    let mut now = fit.clone();
    let mut rows = Rows::of(&plain, data, &now, &of_zero)?;
    for _ in 0..ROUNDS {
        let moved = rows.normal(&now.values).step(&now.values, &rows.ranges, &rows.free, 0.0);
        let after = energy(&rows.innovations(&plain.weighted_residual(&now.model, &moved)));
        let gained = energy(&rows.told) - after;
        if gained.is_nan() || gained <= NEGLIGIBLE_PART * after {
            break;
        }
        now.values = moved;
        rows = Rows::of(&plain, data, &now, &of_zero)?;
    }
    Some((now, rows))
}

/// Whether a wandering zero is among the effects of `fit`.
pub(super) fn wanders(fit: &Fit) -> bool {
    fit.model.times("force_drift") > 0
}

/// Places of the values of the sensor's zero, which a level takes for its own: those of its effects, and each trial's.
fn values_of_zero(fit: &Fit) -> Vec<usize> {
    const ZEROS: [&str; 2] = ["force_drift", "force_bias"];
    let terms = fit.model.terms.iter().enumerate().filter(|(_, term)| ZEROS.contains(&term.name()));
    let values = terms.flat_map(|(nth, term)| {
        let first = fit.model.first_value_of(nth);
        first..first + fit.model.count_of(term)
    });
    fit.model.own_zeros().chain(values).collect()
}

/// `data` whose rows that count are worth one.
fn unweighted<'a>(data: &Data<'a>) -> Data<'a> {
    let one = |weight: &f64| if *weight > 0.0 { 1.0 } else { 0.0 };
    let weights = data.weights.iter().map(|trial| trial.iter().map(one).collect()).collect();
    Data { weights, ..data.clone() }
}

/// What the rows tell of the values beside a level in each trial.
struct Rows {
    levels: Vec<LocalLevel>,
    starts: Vec<usize>,
    ranges: Vec<Range>,
    free: Vec<usize>,
    /// Innovations of what the values leave.
    told: Vec<f64>,
    /// Their derivatives by one step of each value in `free`.
    columns: Vec<Vec<f64>>,
}

impl Rows {
    /// `None` where the rows do not pay for the levels.
    fn of(plain: &Data<'_>, data: &Data<'_>, fit: &Fit, of_zero: &[usize]) -> Option<Self> {
        let residual = plain.weighted_residual(&fit.model, &fit.values);
        let starts = plain.starts();
        let level = |number: usize| {
            let trial = &data.trials[number];
            let rows = &residual[starts[number]..starts[number] + trial.len()];
            // Noise that remembers is the level itself.
            let noise: Vec<f64> = data.noise[number].iter().map(|all| all / data.noise_memory()).collect();
            LocalLevel::fitted(&trial.time, rows, &noise)
        };
        let levels: Vec<LocalLevel> = (0..data.trials.len()).map(level).collect::<Option<_>>()?;
        let paid: f64 = levels.iter().map(|level| level.gain).sum();
        if paid < 0.5 * levels.len() as f64 * (data.rows() as f64).ln() {
            return None;
        }
        let ranges = fit.model.ranges(&fit.values);
        let free: Vec<usize> = (0..fit.values.len()).filter(|at| ranges[*at].free && !of_zero.contains(at)).collect();
        let columns = plain.columns(&fit.model, &fit.values, &ranges, &free, &residual);
        let mut rows = Self { levels, starts, ranges, free, told: Vec::new(), columns: Vec::new() };
        rows.columns = columns.iter().map(|column| rows.innovations(column)).collect();
        rows.told = rows.innovations(&residual);
        Some(rows)
    }

    /// The innovations of the rows of all trials, one after another.
    fn innovations(&self, rows: &[f64]) -> Vec<f64> {
        let ends = self.starts.iter().skip(1).copied().chain([rows.len()]);
        let each = self.starts.iter().zip(ends).zip(&self.levels);
        each.flat_map(|((start, end), level)| level.innovations(&rows[*start..end])).collect()
    }

    /// Log likelihood of what the values leave, each trial's level as likely as can be, nats.
    fn log_likelihood(&self) -> f64 {
        self.levels.iter().map(|level| level.log_likelihood).sum()
    }

    fn normal(&self, values: &[f64]) -> Normal {
        Normal::of(&self.columns, &self.told, &self.ranges, &self.free, values)
    }

    /// The intervals of all values but those of the zero.
    fn intervals(&self, data: &Data<'_>, fit: &Fit) -> Intervals {
        let stretch = stretches(data);
        let power = energy(&self.told) / data.rows().max(1) as f64;
        let clusters = Clusters { stretch: &stretch, place: &[], rounding: &[] };
        let found = spread(&self.told, &self.columns, &priors(&self.ranges, &self.free), power, clusters);
        in_values(fit, &self.ranges, &self.free, &found)
    }
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::data::Data;
    use super::super::identification::identify;
    use super::super::model::{OwnValues, index};
    use super::super::nominal::nominal_fit;
    use super::super::outcome::Outcome;
    use super::super::testing::TestContact;
    use super::{values_of_zero, wanders};
    use crate::diagnose::interval::NORMAL_97_5;
    use crate::diagnose::term::Term;
    use crate::diagnose::verdict::Verdict;
    use crate::effects;
    use crate::recording::Recording;

    fn found(recordings: &[Recording]) -> Outcome {
        let trials = || recordings.iter().map(TestContact::seen).collect::<Vec<_>>();
        identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap()
    }

    /// A zero that wanders by 0.05 N in a root second, and goes 25 mN beside straight lines of an eighth of twelve seconds: more than the sensor's noise,
    /// and the same from row to row. At the motion's 4 rad/s and twice that its density is 1.6e-4 and 4e-5 N^2 s, a hundred and 25 times the
    /// sensor's; the depth has some 3 mm and 1.5 mm there, which tell the stiffness in 24 s to (24 s sum a^2 / 2 S)^-1/2 = 0.8 N/m. The damping hangs
    /// together with where the clocks lie within a row.
    #[test]
    fn a_spring_is_known_beside_a_zero_that_wanders() {
        for seeds in [[1, 2], [3, 4], [5, 6]] {
            let outcome = found(&seeds.map(|seed| TestContact::PLAIN.wandering(0.05, seed)));
            assert_eq!((outcome.chosen.model.names(0), outcome.verdict), (vec!["force_drift"], Verdict::Explained));
            for (at, truth) in [(index::STIFFNESS, 300.0), (index::DAMPING, 6.0)] {
                let (value, [low, high]) = (outcome.chosen.values[at], outcome.intervals[at]);
                // A 95 % interval, widened by a half: three draws.
                let slack = 0.5 * (high - low);
                assert!(low - slack < truth && truth < high + slack, "{at}: {value}, {low} to {high}");
            }
            let [low, high] = outcome.intervals[index::STIFFNESS];
            let deviation = 0.5 * (high - low) / NORMAL_97_5;
            assert!((0.5..1.5).contains(&deviation), "{low} to {high}");
            let first = outcome.chosen.model.first_value_of(0);
            for at in first..outcome.chosen.values.len() {
                let (value, [low, high]) = (outcome.chosen.values[at], outcome.intervals[at]);
                assert!(low <= value && value <= high, "{at}: {value}, {low} to {high}");
            }
        }
    }

    /// Four values that trials share, the second trial's surface and zero, a bias, and the rate of a ramp.
    #[test]
    fn what_a_level_takes_for_its_own_is_every_zero() {
        let trials = [1, 2].map(|seed| TestContact::PLAIN.trial(seed));
        let mut fit = nominal_fit(&Data::new(&trials), &TestContact::nominal());
        fit.model.own = OwnValues { zero: true, ..OwnValues::NONE };
        for name in ["force_bias", "hysteresis", "force_drift"] {
            let term = Term { effect: effects::find(name).unwrap(), form: 0 };
            assert!(!wanders(&fit));
            fit.model = fit.model.with(term);
        }
        let loops = fit.model.count_of(&fit.model.terms[1]);
        assert!(wanders(&fit));
        assert_eq!(values_of_zero(&fit), [5, 6, 7 + loops]);
        fit.model.own = OwnValues::NONE;
        assert_eq!(values_of_zero(&fit), [5, 6 + loops]);
    }
}
