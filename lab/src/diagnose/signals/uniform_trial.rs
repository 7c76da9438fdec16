//! A trial on an even clock, as the analysis takes it in.

use super::dequantize::dequantize;
use crate::diagnose::thresholds::uniform_trial::{GAP_PERIODS, GAP_RECOVERY_LENGTHS};
use crate::recording::Recording;
use crate::sensors::Figures;

/// A trial on an even clock. All columns are of equal length.
#[derive(Debug, Clone)]
pub struct UniformTrial {
    /// File name.
    pub name: String,
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
    /// Whether a row is to be trusted; false in a gap, for a while after it, and at a drop-out.
    pub good: Vec<bool>,
    /// What the sensors leave.
    pub figures: Figures,
    /// Frequency in Hz of a tone of the mains that stands out of the force.
    pub hum: Option<f64>,
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
            mend(time, column, &mut bad);
        }
        if let Some(position) = &mut columns[0] {
            dequantize(|row| time[row], position, figures.position.resolution);
        }
        let dropouts = bad.iter().zip(time).filter(|(bad, _)| **bad).map(|(_, at)| at - origin).collect();
        let mut good = vec![true; rows];
        for (start, span) in &gaps {
            let (from, to) =
                ((start / period).ceil() as usize, ((start + GAP_RECOVERY_LENGTHS * span) / period).floor() as usize);
            good[from.min(rows)..(to + 1).clamp(from.min(rows), rows)].fill(false);
        }
        let [position, force, effort] =
            columns.map(|column| column.map(|values| even(time, &values, origin, period, rows)));
        Self {
            name: recording.name.clone(),
            origin,
            period,
            position: position.unwrap_or_default(),
            force,
            effort,
            good,
            figures,
            hum: None,
            dropouts,
            gaps,
        }
    }

    /// Means of `parts` rows each, `parts` odd; an effort, which is held from its row to the next, over the rows that it is
    /// held for then.
    ///
    /// White noise falls with the root of `parts`. So does rounding where noise shakes the reading over its step; a reading
    /// that keeps to its step for many rows is as coarse as it was.
    #[must_use]
    pub fn thinned(&self, parts: usize) -> Self {
        let half = parts / 2;
        let means = |values: &[f64], first: usize| -> Vec<f64> {
            let rows = |at: usize| &values[first + at * parts..(first + (at + 1) * parts).min(values.len())];
            let mean = |rows: &[f64]| rows.iter().sum::<f64>() / rows.len() as f64;
            (0..values.len() / parts).map(|at| mean(rows(at))).collect()
        };
        let shift = half as f64 * self.period;
        Self {
            name: self.name.clone(),
            origin: self.origin + shift,
            period: self.period * parts as f64,
            position: means(&self.position, 0),
            force: self.force.as_ref().map(|force| means(force, 0)),
            effort: self.effort.as_ref().map(|effort| means(effort, half)),
            good: self.good.chunks_exact(parts).map(|rows| rows.iter().all(|good| *good)).collect(),
            figures: self.figures.thinned(parts),
            hum: self.hum,
            dropouts: self.dropouts.iter().map(|at| at - shift).collect(),
            gaps: self.gaps.iter().map(|(start, span)| (start - shift, *span)).collect(),
        }
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

/// Replaces single readings that leap away from both neighbours by more than the whole remaining range of the channel.
fn mend(time: &[f64], values: &mut [f64], bad: &mut [bool]) {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let (low, high) = (sorted[sorted.len() / 100], sorted[sorted.len() - 1 - sorted.len() / 100]);
    let range = high - low;
    for at in 1..values.len().saturating_sub(1) {
        let (before, after) = (values[at - 1], values[at + 1]);
        let leap = (values[at] - before).abs().min((values[at] - after).abs());
        let beyond = (values[at] - high).max(low - values[at]);
        if range > 0.0 && leap > range && beyond > 0.5 * range {
            let part = (time[at] - time[at - 1]) / (time[at + 1] - time[at - 1]);
            values[at] = before + part * (after - before);
            bad[at] = true;
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensors::Channel;

    fn raw(rows: usize, figures: Channel) -> UniformTrial {
        let line = |first: f64| (0..rows).map(|row| first + row as f64).collect::<Vec<f64>>();
        UniformTrial {
            name: "a line".to_owned(),
            origin: 2.0,
            period: 0.5,
            position: line(0.0),
            force: Some(line(100.0)),
            // Held until the next row: what acts at the row is half a row older.
            effort: Some(line(0.5)),
            good: (0..rows).map(|row| row != 17).collect(),
            figures: Figures { position: figures, force: None, effort: None },
            hum: None,
            dropouts: vec![3.0],
            gaps: Vec::new(),
        }
    }

    #[test]
    fn means_of_rows_keep_every_channel_at_the_instant_of_its_row() {
        let thin = raw(50, Channel { resolution: 0.1, noise: 1.0 }).thinned(5);
        assert_eq!((thin.len(), thin.period, thin.origin), (10, 2.5, 3.0));
        for row in 0..10 {
            let middle = 5.0 * row as f64 + 2.0;
            assert_eq!(thin.position[row], middle);
            assert_eq!(thin.force.as_ref().unwrap()[row], 100.0 + middle);
            // The mean over the five rows that it is held for from there, as long as there are five.
            let held = thin.effort.as_ref().unwrap()[row];
            assert!(row == 9 || held == middle + 2.5, "row {row}: {held}");
        }
        assert_eq!(thin.good.iter().position(|good| !good), Some(3));
        assert_eq!(thin.dropouts, [2.0]);
    }

    #[test]
    fn rounding_falls_with_the_root_where_noise_shakes_the_reading_and_stays_where_it_does_not() {
        let shaken = raw(50, Channel { resolution: 0.1, noise: 1.0 }).thinned(25).figures.position;
        assert_eq!((shaken.resolution, shaken.noise), (0.1 / 5.0, 0.2));
        let at_rest = raw(50, Channel { resolution: 1.0, noise: 1.0 / 12f64.sqrt() }).thinned(25).figures.position;
        assert_eq!(at_rest.resolution, 1.0);
        assert!((at_rest.noise - 1.0 / 12f64.sqrt()).abs() < 1e-12, "{}", at_rest.noise);
    }
}
