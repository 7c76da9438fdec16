//! Forces that can be anything along one quantity: of no law, and a yardstick of those that are.

use super::course::{Along, Varying};
use super::fit::Fit;
use super::model::Model;
use super::scales::Scales;
use super::term::Term;

/// Knots of a curve over position.
const PLACE_KNOTS: usize = 24;

/// Knots of a course over the time of a trial: what warms up or wears does so slowly.
const TIME_KNOTS: usize = 6;

/// Knots of a course over the velocity, each way, the first of them at rest.
const VELOCITY_KNOTS: usize = 5;

/// A load by position.
#[must_use]
pub fn load_by_place(scales: &Scales) -> Term {
    Term::Curve { origin: scales.lowest, spacing: scales.travel / (PLACE_KNOTS - 1) as f64, count: PLACE_KNOTS }
}

/// Friction and effort that change, of those that `model` has.
pub fn courses(scales: &Scales, model: &Model) -> impl Iterator<Item = Term> + use<> {
    let scales = *scales;
    let rubs = model.terms.iter().any(Term::is_friction);
    let all = [
        (Varying::DryFriction, Along::Time),
        (Varying::DryFriction, Along::Place),
        (Varying::ViscousFriction, Along::Time),
        (Varying::ViscousFriction, Along::Place),
        (Varying::ViscousFriction, Along::Velocity),
        (Varying::Effort, Along::Time),
    ];
    all.into_iter().filter(move |(of, _)| rubs || *of != Varying::DryFriction).map(move |(of, along)| {
        let (origin, length, knots) = match along {
            Along::Time => (0.0, scales.duration_s, TIME_KNOTS),
            Along::Place => (scales.lowest, scales.travel, PLACE_KNOTS),
            Along::Velocity => (-scales.speed, scales.speed, VELOCITY_KNOTS),
        };
        let ways = if along == Along::Velocity { 2 } else { 1 };
        Term::Course { of, along, origin, spacing: length / (knots - 1) as f64, count: ways * knots }
    })
}

/// `fit` with `shape` beside it, which does nothing yet.
#[must_use]
pub fn shaped(fit: &Fit, shape: Term) -> Fit {
    let mut start = fit.clone();
    let count = shape.ranges(&fit.model.scales).len();
    start.model.terms.push(shape);
    start.values.extend(vec![0.0; count]);
    start
}
