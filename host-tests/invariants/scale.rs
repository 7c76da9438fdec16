//! Units: powers of two change no bit, and neither nanonewtons nor tens of kilonewtons cost accuracy.

use crate::rig;
use crate::simulator::Trial;
use palpate::{
    ContactDetectorConfig, FrontEndConfig, Method, Observation, Sample, SensorResolution, StreamConfig, Units,
};

fn bench_samples(seed: u64) -> Vec<Sample> {
    Trial { seconds: 2.5, ..Trial::bench("K 300, B 5", |_| (300.0, 5.0)) }.samples(seed)
}

/// The bench with every length times `length` and every force times `force`.
fn scaled(samples: &[Sample], length: f64, force: f64) -> Vec<Sample> {
    let times = |value: f32, factor: f64| (f64::from(value) * factor) as f32;
    samples
        .iter()
        .map(|s| Sample { position: times(s.position, length), force: times(s.force, force), elapsed: s.elapsed })
        .collect()
}

fn stream(units: Units, length: f32, force: f32) -> StreamConfig {
    let (bench, contact_detector) = (StreamConfig::BENCH, ContactDetectorConfig::BENCH);
    let contact_detector = ContactDetectorConfig {
        on_force: contact_detector.on_force * force,
        off_force: contact_detector.off_force * force,
        ..contact_detector
    };
    StreamConfig {
        front_end: FrontEndConfig { units, contact_detector, ..FrontEndConfig::BENCH },
        sensors: SensorResolution {
            position_resolution: bench.sensors.position_resolution * length,
            force_noise: bench.sensors.force_noise * force,
        },
        ..bench
    }
}

#[test]
fn powers_of_two_change_no_bit_but_the_exponent() {
    let samples = bench_samples(3);
    let want = rig::run(&mut rig::bench(StreamConfig::BENCH), &samples);
    for (length, force, time) in [(-13, -20, 0), (9, 12, -4), (-30, 5, 7), (20, -40, 3)] {
        let [length, force, time] = [length, force, time].map(|exponent| 2_f32.powi(exponent));
        let mut config = stream(Units { penetration: length, rate: length / time, force }, length, force);
        config.front_end.period *= time;
        config.front_end.cutoff /= time;
        let mut samples = scaled(&samples, length.into(), force.into());
        samples.iter_mut().for_each(|sample| sample.elapsed *= time);
        let got = rig::run(&mut rig::bench(config), &samples);
        for (k, (got, want)) in got.iter().zip(&want).enumerate() {
            let (got, want) = (got.expect("a good sample"), want.expect("a good sample"));
            for (method, (got, want)) in Method::ALL.iter().zip(got.iter().zip(&want)) {
                let mut back = *got;
                for pair in [&mut back.impedance, &mut back.half_width] {
                    pair.stiffness *= length / force;
                    pair.damping *= length / time / force;
                }
                back.innovation /= force;
                let what = format!("{} at sample {k}, {length:e} m, {force:e} N, {time:e} s", method.name());
                assert_eq!(rig::bits(&back), rig::bits(want), "{what}");
            }
        }
    }
}

#[test]
fn nanonewtons_and_tens_of_kilonewtons_are_identified_as_well_as_newtons() {
    let samples = bench_samples(4);
    // EstimatorBank: 13.5 mm and 4 N. Micrometres and nanonewtons; metres and tens of kilonewtons.
    for (length, force) in [(1e-6 / 0.0135, 1e-9 / 4.0), (1.0 / 0.0135, 1e4 / 4.0)] {
        let bench = Units::BENCH_RANGE;
        let units = Units::for_range(Observation {
            penetration: (f64::from(bench.penetration) * length) as f32,
            rate: (f64::from(bench.rate) * length) as f32,
            force: (f64::from(bench.force) * force) as f32,
        });
        let mut bench = rig::bench(stream(units, length as f32, force as f32));
        let last = rig::run(&mut bench, &scaled(&samples, length, force)).pop().expect("samples").expect("a good one");
        let plain =
            rig::run(&mut rig::bench(StreamConfig::BENCH), &samples).pop().expect("samples").expect("a good one");
        for (method, (got, want)) in Method::ALL.iter().zip(last.iter().zip(&plain)) {
            let error = |got: f32, truth: f64| (f64::from(got) * length / force / truth - 1.0).abs();
            let plain_error = |got: f32, truth: f64| (f64::from(got) / truth - 1.0).abs();
            let errors = [error(got.impedance.stiffness, 300.0), error(got.impedance.damping, 5.0)];
            let plain = [plain_error(want.impedance.stiffness, 300.0), plain_error(want.impedance.damping, 5.0)];
            println!("{:<12} {length:.1e} {force:.1e}: errors {errors:.4?}, on the bench {plain:.4?}", method.name());
            // The unit is the nearest power of two, so settings act as on a bench of up to 1.42 times the size, and a
            // law that still remembers its prior feels that; where it is settled the errors are alike.
            for (got, plain) in errors.iter().zip(plain) {
                assert!(*got <= 1.5 * plain + 0.02, "{}: {errors:?} against {plain:?}", method.name());
            }
        }
    }
}
