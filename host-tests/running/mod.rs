//! SecondOrderSums that run along with the window, against the window summed anew: in double precision, and in single.

mod contact;
mod double;
mod drift;

use crate::reference::{self, RegressionRow, Theta};
use contact::Contact;
use palpate::{
    BlockConfig, BlockLeastMeanFourth, BlockLeastMeanSquare, BlockLeastSquares, Direction, Impedance, Observation,
    Recent, UpdateLaw, direct,
};

/// Samples from one jump of K to the next.
const EVERY: usize = 1237;

const SOUND: &str = "sound settings";

type Step = fn(&[RegressionRow], Theta) -> Theta;

/// Relative errors of K, one an update, each judged from the estimate before it.
struct Errors(Vec<(usize, f64)>);

impl Errors {
    /// Runs `law` over `rows`, and compares every `stride`-th update, and all around a jump, with `step` in double precision.
    fn of(law: &impl UpdateLaw, rows: &[Observation], step: Step, stride: usize) -> Self {
        let (window, doubles) = (law.window(), reference::rows(rows));
        let mut state = law.initial_state();
        let (mut before, mut errors) = (Impedance::ZERO, Vec::new());
        for k in 0..rows.len() {
            let first = (k + 1).saturating_sub(window);
            let after = law.update(&mut state, Recent::of(&rows[first..=k])).estimate;
            if k >= 20 && (k % stride == 0 || k % EVERY < 2 * window) {
                let want = step(&doubles[first..=k], reference::theta(before));
                let error = (f64::from(after.stiffness) / want.x - 1.0).abs();
                assert!(error.is_finite(), "sample {k}: {after:?}, wanted {want:?}");
                errors.push((k, error));
            }
            before = after;
        }
        Self(errors)
    }

    /// The rms over the samples that are `wanted`, by their distance from the last jump.
    fn rms(&self, wanted: impl Fn(usize) -> bool) -> f64 {
        let squares: Vec<f64> = self.0.iter().filter(|(k, _)| wanted(k % EVERY)).map(|(_, e)| e * e).collect();
        assert!(squares.len() > 300, "{} samples", squares.len());
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    }

    fn worst(&self) -> f64 {
        self.0.iter().fold(0.0, |worst, (_, error)| error.max(worst))
    }
}

/// One law in both forms over the same contact of `count` samples, K jumping all the while: the rms errors of K over all
/// samples, and the same over the two windows from the tenth sample after a jump on.
fn both(name: &str, laws: (&impl UpdateLaw, &impl UpdateLaw), step: Step, count: usize) -> [f64; 4] {
    let rows: Vec<_> = Contact::new(1, EVERY).take(count).collect();
    let window = laws.0.window();
    let around = |since: usize| (10..2 * window).contains(&since);
    let (running, anew) = (Errors::of(laws.0, &rows, step, 7), Errors::of(laws.1, &rows, step, 7));
    let [all, all_anew] = [&running, &anew].map(|errors| errors.rms(|_| true));
    let [jump, jump_anew] = [&running, &anew].map(|errors| errors.rms(around));
    println!(
        "{name:<12} W {window:>3}: rms error of K {all:.1e}, summed anew {all_anew:.1e}; after jumps {jump:.1e}, {jump_anew:.1e}; \
         worst {:.1e}, {:.1e}",
        running.worst(),
        anew.worst()
    );
    assert!(all > 1e-9 && all_anew > 1e-9, "{name}: single precision pretends to be exact");
    [all, all_anew, jump, jump_anew]
}

fn least_squares(window: u16, count: usize) -> [f64; 4] {
    let running = BlockLeastSquares::new(BlockConfig::of(window)).expect(SOUND);
    let anew = direct::BlockLeastSquares::new(BlockConfig::of(window)).expect(SOUND);
    both("bls", (&running, &anew), |rows, _| double::least_squares(rows), count)
}

fn mean_fourth(window: u16, direction: Direction, count: usize) -> [f64; 4] {
    let running = BlockLeastMeanFourth::new(BlockConfig::of(window), direction).expect(SOUND);
    let anew = direct::BlockLeastMeanFourth::new(BlockConfig::of(window), direction).expect(SOUND);
    let (name, step): (_, Step) = match direction {
        Direction::SteepestDescent => ("blmf", double::fourth_step),
        Direction::Newton => ("newton_blmf", double::newton_step),
    };
    both(name, (&running, &anew), step, count)
}

#[test]
fn least_squares_after_a_million_samples_of_a_material_that_jumps() {
    // The targets: a last digit of a single is 6e-8, and the sums of 50 rows leave two angles to tell by.
    let [all, _, jump, anew] = least_squares(300, 1_000_000);
    assert!(all < 1e-7, "{all:e}");
    assert!(jump < 2.0 * anew, "after a jump {jump:e}, summed anew {anew:e}");
    let [all, _, jump, anew] = least_squares(50, 300_000);
    assert!(all < 1e-6, "{all:e}");
    assert!(jump < 4.0 * anew, "after a jump {jump:e}, summed anew {anew:e}");
}

#[test]
fn one_step_of_mean_fourth_on_a_material_that_jumps() {
    let [all, _, jump, anew] = mean_fourth(300, Direction::SteepestDescent, 300_000);
    assert!(all < 5e-7, "{all:e}");
    assert!(jump < 2.0 * anew, "after a jump {jump:e}, summed anew {anew:e}");
    let [all, _, jump, anew] = mean_fourth(300, Direction::Newton, 300_000);
    assert!(all < 5e-7, "{all:e}");
    assert!(jump < 2.0 * anew, "after a jump {jump:e}, summed anew {anew:e}");
    // No target was set for a short window; its powers are of few samples about a centre that few samples have set.
    let [all, ..] = mean_fourth(50, Direction::SteepestDescent, 100_000);
    assert!(all < 2e-5, "{all:e}");
    let [all, ..] = mean_fourth(50, Direction::Newton, 100_000);
    assert!(all < 1e-5, "{all:e}");
}

#[test]
fn one_step_of_mean_square_on_a_material_that_jumps() {
    let running = BlockLeastMeanSquare::new(BlockConfig::of(300)).expect(SOUND);
    let anew = direct::BlockLeastMeanSquare::new(BlockConfig::of(300)).expect(SOUND);
    let [all, _, jump, anew] = both("blms", (&running, &anew), double::square_step, 100_000);
    assert!(all < 1e-6, "{all:e}");
    assert!(jump < 2.0 * anew, "after a jump {jump:e}, summed anew {anew:e}");
}

#[test]
fn one_sample_far_out_leaves_nothing_behind() {
    let law = BlockLeastMeanFourth::new(BlockConfig::of(300), Direction::Newton).expect(SOUND);
    let mut rows: Vec<_> = Contact::new(3, usize::MAX).take(4 * EVERY).collect();
    for k in 1..4 {
        // A hundred newtons for a millisecond, at other phases of the sums each time.
        rows[k * EVERY].force += 100.0;
    }
    let errors = Errors::of(&law, &rows, double::newton_step, 7);
    let (out, settled) = (errors.rms(|since| (301..600).contains(&since)), errors.rms(|since| since > 700));
    println!("after a spike has left: {out:.1e}, later: {settled:.1e}");
    // Uncompensated sums would be left with 1e-7 of the fourth power of 100 N, a hundred times what the noise makes.
    assert!(out < 5e-7, "{out:e}");
}
