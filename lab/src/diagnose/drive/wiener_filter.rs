//! What recorded effort and contact force most probably were without their sensors' noise: a Wiener filter over both, from their own spectra.
//!
//! A law that is driven by a noisy input finds it less effective than it is, an inertia too large ("attenuation"). Driven by the expectation of the
//! input given the record it does not: what that lacks is not correlated with what it has (regression calibration: R. J. Carroll, D. Ruppert,
//! L. A. Stefanski, C. M. Crainiceanu, *Measurement Error in Nonlinear Models*, 2nd ed., 2006, ch. 4).

use std::sync::Arc;

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

use super::criteria::{LEAST_SPECTRUM_WIDTH, SPECTRUM_WIDTH};
use super::noise::robust_white_variance;

/// Fewest rows of a spectrum.
const FEWEST_ROWS: usize = 64;

/// Least variance of a noise as a part of its signal's mean square: below it a record is exact.
const EXACT: f64 = 1e-12;

/// Effort and contact force of a trial, of the same rows.
pub type Signals = [Vec<f64>; 2];

/// A filter for one trial's effort and force together.
#[derive(Debug, Clone)]
pub struct WienerFilter {
    /// Variance of the white noise in effort and force, N^2 or (N m)^2; zero for what was taken as exact.
    pub noise: [f64; 2],
    gains: Vec<[[Complex<f64>; 2]; 2]>,
}

impl WienerFilter {
    /// That of `signals` that hold noise of `levels` times the density of what changes from row to row: once for white noise, more for noise that
    /// remembers, and zero for what is exact. `None` where they are too short for a spectrum.
    #[must_use]
    pub fn of(signals: &Signals, levels: [f64; 2]) -> Option<Self> {
        if signals[0].len() < FEWEST_ROWS {
            return None;
        }
        let noise = [0, 1].map(|of| levels[of] * robust_white_variance(&signals[of]));
        let floor = |of: usize| {
            let squares = signals[of].iter().map(|x| x * x).sum::<f64>() / signals[of].len() as f64;
            noise[of].max(EXACT * squares).max(f64::MIN_POSITIVE)
        };
        let deviations = [floor(0), floor(1)].map(f64::sqrt);
        let transformed = Transform::of_rows(signals[0].len()).forward(signals);
        let count = transformed.spectra[0].len() as f64;
        let cross = |a: usize, b: usize| {
            let pairs = transformed.spectra[a].iter().zip(&transformed.spectra[b]);
            averaged(&pairs.map(|(a, b)| a * b.conj()).collect::<Vec<_>>())
                .into_iter()
                .map(move |density| density / (count * deviations[a] * deviations[b]))
        };
        let spectra = cross(0, 0).zip(cross(1, 1)).zip(cross(0, 1));
        let gains = spectra.map(|((effort, force), both)| unwhitened(shrunk(effort.re, force.re, both), deviations));
        Some(Self { noise, gains: gains.collect() })
    }

    /// Variance that it leaves of the effort's noise, N^2 or (N m)^2.
    #[must_use]
    pub fn effort_noise_left(&self) -> f64 {
        let power = self.gains.iter().map(|gain| gain[0][0].norm_sqr()).sum::<f64>();
        self.noise[0] * power / self.gains.len() as f64
    }

    /// What it leaves of `signals`, which have as many rows as those that it was made of.
    #[must_use]
    pub fn passed(&self, signals: &Signals) -> Signals {
        let mut transformed = Transform::of_rows(signals[0].len()).forward(signals);
        let [effort, force] = &mut transformed.spectra;
        let count = effort.len();
        for at in 0..count {
            // Real signals: the spectrum's second half is the conjugate of the first.
            let gain = if at < self.gains.len() {
                self.gains[at]
            } else {
                self.gains[count - at].map(|row| row.map(|gain| gain.conj()))
            };
            let before = [effort[at], force[at]];
            effort[at] = gain[0][0] * before[0] + gain[0][1] * before[1];
            force[at] = gain[1][0] * before[0] + gain[1][1] * before[1];
        }
        transformed.back()
    }
}

/// Mean of `periodogram` about each frequency of its first half, over more of them the higher it is.
fn averaged(periodogram: &[Complex<f64>]) -> Vec<Complex<f64>> {
    let half = periodogram.len() / 2 + 1;
    let mut sums = vec![Complex::<f64>::default(); half + 1];
    for at in 0..half {
        sums[at + 1] = sums[at] + periodogram[at];
    }
    (0..half)
        .map(|at| {
            let width = LEAST_SPECTRUM_WIDTH.value().max((SPECTRUM_WIDTH * at as f64).value()) as usize;
            let (first, end) = (at.saturating_sub(width), (at + width + 1).min(half));
            (sums[end] - sums[first]) / (end - first) as f64
        })
        .collect()
}

/// Gain of what is left of two signals of unit noise with densities `a` and `b` and the cross density `c`: along each principal axis of them
/// the part 1 - 1 / density that is no noise, none where there is less than the noise.
fn shrunk(a: f64, b: f64, c: Complex<f64>) -> [[Complex<f64>; 2]; 2] {
    let apart = (0.25 * (a - b).powi(2) + c.norm_sqr()).sqrt();
    let large = 0.5 * (a + b) + apart;
    let small = large - 2.0 * apart;
    let kept = |density: f64| if density > 1.0 { 1.0 - 1.0 / density } else { 0.0 };
    let (more, less) = (kept(large), kept(small));
    // The projection on the larger axis is (matrix - small) / (large - small).
    let slope = if apart > 0.0 { (more - less) / (2.0 * apart) } else { 0.0 };
    let diagonal = |density: f64| Complex::from(less + slope * (density - small));
    [[diagonal(a), slope * c], [slope * c.conj(), diagonal(b)]]
}

/// The same for signals of which each is `deviations` times that of unit noise.
fn unwhitened(gain: [[Complex<f64>; 2]; 2], deviations: [f64; 2]) -> [[Complex<f64>; 2]; 2] {
    let ratio = deviations[0] / deviations[1];
    [[gain[0][0], gain[0][1] * ratio], [gain[1][0] / ratio, gain[1][1]]]
}

/// Spectra of two signals, each less the line between its ends and mirrored about them, so that it goes on without a step.
struct Transform {
    rows: usize,
    forward: Arc<dyn Fft<f64>>,
    back: Arc<dyn Fft<f64>>,
}

struct Transformed {
    transform: Transform,
    ends: [[f64; 2]; 2],
    spectra: [Vec<Complex<f64>>; 2],
}

impl Transform {
    fn of_rows(rows: usize) -> Self {
        let length = 2 * (rows - 1);
        let mut planner = FftPlanner::new();
        Self { rows, forward: planner.plan_fft_forward(length), back: planner.plan_fft_inverse(length) }
    }

    fn forward(self, signals: &Signals) -> Transformed {
        let last = self.rows - 1;
        let ends = signals.each_ref().map(|signal| [signal[0], signal[last]]);
        let spectra = [0, 1].map(|of| {
            let mut mirrored = vec![Complex::default(); 2 * last];
            for row in 1..last {
                let beside = signals[of][row] - line(ends[of], row, last);
                mirrored[row].re = beside;
                mirrored[2 * last - row].re = -beside;
            }
            self.forward.process(&mut mirrored);
            mirrored
        });
        Transformed { transform: self, ends, spectra }
    }
}

impl Transformed {
    fn back(mut self) -> Signals {
        let last = self.transform.rows - 1;
        for spectrum in &mut self.spectra {
            self.transform.back.process(spectrum);
        }
        [0, 1].map(|of| {
            let beside = |row: usize| self.spectra[of].get(row).map_or(0.0, |bin| bin.re) / (2 * last) as f64;
            (0..=last).map(|row| line(self.ends[of], row, last) + if row < last { beside(row) } else { 0.0 }).collect()
        })
    }
}

/// The straight line from one of `ends` to the other, at `row` of `last`.
fn line(ends: [f64; 2], row: usize, last: usize) -> f64 {
    let part = row as f64 / last as f64;
    ends[0] + part * (ends[1] - ends[0])
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha12Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    const ROWS: usize = 8000;

    fn noise(size: f64, seed: u64) -> Vec<f64> {
        let mut rng = ChaCha12Rng::seed_from_u64(seed);
        (0..ROWS).map(|_| size * Distribution::<f64>::sample(&StandardNormal, &mut rng)).collect()
    }

    /// Two sines, of 3 and of 40 periods, on a slope.
    fn slow(row: usize) -> f64 {
        let turn = std::f64::consts::TAU * row as f64 / ROWS as f64;
        (3.0 * turn).sin() + 0.3 * (40.0 * turn).cos() + turn
    }

    fn rms(values: impl Iterator<Item = f64>) -> f64 {
        (values.map(|x| x * x).sum::<f64>() / ROWS as f64).sqrt()
    }

    #[test]
    fn exact_signals_pass_unchanged() {
        let exact = [(0..ROWS).map(slow).collect::<Vec<_>>(), vec![0.0; ROWS]];
        for (signals, levels) in [(exact.clone(), [8.0, 8.0]), ([noise(1.0, 1), noise(0.1, 2)], [0.0, 0.0])] {
            let passed = WienerFilter::of(&signals, levels).expect("rows enough").passed(&signals);
            for (passed, signal) in passed.iter().zip(&signals) {
                // The least noise that is believed is a millionth of the signal in root mean square, and no more is taken out.
                let (lost, all) = (rms(passed.iter().zip(signal).map(|(a, b)| a - b)), rms(signal.iter().copied()));
                assert!(lost <= 2e-6 * all, "{levels:?}: {lost} of {all}");
            }
        }
    }

    /// The sines take 80 of 8000 frequencies, and 33 to each side pass some: of the noise's power a fiftieth is left, and the smoothing of a
    /// spectrum that has noise alone lets some through, a quarter in root mean square of no signal: a twentieth of the power.
    #[test]
    fn white_noise_on_a_slow_signal_goes_and_the_signal_stays() {
        let white = noise(0.2, 3);
        let signals = [white.iter().enumerate().map(|(row, noise)| slow(row) + noise).collect(), vec![0.0; ROWS]];
        let filter = WienerFilter::of(&signals, [1.0, 0.0]).expect("rows enough");
        let [effort, force] = filter.passed(&signals);
        let left = rms(effort.iter().enumerate().map(|(row, effort)| effort - slow(row)));
        assert!(left < 0.25 * 0.2, "{left}");
        assert!(force.iter().all(|force| *force == 0.0));
        assert!(
            (filter.noise[0].sqrt() / 0.2 - 1.0).abs() < 0.05 && filter.effort_noise_left() < 0.07 * filter.noise[0]
        );
    }

    /// An effort that is known exactly tells what a noisy force has in common with it, at frequencies at which the noise is louder.
    #[test]
    fn a_noisy_force_is_told_by_an_exact_effort() {
        let effort = noise(1.0, 4);
        let force: Vec<f64> = effort.iter().zip(noise(2.0, 5)).map(|(effort, noise)| 0.5 * effort + noise).collect();
        let signals = [effort.clone(), force];
        let levels = [0.0, 1.0];
        // All that changes from row to row of the force counts as noise, 0.25 of signal beside 4: by itself nothing of it passes, and 0.5 is left. What the
        // effort tells of it is known to 4 over half of the frequencies that are averaged, from 16 to 400: 0.2 in root mean square.
        let [_, passed] = WienerFilter::of(&signals, levels).expect("rows enough").passed(&signals);
        let left = rms(passed.iter().zip(&effort).map(|(force, effort)| force - 0.5 * effort));
        assert!(left < 0.35, "{left}");
    }

    #[test]
    fn too_few_rows_have_no_spectrum() {
        assert!(WienerFilter::of(&[vec![1.0; 63], vec![0.0; 63]], [1.0, 1.0]).is_none());
        assert!(WienerFilter::of(&[vec![1.0; 64], vec![0.0; 64]], [1.0, 1.0]).is_some());
    }
}
