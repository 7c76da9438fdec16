//! The same comparison on the host: ratios are what it is for, a host's nanoseconds say nothing about a drive.

use divan::{Bencher, black_box};
use palpate::{
    BlockConfig, BlockLeastMeanFourth, BlockLeastSquares, Direction, Ewrls, EwrlsConfig, Observation, Recent,
    UpdateLaw, direct,
};
use palpate_baselines::{Adskalman, Kfilter, NalgebraRls, minikalman, nalgebra_window};

fn main() {
    divan::main();
}

/// A thousand observations of a dithered contact.
fn rows() -> Vec<Observation> {
    (0..1000)
        .map(|k| {
            let phase = 0.0628 * k as f32;
            let (penetration, rate) = (0.010 + 0.0033 * phase.sin(), 0.207 * phase.cos());
            let hash = (k as u32).wrapping_mul(2_654_435_761) >> 16;
            let noise = hash as f32 / 65_536.0 - 0.5;
            Observation { penetration, rate, force: 300.0 * penetration + 5.0 * rate + 0.3 * noise }
        })
        .collect()
}

fn each(bencher: Bencher<'_, '_>, mut update: impl FnMut(&Observation)) {
    let rows = rows();
    bencher.counter(divan::counter::ItemsCount::new(rows.len())).bench_local(|| rows.iter().for_each(&mut update));
}

#[divan::bench]
fn nalgebra(bencher: Bencher<'_, '_>) {
    let mut baseline = NalgebraRls::default();
    each(bencher, |o| {
        black_box(baseline.update(o));
    });
}

#[divan::bench]
fn kfilter(bencher: Bencher<'_, '_>) {
    let mut baseline = Kfilter::default();
    each(bencher, |o| {
        black_box(baseline.update(o));
    });
}

#[divan::bench]
fn adskalman(bencher: Bencher<'_, '_>) {
    let mut baseline = Adskalman::default();
    each(bencher, |o| {
        black_box(baseline.update(o));
    });
}

#[divan::bench]
fn mini(bencher: Bencher<'_, '_>) {
    let mut baseline = minikalman();
    each(bencher, |o| {
        black_box(baseline(o));
    });
}

#[divan::bench]
fn ewrls_alone(bencher: Bencher<'_, '_>) {
    let law = Ewrls::new(EwrlsConfig::default()).expect("sound settings");
    let mut state = law.initial_state();
    each(bencher, |o| {
        black_box(law.update_estimate(&mut state, o));
    });
}

fn windows(bencher: Bencher<'_, '_>, window: usize, mut update: impl FnMut(Recent<'_>)) {
    let rows = rows();
    bencher.counter(divan::counter::ItemsCount::new(rows.len())).bench_local(|| {
        for k in 0..rows.len() {
            update(Recent::of(&rows[(k + 1).saturating_sub(window)..=k]));
        }
    });
}

fn law(bencher: Bencher<'_, '_>, law: &impl UpdateLaw) {
    let mut state = law.initial_state();
    windows(bencher, law.window(), |recent| {
        if recent.len() == 1 {
            state = law.initial_state();
        }
        black_box(law.update(&mut state, recent));
    });
}

#[divan::bench(args = [50, 300])]
fn nalgebra_windows(bencher: Bencher<'_, '_>, window: usize) {
    windows(bencher, window, |recent| {
        black_box(nalgebra_window(recent));
    });
}

#[divan::bench(args = [50, 300])]
fn bls(bencher: Bencher<'_, '_>, window: u16) {
    law(bencher, &BlockLeastSquares::new(BlockConfig::of(window)).expect("sound settings"));
}

#[divan::bench(args = [50, 300])]
fn bls_anew(bencher: Bencher<'_, '_>, window: u16) {
    law(bencher, &direct::BlockLeastSquares::new(BlockConfig::of(window)).expect("sound settings"));
}

#[divan::bench(args = [50, 300])]
fn blmf(bencher: Bencher<'_, '_>, window: u16) {
    let config = BlockConfig::of(window);
    law(bencher, &BlockLeastMeanFourth::new(config, Direction::SteepestDescent).expect("sound settings"));
}

#[divan::bench(args = [50, 300])]
fn blmf_anew(bencher: Bencher<'_, '_>, window: u16) {
    let config = BlockConfig::of(window);
    law(bencher, &direct::BlockLeastMeanFourth::new(config, Direction::SteepestDescent).expect("sound settings"));
}
