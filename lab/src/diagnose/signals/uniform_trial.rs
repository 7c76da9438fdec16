//! A trial on an even clock, as the analysis takes it in.

use super::dequantize::dequantize;
use super::outliers::interpolate_outliers;
use crate::diagnose::thresholds::uniform_trial::GAP_PERIODS;
use crate::recording::Recording;
use crate::sensors::Figures;

/// A trial on an even clock. All columns are of equal length.
#[derive(Debug, Clone)]
pub struct UniformTrial {
    /// Time of the first row, as recorded.
    pub origin: f64,
    /// Seconds between rows.
    pub period: f64,
    /// Tool position.
    pub position: Vec<f64>,
    /// Force reading.
    pub force: Option<Vec<f64>>,
    /// Commanded effort.
    pub effort: Option<Vec<f64>>,
    /// What the sensors leave.
    pub figures: Figures,
    /// Rows in the recording that are no measurement, as far as one row shows it.
    pub dropouts: Vec<f64>,
    /// Start and length of each gap, s.
    pub gaps: Vec<(f64, f64)>,
}

impl UniformTrial {
    /// Brings `recording` onto a clock of `period` seconds by straight lines between its rows.
    #[must_use]
    pub fn of(recording: &Recording, figures: Figures, period: f64) -> Self {
        let time = &recording.time;
        let origin = time.first().copied().unwrap_or(0.0);
        let length = time.last().copied().unwrap_or(0.0) - origin;
        let rows = (length / period + 0.5).floor() as usize + 1;
        let own = recording.period();
        let gaps = time.windows(2).filter(|pair| pair[1] - pair[0] > GAP_PERIODS * own.max(period));
        let gaps: Vec<_> = gaps.map(|pair| (pair[0] - origin, pair[1] - pair[0])).collect();
        let mut bad = vec![false; time.len()];
        let mut columns = [Some(&recording.position), recording.force.as_ref(), recording.effort.as_ref()]
            .map(|column| column.map(|values| values.to_vec()));
        // An effort is commanded, and a command may leap for one row.
        for column in columns.iter_mut().take(2).flatten() {
            interpolate_outliers(time, column).into_iter().for_each(|row| bad[row] = true);
        }
        if let Some(position) = &mut columns[0] {
            dequantize(|row| time[row], position, figures.position.resolution);
        }
        let dropouts = bad.iter().zip(time).filter(|(bad, _)| **bad).map(|(_, at)| at - origin).collect();
        let [position, force, effort] =
            columns.map(|column| column.map(|values| even(time, &values, origin, period, rows)));
        Self { origin, period, position: position.unwrap_or_default(), force, effort, figures, dropouts, gaps }
    }

    /// Rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }
}

/// `values` at `rows` even instants.
fn even(time: &[f64], values: &[f64], origin: f64, period: f64, rows: usize) -> Vec<f64> {
    let mut next = 1;
    let last = time.len() - 1;
    (0..rows)
        .map(|row| {
            let now = origin + row as f64 * period;
            while next < last && time[next] < now {
                next += 1;
            }
            let part = ((now - time[next - 1]) / (time[next] - time[next - 1])).clamp(0.0, 1.0);
            values[next - 1] + part * (values[next] - values[next - 1])
        })
        .collect()
}
