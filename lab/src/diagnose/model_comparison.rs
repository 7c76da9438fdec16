//! Tests that compare two fitted models.

use statrs::distribution::{ChiSquared, ContinuousCDF as _};

/// Probability of as large a likelihood ratio, in nats of log likelihood that the larger model gains, where the smaller one is true;
/// `values` is how many the larger has more (S. S. Wilks, *Ann. Math. Stat.* 9, 1938).
#[must_use]
pub fn likelihood_ratio_p(gain: f64, values: usize) -> f64 {
    ChiSquared::new(values.max(1) as f64).map_or(1.0, |chi| chi.sf(2.0 * gain.max(0.0)))
}

/// Vuong's statistic: the mean difference of two models' log likelihoods over its deviation, `blocks` of rows taken together
/// (Q. H. Vuong, *Econometrica* 57, 1989); zero where there are fewer than two.
#[must_use]
pub fn vuong(blocks: &[f64]) -> f64 {
    let count = blocks.len() as f64;
    if count < 2.0 {
        return 0.0;
    }
    let mean = blocks.iter().sum::<f64>() / count;
    let variance = blocks.iter().map(|block| (block - mean).powi(2)).sum::<f64>() / (count - 1.0);
    if variance > 0.0 { mean * (count / variance).sqrt() } else { 0.0 }
}

/// Clarke's statistic, of the same differences: by how many deviations more blocks than half speak for the first (K. A. Clarke, *Political
/// Analysis* 15, 2007). It asks the same as Vuong's and does not fail where a few blocks, gains or losses, outweigh all others.
#[must_use]
pub fn clarke(blocks: &[f64]) -> f64 {
    let count = blocks.len() as f64;
    if count < 2.0 {
        return 0.0;
    }
    let gains = blocks.iter().filter(|gain| **gain > 0.0).count() as f64;
    (2.0 * gains - count) / count.sqrt()
}

/// What `more` has over `less`, log likelihoods row by row, in each whole block of `block` rows.
#[must_use]
pub fn block_gains(more: &[f64], less: &[f64], block: usize) -> Vec<f64> {
    let blocks = more.chunks_exact(block).zip(less.chunks_exact(block));
    blocks.map(|(more, less)| more.iter().zip(less).map(|(more, less)| more - less).sum()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loss_in_one_block_does_not_outweigh_gains_in_all_others() {
        let less = vec![0.0; 400];
        let mut more = vec![0.5; 400];
        more[50..60].fill(-30.0);
        assert!(vuong(&block_gains(&more, &less, 20)) < 1.0);
        // 19 of 20 blocks gain: 18 over the root of 20.
        assert!((clarke(&block_gains(&more, &less, 20)) - 18.0 / 20.0f64.sqrt()).abs() < 1e-12);
        let mut once = less.clone();
        once[50..60].fill(30.0);
        assert!(clarke(&block_gains(&once, &less, 20)) < 0.0);
        assert_eq!(clarke(&block_gains(&more[..30], &less[..30], 20)), 0.0);
    }

    #[test]
    fn a_gain_in_one_block_alone_is_no_gain_throughout() {
        let less = vec![0.0; 400];
        let mut once = less.clone();
        once[50..60].fill(30.0);
        assert!(vuong(&block_gains(&once, &less, 20)) < 1.1);
        let throughout: Vec<f64> = (0..400).map(|row| 0.7 + 0.1 * f64::from(row % 3)).collect();
        assert!(vuong(&block_gains(&throughout, &less, 20)) > 30.0);
        assert_eq!(vuong(&block_gains(&once[..30], &less[..30], 20)), 0.0);
    }
}
