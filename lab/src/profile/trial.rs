//! The recording that every profile is of: contact, its loss, a material that jumps, an onset on something stiff.

use anyhow::{Result, anyhow};
use palpate::{EstimatorBankConfig, Observation, Sample, Stream, StreamConfig};
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, Normal};

/// Samples at 1 kHz.
const SAMPLES: u32 = 4_000;

/// Stiffness in N/m from a time in seconds on; none: nothing is touched.
const STIFFNESS_SCHEDULE: [(f64, Option<f64>); 7] = [
    (0.0, None),
    (0.2, Some(300.0)),
    (1.1, Some(900.0)),
    (1.9, Some(250.0)),
    (2.5, None),
    (2.7, Some(1800.0)),
    (3.8, None),
];

/// The settings of all estimators: the paper's.
pub fn config() -> EstimatorBankConfig {
    EstimatorBankConfig::all_methods(StreamConfig::BENCH)
}

/// The samples: 10 mm deep with a dither of 3.3 mm at 10 Hz, B = 5 N s/m, 0.09 N of noise, 0.1 mm a count. The roots and
/// sines are those of `libm`, so the samples are the same everywhere.
///
/// # Errors
/// None for the constants above.
pub fn samples() -> Result<Vec<Sample>> {
    let mut random = ChaCha8Rng::seed_from_u64(20);
    let noise = Normal::new(0.0, 0.09)?;
    Ok((0..SAMPLES)
        .map(|k| {
            let t = f64::from(k) * 1e-3;
            let stiffness =
                STIFFNESS_SCHEDULE.iter().rev().find(|(from, _)| *from <= t).and_then(|(_, stiffness)| *stiffness);
            let phase = 62.831_853 * t;
            let middle = if stiffness.is_some() { 0.010 } else { -0.010 };
            let (x, v) = (middle + 0.0033 * libm::sin(phase), 0.0033 * 62.831_853 * libm::cos(phase));
            let force = stiffness.map_or(0.0, |k| k * x + 5.0 * v) + noise.sample(&mut random);
            let position = libm::round(x * 1e4) * 1e-4;
            Sample { position: position as f32, force: force as f32, elapsed: 1e-3 }
        })
        .collect())
}

/// The samples at which a law is updated: those in contact, by the same front end as in the image.
///
/// # Errors
/// None for the settings above.
pub fn updates(samples: &[Sample]) -> Result<Vec<usize>> {
    Ok(in_contact(samples)?.into_iter().map(|(k, _)| k).collect())
}

/// What they come to.
///
/// # Errors
/// None for the settings above.
pub fn observations(samples: &[Sample]) -> Result<Vec<Observation>> {
    Ok(in_contact(samples)?.into_iter().map(|(_, observation)| observation).collect())
}

fn in_contact(samples: &[Sample]) -> Result<Vec<(usize, Observation)>> {
    let mut stream = Stream::<1>::new(config().stream).map_err(|error| anyhow!("{error:?}"))?;
    let mut found = Vec::new();
    for (k, &sample) in samples.iter().enumerate() {
        let event = stream.update(sample).map_err(|why| anyhow!("sample {k}: {why:?}"))?;
        if event.reading.contact && !event.reading.restarted {
            found.push((k, event.reading.observation));
        }
    }
    Ok(found)
}
