//! The rows on which candidates are compared: some stretches of a long recording in the place of all of it.

use std::ops::Range;

use super::likelihood::Data;
use super::trial::DriveTrial;

/// Rows of a sample, by and large: each value of a law is known from them to a few times what it is known to from all. Chosen.
const SAMPLE_ROWS: usize = 8_000;

/// Rows of a stretch: what a law that is wrong leaves lasts for some hundred, and what is known at its start is lost with it. Chosen.
const STRETCH_ROWS: usize = 500;

/// Rows from which a sample is taken: of fewer it would save less than a third.
const FEWEST_ROWS: usize = SAMPLE_ROWS + SAMPLE_ROWS / 2;

/// Stretches of the trials of `data`, half of them spread evenly and half where more is `missing`, N or N m, a column a trial; `None` where all
/// rows are not many more.
///
/// Systematic sampling with probability in proportion to size (W. G. Madow, *Ann. Math. Stat.* 20, 1949, 333), without chance: ticks at even
/// distances along the stretches' sizes, the size of each being its share of the rows and its share of the missing power.
#[must_use]
pub fn sample(data: &Data<'_>, missing: &[Vec<f64>]) -> Option<Vec<DriveTrial>> {
    let rows: usize = data.trials.iter().map(DriveTrial::len).sum();
    if rows <= FEWEST_ROWS {
        return None;
    }
    let all: Vec<(usize, Range<usize>)> = data
        .trials
        .iter()
        .enumerate()
        .flat_map(|(at, trial)| stretches(trial.len()).map(move |own| (at, own)))
        .collect();
    let power = |(trial, own): &(usize, Range<usize>)| {
        missing[*trial][own.clone()].iter().map(|force| force * force).sum::<f64>()
    };
    let powers: Vec<f64> = all.iter().map(power).collect();
    let whole = powers.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let sizes = all.iter().zip(&powers).map(|((_, own), power)| own.len() as f64 / rows as f64 + power / whole);
    let is_hit = hits(&sizes.collect::<Vec<f64>>(), SAMPLE_ROWS / STRETCH_ROWS);
    let mut chosen: Vec<Vec<Range<usize>>> = vec![Vec::new(); data.trials.len()];
    for ((trial, own), _) in all.into_iter().zip(is_hit).filter(|(_, is_hit)| *is_hit) {
        match chosen[trial].last_mut() {
            Some(last) if last.end == own.start => last.end = own.end,
            _ => chosen[trial].push(own),
        }
    }
    let each = data.trials.iter().zip(chosen).filter(|(_, own)| !own.is_empty());
    Some(each.map(|(trial, own)| trial.of_stretches(&own)).collect())
}

/// A trial of `rows` rows in stretches of like length.
fn stretches(rows: usize) -> impl Iterator<Item = Range<usize>> {
    let count = rows.div_ceil(STRETCH_ROWS);
    (0..count).map(move |at| at * rows / count..(at + 1) * rows / count)
}

/// Which of `sizes`, laid end to end, hold one of `count` ticks or more.
fn hits(sizes: &[f64], count: usize) -> Vec<bool> {
    let apart = sizes.iter().sum::<f64>() / count as f64;
    let (mut end, mut ticks) = (0.0, 0);
    let mut hit = |size: &f64| {
        end += size;
        let before = ticks;
        ticks = (end / apart + 0.5).floor() as usize;
        ticks > before
    };
    sizes.iter().map(&mut hit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::drive::testing::TestDrive;

    #[test]
    fn what_is_larger_than_the_distance_of_ticks_is_hit_and_of_the_rest_one_in_so_many() {
        let mut sizes = vec![1.0; 100];
        sizes[41] = 25.0;
        let hit: Vec<usize> = (0..100).filter(|at| hits(&sizes, 10)[*at]).collect();
        // Ticks at 6.2, 18.6, 31.0, ..., 117.8 of 124.
        assert!(hit.contains(&41) && (8..=9).contains(&hit.len()), "{hit:?}");
        assert!(hit.windows(2).all(|pair| pair[1] - pair[0] <= 13), "{hit:?}");
    }

    /// 30 s with 1 N from the twelfth to the thirteenth second: all of that second is in the sample, and every other part of the recording in turn.
    #[test]
    fn where_much_is_missing_every_row_is_taken_and_elsewhere_some() {
        let trials = [TestDrive::PLAIN.trial(20.0, 1), TestDrive::PLAIN.trial(10.0, 2)];
        let data = Data { trials: &trials, least_encoder_variance: 0.0 };
        let mut missing = [vec![0.0; 20_000], vec![0.0; 10_000]];
        missing[0][12_000..13_000].fill(1.0);
        let sample = sample(&data, &missing).expect("30 000 rows are many");
        let rows: usize = sample.iter().map(DriveTrial::len).sum();
        assert!((SAMPLE_ROWS / 2..=SAMPLE_ROWS).contains(&rows), "{rows}");
        let lively = sample[0].time.iter().filter(|time| (11.9995..12.9995).contains(*time)).count();
        assert_eq!(lively, 1000);
        // Eight ticks over the 30 s.
        for (trial, seconds) in sample.iter().zip([20, 10]) {
            for from in (0..seconds - 5).map(f64::from) {
                assert!(trial.time.iter().any(|time| (from..from + 5.0).contains(time)), "{} from {from}", trial.name);
            }
        }
        let few = Data { trials: &trials[1..], ..data };
        assert!(super::sample(&few, &missing[1..]).is_none());
    }
}
