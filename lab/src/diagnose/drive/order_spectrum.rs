//! A force over the way: at which pitches it repeats, and whether a line of its spectrum stands out of what is around it.

use std::f64::consts::TAU;

use statrs::distribution::{ContinuousCDF as _, FisherSnedecor};

use super::likelihood::Data;
use super::scales::Scales;
use super::trial::DriveTrial;
use crate::diagnose::periodogram::periodogram;

/// Cells of the finest pitch that the way is divided into.
const CELLS_PER_PITCH: f64 = 6.0;
const MOST_CELLS: f64 = 24_000.0;
const MOST_PITCHES: f64 = 8_000.0;

/// Where the surroundings of a line are looked at on either side of it, in the finest steps that the travel tells apart: the nearest is the line's own.
const AROUND: std::ops::RangeInclusive<i32> = 2..=9;

/// Rows before and after one that tell which way it moves.
const ROWS_AROUND: usize = 2;

/// A force, cell by cell of the way.
pub struct OrderSpectrum {
    /// Place of each cell from the lowest, m or rad, and the sum of the force there, less its mean over all rows.
    sums: Vec<(f64, f64)>,
    /// The same of its mean where the drive moves through, less that of its way, forward and then backward: friction is none of it.
    means: Vec<(f64, f64)>,
    /// From the least to the greatest position, m or rad.
    travel: f64,
    /// Finest pitch, m or rad.
    finest: f64,
}

impl OrderSpectrum {
    /// Of `force`, a column a trial.
    #[must_use]
    pub fn of(data: &Data<'_>, scales: &Scales, force: &[Vec<f64>]) -> Self {
        let finest = (4.0 * scales.resolution).max(scales.travel / 4000.0);
        let count = (scales.travel / finest * CELLS_PER_PITCH).clamp(64.0, MOST_CELLS) as usize;
        let width = scales.travel / (count - 1) as f64;
        let [mut all, mut forward, mut backward] = [(); 3].map(|()| Cells::new(count, width));
        for (trial, force) in data.trials.iter().zip(force) {
            for (row, force) in force.iter().enumerate() {
                let place = trial.position[row] - scales.lowest;
                all.add(place, *force);
                let moved = moved(trial, row);
                if moved.abs() > scales.resolution {
                    if moved > 0.0 { &mut forward } else { &mut backward }.add(place, *force);
                }
            }
        }
        let means = [forward.means(), backward.means()].concat();
        Self { sums: all.sums(), means, travel: scales.travel, finest }
    }

    /// The `most` pitches at which it repeats, the strongest first.
    #[must_use]
    pub fn pitches(&self, most: usize) -> Vec<f64> {
        self.peaks(&self.sums, most).into_iter().map(f64::recip).collect()
    }

    /// Wavenumbers of the lines among the `most` strongest peaks of the mean force over the way that are `nats` and more beyond chance.
    #[must_use]
    pub fn lines(&self, most: usize, nats: f64) -> Vec<f64> {
        let waves = self.peaks(&self.means, most).into_iter().map(|order| TAU * order);
        waves.filter(|wavenumber| self.line_nats(*wavenumber).is_some_and(|own| own > nats)).collect()
    }

    /// How unlikely chance makes as strong a line at `wavenumber` of the mean force over the way, beside a spectrum that is level around it, nats, beyond what the number of
    /// pitches that are looked at makes likely: the test of a line against its surroundings (D. J. Thomson, *Proc. IEEE* 70, 1982, 1055). A load over the way acts the same
    /// forward and backward, and each place counts once each way, however long the drive was there. `None` where the travel is too short for surroundings.
    #[must_use]
    pub fn line_nats(&self, wavenumber: f64) -> Option<f64> {
        let step = TAU / self.travel;
        let around: Vec<f64> = AROUND.flat_map(|by| [-by, by]).map(|by| wavenumber + f64::from(by) * step).collect();
        if around.iter().any(|at| *at < step) {
            return None;
        }
        let background = around.iter().map(|at| self.power(*at)).sum::<f64>() / around.len() as f64;
        let ratio = self.power(wavenumber) / background.max(f64::MIN_POSITIVE);
        let chance = FisherSnedecor::new(2.0, 2.0 * around.len() as f64).ok()?.sf(ratio);
        Some(-chance.max(f64::MIN_POSITIVE).ln() - (self.searched().2.max(1) as f64).ln())
    }

    fn power(&self, wavenumber: f64) -> f64 {
        periodogram(&self.means, wavenumber / TAU, 0.0, 1)[0]
    }

    /// First order that is looked at, periods per m or rad, the distance of two, and how many.
    fn searched(&self) -> (f64, f64, usize) {
        let (first, spacing) = (2.0 / self.travel, 0.4 / self.travel);
        (first, spacing, ((1.0 / self.finest - first) / spacing).clamp(0.0, MOST_PITCHES) as usize)
    }

    /// The `most` orders at which `cells` repeat, periods per m or rad, the strongest first.
    fn peaks(&self, cells: &[(f64, f64)], most: usize) -> Vec<f64> {
        let (first, spacing, count) = self.searched();
        let power = periodogram(cells, first, spacing, count);
        let is_peak = |at: &usize| power[*at] >= power[at - 1] && power[*at] > power[at + 1];
        let mut peaks: Vec<usize> = (1..count.saturating_sub(1)).filter(is_peak).collect();
        peaks.sort_by(|a, b| power[*b].total_cmp(&power[*a]));
        peaks.truncate(most);
        peaks.into_iter().map(|at| first + at as f64 * spacing).collect()
    }
}

/// How far the drive moves around `row`, m or rad.
fn moved(trial: &DriveTrial, row: usize) -> f64 {
    let last = trial.position.len() - 1;
    trial.position[(row + ROWS_AROUND).min(last)] - trial.position[row.saturating_sub(ROWS_AROUND)]
}

/// Sum and rows of each cell of the way.
struct Cells {
    width: f64,
    cells: Vec<(f64, f64)>,
}

impl Cells {
    fn new(count: usize, width: f64) -> Self {
        Self { width, cells: vec![(0.0, 0.0); count] }
    }

    fn add(&mut self, place: f64, force: f64) {
        let at = ((place / self.width) as usize).min(self.cells.len() - 1);
        self.cells[at].0 += force;
        self.cells[at].1 += 1.0;
    }

    /// Place, sum and rows of each that holds any.
    fn visited(&self) -> impl Iterator<Item = (f64, f64, f64)> {
        let each = self.cells.iter().enumerate().filter(|(_, (_, rows))| *rows > 0.0);
        each.map(|(cell, (sum, rows))| (cell as f64 * self.width, *sum, *rows))
    }

    fn sums(&self) -> Vec<(f64, f64)> {
        let [sum, rows] = self.visited().fold([0.0, 0.0], |all, (_, sum, rows)| [all[0] + sum, all[1] + rows]);
        let mean = sum / f64::max(rows, 1.0);
        self.visited().map(|(place, sum, rows)| (place, sum - mean * rows)).collect()
    }

    fn means(&self) -> Vec<(f64, f64)> {
        let each: Vec<(f64, f64)> = self.visited().map(|(place, sum, rows)| (place, sum / rows)).collect();
        let mean = each.iter().map(|(_, force)| force).sum::<f64>() / each.len().max(1) as f64;
        each.into_iter().map(|(place, force)| (place, force - mean)).collect()
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha12Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::super::criteria::LEAST_GAIN;
    use super::super::testing::{SCALES, TestDrive};
    use super::*;

    const PITCH: f64 = 3e-3;

    /// Nats of a line of [`PITCH`] in `force`, of place, direction and noise (deviation 1), along ten seconds of a drive that moves both ways.
    fn nats(force: impl Fn(f64, f64, f64) -> f64) -> Option<f64> {
        let trials = [TestDrive::PLAIN.trial(10.0, 3)];
        let mut rng = ChaCha12Rng::seed_from_u64(5);
        let mut noise = || Distribution::<f64>::sample(&StandardNormal, &mut rng);
        let [least, most] = trials[0]
            .position
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |ends, x| [ends[0].min(*x), ends[1].max(*x)]);
        let scales = Scales { lowest: least, travel: most - least, ..SCALES };
        let rows = 0..trials[0].position.len();
        let force = rows.map(|row| force(trials[0].position[row], moved(&trials[0], row).signum(), noise())).collect();
        let data = Data { trials: &trials, ..super::super::testing::search_over(&trials, &TestDrive::PLAIN).data };
        OrderSpectrum::of(&data, &scales, &[force]).line_nats(TAU / PITCH)
    }

    fn wave(place: f64) -> f64 {
        (TAU * place / PITCH).sin()
    }

    /// A wave of a fifth of the noise over 10 000 rows takes 200 of a mean of one.
    #[test]
    fn a_wave_along_the_way_stands_out_of_noise_and_noise_does_not() {
        let least = LEAST_GAIN.value();
        assert!(nats(|x, _, noise| noise + 0.2 * wave(x)).unwrap() > least);
        assert!(nats(|_, _, noise| noise).unwrap() < 0.0);
        // Friction is as large everywhere, however much larger than the wave.
        assert!(nats(|x, way, noise| noise + 5.0 * way + 0.3 * wave(x)).unwrap() > least);
    }

    #[test]
    fn what_acts_the_other_way_round_on_the_way_back_is_no_load_along_the_way() {
        assert!(nats(|x, way, noise| noise + 0.3 * way * wave(x)).unwrap() < LEAST_GAIN.value());
    }

    /// A load that wanders along the way has power at every order near it, and none stands out.
    #[test]
    fn a_wavy_load_has_no_line() {
        let wavy = |x: f64| {
            (0..40).map(|at| (TAU * x * (250.0 + 4.3 * f64::from(at)) + f64::from(at * at)).sin()).sum::<f64>()
        };
        assert!(nats(|x, _, noise| noise + wavy(x)).unwrap() < LEAST_GAIN.value());
    }

    #[test]
    fn a_travel_of_few_periods_shows_no_surroundings() {
        let trials = [TestDrive::PLAIN.trial(2.0, 3)];
        let data = Data { trials: &trials, ..super::super::testing::search_over(&trials, &TestDrive::PLAIN).data };
        let force = [vec![0.0; trials[0].position.len()]];
        let spectrum = OrderSpectrum::of(&data, &SCALES, &force);
        let order = |periods: f64| spectrum.line_nats(periods * TAU / SCALES.travel);
        assert!(order(9.5).is_none() && order(10.5).is_some());
    }
}
