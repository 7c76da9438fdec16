//! The size of an effect that has a requested strength.

use anyhow::Result;

use crate::effect::SizeRange;

/// What a size came to.
#[derive(Debug, Clone)]
pub struct SizeResult<T> {
    /// The size.
    pub size: f64,
    /// Its strength.
    pub ratio: f64,
    /// What the trial at this size trials.
    pub trials: T,
}

/// A size and its strength.
type SizeAndRatio = (f64, f64);

/// Close enough: four percent.
const LOG_RATIO_TOLERANCE: f64 = 0.04;

/// Finds the size whose strength is `target`, by the secant between the nearest misses in logarithms; where no possible
/// size has it, the nearest that was met. `measure` returns the strength, infinite where the size is impossible.
///
/// # Errors
/// Those of `measure`.
pub fn find_size<T>(
    target: f64,
    sizes: SizeRange,
    mut measure: impl FnMut(f64) -> Result<(f64, T)>,
) -> Result<SizeResult<T>> {
    let (mut below, mut above): (Option<SizeAndRatio>, Option<SizeAndRatio>) = (None, None);
    let mut size = sizes.initial;
    let (ratio, trials) = measure(size)?;
    let mut best = SizeResult { size, ratio, trials };
    let mut ratio = best.ratio;
    for round in 0..16 {
        if miss(best.ratio, target) < LOG_RATIO_TOLERANCE {
            break;
        }
        if ratio < target {
            below = Some((size, ratio));
        } else {
            above = Some((size, ratio));
        }
        let ended = (ratio < target && size >= sizes.largest) || (ratio > target && size <= sizes.smallest);
        if ended {
            break;
        }
        size = next(target, below, above, round).clamp(sizes.smallest, sizes.largest);
        let (met, trials) = measure(size)?;
        ratio = met;
        if miss(ratio, target) < miss(best.ratio, target) {
            best = SizeResult { size, ratio, trials };
        }
    }
    Ok(best)
}

/// Distance in logarithms, for which nothing and the impossible are infinitely far.
fn miss(ratio: f64, target: f64) -> f64 {
    let miss = (ratio / target).ln().abs();
    if miss.is_nan() { f64::INFINITY } else { miss }
}

fn next(target: f64, below: Option<SizeAndRatio>, above: Option<SizeAndRatio>, round: usize) -> f64 {
    match (below, above) {
        (Some((low, low_ratio)), Some((high, high_ratio))) => {
            let secant = (target / low_ratio).ln() / (high_ratio / low_ratio).ln();
            // A strength is not always smooth in the size: every third step halves what is trials.
            let share = if secant.is_finite() && round % 3 != 2 { secant.clamp(0.03, 0.97) } else { 0.5 };
            low * (high / low).powf(share)
        }
        (Some((size, ratio)), None) | (None, Some((size, ratio))) => size * (target / ratio).clamp(0.02, 50.0),
        (None, None) => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_a_size_on_any_power_and_stops_at_the_largest() {
        for power in [0.5, 1.0, 2.0] {
            let found = find_size(3.0, SizeRange::new(1.0, 1e6), |size| Ok((0.01 * size.powf(power), ()))).unwrap();
            assert!((found.ratio / 3.0).ln().abs() < LOG_RATIO_TOLERANCE, "{power}: {found:?}");
        }
        let capped = find_size(3.0, SizeRange::new(1.0, 10.0), |size| Ok((0.01 * size, ()))).unwrap();
        assert_eq!((capped.size, capped.ratio), (10.0, 0.1));
        let impossible = find_size(3.0, SizeRange::new(1.0, 1e6), |size| {
            Ok((if size > 7.0 { f64::INFINITY } else { size * 0.1 }, ()))
        })
        .unwrap();
        assert!((5.0..=7.0).contains(&impossible.size), "{impossible:?}");
    }
}
