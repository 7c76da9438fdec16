//! A tone of the mains in the force, before anything is smoothed: it is no noise, and a filter that ends below it hides it.

use super::uniform_trial::UniformTrial;
use crate::diagnose::thresholds::mains_tone::{
    BACKGROUND_FRACTION, MAINS_FREQUENCY_TOLERANCE, MAINS_HZ, MIN_CYCLES, TONE_POWER_RATIO,
};

/// A tone in one trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MainsTone {
    /// Hz.
    pub frequency: f64,
    /// Part that goes with the sine of the time since the first row.
    pub sine: f64,
    /// Part that goes with the cosine.
    pub cosine: f64,
}

impl MainsTone {
    /// Its value `time` seconds after the first row.
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        let (sine, cosine) = (std::f64::consts::TAU * self.frequency * time).sin_cos();
        self.sine * sine + self.cosine * cosine
    }
}

/// The tone of the mains in the force of `raw`, where one stands out.
#[must_use]
pub fn detect(raw: &UniformTrial) -> Option<MainsTone> {
    let force = raw.force.as_ref()?;
    let seconds = force.len() as f64 * raw.period;
    let within = |mains: &f64| *mains < 0.4 / raw.period && mains * seconds > MIN_CYCLES;
    let tones = MAINS_HZ.into_iter().filter(within).filter_map(|mains| stands_out(raw, force, mains, seconds));
    tones.max_by(|a, b| (a.sine.hypot(a.cosine)).total_cmp(&b.sine.hypot(b.cosine)))
}

/// The loudest tone near `mains`, if it is far above what lies around.
fn stands_out(raw: &UniformTrial, force: &[f64], mains: f64, seconds: f64) -> Option<MainsTone> {
    let apart = 0.25 / seconds;
    let half = (MAINS_FREQUENCY_TOLERANCE * mains / apart).value().ceil() as i32;
    let near: Vec<MainsTone> = (-half..=half).map(|step| tone(raw, force, mains + f64::from(step) * apart)).collect();
    let best = near.into_iter().max_by(|a, b| power(a).total_cmp(&power(b)))?;
    // As far from the tone as its own skirts reach, and no farther than the spectrum of a motion stays alike.
    let around = (2..=8).map(|step| f64::from(step) / 8.0 * (BACKGROUND_FRACTION * mains).value());
    let around: Vec<f64> =
        around.flat_map(|away| [mains - away, mains + away]).map(|at| power(&tone(raw, force, at))).collect();
    let mean = around.iter().sum::<f64>() / around.len() as f64;
    (power(&best) > TONE_POWER_RATIO * mean).then_some(best)
}

fn power(tone: &MainsTone) -> f64 {
    tone.sine.powi(2) + tone.cosine.powi(2)
}

/// Part of `force` at `frequency`, under a window that has no edges.
fn tone(raw: &UniformTrial, force: &[f64], frequency: f64) -> MainsTone {
    // Each row's angles are turned on from the row's before.
    let turn = (std::f64::consts::TAU * frequency * raw.period).sin_cos();
    let slow = (std::f64::consts::TAU / force.len() as f64).sin_cos();
    let turned = |(s, c): (f64, f64), (by_s, by_c): (f64, f64)| (s * by_c + c * by_s, c * by_c - s * by_s);
    let (mut fast, mut window) = ((0.0, 1.0), (std::f64::consts::PI / force.len() as f64).sin_cos());
    let (mut sine, mut cosine, mut weights) = (0.0, 0.0, 0.0);
    let mean = force.iter().sum::<f64>() / force.len() as f64;
    for force in force {
        let weight = 1.0 - window.1;
        sine += weight * (force - mean) * fast.0;
        cosine += weight * (force - mean) * fast.1;
        weights += weight;
        (fast, window) = (turned(fast, turn), turned(window, slow));
    }
    MainsTone { frequency, sine: 2.0 * sine / weights, cosine: 2.0 * cosine / weights }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution as _, StandardNormal};

    use super::*;
    use crate::sensors::{Channel, Figures};

    const RATE: f64 = 1000.0;

    /// Twenty seconds of noise of deviation one beside a motion that shows in the force, and `amplitude` of 60.03 Hz.
    fn noisy(amplitude: f64) -> UniformTrial {
        let mut chance = ChaCha8Rng::seed_from_u64(7);
        let force = (0..20_000).map(|row| {
            let time = f64::from(row) / RATE;
            let noise: f64 = StandardNormal.sample(&mut chance);
            // Presses, with a corner each: their spectrum reaches far.
            let press = 300.0 * (std::f64::consts::TAU * 1.3 * time).sin().max(0.0);
            press + noise + amplitude * (std::f64::consts::TAU * 60.03 * time + 0.4).sin()
        });
        let force: Vec<f64> = force.collect();
        UniformTrial {
            origin: 0.0,
            period: 1.0 / RATE,
            position: vec![0.0; force.len()],
            force: Some(force),
            effort: None,
            figures: Figures { position: Channel { resolution: 0.0, noise: 1.0 }, force: None, effort: None },
            dropouts: Vec::new(),
            gaps: Vec::new(),
        }
    }

    #[test]
    fn a_tone_of_a_third_of_the_noise_is_heard_and_measured() {
        let tone = detect(&noisy(0.33)).unwrap();
        // White noise leaves a deviation of sqrt(2 / 20000) under a window that costs a half more, and the grid is an eightieth of
        // a hertz.
        assert!((tone.sine.hypot(tone.cosine) - 0.33).abs() < 4.0 * 0.0123, "{tone:?}");
        assert!((tone.frequency - 60.03).abs() < 0.0125, "{tone:?}");
        assert!((tone.at(0.0) - 0.33 * 0.4f64.sin()).abs() < 0.1, "{tone:?}");
    }

    #[test]
    fn where_there_is_none_none_is_heard() {
        assert_eq!(detect(&noisy(0.0)), None);
    }
}
