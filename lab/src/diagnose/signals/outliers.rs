//! Single readings that are no measurements.

/// A first reading leaps where its second difference is so many times the largest that follows. Chosen: a row less costs nothing.
const START_LEAP: f64 = 2.0;
/// Rows from which there are bends enough to compare with.
const FEWEST_BENDS: usize = 10;

/// Replaces single readings that leap away from both neighbours by more than the whole remaining range of the channel by what lies
/// on the line between those; and a first reading, as of a converter that was not read yet, by the line through the next two: the rows
/// that were.
pub fn interpolate_outliers(time: &[f64], values: &mut [f64]) -> Vec<usize> {
    if values.len() < 3 {
        return Vec::new();
    }
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let (low, high) = (sorted[sorted.len() / 100], sorted[sorted.len() - 1 - sorted.len() / 100]);
    let range = high - low;
    let mut replaced = Vec::new();
    let bend = |at: usize| (values[at] - 2.0 * values[at + 1] + values[at + 2]).abs();
    if values.len() > FEWEST_BENDS && bend(0) > START_LEAP * (1..values.len() - 2).map(bend).fold(0.0, f64::max) {
        values[0] = 2.0 * values[1] - values[2];
        replaced.push(0);
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn swing() -> (Vec<f64>, Vec<f64>) {
        let time: Vec<f64> = (0..200).map(|row| 1e-3 * f64::from(row)).collect();
        let force = time.iter().map(|time| 5.0 + (40.0 * time).sin()).collect();
        (time, force)
    }

    #[test]
    fn a_first_reading_of_nothing_is_no_measurement() {
        let (time, mut force) = swing();
        let there = force[0];
        force[0] = 0.0;
        assert_eq!(interpolate_outliers(&time, &mut force), [0]);
        // The line through the next two: off by one second difference, (40 / s * 1 ms)^2 of the swing at most.
        assert!((force[0] - there).abs() < 2e-3, "{}", force[0]);
    }

    #[test]
    fn a_first_reading_like_the_others_stays() {
        let (time, mut force) = swing();
        let before = force.clone();
        assert!(interpolate_outliers(&time, &mut force).is_empty());
        assert_eq!(force, before);
    }

    #[test]
    fn a_leap_beyond_the_range_is_replaced_by_the_line_between_its_neighbours() {
        let (time, mut force) = swing();
        force[90] = 60.0;
        assert_eq!(interpolate_outliers(&time, &mut force), [90]);
        assert!((force[90] - 0.5 * (force[89] + force[91])).abs() < 1e-12);
    }
}
