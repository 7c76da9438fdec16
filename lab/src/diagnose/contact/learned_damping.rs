//! What no law of the list explains where it goes with the speed in contact, learned as a curve over that.

use nalgebra::DMatrix;

use super::data::Data;
use super::fit::{Effort, Fit};
use super::free_curve::{Curve, columns, speeds};
use super::held_out::Folds;
use super::learned::share_that_pays;
use super::model::{ContactModel, index};
use super::rest::Rest;
use crate::diagnose::interval::NORMAL_97_5;
use crate::diagnose::linalg::{energy, gram, solve};
use crate::diagnose::term::Term;
use crate::effects::{DAMPING_BY_SPEED, DAMPING_BY_SPEED_AND_DEPTH, DAMPING_KNOTS, LEARNED_DAMPING};

/// A law with an element over the speed behind its other terms.
#[derive(Debug, Clone)]
pub struct DampingCurve {
    /// The law, the element last.
    pub fit: Fit,
    /// What it leaves of rows that taught nothing, N or N m, a column a trial.
    pub residual: Vec<Vec<f64>>,
    /// Share of the power above the noise that it takes there of what the law without it leaves.
    pub held_out_share: f64,
    /// Covariance of the forces at the knots.
    pub covariance: DMatrix<f64>,
    /// Whether its forces grow with the depth.
    pub grows_with_depth: bool,
}

/// The knot at rest.
const REST: usize = DAMPING_KNOTS / 2;

impl DampingCurve {
    /// The fastest knot, and the force there with the half-width of its 95 % interval: inwards, and outwards.
    #[must_use]
    pub fn ends(&self) -> (f64, [[f64; 2]; 2]) {
        let knots = &self.fit.values[self.fit.values.len() - 2 * DAMPING_KNOTS..];
        let of =
            |knot: usize| [knots[DAMPING_KNOTS + knot], NORMAL_97_5 * self.covariance[(knot, knot)].max(0.0).sqrt()];
        (knots[DAMPING_KNOTS - 1], [of(DAMPING_KNOTS - 1), of(0)])
    }
}

/// The element over the speed that takes most of what `law` leaves, by the `curve` of its kind; `None` where unseen rows do not pay for it, or where that is none.
#[must_use]
pub(super) fn learned_damping(data: &Data<'_>, law: &Fit, curve: Curve) -> Option<DampingCurve> {
    let element = Element::of(data, law, curve)?;
    let folds = Folds::of(data);
    let [first, second] = [0, 1].map(|half| element.fitted(&folds.masked(data, half)));
    let unseen = folds.judged(data, &element.model, [first?.values, second?.values]);
    let held_out_share = share_that_pays(data, &folds.held_out(data, law), &unseen)?;
    let fit = element.fitted(data)?;
    let covariance = element.covariance(data, &fit)?;
    let grows_with_depth = curve == Curve::SpeedTimesDepth;
    Some(DampingCurve { residual: unseen.residual, held_out_share, covariance, grows_with_depth, fit })
}

/// `law` with a `curve` over the speed, fitted to `data`; `None` where it is none over the speed.
#[must_use]
pub(super) fn with_damping(data: &Data<'_>, law: &Fit, curve: Curve) -> Option<Fit> {
    Element::of(data, law, curve)?.fitted(data)
}

/// An element over the speed beside a law.
///
/// The force at rest is zero, as a constant is a place of the surface, or a stiffness; and where it does not grow with the depth the damping stays the law's, as a straight line of
/// the speed is damping.
struct Element<'a> {
    law: &'a Fit,
    curve: Curve,
    /// The law with it.
    model: ContactModel,
    /// Its values before the forces at the knots, the last of them the speeds.
    before: Vec<f64>,
}

impl<'a> Element<'a> {
    fn of(data: &Data<'_>, law: &'a Fit, curve: Curve) -> Option<Self> {
        let form = match curve {
            Curve::Speed => DAMPING_BY_SPEED,
            Curve::SpeedTimesDepth => DAMPING_BY_SPEED_AND_DEPTH,
            Curve::Place | Curve::PlaceAndDirection => return None,
        };
        let mut before = law.values.clone();
        before.extend((curve == Curve::SpeedTimesDepth).then_some(law.model.scales.depth));
        before.extend(speeds(data, law));
        Some(Self { law, curve, model: law.model.with(Term { effect: LEARNED_DAMPING, form }), before })
    }

    /// Whether value `at` of the model stays.
    fn is_held(&self, at: usize) -> bool {
        at == self.before.len() + REST || at == index::DAMPING && self.curve == Curve::Speed
    }

    /// Which of `values` of `model` are fitted.
    fn free(&self, model: &ContactModel, values: &[f64]) -> Vec<usize> {
        let ranges = model.ranges(values);
        (0..values.len()).filter(|at| ranges[*at].free && !self.is_held(*at)).collect()
    }

    /// The law with it by the rows of `data`.
    fn fitted(&self, data: &Data<'_>) -> Option<Fit> {
        let start: Vec<f64> = self.before.iter().copied().chain(self.forces(data)?).collect();
        Some(data.fit_holding(&self.model, &start, Effort::QUICK, &|at| self.is_held(at)))
    }

    /// The forces at the knots, to first order beside the law's values.
    fn forces(&self, data: &Data<'_>) -> Option<Vec<f64>> {
        let Fit { model, values, .. } = self.law;
        let left = data.weighted_residual(model, values);
        let mut all = data.columns(model, values, &model.ranges(values), &self.free(model, values), &left);
        let others = all.len();
        let mut own = columns(data, self.law, self.curve, &self.before[self.before.len() - DAMPING_KNOTS..]);
        let is_met = |knot: &usize| *knot != REST && energy(&own[*knot]) > 0.0;
        let met: Vec<usize> = (0..DAMPING_KNOTS).filter(is_met).collect();
        all.extend(met.iter().map(|knot| std::mem::take(&mut own[*knot])));
        let found = solve(&all.into_iter().enumerate().collect::<Vec<_>>(), &left)?;
        let mut forces = [0.0; DAMPING_KNOTS];
        met.iter().zip(found.iter().skip(others)).for_each(|(knot, force)| forces[*knot] = *force);
        // A speed that was not met has the force of the next one that was.
        for knot in (0..REST).rev().filter(|knot| !met.contains(knot)) {
            forces[knot] = forces[knot + 1];
        }
        for knot in (REST + 1..DAMPING_KNOTS).filter(|knot| !met.contains(knot)) {
            forces[knot] = forces[knot - 1];
        }
        Some(forces.into())
    }

    /// Covariance of the forces of `fit`: by the curvature of least squares, rows that tell no more than one counted once.
    fn covariance(&self, data: &Data<'_>, fit: &Fit) -> Option<DMatrix<f64>> {
        let base = data.weighted_residual(&fit.model, &fit.values);
        let (ranges, free) = (fit.model.ranges(&fit.values), self.free(&fit.model, &fit.values));
        let mut columns = data.columns(&fit.model, &fit.values, &ranges, &free, &base);
        let rest = Rest::of(data, fit);
        let power = rest.power * rest.correlated_rows;
        for (column, at) in columns.iter_mut().zip(&free).filter(|(_, at)| **at >= self.before.len()) {
            column.iter_mut().for_each(|slope| *slope /= ranges[*at].size);
        }
        let mut curvature = gram(&columns);
        // Of a speed that was not met it is known that the force is no more than the range of the recorded one.
        for at in (0..free.len()).filter(|at| free[*at] >= self.before.len()) {
            curvature[(at, at)] += power * self.model.scales.force.powi(-2);
        }
        let inverse = curvature.cholesky()?.inverse() * power;
        let place = |knot: usize| free.iter().position(|at| *at == self.before.len() + knot);
        Some(DMatrix::from_fn(DAMPING_KNOTS, DAMPING_KNOTS, |a, b| match (place(a), place(b)) {
            (Some(a), Some(b)) => inverse[(a, b)],
            _ => 0.0,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::held_out::rms;
    use super::super::learned::Learned;
    use super::super::nominal::nominal_fit;
    use super::super::testing::{FORCE_NOISE, TestContact};
    use super::*;

    /// A valve adds 8 N s/m on the way in alone, in proportion to the depth or not: damping and curve together are the damper's force, and unseen rows are left
    /// with the noise.
    #[test]
    fn a_damper_that_differs_by_direction_is_learned_over_the_speed() {
        for curve in [Curve::Speed, Curve::SpeedTimesDepth] {
            let deepest = TestContact::PLAIN.trial(1).position.iter().copied().fold(0.0, f64::max);
            let valve = |x: f64, v: f64| {
                let part = if curve == Curve::Speed { f64::from(x > 0.0) } else { x.max(0.0) / deepest };
                8.0 * v.max(0.0) * part
            };
            let trials = [1, 2].map(|seed| TestContact::PLAIN.trial_beside(seed, valve));
            let data = Data::new(&trials);
            let law = nominal_fit(&data, &TestContact::nominal());
            let found = learned_damping(&data, &law, curve).expect("unseen rows pay for it");
            assert!(found.held_out_share > 0.9, "{curve:?}: {}", found.held_out_share);
            // The encoder adds 0.6 mN.
            let left = rms(&data, &found.residual);
            assert!((left / FORCE_NOISE - 1.0).abs() < 0.05, "{curve:?}: {left} N");
            let (speed, [[inwards, in_half], [outwards, out_half]]) = found.ends();
            // The knot at rest is held, and has no interval.
            let ends = Learned::OverSpeed(found.clone()).intervals(&vec![[0.0; 2]; law.values.len()]);
            let forces = &ends[ends.len() - DAMPING_KNOTS..];
            assert!((0..DAMPING_KNOTS).all(|knot| forces[knot][0].is_finite() == (knot != REST)), "{forces:?}");
            // What the nominal damping has besides is the line that both ways share.
            let by_valve = inwards + outwards;
            let half = in_half.hypot(out_half);
            assert!((by_valve - 8.0 * speed).abs() < 2.0 * half, "{curve:?}: {by_valve} N at {speed} m/s, to {half} N");
        }
    }
}
