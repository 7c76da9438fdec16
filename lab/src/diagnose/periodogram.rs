//! Power of a signal at evenly spaced frequencies; its rows may lie anywhere.

use rayon::prelude::*;

/// Frequencies that are reached by turning each row's wave on from the one before: rounding adds up over them.
const TURNS: usize = 64;

/// |sum of signal exp(2 pi i frequency place)|^2 over `rows`, each a place and the signal there, at `count` frequencies: the first `first` and each
/// `apart` from the one before, periods per unit of place.
#[must_use]
pub fn periodogram(rows: &[(f64, f64)], first: f64, apart: f64, count: usize) -> Vec<f64> {
    let starts: Vec<usize> = (0..count).step_by(TURNS).collect();
    let part = |start: &usize| turned(rows, first + apart * *start as f64, apart, TURNS.min(count - start));
    starts.par_iter().flat_map(part).collect()
}

fn turned(rows: &[(f64, f64)], first: f64, apart: f64, count: usize) -> Vec<f64> {
    let waves = |frequency: f64| -> Vec<(f64, f64)> {
        let pulse = std::f64::consts::TAU * frequency;
        rows.iter().map(|(place, _)| (pulse * place).sin_cos()).collect()
    };
    let (mut waves, turns) = (waves(first), waves(apart));
    let power = |_| {
        let (mut sine, mut cosine) = (0.0, 0.0);
        for (((_, signal), wave), turn) in rows.iter().zip(&mut waves).zip(&turns) {
            sine += signal * wave.0;
            cosine += signal * wave.1;
            *wave = (wave.0 * turn.1 + wave.1 * turn.0, wave.1 * turn.1 - wave.0 * turn.0);
        }
        sine * sine + cosine * cosine
    };
    (0..count).map(power).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_each_frequency_it_is_what_a_wave_of_it_holds() {
        // Two waves, at places that are not evenly spaced.
        let row = |at: i32| {
            let place = 0.01 * f64::from(at) + 1e-3 * (1.7 * f64::from(at)).sin();
            (place, (7.0 * place + 0.3).sin() + 0.4 * (31.0 * place).cos())
        };
        let rows: Vec<(f64, f64)> = (0..900).map(row).collect();
        let (first, apart, count) = (0.2, 0.05, 200);
        let powers = periodogram(&rows, first, apart, count);
        let directly = |frequency: f64| {
            let sum = |wave: fn(f64) -> f64| {
                rows.iter().map(|(place, signal)| signal * wave(std::f64::consts::TAU * frequency * place)).sum::<f64>()
            };
            sum(f64::sin).powi(2) + sum(f64::cos).powi(2)
        };
        assert_eq!(powers.len(), count);
        let loudest = powers.iter().fold(0.0f64, |most, power| most.max(*power));
        // 64 turns of a rounding each, over sums of 900 rows.
        for (at, power) in powers.iter().enumerate() {
            let direct = directly(first + apart * at as f64);
            assert!((power - direct).abs() < 1e-12 * loudest, "{at}: {power} {direct}");
        }
    }
}
