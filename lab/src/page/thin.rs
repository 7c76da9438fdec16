//! Which rows of a long trial the page shows.

/// More rows than this a screen cannot show, and nine methods of them already weigh 3 MB.
const ROWS_OF_A_TRIAL: usize = 12_000;
/// Numbers that the trials of a page share (at 5.3 bytes each), so that twenty recordings weigh no more than a few.
const NUMBERS_OF_A_PAGE: usize = 2_000_000;
/// Below this a picture is no longer one.
const MIN_PICTURE_ROWS: usize = 500;

/// Rows that each trial of a page may show, where all trials together have `columns`.
pub(crate) fn budget(columns: usize) -> usize {
    (NUMBERS_OF_A_PAGE / columns.max(1)).clamp(MIN_PICTURE_ROWS, ROWS_OF_A_TRIAL)
}

/// At most `budget` of `total` rows, in order: the first and the last, those of `certain`, and in every stretch of
/// time the extremes of each signal. `certain` must leave some of the budget.
pub(crate) fn rows(total: usize, certain: &[usize], signals: &[&[f32]], budget: usize) -> Vec<usize> {
    if total <= budget {
        return (0..total).collect();
    }
    let mut stretches = budget / 2;
    loop {
        let kept = keep(total, certain, signals, stretches);
        if kept.len() <= budget || stretches == 1 {
            return kept;
        }
        // Signals share extremes to an unknown degree, so the number of stretches is found by trial; 0.95 spares
        // the last rounds of a slow approach.
        stretches = ((stretches * budget) as f64 / kept.len() as f64 * 0.95).max(1.0) as usize;
    }
}

/// Both sides of every edge of `flags`; where they would be more than `most`, of every n-th.
pub(crate) fn edges(flags: &[bool], most: usize) -> Vec<usize> {
    let is_edge = |&i: &usize| flags[i] != flags[i - 1];
    let all: Vec<usize> = (1..flags.len()).filter(is_edge).collect();
    let every = (2 * all.len()).div_ceil(most.max(2)).max(1);
    all.into_iter().step_by(every).flat_map(|i| [i - 1, i]).collect()
}

fn keep(total: usize, certain: &[usize], signals: &[&[f32]], stretches: usize) -> Vec<usize> {
    let mut kept = vec![false; total];
    kept[0] = true;
    kept[total - 1] = true;
    certain.iter().for_each(|&row| kept[row] = true);
    for signal in signals {
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
