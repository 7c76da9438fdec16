//! The white noise of a channel, separated from whatever moves slowly beneath it.

/// Samples that one residual spans.
const FILTER_SPAN: usize = 7;

/// Residuals whose mean square makes one vote.
const BLOCK_SAMPLES: usize = 32;

/// Median over mean of the mean square of such a block. Neighbouring residuals share samples: 32 of them are worth 10.4
/// independent ones (the squares of their autocorrelations C(12, 6+j)/C(12, 6) add to 3.17), and the median of a
/// chi-square of k degrees is (1 - 2/(9 k))^3 of its mean.
const MEDIAN_OVER_MEAN: f64 = 0.937;

/// Standard deviation of the white noise of `values` sampled at `time`; 0 for fewer than three values.
///
/// Each run of seven samples gives one residual, the divided difference of order six scaled to the noise: it is blind to
/// any polynomial of degree five on any time grid, and to a sine at a tenth of the sample rate but for 0.2 % of its
/// amplitude. The mean square over blocks of 32 residuals, and the median over the blocks, keeps contact onsets and spikes
/// out and, other than a median of single residuals, does not snap to a rounded sensor's steps.
///
/// Noise that a filter has coloured is underestimated: only what changes from one sample to the next counts.
#[must_use]
pub fn white_noise(time: &[f64], values: &[f64]) -> f64 {
    let rows = time.len().min(values.len());
    if rows < 3 {
        return 0.0;
    }
    let reach = FILTER_SPAN.min(rows);
    let residuals = rows - reach + 1;
    let mut votes: Vec<_> = (0..residuals)
        .step_by(BLOCK_SAMPLES)
        .map(|start| {
            let block = start..(start + BLOCK_SAMPLES).min(residuals);
            mean_square(block.map(|at| residual(&time[at..at + reach], &values[at..at + reach])))
        })
        .collect();
    // A short remainder counts as much as a block: leave it out where there is anything else.
    if !residuals.is_multiple_of(BLOCK_SAMPLES) && votes.len() > 1 {
        votes.pop();
    }
    let middle = votes.len() / 2;
    let median = *votes.select_nth_unstable_by(middle, f64::total_cmp).1;
    // One or two votes have no median to speak of.
    if votes.len() > 2 { (median / MEDIAN_OVER_MEAN).sqrt() } else { median.sqrt() }
}

fn mean_square(block: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = block.len() as f64;
    block.map(|residual| residual * residual).sum::<f64>() / count
}

/// The divided difference of all points, its weights scaled to unit length.
fn residual(time: &[f64], values: &[f64]) -> f64 {
    let span = time[time.len() - 1] - time[0];
    // Offsets are taken out first: a large constant would leave its rounding errors.
    let base = values[0];
    let (mut sum, mut square) = (0.0, 0.0);
    for (i, &t) in time.iter().enumerate() {
        let others = time.iter().enumerate().filter(|(j, _)| *j != i);
        let weight = others.map(|(_, &other)| (t - other) / span).product::<f64>().recip();
        sum += weight * (values[i] - base);
        square += weight * weight;
    }
    // Two times within a rounding error of each other: no weight to speak of.
    if square.is_finite() { sum / square.sqrt() } else { 0.0 }
}
