//! What the fourth power is good for, and what one step of its descent is worth.

use crate::reference;
use crate::simulator::Noise;
use palpate::direct::{BlockLeastMeanFourth, BlockLeastSquares};
use palpate::{BlockConfig, Direction, Impedance, Observation, Recent, UpdateLaw};

const K: f64 = 300.0;
const B: f64 = 5.0;

/// A window of 300 ms of the bench at 10 Hz, with `noise` on the force.
fn window(mut noise: impl FnMut() -> f64) -> Vec<Observation> {
    (0..300)
        .map(|k| {
            let phase = 62.831_853 * 1e-3 * f64::from(k);
            let (x, v) = (0.0100 + 0.0033 * phase.sin(), 0.0033 * 62.831_853 * phase.cos());
            Observation { penetration: x as f32, rate: v as f32, force: (K * x + B * v + noise()) as f32 }
        })
        .collect()
}

/// The estimates of `law` on one window, step after step, from zero.
fn descend<L: UpdateLaw>(law: &L, window: &[Observation], steps: usize) -> Vec<Impedance> {
    let mut state = law.initial_state();
    (0..steps).map(|_| law.update(&mut state, Recent::of(window)).estimate).collect()
}

fn fourth(direction: Direction) -> BlockLeastMeanFourth {
    BlockLeastMeanFourth::new(BlockConfig::default(), direction).expect("sound settings")
}

/// Spread of K by mean fourth over its spread by least squares, over `windows` windows.
fn spread_over_least_squares(windows: u32, mut noise: impl FnMut() -> f64) -> f64 {
    let (newton, squares) = (fourth(Direction::Newton), BlockLeastSquares::new(BlockConfig::default()));
    let squares = squares.expect("sound settings");
    let mut variance = [0.0; 2];
    for _ in 0..windows {
        let window = window(&mut noise);
        let settled = descend(&newton, &window, 40).pop().expect("a step");
        let solved = descend(&squares, &window, 2).pop().expect("a step");
        for (variance, estimate) in variance.iter_mut().zip([settled, solved]) {
            *variance += (f64::from(estimate.stiffness) - K).powi(2);
        }
    }
    (variance[0] / variance[1]).sqrt()
}

#[test]
fn it_suits_bounded_noise_and_is_no_friend_of_outliers() {
    let mut random = Noise::new(4);
    let gaussian = spread_over_least_squares(600, || 0.09 * random.normal());
    let uniform = spread_over_least_squares(600, || 0.3 * (random.uniform() - 0.5));
    let spiky = spread_over_least_squares(600, || {
        let spike = if random.uniform() < 0.005 { if random.uniform() < 0.5 { 3.0 } else { -3.0 } } else { 0.0 };
        0.09 * random.normal() + spike
    });
    println!(
        "STD of K, mean fourth over least squares: Gaussian {gaussian:.2}, uniform {uniform:.2}, spikes {spiky:.1}"
    );
    // Theory, for many samples: sqrt(15)/3 = 1.29 for Gaussian noise and sqrt(3/7) = 0.65 for uniform noise; 600 windows
    // know a ratio of spreads to 6 %.
    assert!((1.12..1.45).contains(&gaussian), "{gaussian}");
    assert!((0.56..0.78).contains(&uniform), "{uniform}");
    assert!((8.0..40.0).contains(&spiky), "{spiky}");
}

#[test]
fn newton_needs_a_few_steps_where_the_steepest_descent_needs_many() {
    let mut random = Noise::new(5);
    let window = window(|| 0.09 * random.normal());
    let minimum = reference::whole_minimum(&reference::rows(&window));
    let steps = |direction| {
        let path = descend(&fourth(direction), &window, 3000);
        let away = |e: &Impedance| {
            let error = reference::theta(*e) - minimum;
            (error.x / minimum.x).abs().max((error.y / minimum.y).abs())
        };
        path.iter().rposition(|e| away(e) > 0.02).map_or(0, |last| last + 1) + 1
    };
    let (steepest, newton) = (steps(Direction::SteepestDescent), steps(Direction::Newton));
    println!("steps to 2 % of the minimum: steepest descent {steepest}, Newton {newton}");
    assert!(newton <= 5, "{newton}");
    assert!((20..3000).contains(&steepest), "{steepest}");
}
