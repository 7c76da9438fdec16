//! The parts of the diagnosis, each against a truth from elsewhere: closed forms, other algorithms.

use palpate_lab::diagnose::signals::dequantize::dequantize;
use palpate_lab::diagnose::signals::derivative_filter::DerivativeFilter;
use palpate_lab::effects::{Reading, gate, ramp};

/// Largest distance of two rows, `edge` rows at either end left out; NaN fails any bound.
fn apart(a: &[f64], b: &[f64], edge: usize) -> f64 {
    assert_eq!(a.len(), b.len());
    let rows = edge..a.len() - edge;
    rows.map(|row| (a[row] - b[row]).abs()).fold(0.0, |most, apart| if apart <= most { most } else { apart })
}

#[test]
fn a_lens_leaves_a_parabola_its_velocity_and_its_acceleration() {
    // x = 2 - 3 t + 5 t^2: level is x + 5 blur^2 (the mean of t^2 over the Gaussian), slope and bend are exact.
    for (filter_width, stride) in [(0.66e-3, 1), (4e-3, 3), (20e-3, 7)] {
        let lens = DerivativeFilter::new(filter_width, 1e-3, stride);
        let time: Vec<f64> = (0..2000).map(|row| f64::from(row) * 1e-3).collect();
        let x: Vec<f64> = time.iter().map(|t| 2.0 - 3.0 * t + 5.0 * t * t).collect();
        let valid: Vec<f64> = time.iter().copied().step_by(stride).collect();
        let edge = lens.half_width_rows() / stride + 2;
        let slope: Vec<f64> = valid.iter().map(|t| -3.0 + 10.0 * t).collect();
        assert!(apart(&lens.first_derivative(&x), &slope, edge) < 1e-8, "blur {filter_width}");
        assert!(apart(&lens.second_derivative(&x), &vec![10.0; valid.len()], edge) < 1e-5, "blur {filter_width}");
        // What is held from its row to the next runs half a row late.
        let held: Vec<f64> = time.iter().map(|t| 7.0 * t).collect();
        let late: Vec<f64> = valid.iter().map(|t| 7.0 * (t - 0.5e-3)).collect();
        assert!(apart(&lens.smooth_held(&held), &late, edge) < 1e-9, "blur {filter_width}");
    }
}

#[test]
fn a_lens_passes_a_sine_as_its_corner_says() {
    let lens = DerivativeFilter::new(0.132_5 / 40.0, 1e-3, 1);
    let wave: Vec<f64> = (0..4000).map(|row| (std::f64::consts::TAU * 40.0 * f64::from(row) * 1e-3).sin()).collect();
    let valid = lens.smooth(&wave);
    let size = valid[500..3500].iter().map(|x| x * x).sum::<f64>() * 2.0 / 3000.0;
    // -3 dB is half the power; the constant 0.1325 is given to four digits.
    assert!((size - 0.5).abs() < 2e-3, "{size}");
}

#[test]
fn a_slow_motion_on_a_coarse_encoder_is_known_far_better_than_its_steps() {
    let step = 1e-4;
    let truth: Vec<f64> = (0..4000).map(|row| 2.3e-3 * (0.7 * f64::from(row) * 1e-3).sin()).collect();
    let mut read: Vec<f64> = truth.iter().map(|x| (x / step).round() * step).collect();
    let rounded = apart(&read, &truth, 100);
    dequantize(|row| row as f64, &mut read, step);
    let told = apart(&read, &truth, 100);
    // The instants of the steps are known to half a row, 1 um at this speed; at the turn to less than half a step.
    assert!(rounded > 0.45 * step && told < 0.25 * step, "{rounded} {told}");
    let mean = read.iter().zip(&truth).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / truth.len() as f64;
    assert!(mean.sqrt() < 0.06 * step, "{}", mean.sqrt() / step);
}

#[test]
fn a_reading_that_steps_at_every_row_stays_as_it_is() {
    let mut read: Vec<f64> = (0..100).map(|row| f64::from(row * 2)).collect();
    let before = read.clone();
    dequantize(|row| row as f64, &mut read, 1.0);
    assert_eq!(read, before);
}

#[test]
fn the_smoothed_corner_is_the_mean_over_its_width() {
    for (value, width) in [(0.3, 1.0), (-2.0, 1.0), (0.0, 0.5), (1.0, 0.0), (-1.0, 0.0)] {
        let nodes = (-80_000..=80_000).map(|i| f64::from(i) * 1e-4);
        let (mut corner, mut inside) = (0.0, 0.0);
        for n in nodes {
            let weight = (-0.5 * n * n).exp() / std::f64::consts::TAU.sqrt() * 1e-4;
            corner += weight * (value + width * n).max(0.0);
            inside += weight * f64::from(value + width * n > 0.0);
        }
        assert!((ramp(value, width) - corner).abs() < 1e-6, "{value} {width}");
        assert!((gate(value, width) - inside).abs() < 1e-4, "{value} {width}");
    }
}

/// Of a tool that rests.
fn reading<'a>(at_rest: &'a [f64], step: f64, force: &'a mut [f64]) -> Reading<'a> {
    let (position, velocity, acceleration) = (at_rest, at_rest, at_rest);
    Reading { start: 0.0, step, filter_width: 0.0, position, velocity, acceleration, force }
}

#[test]
fn a_delay_shifts_a_wave_and_a_lag_filters_it() {
    let (step, pulse) = (5e-3, std::f64::consts::TAU * 12.0);
    let wave = |t: f64| (pulse * t).sin();
    let rows: Vec<f64> = (0..800).map(|row| wave(f64::from(row) * step)).collect();
    let at_rest = vec![0.0; rows.len()];
    for lag in [0.2e-3, 2.5e-3, 7.1e-3] {
        let mut force = rows.clone();
        reading(&at_rest, step, &mut force).delay(lag);
        let late: Vec<f64> = (0..800).map(|row| wave(f64::from(row) * step - lag)).collect();
        // Six points of a wave at 0.06 of the rate: the next term of the series is below 1e-3.
        assert!(apart(&force, &late, 10) < 1e-3, "{lag}");
        let mut force = rows.clone();
        reading(&at_rest, step, &mut force).low_pass(lag);
        let (size, angle) = ((1.0 + (pulse * lag).powi(2)).sqrt().recip(), (pulse * lag).atan());
        let slow: Vec<f64> = (0..800).map(|row| size * (pulse * f64::from(row) * step - angle).sin()).collect();
        // Straight lines between rows lose (pulse step)^2 / 12 of the wave.
        assert!(apart(&force, &slow, 60) < 0.013, "{lag}");
    }
}
