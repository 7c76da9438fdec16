//! The measures under which all estimators are compared.

use palpate::{Estimate, Flags, Sample};

/// A mean and its spread over trials: the sample standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct MeanAndDeviation {
    /// Mean.
    pub mean: f64,
    /// Standard deviation; zero of a single value.
    pub deviation: f64,
    /// The greatest.
    pub greatest: f64,
}

impl MeanAndDeviation {
    /// Of `values`; NaN where there are none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.into_iter().collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
        let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Self { greatest, mean, deviation: if count > 1.0 { (square / (count - 1.0)).sqrt() } else { 0.0 } }
    }
}

/// The middle one of `values`; NaN where there are none.
pub fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The rows of the longest unbroken contact.
pub fn contact(estimates: &[Estimate]) -> std::ops::Range<usize> {
    let (mut best, mut start) = (0..0, 0);
    for (k, estimate) in estimates.iter().enumerate() {
        if estimate.flags.contains(Flags::NO_CONTACT) {
            start = k + 1;
        } else if k + 1 - start > best.len() {
            best = start..k + 1;
        }
    }
    best
}

/// 100 rms(innovation) / rms(force) over every row in contact from `after` rows behind its beginning on.
pub fn rmse_percent(estimates: &[Estimate], samples: &[Sample], after: usize) -> f64 {
    let (mut errors, mut forces, mut since) = (0.0, 0.0, 0);
    for (estimate, sample) in estimates.iter().zip(samples) {
        since = if estimate.flags.contains(Flags::NO_CONTACT) { 0 } else { since + 1 };
        if since > after {
            errors += f64::from(estimate.innovation).powi(2);
            forces += f64::from(sample.force).powi(2);
        }
    }
    100.0 * (errors / forces).sqrt()
}

/// K, row by row.
pub fn stiffness(estimates: &[Estimate]) -> impl Iterator<Item = f64> + '_ {
    estimates.iter().map(|estimate| f64::from(estimate.impedance.stiffness))
}

/// B, row by row.
pub fn damping(estimates: &[Estimate]) -> impl Iterator<Item = f64> + '_ {
    estimates.iter().map(|estimate| f64::from(estimate.impedance.damping))
}

/// Rows from the first of `estimates` until K stays within `share` of `truth`; all of them where it never does.
pub fn settling(estimates: &[Estimate], truth: f64, share: f64) -> usize {
    let outside = |k: f64| k.is_nan() || (k - truth).abs() > share * truth;
    let values: Vec<f64> = stiffness(estimates).collect();
    values.iter().rposition(|k| outside(*k)).map_or(0, |last| last + 1)
}

/// Shares of the rows whose 95 % intervals hold K and B.
pub fn coverage(estimates: &[Estimate], stiffness: f64, damping: f64) -> [f64; 2] {
    let inside = |got: f32, truth: f64, width: f32| (f64::from(got) - truth).abs() <= f64::from(width);
    let share = |holds: &dyn Fn(&Estimate) -> bool| {
        estimates.iter().filter(|e| holds(e)).count() as f64 / estimates.len() as f64
    };
    [
        share(&|e| inside(e.impedance.stiffness, stiffness, e.half_width.stiffness)),
        share(&|e| inside(e.impedance.damping, damping, e.half_width.damping)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use palpate::Impedance;

    fn course(values: &[f32]) -> Vec<Estimate> {
        let estimate = |k: &f32| Estimate {
            impedance: Impedance { stiffness: *k, damping: 0.0 },
            flags: if *k == 0.0 { Flags::NO_CONTACT } else { Flags::empty() },
            ..Estimate::NO_CONTACT
        };
        values.iter().map(estimate).collect()
    }

    #[test]
    fn settled_is_what_stays_and_not_what_passes() {
        let estimates = course(&[0.0, 10.0, 100.0, 150.0, 95.0, 105.0]);
        assert_eq!(settling(&estimates, 100.0, 0.1), 4, "it passed 100 and left it again");
        assert_eq!(settling(&course(&[100.0; 3]), 100.0, 0.1), 0);
        assert_eq!(settling(&course(&[f32::NAN; 3]), 100.0, 0.1), 3, "what is no number has not settled");
    }

    #[test]
    fn the_longest_contact_is_found_among_flickers() {
        assert_eq!(contact(&course(&[0.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 1.0])), 3..6);
        assert_eq!(contact(&course(&[0.0; 4])), 0..0);
    }

    #[test]
    fn a_spread_is_that_of_a_sample() {
        let spread = MeanAndDeviation::of([1.0, 2.0, 3.0]);
        assert!((spread.mean - 2.0).abs() < 1e-12 && (spread.deviation - 1.0).abs() < 1e-12, "{spread:?}");
        assert!((median([3.0, 1.0, 2.0]) - 2.0).abs() < 1e-12);
    }
}
