//! Whether what is missing is a single tone in time: what turns or pumps at a rate of its own, whatever the drive does.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::criteria::FEWEST_PERIODS;

/// Times by which a trial is padded: between two frequencies of the spectrum a tone loses no more than a twentieth of its power.
const PADDED: usize = 4;

/// Mean square that the loudest tone takes of `missing`, a column a trial, N^2 or (N m)^2. The frequency is that of all trials, a phase and a size belong to each;
/// rows are taken to follow each other evenly. Zero without rows.
#[must_use]
pub fn loudest_tone(missing: &[Vec<f64>]) -> f64 {
    let rows: usize = missing.iter().map(Vec::len).sum();
    let longest = missing.iter().map(Vec::len).max().unwrap_or(0);
    let length = PADDED * longest.next_power_of_two();
    let transform = FftPlanner::new().plan_fft_forward(length);
    let mut taken = vec![0.0; length / 2];
    for trial in missing.iter().filter(|trial| !trial.is_empty()) {
        let mean = trial.iter().sum::<f64>() / trial.len() as f64;
        let mut spectrum = vec![Complex::default(); length];
        spectrum.iter_mut().zip(trial).for_each(|(bin, force)| bin.re = force - mean);
        transform.process(&mut spectrum);
        // Least squares of sine and cosine over many periods: twice the squared sum over the rows.
        taken.iter_mut().zip(&spectrum).for_each(|(taken, bin)| *taken += 2.0 * bin.norm_sqr() / trial.len() as f64);
    }
    let slowest = (FEWEST_PERIODS * length as f64 / longest.max(1) as f64).value() as usize;
    taken.iter().skip(slowest).copied().fold(0.0, f64::max) / rows.max(1) as f64
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn tone(size: f64, periods: f64, phase: f64, rows: usize) -> Vec<f64> {
        (0..rows).map(|row| 0.3 + size * (TAU * periods * row as f64 / 2000.0 + phase).sin()).collect()
    }

    #[test]
    fn a_tone_has_half_its_squared_size_whatever_its_phase_in_a_trial() {
        for periods in [37.0, 37.1, 413.37] {
            let taken = loudest_tone(&[tone(2.0, periods, 0.0, 2000), tone(2.0, periods, 2.0, 1500)]);
            // A twentieth between two frequencies, and what sine and cosine of a part of a period have in common.
            assert!((taken / 2.0 - 1.0).abs() < 0.07, "{periods}: {taken}");
        }
    }

    #[test]
    fn a_slow_course_and_what_has_many_frequencies_are_no_tone() {
        assert!(loudest_tone(&[tone(2.0, 2.0, 0.0, 2000)]) < 0.05);
        // Pulses of a tenth of the time: (2 / pi sin(pi / 10))^2 / 2 of their variance, 0.09, is in the first tone, 0.215.
        let pulses: Vec<f64> = (0..2000).map(|row| if row % 50 < 5 { 1.0 } else { 0.0 }).collect();
        assert!((loudest_tone(&[pulses]) / (0.09 * 0.215) - 1.0).abs() < 0.05);
        assert_eq!((loudest_tone(&[]), loudest_tone(&[Vec::new()])), (0.0, 0.0));
    }
}
