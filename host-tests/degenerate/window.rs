//! Rows that say too little, or that are too large: part-filled windows, columns in line, the ends of the range.

use super::{B, K};
use crate::rig::Bare;
use crate::simulator::Noise;
use palpate::{Flags, FrontEnd, Method, Observation, Step};
use std::f64::consts::TAU;

/// A row of the dithered contact, without noise.
fn row(k: usize) -> Observation {
    let phase = TAU * 10e-3 * k as f64;
    let (x, v) = (13.5e-3 + 3.3e-3 * phase.sin(), 0.207 * phase.cos());
    Observation { penetration: x as f32, rate: v as f32, force: (K * x + B * v) as f32 }
}

fn stiffness_error(step: &Step) -> f64 {
    (f64::from(step.estimate.stiffness) / K - 1.0).abs()
}

const BLOCK: [Method; 4] = [Method::Bls, Method::Blms, Method::Blmf, Method::NewtonBlmf];

#[test]
fn a_window_that_fills() {
    for mut law in Bare::all() {
        let block = BLOCK.contains(&law.method);
        for k in 1..=400 {
            let step = (law.update)(row(k));
            assert!(step.estimate.is_finite() && (0.0..=1.0).contains(&step.fill), "{}: {step:?}", law.method.name());
            if block {
                let too_few = step.flags.contains(Flags::TOO_FEW);
                assert_eq!(too_few, k < 20, "{} at {k}", law.method.name());
                assert_eq!(step.fill, (k as f32 / 300.0).min(1.0), "{} at {k}", law.method.name());
                let unknown = step.confidence.noise_gain.xx.is_infinite();
                assert!(!too_few || (unknown && step.estimate.stiffness == 0.0), "{} at {k}", law.method.name());
            }
        }
    }
}

#[test]
fn penetration_in_line_with_its_rate() {
    for mut law in Bare::all() {
        let name = law.method.name();
        let mut last = None;
        for k in 0..3000 {
            let x = 2e-3 + 10e-3 * (k as f64 / 3000.0);
            let (x, v) = (x as f32, 8.0 * x as f32);
            // A power of two between the columns leaves not a trace of a second direction.
            let step = (law.update)(Observation { penetration: x, rate: v, force: 340.0 * x });
            assert!(step.estimate.is_finite() && !step.innovation.is_nan(), "{name}: {step:?}");
            assert!(step.excitation < 1e-5, "{name}: {step:?}");
            last = Some(step);
        }
        let flags = last.expect("a step").flags;
        if law.method == Method::Bls {
            assert!(flags.contains(Flags::DAMPING_HELD), "{flags:?}");
        }
        let recovered = (0..4000).map(|k| (law.update)(row(k))).last().expect("a step");
        // The rows in line agree with K = 300 and B = 5, but four thousand others are no more than seven times as strong
        // as the prior of the law that forgets neither.
        let bound = if law.method == Method::Rls { 0.15 } else { 0.02 };
        assert!(stiffness_error(&recovered) < bound, "{name}: {recovered:?}");
    }
}

#[test]
fn the_ends_of_the_range() {
    let mut noise = Noise::new(31);
    let mut end =
        || (10_f64.powf(24.0 * noise.uniform() - 18.0) * if noise.uniform() < 0.5 { -1.0 } else { 1.0 }) as f32;
    let mut wild: Vec<_> = (0..5000).map(|_| Observation { penetration: end(), rate: end(), force: end() }).collect();
    let r = FrontEnd::MAX_MAGNITUDE;
    for signs in 0..8 {
        let [penetration, rate, force] = [0, 1, 2].map(|bit| if signs >> bit & 1 == 0 { r } else { -r });
        wild.extend([Observation { penetration, rate, force }; 50]);
    }
    for mut law in Bare::all() {
        let name = law.method.name();
        for o in &wild {
            let step = (law.update)(*o);
            assert!(step.estimate.is_finite() && !step.innovation.is_nan(), "{name}: {step:?} on {o:?}");
            let c = step.confidence;
            assert!(
                !c.noise.xx.is_nan() && !c.noise_gain.xx.is_nan() && !c.startup_bias.stiffness.is_nan(),
                "{name}: {c:?}"
            );
        }
        let recovered = (0..20_000).map(|k| (law.update)(row(k))).last().expect("a step");
        // What never forgets keeps rows of a million for ever; all others are back.
        let recovers = law.method != Method::Rls;
        assert!(!recovers || stiffness_error(&recovered) < 0.02, "{name}: {recovered:?}");
    }
}
