//! Where the residual of a channel lies: in time, phase, position, speed and frequency.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::diagnosis::{BinnedResidual, Location};
use crate::diagnose::phase::{self, Phase};
use crate::page::quantity;
use crate::rig::Coordinate;

/// Places that are reported, and the least share of the channel's energy that is one.
const MOST_PLACES: usize = 4;
const MIN_LOCATION_SHARE: f64 = 0.02;

/// Bins along a quantity.
const BINS: usize = 8;

/// Part of what the answer gains in a trial that the stretch which shows it holds, and the blocks that it is made of.
const STRETCH_SHARE: f64 = 0.6;
const STRETCH_BLOCKS: usize = 200;

/// A row of a channel: its state, and the power of the residual in it.
pub(super) struct ResidualRow {
    /// Number of the trial.
    pub(super) trial: usize,
    /// Seconds since the first row of the trial.
    pub(super) time_s: f64,
    /// Depth below the fitted surface, or position of a drive; m or rad.
    pub(super) position: f64,
    /// m/s or rad/s.
    pub(super) velocity: f64,
    /// Phase of contact.
    pub(super) phase: Phase,
    /// Square of the residual without the named effects, and with them.
    pub(super) before: f64,
    /// See `before`.
    pub(super) after: f64,
    /// Expected square by the sensors alone.
    pub(super) noise: f64,
    /// What the answer takes of `before`.
    pub(super) gained: f64,
}

impl ResidualRow {
    fn above(&self) -> f64 {
        self.before - self.noise
    }
}

/// The residual of a channel over all of its trials.
pub(super) struct ChannelResidual<'a> {
    /// "force" or "effort".
    pub(super) channel: &'static str,
    /// Linear or rotary.
    pub(super) coordinate: Coordinate,
    /// "depth" or "position".
    pub(super) position_name: &'static str,
    /// File names.
    pub(super) trials: Vec<&'a str>,
    /// Rows that count, trial by trial.
    pub(super) rows: Vec<ResidualRow>,
    /// The residual itself without the named effects, and with them, a column a trial.
    pub(super) columns: [&'a [Vec<f64>]; 2],
    /// Time between rows, s.
    pub(super) step_s: f64,
    /// Up to which frequency the channel is analysed, Hz.
    pub(super) highest_hz: f64,
    /// Root mean square that the sensors leave, spread evenly over frequencies up to `noise_to_hz`.
    pub(super) expected_noise: f64,
    /// See `expected_noise`.
    pub(super) noise_to_hz: f64,
    /// Longest stretch that is one place, s.
    pub(super) longest_s: f64,
}

/// Both ends, and one number where nobody would tell them apart: at a hold the tool does not move.
fn span(low: f64, high: f64, unit: &str) -> String {
    let is_one = high - low < 1e-3 * low.abs().max(high.abs());
    if is_one { quantity::plain(0.5 * (low + high), unit) } else { quantity::between(low, high, unit) }
}

impl ChannelResidual<'_> {
    /// The stretches that hold most of the mismatch: share and states are those of the very rows that are named.
    pub(super) fn locations(&self) -> Vec<Location> {
        let stretch = |row: &ResidualRow| (row.trial, row.phase, (row.time_s / self.longest_s) as usize);
        let passes: Vec<&[ResidualRow]> = self.rows.chunk_by(|a, b| stretch(a) == stretch(b)).collect();
        let above = |rows: &[ResidualRow]| rows.iter().map(ResidualRow::above).sum::<f64>().max(0.0);
        let total: f64 = passes.iter().map(|rows| above(rows)).sum();
        if total <= 0.0 {
            return Vec::new();
        }
        let mut places: Vec<(f64, &[ResidualRow])> = passes
            .into_iter()
            .map(|rows| (above(rows) / total, rows))
            .filter(|(share, _)| *share >= MIN_LOCATION_SHARE)
            .collect();
        places.sort_by(|a, b| b.0.total_cmp(&a.0));
        places.truncate(MOST_PLACES);
        places.into_iter().filter_map(|(share, rows)| self.place(share, rows)).collect()
    }

    fn place(&self, share: f64, rows: &[ResidualRow]) -> Option<Location> {
        let (first, last) = (rows.first()?, rows.last()?);
        let (low, high) = range(rows.iter().map(|row| row.position));
        let (slow, fast) = range(rows.iter().map(|row| row.velocity.abs()));
        let (metre, speed) = (self.coordinate.position_unit(), self.coordinate.velocity_unit());
        Some(Location {
            channel: self.channel,
            trial: (*self.trials.get(first.trial)?).to_owned(),
            start_s: first.time_s,
            end_s: last.time_s,
            phase: first.phase,
            share,
            states: format!("x {}, |v| {}", span(low, high, metre), span(slow, fast, speed)),
        })
    }

    /// The trial that gains most by the answer, and the shortest stretch of it, in seconds, that holds most of that; `None` where
    /// nothing is gained.
    pub(super) fn shortest_stretch(&self) -> Option<(usize, [f64; 2])> {
        let trials: Vec<&[ResidualRow]> = self.rows.chunk_by(|a, b| a.trial == b.trial).collect();
        let blocks = |rows: &[ResidualRow]| -> Vec<(f64, [f64; 2])> {
            let size = rows.len().div_ceil(STRETCH_BLOCKS).max(1);
            let each = rows.chunks(size).map(|block| {
                let gained: f64 = block.iter().map(|row| row.gained).sum();
                (gained.max(0.0), [block[0].time_s, block[block.len() - 1].time_s])
            });
            each.collect()
        };
        let sum = |blocks: &[(f64, [f64; 2])]| blocks.iter().map(|block| block.0).sum::<f64>();
        let all = trials.into_iter().map(|rows| (rows[0].trial, blocks(rows)));
        let (trial, blocks) = all.max_by(|a, b| sum(&a.1).total_cmp(&sum(&b.1)))?;
        let wanted = STRETCH_SHARE * sum(&blocks);
        let (mut first, mut held, mut shortest) = (0, 0.0, None::<[usize; 2]>);
        for last in 0..blocks.len() {
            held += blocks[last].0;
            while held - blocks[first].0 >= wanted && first < last {
                held -= blocks[first].0;
                first += 1;
            }
            if held >= wanted && shortest.is_none_or(|[from, to]| last - first < to - from) {
                shortest = Some([first, last]);
            }
        }
        let [first, last] = shortest.filter(|_| wanted > 0.0)?;
        Some((trial, [blocks[first].1[0], blocks[last].1[1]]))
    }

    /// The maps of the page.
    pub(super) fn maps(&self) -> Vec<BinnedResidual> {
        let mut maps = vec![
            self.by_phase(),
            self.along(self.position_name, self.coordinate.position_unit(), |row| row.position),
            self.along("speed", self.coordinate.velocity_unit(), |row| row.velocity.abs()),
            self.along("time", "s", |row| row.time_s),
            self.by_frequency(),
        ];
        maps.retain(|map| map.labels.len() > 1);
        maps
    }

    fn by_phase(&self) -> BinnedResidual {
        let here: Vec<Phase> =
            phase::ALL.into_iter().filter(|phase| self.rows.iter().any(|row| row.phase == *phase)).collect();
        let labels = here.iter().map(|phase| phase::word(*phase).to_owned()).collect();
        self.summed("phase", String::new(), labels, |row| here.iter().position(|phase| *phase == row.phase))
    }

    fn along(&self, name: &'static str, unit: &str, value: impl Fn(&ResidualRow) -> f64) -> BinnedResidual {
        let (low, high) = range(self.rows.iter().map(&value));
        let width = (high - low) / BINS as f64;
        let bins = if width > 0.0 { BINS } else { 0 };
        let (factor, unit) = quantity::prefixed_unit(low.abs().max(high.abs()), unit);
        let labels = (0..bins).map(|bin| quantity::short((low + (bin as f64 + 0.5) * width) / factor)).collect();
        self.summed(name, unit, labels, |row| (bins > 0).then(|| (((value(row) - low) / width) as usize).min(BINS - 1)))
    }

    fn summed(
        &self,
        along: &'static str,
        unit: String,
        labels: Vec<String>,
        bin: impl Fn(&ResidualRow) -> Option<usize>,
    ) -> BinnedResidual {
        let mut sums = vec![[0.0; 3]; labels.len()];
        for row in &self.rows {
            if let Some(sum) = bin(row).and_then(|bin| sums.get_mut(bin)) {
                *sum = [sum[0] + row.before, sum[1] + row.after, sum[2] + row.noise];
            }
        }
        self.binned(along, unit, labels, &sums)
    }

    /// Power of the residual in bands, over that of the expected noise.
    fn by_frequency(&self) -> BinnedResidual {
        let longest = self.columns[0].iter().map(Vec::len).max().unwrap_or(0);
        let highest = self.highest_hz.min(0.45 / self.step_s);
        let lowest = (4.0 / (longest as f64 * self.step_s)).clamp(highest / 1000.0, highest / 2.0);
        let edges = crate::effects::geometric(lowest, highest, BINS + 1);
        let [before, after] = self.columns.map(|columns| spectrum(columns, self.step_s, &edges));
        let rows: usize = self.columns[0].iter().map(Vec::len).sum();
        let density = self.expected_noise.powi(2) * rows as f64 / (2.0 * self.noise_to_hz);
        let bands = edges.windows(2).zip(before.iter().zip(&after));
        let sums: Vec<[f64; 3]> =
            bands.map(|(band, (before, after))| [*before, *after, density * (band[1] - band[0])]).collect();
        let labels = edges.windows(2).map(|band| quantity::short((band[0] * band[1]).sqrt())).collect();
        self.binned("frequency", "Hz".to_owned(), labels, &sums)
    }

    /// `sums` holds, bin by bin, the powers before and after and that of the noise.
    fn binned(&self, along: &'static str, unit: String, labels: Vec<String>, sums: &[[f64; 3]]) -> BinnedResidual {
        let over_noise = |of: usize| sums.iter().map(|sum| sum[of] / sum[2].max(f64::MIN_POSITIVE)).collect();
        let above: Vec<f64> = sums.iter().map(|sum| (sum[0] - sum[2]).max(0.0)).collect();
        let total = above.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        BinnedResidual {
            channel: self.channel,
            along,
            unit,
            labels,
            before: over_noise(0),
            after: over_noise(1),
            share: above.iter().map(|above| above / total).collect(),
        }
    }
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

/// Power of `columns` between `edges`, Hz: the squares that add up to those of the rows, of one side of the spectrum.
fn spectrum(columns: &[Vec<f64>], step: f64, edges: &[f64]) -> Vec<f64> {
    let mut power = vec![0.0; edges.len().saturating_sub(1)];
    for column in columns {
        let mut wave: Vec<Complex<f64>> = column.iter().map(|force| Complex::new(*force, 0.0)).collect();
        let rows = wave.len();
        FftPlanner::new().plan_fft_forward(rows).process(&mut wave);
        for (line, value) in wave.iter().enumerate().take(rows / 2).skip(1) {
            let frequency = line as f64 / (rows as f64 * step);
            let band = edges.partition_point(|edge| *edge <= frequency);
            if let Some(sum) = band.checked_sub(1).and_then(|band| power.get_mut(band)) {
                *sum += value.norm_sqr() / rows as f64;
            }
        }
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten rows of noise, ten with a residual of 2, ten that leave less than noise, ten with a residual of 3.
    fn residual(columns: [&[Vec<f64>]; 2]) -> ChannelResidual<'_> {
        let of_phase = |(nth, before): (usize, f64)| {
            (0..10).map(move |row| ResidualRow {
                trial: 0,
                time_s: 0.1 * (10 * nth + row) as f64,
                position: (10 * nth + row) as f64,
                velocity: 1.0,
                phase: phase::ALL[nth],
                before,
                after: 1.0,
                noise: 1.0,
                gained: before - 1.0,
            })
        };
        ChannelResidual {
            channel: "force",
            coordinate: Coordinate::Linear,
            position_name: "depth",
            trials: vec!["a.csv"],
            rows: [1.0, 4.0, 0.1, 9.0].into_iter().enumerate().flat_map(of_phase).collect(),
            columns,
            step_s: 0.1,
            highest_hz: 4.5,
            expected_noise: 1.0,
            noise_to_hz: 5.0,
            longest_s: f64::INFINITY,
        }
    }

    #[test]
    fn shares_of_places_and_bins_add_up_to_one_and_belong_to_their_rows() {
        let columns = [vec![vec![1.0; 40]], vec![vec![1.0; 40]]];
        let residual = residual([&columns[0], &columns[1]]);
        let places = residual.locations();
        let told: Vec<(Phase, f64)> = places.iter().map(|place| (place.phase, place.share)).collect();
        // 80 and 30 above the noise; the stretch below it is no place and takes nothing from the others.
        assert_eq!(told, [(phase::ALL[3], 80.0 / 110.0), (phase::ALL[1], 30.0 / 110.0)]);
        assert!((places[0].start_s - 3.0).abs() < 1e-12 && (places[0].end_s - 3.9).abs() < 1e-12);
        assert!(places[0].states.starts_with("x 30.0"), "{}", places[0].states);
        for map in residual.maps() {
            let sum: f64 = map.share.iter().sum();
            assert!(sum < 1.0 + 1e-12, "{}: {sum}", map.along);
        }
        assert_eq!(residual.maps()[0].share, [0.0, 30.0 / 110.0, 0.0, 80.0 / 110.0]);
    }

    #[test]
    fn the_stretch_that_is_shown_holds_most_and_nothing_beside() {
        let columns = [vec![vec![1.0; 40]], vec![vec![1.0; 40]]];
        // 80 of 110 are gained in the last ten rows, 8 a row: nine of them hold three fifths.
        let (trial, [start, end]) =
            residual([&columns[0], &columns[1]]).shortest_stretch().expect("something is gained");
        assert_eq!(trial, 0);
        assert!((3.0..3.15).contains(&start) && (3.75..3.95).contains(&end), "{start} {end}");
        let mut still = residual([&columns[0], &columns[1]]);
        still.rows.iter_mut().for_each(|row| row.gained = -1.0);
        assert!(still.shortest_stretch().is_none());
    }

    #[test]
    fn a_tone_lies_in_its_band_and_white_noise_in_all() {
        let tone: Vec<f64> = (0..400).map(|row| 4.0 * (std::f64::consts::TAU * 0.1 * f64::from(row)).sin()).collect();
        let columns = [vec![tone], vec![vec![0.0; 400]]];
        let map = residual([&columns[0], &columns[1]]).by_frequency();
        // A tone of 1 Hz, sampled at 10 Hz, and bands that grow by a factor.
        let most = map.share.iter().position(|share| *share > 0.99);
        let label: f64 = map.labels[most.expect("one band holds it")].parse().expect("a number");
        assert!((0.7..1.4).contains(&label), "{label}");
    }
}
