//! What a day of samples leaves behind in the sums: nothing.

use super::{SOUND, contact::Contact};
use palpate::{
    BlockConfig, BlockLeastMeanFourth, BlockLeastSquares, Direction, Observation, Recent, UpdateLaw, direct,
};

const WINDOW: usize = 300;

/// After `count` samples: the estimate against a law that saw the last window alone, summed anew, as a share of K and B.
fn left_behind<L: UpdateLaw, D: UpdateLaw>(law: &L, anew: &D, count: usize) -> [f64; 2] {
    // A thousand samples of noise go round and round; drawing 1e8 would take longer than estimating.
    let circle: Vec<Observation> = Contact::new(9, usize::MAX).take(1000).collect();
    let twice: Vec<Observation> = circle.iter().chain(&circle).copied().collect();
    let (mut state, mut last) = (law.initial_state(), None);
    for k in 0..count {
        let end = 1000 + k % 1000;
        let first = end + 1 - WINDOW.min(k + 1);
        last = Some(law.update(&mut state, Recent::of(&twice[first..=end])));
    }
    let got = last.expect("samples").estimate;
    let end = 1000 + (count - 1) % 1000;
    // Newton settles on the minimum of one window in a few steps.
    let mut fresh = anew.initial_state();
    let want = (0..40).map(|_| anew.update(&mut fresh, Recent::of(&twice[end + 1 - WINDOW..=end])).estimate).last();
    let want = want.expect("a step");
    let share = |got: f32, want: f32| (f64::from(got) / f64::from(want) - 1.0).abs();
    [share(got.stiffness, want.stiffness), share(got.damping, want.damping)]
}

/// Fails where `count` samples have moved either law by more than a few last digits. Least squares rests on nothing but its
/// window; so does Newton's mean fourth, up to the step that it lags behind a window that moves.
fn nothing_is_left_after(count: usize) {
    let config = BlockConfig::of(WINDOW as u16);
    let [k, b] = left_behind(
        &BlockLeastSquares::new(config).expect(SOUND),
        &direct::BlockLeastSquares::new(config).expect(SOUND),
        count,
    );
    println!("bls after {count} samples: K off by {k:.1e}, B by {b:.1e}");
    assert!(k < 4e-7 && b < 1e-6, "K {k:e}, B {b:e}");
    let newton = |count| {
        left_behind(
            &BlockLeastMeanFourth::new(config, Direction::Newton).expect(SOUND),
            &direct::BlockLeastMeanFourth::new(config, Direction::Newton).expect(SOUND),
            count,
        )
    };
    // The lag is the same at the same place of the circle, so a thousand samples and all of them must agree.
    let ([k, b], [soon_k, soon_b]) = (newton(count), newton(2000));
    println!(
        "newton_blmf after {count} samples: K off by {k:.1e}, B by {b:.1e}; after 2000: {soon_k:.1e}, {soon_b:.1e}"
    );
    assert!((k - soon_k).abs() < 2e-6 && (b - soon_b).abs() < 1e-5, "K {k:e}, B {b:e}");
}

#[test]
fn a_million_samples_change_nothing() {
    nothing_is_left_after(1_000_000);
}

/// Twenty-eight hours at 1 kHz: `cargo test -p palpate --test host -- --ignored --nocapture drift`, half a minute.
#[test]
#[ignore = "1e8 samples take half a minute"]
fn a_hundred_million_samples_change_nothing() {
    nothing_is_left_after(100_000_000);
}
