//! Which rows of a long trial the page shows.

use super::Trial;

/// More rows than this a screen cannot show, and nine methods of them already weigh 3 MB.
const ROWS_OF_A_TRIAL: usize = 12_000;
/// Numbers that the trials of a page share (at 5.3 bytes each), so that twenty recordings weigh no more than a few.
const NUMBERS_OF_A_PAGE: usize = 2_000_000;
/// Below this a picture is no longer one.
const FEWEST: usize = 500;

/// Rows that each trial of a page may show.
pub(super) fn budget(trials: &[Trial]) -> usize {
    let columns: usize = trials.iter().map(|trial| 5 + 5 * trial.methods.len()).sum();
    (NUMBERS_OF_A_PAGE / columns.max(1)).clamp(FEWEST, ROWS_OF_A_TRIAL)
}

/// At most `budget` rows of `trial`, in order: the first and the last, both sides of every edge of contact, and in
/// every stretch of time the extremes of penetration, of force and of each innovation. Where the edges alone would
/// take more than half of the budget, every n-th of them.
pub(super) fn rows(trial: &Trial, budget: usize) -> Vec<usize> {
    let total = trial.time.len();
    if total <= budget {
        return (0..total).collect();
    }
    let edges = edges(&trial.contact, budget / 2);
    let mut stretches = budget / 2;
    loop {
        let kept = keep(trial, &edges, stretches);
        if kept.len() <= budget || stretches == 1 {
            return kept;
        }
        // Signals share extremes to an unknown degree, so the number of stretches is found by trial; 0.95 spares
        // the last rounds of a slow approach.
        stretches = ((stretches * budget) as f64 / kept.len() as f64 * 0.95).max(1.0) as usize;
    }
}

fn edges(contact: &[bool], most: usize) -> Vec<usize> {
    let is_edge = |&i: &usize| contact[i] != contact[i - 1];
    let all: Vec<usize> = (1..contact.len()).filter(is_edge).collect();
    let every = (2 * all.len()).div_ceil(most.max(2)).max(1);
    all.into_iter().step_by(every).flat_map(|i| [i - 1, i]).collect()
}

fn keep(trial: &Trial, edges: &[usize], stretches: usize) -> Vec<usize> {
    let total = trial.time.len();
    let mut kept = vec![false; total];
    kept[0] = true;
    kept[total - 1] = true;
    edges.iter().for_each(|&row| kept[row] = true);
    let innovations = trial.methods.iter().map(|method| method.innovation.as_slice());
    for signal in [trial.penetration.as_slice(), &trial.force].into_iter().chain(innovations) {
        for stretch in 0..stretches {
            let (start, end) = (stretch * total / stretches, (stretch + 1) * total / stretches);
            for row in extremes(&signal[start..end]).into_iter().flatten() {
                kept[start + row] = true;
            }
        }
    }
    kept.iter().enumerate().filter_map(|(row, &keep)| keep.then_some(row)).collect()
}

/// Where the least and the greatest number are; nowhere if there are only NaNs.
fn extremes(signal: &[f32]) -> [Option<usize>; 2] {
    let numbers = || signal.iter().enumerate().filter(|(_, value)| !value.is_nan());
    let least = numbers().min_by(|a, b| a.1.total_cmp(b.1));
    let greatest = numbers().max_by(|a, b| a.1.total_cmp(b.1));
    [least, greatest].map(|found| found.map(|(row, _)| row))
}
