//! Samples that cannot be: rejected whole, with the reason, and without a trace.

use super::all_know_stiffness;
use crate::rig;
use crate::simulator::{Noise, Trial};
use palpate::{Field, Rejection, Sample, StreamConfig};

/// Every way for one field to be wrong, and what must be said of it.
fn spoilt(good: Sample, pick: u64) -> (Sample, Rejection) {
    let strange = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let value = strange[(pick / 16 % 3) as usize];
    let huge = [1e30, -1e30, f32::MAX][(pick / 16 % 3) as usize];
    let late = [0.0, -0.0, -1e-3][(pick / 16 % 3) as usize];
    match pick % 6 {
        0 => (Sample { position: value, ..good }, Rejection::NotFinite(Field::Position)),
        1 => (Sample { force: value, ..good }, Rejection::NotFinite(Field::Force)),
        2 => (Sample { elapsed: value, ..good }, Rejection::NotFinite(Field::Elapsed)),
        3 => (Sample { position: huge, ..good }, Rejection::OutOfRange(Field::Position)),
        4 => (Sample { force: huge, ..good }, Rejection::OutOfRange(Field::Force)),
        _ => (Sample { elapsed: late, ..good }, Rejection::OutOfRange(Field::Elapsed)),
    }
}

#[test]
fn a_bad_sample_changes_nothing_but_the_clock() {
    let trial = Trial { seconds: 3.0, ..Trial::bench("K 300, B 5", |_| (300.0, 5.0)) };
    let mut noise = Noise::new(21);
    let (mut marred, mut whole) = (rig::bench(StreamConfig::BENCH), rig::bench(StreamConfig::BENCH));
    let mut rejected = 0;
    let mut last = None;
    for (k, &sample) in trial.samples(8).iter().enumerate() {
        let mut good = sample;
        let mut waited = 0.0;
        while noise.uniform() < 0.2 {
            let part = Sample { elapsed: 0.25e-3, ..sample };
            let (bad, reason) = spoilt(part, noise.bits());
            assert_eq!(marred.update(bad).expect_err("a bad sample"), reason, "sample {k}: {bad:?}");
            rejected += 1;
            if bad.elapsed.is_finite() && bad.elapsed > 0.0 {
                waited += bad.elapsed;
                good.elapsed = 0.5e-3;
            }
        }
        let want = whole.update(Sample { elapsed: good.elapsed + waited, ..good });
        let got = marred.update(good);
        rig::same(&format!("sample {k}, after {waited} s of bad ones"), &got, &want);
        last = got.ok();
    }
    assert!(rejected > 500, "{rejected}");
    all_know_stiffness(&last.expect("a good sample"), 0.05, &[palpate::Method::Rls, palpate::Method::ResetRls]);
}

#[test]
fn an_hour_of_a_dead_sensor_is_a_gap() {
    let mut bench = rig::bench(StreamConfig::BENCH);
    rig::run(&mut bench, &super::excitation(2000).collect::<Vec<_>>());
    for _ in 0..HOUR {
        let dead = Sample { position: f32::NAN, force: f32::NAN, elapsed: 1e-3 };
        assert_eq!(bench.update(dead).expect_err("a dead sensor"), Rejection::NotFinite(Field::Position));
    }
    let back = bench.update(super::dithered(0.0, 1e-3)).expect("a good sample");
    for e in back {
        assert!(e.flags.contains(palpate::Flags::RESTARTED | palpate::Flags::HELD), "{:?}", e.flags);
    }
    let after = rig::run(&mut bench, &super::excitation(2000).collect::<Vec<_>>());
    all_know_stiffness(&after.last().expect("samples").expect("a good sample"), 0.02, &[palpate::Method::Rls]);
}

const HOUR: usize = 3_600_000;
