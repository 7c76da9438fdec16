//! A recording as the drive's model sees it: encoder rows, and the signals that act between them.

use std::ops::Range;
use std::sync::Arc;

use super::noise::{robust_white_variance, white_variance};
use super::wiener_filter::WienerFilter;
use crate::diagnose::median::median;

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
    /// Median time between recorded rows, s.
    pub recorded_period_s: f64,
    /// Time of each recorded row, s.
    pub source_time: Vec<f64>,
    /// Effort, N or N m, held from its row to the next.
    pub effort: Vec<f64>,
    /// What a rigid-body model explains of the effort, N or N m, straight from its row to the next; `None` where none is given.
    pub load: Option<Vec<f64>>,
    /// Contact force, N or N m, positive when the tool pushes; `None` in free motion.
    pub force: Option<Vec<f64>>,
    /// Two-sided density of the force sensor's noise, which the model feels as a force on the load, N^2 s or (N m)^2 s.
    pub force_density: f64,
    /// What took the sensors' noise out of effort and force; `None` where they are as recorded.
    pub noise_filter: Option<Arc<WienerFilter>>,
}

/// Periods after which a pause is a gap: what the drive did meanwhile is unknown, and the filter starts anew.
const GAP_PERIODS: f64 = 8.0;

/// Periods before and after a stretch within which the signals of its trial are kept: an effort comes late by twenty at the most, and of a lag of
/// fifty e^-4 is lost.
const LEAD_PERIODS: f64 = 200.0;

impl DriveTrial {
    /// A trial without a load, of which every `every`-th row is taken as an encoder row, and whose force is without noise.
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
        let period_s = median(time.windows(2).map(|pair| pair[1] - pair[0])).unwrap_or(1.0);
        let recorded_period_s = median(source_time.windows(2).map(|pair| pair[1] - pair[0])).unwrap_or(period_s);
        let restart =
            (0..time.len()).map(|row| row == 0 || time[row] - time[row - 1] > GAP_PERIODS * period_s).collect();
        Self {
            name,
            time,
            position,
            restart,
            period_s,
            recorded_period_s,
            source_time,
            effort,
            load: None,
            force,
            force_density: 0.0,
            noise_filter: None,
        }
    }

    /// What the effort has beyond the load as it is given, N or N m, at each recorded row.
    #[must_use]
    pub fn net_effort(&self) -> Vec<f64> {
        let Some(load) = &self.load else { return self.effort.clone() };
        self.effort.iter().zip(load).map(|(effort, load)| effort - load).collect()
    }

    /// The same with effort and force as they most probably were, where they were recorded with noise of `levels` times what
    /// changes from row to row.
    #[must_use]
    pub fn denoised(&self, levels: [f64; 2]) -> Self {
        let force = self.force.clone().unwrap_or_else(|| vec![0.0; self.effort.len()]);
        let recorded = [self.effort.clone(), force];
        let Some(filter) = WienerFilter::of(&recorded, levels) else { return self.clone() };
        let [effort, force] = filter.passed(&recorded);
        Self {
            effort,
            force: self.force.is_some().then_some(force),
            noise_filter: Some(Arc::new(filter)),
            ..self.clone()
        }
    }

    /// Variance of the white noise in the effort, N^2 or (N m)^2.
    #[must_use]
    pub fn effort_variance(&self) -> f64 {
        let left = self.noise_filter.as_ref().map_or(0.0, |filter| filter.effort_noise_left());
        left.max(robust_white_variance(&self.effort))
    }

    /// The same without what acts on it.
    #[must_use]
    pub fn without_effort(mut self) -> Self {
        self.effort.fill(0.0);
        Self { load: None, ..self }
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
    pub fn slice(&self, rows: Range<usize>) -> Self {
        self.cut(&[rows], 0..self.source_time.len())
    }

    /// The encoder rows of `stretches`, which follow each other with other rows between, each as a stretch of its own, with the signals that act near
    /// them.
    #[must_use]
    pub fn of_stretches(&self, stretches: &[Range<usize>]) -> Self {
        let lead_s = LEAD_PERIODS * self.period_s;
        let mut kept: Vec<usize> = Vec::new();
        for rows in stretches.iter().filter(|rows| !rows.is_empty()) {
            let ends = [self.time[rows.start] - lead_s, self.time[rows.end - 1] + lead_s];
            let [start, end] = ends.map(|end| self.source_time.partition_point(|time| *time < end));
            kept.extend(start.max(kept.last().map_or(0, |last| last + 1))..end);
        }
        self.cut(stretches, kept.into_iter())
    }

    /// The encoder rows of `stretches`, each as a stretch of its own, and the `kept` rows of the signals between them.
    fn cut(&self, stretches: &[Range<usize>], kept: impl Iterator<Item = usize> + Clone) -> Self {
        let of_rows = |column: &[f64]| stretches.iter().flat_map(|rows| column[rows.clone()].iter().copied()).collect();
        let of_kept = |column: &Vec<f64>| kept.clone().map(|row| column[row]).collect();
        let starts = |rows: &Range<usize>| {
            let start = rows.start;
            rows.clone().map(move |row| row == start || self.restart[row])
        };
        Self {
            name: self.name.clone(),
            time: of_rows(&self.time),
            position: of_rows(&self.position),
            restart: stretches.iter().flat_map(starts).collect(),
            period_s: self.period_s,
            recorded_period_s: self.recorded_period_s,
            source_time: of_kept(&self.source_time),
            effort: of_kept(&self.effort),
            load: self.load.as_ref().map(of_kept),
            force: self.force.as_ref().map(of_kept),
            force_density: self.force_density,
            noise_filter: self.noise_filter.clone(),
        }
    }

    /// The same without the encoder rows from `start_s` to `end_s` of each of `spans`.
    #[must_use]
    pub fn without(&self, spans: &[[f64; 2]]) -> Self {
        let is_kept =
            |row: &usize| !spans.iter().any(|[start_s, end_s]| (*start_s..=*end_s).contains(&self.time[*row]));
        let rows: Vec<usize> = (0..self.len()).filter(is_kept).collect();
        let follows = |at: usize| at > 0 && rows[at] == rows[at - 1] + 1;
        Self {
            time: rows.iter().map(|row| self.time[*row]).collect(),
            position: rows.iter().map(|row| self.position[*row]).collect(),
            restart: (0..rows.len()).map(|at| !follows(at) || self.restart[rows[at]]).collect(),
            ..self.clone()
        }
    }

    /// Variance of the white noise in the encoder's rows, no stretch held against the next, m^2 or rad^2.
    #[must_use]
    pub fn encoder_variance(&self) -> f64 {
        let starts: Vec<usize> = (0..self.len()).filter(|row| self.restart[*row]).chain([self.len()]).collect();
        let of_stretch = |ends: &[usize]| {
            let rows = &self.position[ends[0]..ends[1]];
            let weight = rows.len().saturating_sub(6) as f64;
            (weight * white_variance(rows), weight)
        };
        let (sum, weight) =
            starts.windows(2).map(of_stretch).fold((0.0, 0.0), |all, own| (all.0 + own.0, all.1 + own.1));
        sum / weight.max(1.0)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::drive::input::Inputs;
    use crate::diagnose::drive::law::DriveLaw;

    #[test]
    fn a_cut_is_no_noise_of_the_encoder_and_starts_a_stretch() {
        let time: Vec<f64> = (0..400).map(|row| f64::from(row) * 1e-3).collect();
        let position: Vec<f64> = time.iter().map(|t| 3.0 * t * t).collect();
        let trial = DriveTrial::new("cut.csv".to_owned(), time.clone(), &position, time.clone(), None, 1);
        let cut = trial.without(&[[0.1, 0.2], [0.3, 0.3005]]);
        // Rows 100 to 200, and row 300.
        assert_eq!((cut.len(), cut.time[100], cut.time[199]), (298, 0.201, 0.301));
        assert_eq!((0..cut.len()).filter(|row| cut.restart[*row]).collect::<Vec<_>>(), [0, 100, 199]);
        assert!(cut.encoder_variance() < 1e-20 && white_variance(&cut.position) > 1e-6);
        assert_eq!(cut.source_time, time);
    }

    /// A late effort through a lag of ten rows is within a stretch what it is in the whole trial.
    #[test]
    fn stretches_keep_what_acts_near_them() {
        let time: Vec<f64> = (0..4000).map(|row| f64::from(row) * 1e-3).collect();
        let wave = |hz: f64| time.iter().map(|t| (std::f64::consts::TAU * hz * t).sin()).collect::<Vec<f64>>();
        let (position, effort, force) = (wave(1.0), wave(3.0), wave(7.0));
        let mut trial = DriveTrial::new("whole.csv".to_owned(), time.clone(), &position, effort, Some(force), 1);
        trial.load = Some(wave(2.0));
        trial.restart[1300] = true;
        // The first two share what lies between them.
        let stretches = [400..700, 800..1000, 1200..1500, 3000..3500];
        let cut = trial.of_stretches(&stretches);
        let rows: Vec<usize> = stretches.iter().cloned().flatten().collect();
        assert_eq!(cut.position, rows.iter().map(|row| position[*row]).collect::<Vec<_>>());
        assert_eq!((0..cut.len()).filter(|row| cut.restart[*row]).collect::<Vec<_>>(), [0, 300, 500, 600, 800]);
        assert!(cut.source_time.windows(2).all(|pair| pair[1] > pair[0]) && cut.source_time.len() < 2500);
        let law = DriveLaw { effort_lag_s: 0.01, effort_delay_s: 0.02, ..DriveLaw::nominal(1.0, 0.0, 0.0) };
        let [whole, own] = [&trial, &cut].map(|trial| Inputs::of(trial, &law));
        for (at, row) in rows.iter().enumerate().filter(|(at, _)| !cut.restart[*at]) {
            // Of the lag e^-18 is lost, and a curve through its end has no bend.
            assert!((own.effort[at] - whole.effort[*row]).abs() < 1e-7, "{row}");
            assert!((own.borne(at) - whole.borne(*row)).abs() < 1e-12, "{row}");
        }
        assert!(trial.slice(7..7).is_empty() && trial.of_stretches(&[7..7, 9..9]).is_empty());
        assert_eq!(trial.slice(7..9).source_time, time);
    }
}
