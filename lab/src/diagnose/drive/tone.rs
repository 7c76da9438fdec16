//! Whether what is missing is a single tone in time: what turns or pumps at a rate of its own, whatever the drive does.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::criteria::FEWEST_PERIODS;

/// Times by which a trial is padded: between two frequencies of the spectrum a tone loses no more than a twentieth of its power.
const PADDED: usize = 4;

/// A tone of one frequency in all trials, with a phase and a size in each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tone {
    /// Mean square that it takes of a force, N^2 or (N m)^2.
    pub power: f64,
    /// Its frequency, periods a row, to the width of a line of the padded spectrum.
    pub frequency: f64,
    /// That width.
    pub width: f64,
}

/// The tone that takes most of `missing`, a column a trial; rows are taken to follow each other evenly. One of no power without rows.
#[must_use]
pub fn loudest_tone(missing: &[Vec<f64>]) -> Tone {
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
    let width = 1.0 / length as f64;
    let powers = taken.iter().map(|taken| taken / rows.max(1) as f64);
    let tones = powers.enumerate().map(|(bin, power)| Tone { power, frequency: bin as f64 * width, width });
    let none = Tone { power: 0.0, frequency: 0.0, width };
    tones.skip(slowest).fold(none, |loudest, tone| if tone.power > loudest.power { tone } else { loudest })
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
            let found = loudest_tone(&[tone(2.0, periods, 0.0, 2000), tone(2.0, periods, 2.0, 1500)]);
            // A twentieth between two frequencies, and what sine and cosine of a part of a period have in common.
            assert!((found.power / 2.0 - 1.0).abs() < 0.07, "{periods}: {found:?}");
            assert!((found.frequency - periods / 2000.0).abs() <= 0.5 * found.width, "{periods}: {found:?}");
        }
    }

    #[test]
    fn a_slow_course_and_what_has_many_frequencies_are_no_tone() {
        assert!(loudest_tone(&[tone(2.0, 2.0, 0.0, 2000)]).power < 0.05);
        // Pulses of a tenth of the time: (2 / pi sin(pi / 10))^2 / 2 of their variance, 0.09, is in the first tone, 0.215.
        let pulses: Vec<f64> = (0..2000).map(|row| if row % 50 < 5 { 1.0 } else { 0.0 }).collect();
        assert!((loudest_tone(&[pulses]).power / (0.09 * 0.215) - 1.0).abs() < 0.05);
        assert_eq!((loudest_tone(&[]).power, loudest_tone(&[Vec::new()]).power), (0.0, 0.0));
    }
}
