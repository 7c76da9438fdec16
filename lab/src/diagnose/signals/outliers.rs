//! Single readings that are no measurements.

/// Replaces single readings that leap away from both neighbours by more than the whole remaining range of the channel by what lies
/// on the line between those: the rows that were.
pub fn interpolate_outliers(time: &[f64], values: &mut [f64]) -> Vec<usize> {
    if values.len() < 3 {
        return Vec::new();
    }
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let (low, high) = (sorted[sorted.len() / 100], sorted[sorted.len() - 1 - sorted.len() / 100]);
    let range = high - low;
    let mut replaced = Vec::new();
    for at in 1..values.len() - 1 {
        let (before, after) = (values[at - 1], values[at + 1]);
        let leap = (values[at] - before).abs().min((values[at] - after).abs());
        let beyond = (values[at] - high).max(low - values[at]);
        if range > 0.0 && leap > range && beyond > 0.5 * range {
            let part = (time[at] - time[at - 1]) / (time[at + 1] - time[at - 1]);
            values[at] = before + part * (after - before);
            replaced.push(at);
        }
    }
    replaced
}
