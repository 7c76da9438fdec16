//! Names in whose place a tone in time does far better: what pumps or turns beside the drive at a rate of its own.
//!
//! A loop that holds against such a tone moves by it, and its answer looks like a law of the motion: an effort that comes late, a link that swings.
//! The tone is taken off, its frequency being that of all trials and its size and phase each trial's own, and the law without the name is
//! fitted to the rest; likelihoods are compared at a price for each value (G. Schwarz, *Ann. Statist.* 6, 1978).

use std::f64::consts::TAU;

use super::candidates::pays_for;
use super::criteria::LEAST_SHARE;
use super::fit::Fit;
use super::held_out::rms;
use super::likelihood::Data;
use super::selection::Search;
use super::tone::{Tone, loudest_tone};
use super::trial::DriveTrial;
use crate::diagnose::linalg::solve;
use crate::golden_section::least_between;

/// Rounds of tone and law: what a wrong law makes of the tone, and the smoothed disturbance leaves of it, goes in the next.
const ROUNDS: usize = 3;

/// The tone and its octave.
const HARMONICS: usize = 2;

/// Part of a line of the padded spectrum to which the frequency is sought: over the longest trial a phase is off by an eightieth of a turn at the most.
const PRECISION: f64 = 0.05;

impl Search<'_> {
    /// Whether a tone does far better in the place of term `at` of `fit`, and that term is not worth having beside it.
    #[must_use]
    pub fn is_rivalled_by_a_tone(&self, fit: &Fit, at: usize) -> bool {
        let (model, values) = fit.model.without(at, &fit.values);
        let less = self.lessened(fit, model, values);
        let missing = self.disturbance(&less);
        let tone = loudest_tone(&missing);
        if tone.power < LEAST_SHARE * rms(&missing).powi(2) {
            return false;
        }
        let frequency = frequency_of(tone, &missing);
        let (mut rival, mut trials) = (less, self.data.trials.to_vec());
        for _ in 0..ROUNDS {
            let missing = self.on(&trials).disturbance(&rival);
            trials.iter_mut().zip(&missing).for_each(|(trial, missing)| take_off(trial, missing, frequency));
            rival = self.on(&trials).polished(&rival);
        }
        let tones = 1 + 2 * HARMONICS * trials.len();
        let values = (rival.values.len() + tones).saturating_sub(fit.values.len());
        if !pays_for(values, rival.log_likelihood - fit.log_likelihood) || !self.leaves_far_more(fit, &rival) {
            return false;
        }
        let mut both = rival.clone();
        both.model.terms.push(fit.model.terms[at].clone());
        both.values.extend_from_slice(&fit.values[fit.model.values_of(at)]);
        let search = self.on(&trials);
        !search.is_worth(&search.polished(&both), &rival)
    }

    /// The same search on `trials`.
    fn on<'a>(&self, trials: &'a [DriveTrial]) -> Search<'a> {
        Search { data: Data { trials, ..self.data }, nominal: self.nominal.clone(), sides: self.sides.clone(), ..*self }
    }
}

/// The frequency of `tone`, of which least is left of `missing`, periods a row.
fn frequency_of(tone: Tone, missing: &[Vec<f64>]) -> f64 {
    let around = [tone.frequency - tone.width, tone.frequency + tone.width];
    let left = |frequency: f64| -> f64 {
        let of = |trial: &Vec<f64>| {
            let tone = tone_in(trial, frequency);
            trial.iter().zip(tone).map(|(force, tone)| (force - tone).powi(2)).sum::<f64>()
        };
        missing.iter().map(of).sum()
    };
    least_between(around, PRECISION * tone.width, left)
}

/// What a tone of `frequency` periods a row and its octave take of `missing`, row by row, beside its mean.
fn tone_in(missing: &[f64], frequency: f64) -> Vec<f64> {
    waves(missing, frequency).map_or_else(
        || vec![0.0; missing.len()],
        |waves| (0..missing.len()).map(|row| value_of(&waves, frequency * row as f64)).collect(),
    )
}

/// Cosine and sine of each harmonic in `missing`; `None` where it does not tell them.
fn waves(missing: &[f64], frequency: f64) -> Option<Vec<f64>> {
    let mean = missing.iter().sum::<f64>() / missing.len().max(1) as f64;
    let centred: Vec<f64> = missing.iter().map(|force| force - mean).collect();
    let wave = |times: usize, of: fn(f64) -> f64| -> Vec<f64> {
        (0..missing.len()).map(|row| of(TAU * times as f64 * frequency * row as f64)).collect()
    };
    let harmonics = 1..=HARMONICS;
    let columns = harmonics.flat_map(|times| [wave(times, f64::cos), wave(times, f64::sin)]).enumerate();
    solve(&columns.collect::<Vec<_>>(), &centred).map(|waves| waves.iter().copied().collect())
}

/// The sum of `waves` after so many `periods` of the first.
fn value_of(waves: &[f64], periods: f64) -> f64 {
    let harmonics = waves.chunks_exact(2).zip(1..);
    harmonics
        .map(|(wave, times)| {
            let (sine, cosine) = (TAU * f64::from(times) * periods).sin_cos();
            wave[0] * cosine + wave[1] * sine
        })
        .sum()
}

/// Adds to the effort of `trial` the tone in the force that it is `missing`: what acts beside the effort acts with it.
fn take_off(trial: &mut DriveTrial, missing: &[f64], frequency: f64) {
    let Some(waves) = waves(missing, frequency) else { return };
    let (first, period) = (trial.time[0], trial.period_s);
    for (effort, time) in trial.effort.iter_mut().zip(&trial.source_time) {
        *effort += value_of(&waves, frequency * (time - first) / period);
    }
}

#[cfg(test)]
mod tests {
    use super::super::term::Term;
    use super::super::testing::{TestDrive, search_over};
    use super::*;

    /// A pump that shakes the drive by 0.4 N, in a phase of its own in each trial: dry friction takes nothing that is its own. Beside a pump of 1 N, which does
    /// far better, there are 0.15 N of it.
    #[test]
    fn what_a_tone_does_far_better_is_no_friction_and_friction_beside_it_is() {
        let is_rivalled = |drive: TestDrive| {
            let trials = [drive.trial(6.0, 6), drive.trial(6.0, 7)];
            let search = search_over(&trials, &drive);
            let mut start = search.nominal.clone();
            start.model.terms.push(Term::Coulomb);
            start.values.push(0.1);
            let fit = search.polished(&start);
            search.is_rivalled_by_a_tone(&fit, 0)
        };
        assert!(is_rivalled(TestDrive { tone: 0.4, ..TestDrive::PLAIN }));
        assert!(!is_rivalled(TestDrive { tone: 1.0, coulomb: 0.15, ..TestDrive::PLAIN }));
        assert!(!is_rivalled(TestDrive { coulomb: 0.4, ..TestDrive::PLAIN }));
    }

    /// A tone between two lines of the spectrum, with a third of it an octave above and a mean: all of it but the mean goes into the effort.
    #[test]
    fn a_tone_and_its_octave_are_taken_off_to_the_ends_of_a_trial() {
        let trial = TestDrive::PLAIN.trial(6.0, 1);
        let turns = |time: f64| TAU * 7.37 * time + 0.4;
        let pushed = |time: f64| 0.4 * turns(time).sin() + 0.13 * (2.0 * turns(time)).cos();
        let missing: Vec<f64> = trial.time.iter().map(|time| 0.2 + pushed(*time)).collect();
        let columns = [missing];
        let frequency = frequency_of(loudest_tone(&columns), &columns);
        assert!((frequency / trial.period_s - 7.37).abs() < 1e-3, "{frequency}");
        let mut without = trial.clone();
        take_off(&mut without, &columns[0], frequency);
        for ((before, after), time) in trial.effort.iter().zip(&without.effort).zip(&trial.source_time) {
            // A thousandth of a hertz is 0.04 rad after six seconds.
            assert!((after - before - pushed(*time)).abs() < 0.02, "{time}");
        }
    }
}
