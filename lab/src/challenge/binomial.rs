//! How far a share of few cases may be off.

use statrs::distribution::{Beta, ContinuousCDF as _};

/// Half of what a 95 % interval leaves out.
const TAIL_PROBABILITY: f64 = 0.025;

/// The 95 % interval of a probability of which `hits` of `of` were seen (C. J. Clopper, E. S. Pearson, Biometrika 26 (1934)
/// 404); all of 0 to 1 where nothing was seen.
#[must_use]
pub fn clopper_pearson(hits: usize, of: usize) -> [f64; 2] {
    let (hit, missed) = (hits as f64, of.saturating_sub(hits) as f64);
    let quantile = |a: f64, b: f64, at: f64| Beta::new(a, b).map_or(f64::NAN, |beta| beta.inverse_cdf(at));
    let low = if hits == 0 { 0.0 } else { quantile(hit, missed + 1.0, TAIL_PROBABILITY) };
    let high = if hits >= of { 1.0 } else { quantile(hit + 1.0, missed, 1.0 - TAIL_PROBABILITY) };
    [low, high]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tabulated_intervals() {
        // SciPy: scipy.stats.binomtest(hits, of).proportion_ci(method="exact").
        for (hits, of, low, high) in
            [(0, 300, 0.0, 0.012_220_7), (1, 20, 0.001_265_1, 0.248_732_8), (18, 20, 0.683_017_3, 0.987_651_4)]
        {
            let found = clopper_pearson(hits, of);
            assert!((found[0] - low).abs() < 1e-6 && (found[1] - high).abs() < 1e-6, "{hits} of {of}: {found:?}");
        }
        assert_eq!(clopper_pearson(0, 0), [0.0, 1.0]);
    }
}
