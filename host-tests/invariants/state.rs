//! The covariance stays one, a window forgets entirely, and nothing of one contact reaches the next.

use super::runner;
use crate::reference;
use crate::rig;
use crate::simulator::Trial;
use crate::tolerance::close;
use nalgebra::Matrix2;
use palpate::{
    BlockConfig, BlockLeastSquares, Covariance, Ewrls, EwrlsConfig, Flags, FrontEnd, Observation, Recent,
    RecursiveState, Sample, Sprls, SprlsConfig, StreamConfig, Sym2, UpdateLaw,
};
use proptest::collection::vec;
use proptest::prelude::*;

/// Of either sign, with a logarithm spread evenly; zero now and then.
fn magnitude(low: f32, high: f32) -> impl Strategy<Value = f32> {
    let size = (low.log10()..high.log10()).prop_map(|log| 10_f32.powf(log));
    prop_oneof![8 => size.clone(), 8 => size.prop_map(|s| -s), 1 => Just(0.0)]
}

fn observation() -> impl Strategy<Value = Observation> {
    (magnitude(1e-6, 1e6), magnitude(1e-6, 1e6), magnitude(1e-6, 1e6))
        .prop_map(|(penetration, rate, force)| Observation { penetration, rate, force })
}

/// Positive on the diagonal, and no negative eigenvalue beyond the rounding of the three entries.
fn assert_covariance(p: Sym2) {
    assert!(p.is_finite() && p.xx > 0.0 && p.vv > 0.0, "{p:?}");
    let (xx, xv, vv) = (f64::from(p.xx), f64::from(p.xv), f64::from(p.vv));
    // The determinant is a difference of products that are each known to a few last digits.
    assert!(xx * vv - xv * xv >= -4.0 * f64::from(f32::EPSILON) * xx * vv, "{p:?}");
}

#[test]
fn the_covariance_of_forgetting_is_always_a_covariance() {
    let input = (vec(observation(), 1..200), 0.6_f32..=1.0, 0.0_f32..=8.0);
    runner(400)
        .run(&input, |(observations, forgetting_factor, log)| {
            let initial_covariance = 10_f32.powf(log).min(1e8);
            let config =
                EwrlsConfig { forgetting_factor, initial_covariance, covariance_limit: initial_covariance.max(1e6) };
            let law = Ewrls::new(config).expect("sound settings");
            let mut state = law.initial_state();
            for o in &observations {
                law.update(&mut state, Recent::of(std::slice::from_ref(o)));
                assert_covariance(state.covariance.matrix());
                assert!(state.covariance.is_sound() && state.estimate.is_finite(), "{state:?}");
            }
            Ok(())
        })
        .unwrap();
}

#[test]
fn the_covariance_of_self_perturbation_is_always_a_covariance() {
    let input = (vec(observation(), 1..200), 0.0_f32..1e4, 0.0_f32..100.0, 0.0_f32..=8.0);
    runner(400)
        .run(&input, |(observations, perturbation_gain, perturbation_sensitivity, log)| {
            let config = SprlsConfig {
                perturbation_gain,
                perturbation_sensitivity,
                initial_covariance: 10_f32.powf(log).min(1e8),
                covariance_limit: 1e9,
            };
            let law = Sprls::new(config).expect("sound settings");
            let mut state = law.initial_state();
            for o in &observations {
                law.update(&mut state, Recent::of(std::slice::from_ref(o)));
                assert_covariance(state.recursion.covariance.matrix());
                assert!(state.recursion.covariance.is_sound() && state.recursion.estimate.is_finite(), "{state:?}");
            }
            Ok(())
        })
        .unwrap();
}

#[test]
fn the_covariance_is_the_inverse_of_the_information() {
    let pair = (-1.0_f32..1.0, -1.0_f32..1.0, 0.0_f32..4.0);
    let input = (vec(pair, 1..120), 0.9_f32..=1.0, -1.0_f32..5.0);
    runner(300)
        .run(&input, |(steps, forgetting, log)| {
            let size = 10_f32.powf(log);
            let mut covariance = Covariance::identity(size);
            let mut information = Matrix2::identity() / f64::from(size);
            for (penetration, rate, perturbation) in steps {
                covariance.observe(&Observation { penetration, rate, force: 0.0 }, forgetting);
                let phi = nalgebra::Vector2::new(f64::from(penetration), f64::from(rate));
                information = information * f64::from(forgetting) + phi * phi.transpose();
                if perturbation > 3.0 {
                    covariance.inflate(perturbation);
                    let kicked =
                        information.try_inverse().expect("definite") + Matrix2::identity() * f64::from(perturbation);
                    information = kicked.try_inverse().expect("definite");
                }
            }
            let want = information.try_inverse().expect("definite");
            let got = covariance.matrix();
            // Up to 120 updates of some ten roundings each, on a matrix whose factors carry relative errors.
            let scale = 2e-4 * want.trace();
            close("xx", got.xx.into(), want[(0, 0)], 0.0, scale);
            close("xv", got.xv.into(), want[(0, 1)], 0.0, scale);
            close("vv", got.vv.into(), want[(1, 1)], 0.0, scale);
            Ok(())
        })
        .unwrap();
}

#[test]
fn a_window_that_went_round_equals_a_fresh_start_on_its_samples() {
    let row = (1e-3_f32..0.02, -0.2_f32..0.2, -0.3_f32..0.3);
    runner(60)
        .run(&(vec(row, 120..400), 20_usize..100), |(rows, window)| {
            let mut observations = rows.iter().enumerate().map(|(k, &(penetration, rate, noise))| {
                // A material that changes, so that what has left the window would be noticed.
                let stiffness = if k < rows.len() / 2 { 2000.0 } else { 300.0 };
                Observation { penetration, rate, force: stiffness * penetration + 5.0 * rate + noise }
            });
            let observations: Vec<_> = observations.by_ref().collect();
            let law = BlockLeastSquares::new(BlockConfig::of(window as u16)).expect("sound settings");
            let (mut long, mut fresh) = (law.initial_state(), law.initial_state());
            for k in 0..observations.len() {
                law.update(&mut long, Recent::of(&observations[..=k]));
            }
            let last = &observations[observations.len() - window..];
            law.update(&mut fresh, Recent::of(last));
            let rho = reference::independence(&reference::rows(last));
            // The sums of the fresh start are of raw force, those of the long run about a near estimate.
            let allowed = 4.0 * (window as f64).sqrt() * f64::from(f32::EPSILON) / rho;
            let (got, want) = (long.estimate, fresh.estimate);
            close("K", got.stiffness.into(), want.stiffness.into(), allowed, 0.0);
            close("B", got.damping.into(), want.damping.into(), allowed, allowed * 40.0);
            Ok(())
        })
        .unwrap();
}

#[test]
fn the_same_trial_later_gives_the_same_bits() {
    let trial = Trial::bench("K 300, B 5", |_| (300.0, 5.0));
    let mut samples = Trial { seconds: 2.0, ..trial.clone() }.samples(5);
    let alone = rig::run(&mut rig::bench(StreamConfig::BENCH), &samples);
    // Another trial before it, the tool lifted, and a second of silence.
    let mut before = Trial { seconds: 4.0, ..Trial::bench("K 3000", |_| (3000.0, 6.0)) }.samples(6);
    before.extend([Sample { position: -0.02, force: 0.0, elapsed: 1e-3 }; 20]);
    let mut bench = rig::bench(StreamConfig::BENCH);
    rig::run(&mut bench, &before);
    samples[0].elapsed = 1.0;
    for (k, (got, want)) in rig::run(&mut bench, &samples).iter().zip(&alone).enumerate() {
        rig::same(&format!("sample {k}"), got, want);
    }
}

/// A dithered contact, one that is held until the covariance is at its limit, and rows at both ends of the range.
fn all_weathers() -> Vec<Observation> {
    let dithered = (0..2000).map(|k| {
        let phase = 0.063 * f64::from(k);
        let (x, v) = (0.0135 + 0.0033 * phase.sin(), 0.207 * phase.cos());
        let jumped = if k < 1000 { 300.0 } else { 1800.0 };
        Observation { penetration: x as f32, rate: v as f32, force: (jumped * x + 5.0 * v) as f32 }
    });
    let held = (0..9000).map(|_| Observation { penetration: 5e-3, rate: 0.0, force: 1.5 });
    let range = FrontEnd::MAX_MAGNITUDE;
    let far = [(range, -range, range), (-range, range, range), (range, range, -range), (0.0, 0.0, range)];
    let near = [(1e-20, 1e-20, 1e-20), (0.0, 1e-30, 0.0), (1e-30, 0.0, range)];
    let ends = far.into_iter().chain(near).cycle().take(700);
    let ends = ends.map(|(penetration, rate, force)| Observation { penetration, rate, force });
    dithered.clone().chain(held).chain(ends).chain(dithered).collect()
}

#[test]
fn learning_alone_comes_to_the_bits_of_an_update() {
    let (ewrls, sprls) = (Ewrls::new(EwrlsConfig::default()).unwrap(), Sprls::new(SprlsConfig::default()).unwrap());
    let (mut e, mut s) = ([ewrls.initial_state(); 2], [sprls.initial_state(); 2]);
    let mut limited = 0;
    for (k, o) in all_weathers().iter().enumerate() {
        let recent = Recent::of(std::slice::from_ref(o));
        ewrls.update_estimate(&mut e[0], o);
        limited += usize::from(ewrls.update(&mut e[1], recent).flags.intersects(Flags::LIMITED | Flags::RESET));
        sprls.update_estimate(&mut s[0], o);
        sprls.update(&mut s[1], recent);
        let bits = |r: &RecursiveState| (r.estimate.stiffness.to_bits(), r.estimate.damping.to_bits(), r.covariance);
        assert_eq!(bits(&e[0]), bits(&e[1]), "ewrls at {k}: {o:?}");
        assert_eq!(bits(&s[0].recursion), bits(&s[1].recursion), "sprls at {k}: {o:?}");
    }
    assert!(limited > 100, "the way that is seldom gone was gone {limited} times");
}
