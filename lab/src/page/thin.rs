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
    let Some(mut search) = Search::new(total, signals.len(), budget) else { return (0..total).collect() };
    loop {
        (0..total).for_each(|row| search.take(signals.iter().map(|signal| signal[row])));
        if let Some(rows) = search.end_of_pass(certain) {
            return rows;
        }
    }
}

/// Both sides of every edge of `flags`; where they would be more than `most`, of every n-th.
pub(crate) fn edges(flags: &[bool], most: usize) -> Vec<usize> {
    let is_edge = |&i: &usize| flags[i] != flags[i - 1];
    let count = (1..flags.len()).filter(is_edge).count();
    let every = (2 * count).div_ceil(most.max(2)).max(1);
    (1..flags.len()).filter(is_edge).step_by(every).flat_map(|i| [i - 1, i]).collect()
}

/// The search for the rows of a trial that is too long to be held: it goes through all rows, in order, until what it keeps fits.
pub(crate) struct Search {
    budget: usize,
    pass: Pass,
}

impl Search {
    /// For at most `budget` of `total` rows, by the extremes of `signals` signals; `None` where all rows fit.
    pub(crate) fn new(total: usize, signals: usize, budget: usize) -> Option<Self> {
        (total > budget).then(|| Self { budget, pass: Pass::new(total, signals, budget / 2) })
    }

    /// The signals of the next row.
    pub(crate) fn take(&mut self, signals: impl Iterator<Item = f32>) {
        self.pass.take(signals);
    }

    /// The rows, with those of `certain`, where a pass over all rows has found few enough; `None` asks for another one.
    pub(crate) fn end_of_pass(&mut self, certain: &[usize]) -> Option<Vec<usize>> {
        let Pass { total, stretches, .. } = self.pass;
        let kept = std::mem::take(&mut self.pass.kept);
        let mut kept: Vec<usize> = kept.into_iter().chain(certain.iter().copied()).chain([0, total - 1]).collect();
        kept.sort_unstable();
        kept.dedup();
        if kept.len() <= self.budget || stretches == 1 {
            return Some(kept);
        }
        // Signals share extremes to an unknown degree, so the number of stretches is found by trial; 0.95 spares
        // the last rounds of a slow approach.
        let fewer = ((stretches * self.budget) as f64 / kept.len() as f64 * 0.95).max(1.0) as usize;
        self.pass = Pass::new(total, self.pass.extremes.len(), fewer);
        None
    }
}

/// The extremes of each signal in each of `stretches` stretches of time, row by row.
struct Pass {
    total: usize,
    stretches: usize,
    /// Of the stretch that is under way.
    extremes: Vec<Extremes>,
    stretch: usize,
    row: usize,
    /// Rows of the extremes of the stretches that are over.
    kept: Vec<usize>,
}

impl Pass {
    fn new(total: usize, signals: usize, stretches: usize) -> Self {
        Self { total, stretches, extremes: vec![Extremes::default(); signals], stretch: 0, row: 0, kept: Vec::new() }
    }

    fn take(&mut self, signals: impl Iterator<Item = f32>) {
        self.extremes.iter_mut().zip(signals).for_each(|(extremes, value)| extremes.take(self.row, value));
        self.row += 1;
        if self.row == (self.stretch + 1) * self.total / self.stretches {
            self.kept.extend(self.extremes.iter().flat_map(Extremes::rows));
            self.extremes.fill(Extremes::default());
            self.stretch += 1;
        }
    }
}

/// Where the least and the greatest number are, with the numbers; nowhere as long as there are only NaNs.
#[derive(Clone, Copy, Default)]
struct Extremes {
    least: Option<(usize, f32)>,
    greatest: Option<(usize, f32)>,
}

impl Extremes {
    /// Of equal numbers the first is the least and the last the greatest.
    fn take(&mut self, row: usize, value: f32) {
        if value.is_nan() {
            return;
        }
        if self.least.is_none_or(|(_, least)| value.total_cmp(&least).is_lt()) {
            self.least = Some((row, value));
        }
        if self.greatest.is_none_or(|(_, greatest)| value.total_cmp(&greatest).is_ge()) {
            self.greatest = Some((row, value));
        }
    }

    fn rows(&self) -> impl Iterator<Item = usize> + use<> {
        [self.least, self.greatest].into_iter().flatten().map(|(row, _)| row)
    }
}
