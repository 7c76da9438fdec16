//! How far each is from the same estimate in double precision: the rms error of K over the recording, as a share of K.

use nalgebra::{Matrix2, Vector2};
use palpate::{
    BlockConfig, BlockLeastMeanFourth, BlockLeastSquares, Direction, Ewrls, EwrlsConfig, Impedance, Observation,
    Recent, UpdateLaw, direct,
};
use palpate_baselines::{Adskalman, COVARIANCE, FORGETTING, Kfilter, NalgebraRls, minikalman, nalgebra_window};

/// Observations from which on the errors count: before, K is about nothing.
const FIRST_SCORED_SAMPLE: usize = 300;

/// By name and window, the rms error; `None` where there is nothing to hold it against.
pub fn of(name: &str, window: Option<u16>, rows: &[Observation]) -> Option<f64> {
    let config = BlockConfig::of(window.unwrap_or(300));
    let last = usize::from(config.window);
    match name {
        "nalgebra" => {
            let mut baseline = NalgebraRls::default();
            Some(recursive(rows, |o| baseline.update(o)))
        }
        "kfilter" => {
            let mut baseline = Kfilter::default();
            Some(recursive(rows, |o| baseline.update(o)))
        }
        "adskalman" => {
            let mut baseline = Adskalman::default();
            Some(recursive(rows, |o| baseline.update(o)))
        }
        "minikalman" => Some(recursive(rows, minikalman())),
        "ewrls" | "ewrls_alone" => {
            let law = Ewrls::new(EwrlsConfig::default()).ok()?;
            let mut state = law.initial_state();
            Some(recursive(rows, |o| {
                law.update_estimate(&mut state, o);
                state.estimate
            }))
        }
        "nalgebra_window" => Some(windowed(rows, last, nalgebra_window)),
        "bls" | "bls_alone" => block(&BlockLeastSquares::new(config).ok()?, rows, last),
        "bls_anew" => block(&direct::BlockLeastSquares::new(config).ok()?, rows, last),
        "blmf" | "blmf_alone" => {
            fourth(&BlockLeastMeanFourth::new(config, Direction::SteepestDescent).ok()?, rows, last)
        }
        "blmf_anew" => fourth(&direct::BlockLeastMeanFourth::new(config, Direction::SteepestDescent).ok()?, rows, last),
        _ => None,
    }
}

fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

fn recursive(rows: &[Observation], mut update: impl FnMut(&Observation) -> Impedance) -> f64 {
    let (mut theta, mut covariance) = (Vector2::<f64>::zeros(), Matrix2::identity() * f64::from(COVARIANCE));
    let lambda = f64::from(FORGETTING);
    let errors = rows.iter().map(|o| {
        let phi = Vector2::new(f64::from(o.penetration), f64::from(o.rate));
        let spread = covariance * phi;
        let gain = spread / (lambda + phi.dot(&spread));
        theta += gain * (f64::from(o.force) - phi.dot(&theta));
        covariance = (covariance - gain * spread.transpose()) / lambda;
        f64::from(update(o).stiffness) / theta.x - 1.0
    });
    rms(&errors.collect::<Vec<_>>()[FIRST_SCORED_SAMPLE..])
}

fn windowed(rows: &[Observation], last: usize, mut update: impl FnMut(Recent<'_>) -> Impedance) -> f64 {
    let mut errors = Vec::new();
    for k in 0..rows.len() {
        let seen = &rows[(k + 1).saturating_sub(last)..=k];
        let got = f64::from(update(Recent::of(seen)).stiffness);
        if k >= FIRST_SCORED_SAMPLE {
            errors.push(got / least_squares(seen).x - 1.0);
        }
    }
    rms(&errors)
}

fn least_squares(rows: &[Observation]) -> Vector2<f64> {
    let (mut normal, mut right) = (Matrix2::<f64>::zeros(), Vector2::<f64>::zeros());
    for o in rows {
        let phi = Vector2::new(f64::from(o.penetration), f64::from(o.rate));
        normal += phi * phi.transpose();
        right += phi * f64::from(o.force);
    }
    normal.try_inverse().map_or_else(Vector2::zeros, |inverse| inverse * right)
}

fn block(law: &impl UpdateLaw, rows: &[Observation], last: usize) -> Option<f64> {
    let mut state = law.initial_state();
    Some(windowed(rows, last, |recent| law.update(&mut state, recent).estimate))
}

/// One step from the same estimate, for a descent left to itself is chaotic.
fn fourth(law: &impl UpdateLaw, rows: &[Observation], last: usize) -> Option<f64> {
    let (mut state, mut before, mut errors) = (law.initial_state(), Impedance::ZERO, Vec::new());
    for k in 0..rows.len() {
        let seen = &rows[(k + 1).saturating_sub(last)..=k];
        let after = law.update(&mut state, Recent::of(seen)).estimate;
        if k >= FIRST_SCORED_SAMPLE {
            errors.push(f64::from(after.stiffness) / fourth_step(seen, before).x - 1.0);
        }
        before = after;
    }
    Some(rms(&errors))
}

/// One exact step down the fourth power, in double precision: Newton on the slope, which rises everywhere.
fn fourth_step(rows: &[Observation], from: Impedance) -> Vector2<f64> {
    let from = Vector2::new(f64::from(from.stiffness), f64::from(from.damping));
    let phi = |o: &Observation| Vector2::new(f64::from(o.penetration), f64::from(o.rate));
    let terms = || rows.iter().map(|o| (phi(o), f64::from(o.force) - phi(o).dot(&from)));
    let u = terms().map(|(phi, e)| phi * e.powi(3)).sum::<Vector2<f64>>().normalize();
    let mut t = 0.0;
    for _ in 0..60 {
        let (slope, bend) = terms().fold((0.0, 0.0), |(slope, bend), (phi, e)| {
            let (p, left) = (phi.dot(&u), e - t * phi.dot(&u));
            (slope - p * left.powi(3), bend + 3.0 * (p * left).powi(2))
        });
        if bend > 0.0 {
            t -= slope / bend;
        }
    }
    from + u * t
}
