//! Terms of the drive as effects of the list: name, form, and parameters in its order.

use std::f64::consts::TAU;

use super::fit::Fit;
use super::law::Side;
use super::model::index;
use super::scales::Scales;
use super::term::Term;
use crate::effects::{Effect, Resolved, find};

/// An effect of the list with its values and their 95 % intervals.
pub struct NamedEffect {
    /// Which one.
    pub effect: &'static dyn Effect,
    /// Index of its form.
    pub form: usize,
    /// In the order of the form's parameters.
    pub values: Vec<f64>,
    /// 95 % interval of each.
    pub intervals: Vec<[f64; 2]>,
}

impl NamedEffect {
    /// As the list has it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.effect.spec().name
    }
}

/// Term `at` of `fit` as an effect; `None` for a term that is no effect of the list.
#[must_use]
pub fn named(fit: &Fit, intervals: &[[f64; 2]], at: usize) -> Option<NamedEffect> {
    let own = fit.model.values_of(at);
    let (values, ends) = (&fit.values[own.clone()], &intervals[own]);
    let term = &fit.model.terms[at];
    let same = |from: &[usize]| -> Vec<(f64, [f64; 2])> { from.iter().map(|at| (values[*at], ends[*at])).collect() };
    let fixed = |value: f64| (value, [value, value]);
    let pitch = |at: usize| (TAU / values[at], [TAU / ends[at][1], TAU / ends[at][0]]);
    let of_motor = |of_load: usize| (1.0 - values[of_load], [1.0 - ends[of_load][1], 1.0 - ends[of_load][0]]);
    let (form, all) = match term {
        Term::Coulomb | Term::ConstantLoad | Term::EffortLimit | Term::EffortLag => (0, same(&[0])),
        Term::LoadFriction | Term::ForceGain | Term::ForceDelay | Term::ToolInertia => (0, same(&[0])),
        Term::AsymmetricCoulomb => (1, same(&[0, 1])),
        Term::Stribeck => (0, same(&[0, 1, 2])),
        Term::Sublinear => (0, [same(&[0, 1]), vec![fixed(fit.model.scales.speed)]].concat()),
        Term::AngleLoad if fit.model.scales.is_rotary => (1, same(&[0, 1, 2])),
        Term::AngleLoad => (2, [same(&[0, 1]), vec![pitch(2)]].concat()),
        Term::Cogging => (0, [same(&[0, 1]), vec![pitch(2)]].concat()),
        Term::Compliance(_) => {
            let motor = (1.0 - values[2]) * fit.values[index::INERTIA];
            let ratio = |damping: f64| damping / (2.0 * (values[0] * motor).sqrt());
            let damping_ratio = (ratio(values[1]), ends[1].map(ratio));
            (1, vec![(values[0], ends[0]), of_motor(2), damping_ratio, of_motor(3)])
        }
        Term::Play(_) => (1, vec![(values[3], ends[3]), of_motor(2), (values[0], ends[0]), of_motor(4)]),
        Term::Presliding | Term::LoadScale | Term::Course { .. } | Term::Curve { .. } => return None,
    };
    let (values, intervals) = all.into_iter().unzip();
    Some(NamedEffect { effect: find(term.name())?, form, values, intervals })
}

/// The term, with values to start from, of an effect that a rig file already holds; `None` where the drive's model has no such term.
#[must_use]
pub fn known(resolved: &Resolved, scales: &Scales, encoder: Side) -> Option<(Term, Vec<f64>)> {
    let v = &resolved.values;
    let damping = |stiffness: f64, motor_share: f64, ratio: f64| {
        2.0 * ratio * (stiffness * motor_share * scales.inertia).max(0.0).sqrt()
    };
    // Of the load; all of it where the form has none on the motor.
    let friction_share = if resolved.form == 0 { 1.0 } else { 1.0 - v.last().copied().unwrap_or(0.0) };
    let found = match (resolved.effect.spec().name, resolved.form) {
        ("coulomb_friction", 0) => (Term::Coulomb, vec![v[0]]),
        ("coulomb_friction", _) => (Term::AsymmetricCoulomb, v[..2].to_vec()),
        ("stribeck_friction", _) => (Term::Stribeck, v[..3].to_vec()),
        ("sublinear_friction", _) => (Term::Sublinear, vec![v[0] * (scales.speed / v[2]).powf(v[1]), v[1]]),
        ("load_dependent_friction", _) => (Term::LoadFriction, vec![v[0]]),
        ("gravity_load", 0) => (Term::ConstantLoad, vec![v[0]]),
        ("gravity_load", 1) => (Term::AngleLoad, v[..3].to_vec()),
        ("gravity_load", _) => (Term::AngleLoad, vec![v[0], v[1], TAU / v[2]]),
        ("cogging", _) => (Term::Cogging, vec![v[0], v[1], TAU / v.last()?]),
        ("effort_saturation", _) => (Term::EffortLimit, vec![v[0]]),
        ("effort_lag", _) => (Term::EffortLag, vec![v[0]]),
        ("force_gain", _) => (Term::ForceGain, vec![v[0]]),
        ("tool_inertia", _) => (Term::ToolInertia, vec![v[0]]),
        ("transmission_compliance", _) => {
            (Term::Compliance(encoder), vec![v[0], damping(v[0], v[1], v[2]), 1.0 - v[1], friction_share])
        }
        ("backlash", _) => {
            (Term::Play(encoder), vec![v[2], damping(v[2], v[1], 0.05), 1.0 - v[1], v[0], friction_share])
        }
        _ => return None,
    };
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::super::model::Model;
    use super::super::noise::Noise;
    use super::*;
    use crate::diagnose::drive::levenberg_marquardt::Ended;
    use crate::diagnose::drive::testing::SCALES;

    /// The stiffness of a play's flanks is fitted like its gap: an interval without width would be a claim that nothing backs.
    #[test]
    fn every_value_of_a_play_has_the_interval_of_its_fit() {
        let fit = Fit {
            model: Model { terms: vec![Term::Play(Side::Motor)], scales: SCALES },
            values: vec![0.8, 4.0, 0.0, 0.0, 4e4, 30.0, 0.6, 2e-4, 0.7],
            noise: Noise { ln_disturbance: -11.0, ln_encoder: -24.0 },
            log_likelihood: 0.0,
            ended: Ended::Converged,
        };
        let intervals: Vec<[f64; 2]> = fit.values.iter().map(|value| [value - 0.1, value + 0.1]).collect();
        let play = named(&fit, &intervals, 0).unwrap();
        for ((value, ends), expected) in play.values.iter().zip(&play.intervals).zip([2e-4, 0.4, 4e4, 0.3]) {
            assert!((value / expected - 1.0).abs() < 1e-9, "{value}");
            assert!((ends[0] - (expected - 0.1)).abs() < 1e-9 && (ends[1] - (expected + 0.1)).abs() < 1e-9, "{ends:?}");
        }
    }
}
