//! A recording as the drive's model sees it: encoder rows, and the signals that act between them.

/// One trial. Encoder rows may be fewer than the recorded ones; effort and force keep every recorded row.
#[derive(Debug, Clone)]
pub struct DriveTrial {
    /// File name of the recording.
    pub name: String,
    /// Time of each encoder row, s, increasing.
    pub time: Vec<f64>,
    /// Encoder position of each row, m or rad.
    pub position: Vec<f64>,
    /// Whether the row starts a stretch: the first one, or one after a gap.
    pub restart: Vec<bool>,
    /// Median time between encoder rows, s.
    pub period_s: f64,
    /// Time of each recorded row, s.
    pub source_time: Vec<f64>,
    /// Effort less the known load, N or N m, held from its row to the next.
    pub effort: Vec<f64>,
    /// Contact force, N or N m, positive when the tool pushes; `None` in free motion.
    pub force: Option<Vec<f64>>,
}

/// Periods after which a pause is a gap: what the drive did meanwhile is unknown, and the filter starts anew.
const GAP_PERIODS: f64 = 8.0;

impl DriveTrial {
    /// A trial of which every `every`-th row is taken as an encoder row.
    #[must_use]
    pub fn new(
        name: String,
        source_time: Vec<f64>,
        position: &[f64],
        effort: Vec<f64>,
        force: Option<Vec<f64>>,
        every: usize,
    ) -> Self {
        let every = every.max(1);
        let time: Vec<f64> = source_time.iter().step_by(every).copied().collect();
        let position: Vec<f64> = position.iter().step_by(every).copied().collect();
        let period_s = median(time.windows(2).map(|pair| pair[1] - pair[0]).collect());
        let restart =
            (0..time.len()).map(|row| row == 0 || time[row] - time[row - 1] > GAP_PERIODS * period_s).collect();
        Self { name, time, position, restart, period_s, source_time, effort, force }
    }

    /// Encoder rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Seconds from the first row to the last.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.time.last().unwrap_or(&0.0) - self.time.first().unwrap_or(&0.0)
    }

    /// The encoder rows `rows` as a trial of their own; the signals between them stay whole.
    #[must_use]
    pub fn slice(&self, rows: std::ops::Range<usize>) -> Self {
        let mut restart = self.restart[rows.clone()].to_vec();
        if let Some(first) = restart.first_mut() {
            *first = true;
        }
        Self {
            name: self.name.clone(),
            time: self.time[rows.clone()].to_vec(),
            position: self.position[rows].to_vec(),
            restart,
            period_s: self.period_s,
            source_time: self.source_time.clone(),
            effort: self.effort.clone(),
            force: self.force.clone(),
        }
    }

    /// Mean speed from row `row` to the next, where there is one.
    #[must_use]
    pub fn rate_after(&self, row: usize) -> f64 {
        match (self.position.get(row + 1), self.time.get(row + 1)) {
            (Some(position), Some(time)) => (position - self.position[row]) / (time - self.time[row]),
            _ => 0.0,
        }
    }

    /// Greatest speed between two rows: the deviation of a speed that nothing is known of.
    #[must_use]
    pub fn fastest(&self) -> f64 {
        (0..self.len()).map(|row| self.rate_after(row).abs()).fold(0.0, f64::max)
    }

    /// How many rows lie between each row and the start of its stretch.
    pub fn rows_since_restart(&self) -> impl Iterator<Item = usize> + '_ {
        self.restart.iter().scan(0, |since, restart| {
            *since = if *restart { 0 } else { *since + 1 };
            Some(*since)
        })
    }
}

fn median(mut all: Vec<f64>) -> f64 {
    if all.is_empty() {
        return 1.0;
    }
    let middle = all.len() / 2;
    *all.select_nth_unstable_by(middle, f64::total_cmp).1
}
