//! Do the 95 % intervals hold what they promise?
//!
//! Many benches with their own noise and their own surface error within half a count, both sensors quantised. K and B
//! are looked at every 150 ms from 1.5 s after the onset on, when every law has settled that ever does.

use crate::rig;
use crate::simulator::{Noise, Trial};
use palpate::{
    Bench, BenchConfig, EwrlsConfig, GradientConfig, Ignorance, Method, ResetRlsConfig, SprlsConfig, StreamConfig,
};

const SEEDS: u64 = 150;

/// Of one method: how often the truth lay inside, how often anything was claimed, and the mean half-width.
#[derive(Debug, Clone, Copy, Default)]
struct Coverage {
    looks: f64,
    inside: [f64; 2],
    width: [f64; 2],
}

fn bench(ignorance: Ignorance) -> Bench {
    let all = rig::settings(StreamConfig::BENCH);
    Bench::new(&BenchConfig {
        rls: EwrlsConfig { ignorance, ..all.rls },
        ewrls: EwrlsConfig { ignorance, ..all.ewrls },
        sprls: SprlsConfig { ignorance, ..all.sprls },
        reset_rls: ResetRlsConfig { ignorance, ..all.reset_rls },
        gradient: GradientConfig { ignorance, ..all.gradient },
        ..all
    })
    .expect("sound settings")
}

fn measure(trial: &Trial, truth: [f64; 2], ignorance: Ignorance) -> [Coverage; 9] {
    let mut coverage = [Coverage::default(); 9];
    let mut noise = Noise::new(77);
    for seed in 0..SEEDS {
        let surface = 1e-4 * (noise.uniform() - 0.5);
        let samples = Trial { surface, ..trial.clone() }.samples(1000 + seed);
        let mut bench = bench(ignorance);
        for (k, sample) in samples.iter().enumerate() {
            let estimates = bench.update(*sample).expect("a good sample");
            if k < 2200 || k % 150 != 0 {
                continue;
            }
            for (coverage, e) in coverage.iter_mut().zip(&estimates) {
                coverage.looks += 1.0;
                let pairs =
                    [(e.impedance.stiffness, e.half_width.stiffness), (e.impedance.damping, e.half_width.damping)];
                for (axis, (got, width)) in pairs.into_iter().enumerate() {
                    let inside = (f64::from(got) - truth[axis]).abs() <= f64::from(width);
                    coverage.inside[axis] += f64::from(u8::from(inside));
                    coverage.width[axis] += f64::from(width) / truth[axis];
                }
            }
        }
    }
    coverage
}

fn report(name: &str, coverage: &[Coverage; 9]) {
    for (method, c) in Method::ALL.iter().zip(coverage) {
        let [k, b] = c.inside.map(|inside| 100.0 * inside / c.looks);
        let [width_k, width_b] = c.width.map(|width| 100.0 * width / c.looks);
        println!(
            "{name:<12} {:<12} K {k:5.1} % inside +-{width_k:6.2} %   B {b:5.1} % inside +-{width_b:6.2} %",
            method.name()
        );
    }
}

/// Fails unless the truth of `methods` lay inside as often as promised: 90 % of the looks or more for K, 85 % for B.
///
/// Of 150 benches an honest 95 % leaves 89 to 99 % inside. The surface error is bounded, not Gaussian, and its bound
/// is added in full, so more than 95 % is expected; what keeps the upper side honest is the width.
fn assert_covered(coverage: &[Coverage; 9], methods: &[Method], widest: [f64; 2]) {
    for (method, c) in Method::ALL.iter().zip(coverage).filter(|(method, _)| methods.contains(method)) {
        let [k, b] = c.inside.map(|inside| inside / c.looks);
        let [width_k, width_b] = c.width.map(|width| width / c.looks);
        assert!(k >= 0.90 && b >= 0.85, "{}: {k} of K and {b} of B inside", method.name());
        assert!(width_k < widest[0] && width_b < widest[1], "{}: +-{width_k} and +-{width_b}", method.name());
    }
}

/// Those that 300 samples of this excitation outweigh all that they began with.
const SETTLED: [Method; 5] = [Method::Sprls, Method::Bls, Method::Blms, Method::Blmf, Method::NewtonBlmf];

fn soft() -> Trial {
    Trial { seconds: 3.4, cycle: 4.0, ..Trial::bench("K 300, B 5", |_| (300.0, 5.0)) }
}

fn medium() -> Trial {
    Trial { depth: 3e-3, dither: 1e-3, material: |_| (3000.0, 6.0), ..soft() }
}

#[test]
fn on_the_soft_bench() {
    let coverage = measure(&soft(), [300.0, 5.0], Ignorance::default());
    report("K 300, B 5", &coverage);
    // Of plain and resetting least squares the interval says that the prior of the paper still rules them.
    assert_covered(&coverage, &Method::ALL, [1.6, 1.5]);
    assert_covered(&coverage, &SETTLED, [0.01, 0.03]);
}

#[test]
fn on_the_medium_bench() {
    // Three times as stiff as the default takes for likely, so whoever expects such a contact has to say so.
    let coverage = measure(&medium(), [3000.0, 6.0], Ignorance { stiffness: 3000.0, damping: 30.0 });
    report("K 3000, B 6", &coverage);
    assert_covered(&coverage, &Method::ALL, [2.0, 30.0]);
    assert_covered(&coverage, &SETTLED, [0.03, 0.1]);
}

#[test]
fn on_the_medium_bench_with_the_default_ignorance() {
    let coverage = measure(&medium(), [3000.0, 6.0], Ignorance::default());
    report("default", &coverage);
    // Laws that have not settled yet can be no better than what they were told of the start; the others have to be.
    assert_covered(&coverage, &SETTLED, [0.03, 0.1]);
}
