//! Terms of the drive as effects of the list: name, form, and parameters in its order.

use std::f64::consts::TAU;

use super::fit::Fit;
use super::law::Side;
use super::load_share::{HALF, OfHalves, possible};
use super::model::index;
use super::scales::Scales;
use super::term::Term;
use crate::effects::{Effect, Resolved, find, waves};

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
    let motor_share = || {
        let [least, most] = possible(term, &fit.model.scales, ends[2]);
        (1.0 - values[2], [1.0 - most, 1.0 - least])
    };
    // A value that is told with the load's share: over all shares that are possible.
    let of_share = |side: Side, factor: fn(OfHalves) -> f64, at: usize| {
        let at_share = |share: f64| factor(OfHalves::new(side, share));
        let [least, most] = possible(term, &fit.model.scales, ends[2]);
        // share (1 - share) is largest at a half, the other factors at an end.
        let all = [least, most, HALF.clamp(least, most)].map(at_share);
        let low = all.into_iter().fold(f64::INFINITY, f64::min);
        let high = all.into_iter().fold(0.0, f64::max);
        (at_share(values[2]) * values[at], [low * ends[at][0], high * ends[at][1]])
    };
    let friction_share = |side: Side, at: usize| {
        let (of_load, [low, high]) = of_share(side, |of| of.friction, at);
        let of_motor = |of_load: f64| 1.0 - of_load.min(1.0);
        (of_motor(of_load), [of_motor(high), of_motor(low)])
    };
    let (form, all) = match term {
        Term::Coulomb | Term::ConstantLoad | Term::EffortLimit | Term::EffortLag => (0, same(&[0])),
        Term::SmoothLimit => (1, same(&[0])),
        Term::LoadFriction | Term::ForceGain | Term::ForceDelay | Term::ToolInertia => (0, same(&[0])),
        Term::AsymmetricCoulomb => (1, same(&[0, 1])),
        Term::Stribeck => (0, same(&[0, 1, 2])),
        Term::Sublinear => (0, [same(&[0, 1]), vec![fixed(fit.model.scales.speed)]].concat()),
        Term::AngleLoad if fit.model.scales.is_rotary => (1, same(&[0, 1, 2])),
        Term::AngleLoad => (2, [same(&[0, 1]), vec![pitch(2)]].concat()),
        Term::Cogging => (0, [same(&[0, 1]), vec![pitch(2)]].concat()),
        Term::Ripples(2) => (2, [same(&[0, 1, 3, 4]), vec![pitch(2), pitch(5)]].concat()),
        Term::Ripples(count) => {
            let wave = |one: usize| [same(&[3 * one, 3 * one + 1]), vec![pitch(3 * one + 2)]].concat();
            (*count, (0..*count).flat_map(wave).collect())
        }
        Term::Compliance(side) => {
            let (stiffness, damping) = (of_share(*side, |of| of.stiffness, 0), of_share(*side, |of| of.stiffness, 1));
            let motor = (1.0 - values[2]) * fit.values[index::INERTIA];
            let ratio = |damping: f64| damping / (2.0 * (stiffness.0 * motor).sqrt());
            let damping_ratio = (ratio(damping.0), damping.1.map(ratio));
            (1, vec![stiffness, motor_share(), damping_ratio, friction_share(*side, 3)])
        }
        Term::Play(side) => {
            let (stiffness, gap) = (of_share(*side, |of| of.stiffness, 0), of_share(*side, |of| of.play, 3));
            (1, vec![gap, motor_share(), stiffness, friction_share(*side, 4)])
        }
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
    let of_halves = |motor_share: f64| OfHalves::new(encoder, 1.0 - motor_share);
    let found = match (resolved.effect.spec().name, resolved.form) {
        ("coulomb_friction", 0) => (Term::Coulomb, vec![v[0]]),
        ("coulomb_friction", _) => (Term::AsymmetricCoulomb, v[..2].to_vec()),
        ("stribeck_friction", _) => (Term::Stribeck, v[..3].to_vec()),
        ("sublinear_friction", _) => (Term::Sublinear, vec![v[0] * (scales.speed / v[2]).powf(v[1]), v[1]]),
        ("load_dependent_friction", _) => (Term::LoadFriction, vec![v[0]]),
        ("gravity_load", 0) => (Term::ConstantLoad, vec![v[0]]),
        ("gravity_load", 1) => (Term::AngleLoad, v[..3].to_vec()),
        ("gravity_load", _) => (Term::AngleLoad, vec![v[0], v[1], TAU / v[2]]),
        ("cogging", 0) => (Term::Cogging, vec![v[0], v[1], TAU / v[2]]),
        ("cogging", form) => {
            let waves: Vec<[f64; 3]> = waves(form, v).collect();
            (Term::Ripples(waves.len()), waves.concat())
        }
        ("effort_saturation", 0) => (Term::EffortLimit, vec![v[0]]),
        ("effort_saturation", _) => (Term::SmoothLimit, vec![v[0]]),
        ("effort_lag", _) => (Term::EffortLag, vec![v[0]]),
        ("force_gain", _) => (Term::ForceGain, vec![v[0]]),
        ("tool_inertia", _) => (Term::ToolInertia, vec![v[0]]),
        ("transmission_compliance", _) => {
            let link = [v[0], damping(v[0], v[1], v[2])].map(|value| value / of_halves(v[1]).stiffness);
            let friction = friction_share / of_halves(v[1]).friction;
            (Term::Compliance(encoder), vec![link[0], link[1], 1.0 - v[1], friction])
        }
        ("backlash", _) => {
            let link = [v[2], damping(v[2], v[1], 0.05)].map(|value| value / of_halves(v[1]).stiffness);
            let (gap, friction) = (v[0] / of_halves(v[1]).play, friction_share / of_halves(v[1]).friction);
            (Term::Play(encoder), vec![link[0], link[1], 1.0 - v[1], gap, friction])
        }
        _ => return None,
    };
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::drive::testing::{SCALES, fit_of};
    use crate::diagnose::interval::NORMAL_97_5;

    /// The stiffness of a play's flanks is fitted like its gap: an interval without width would be a claim that nothing backs.
    /// A link of 4e4 N/m with a gap of 0.2 mm in a rig file is the same law wherever the encoder is, and told as it was.
    #[test]
    fn what_a_rig_file_holds_of_a_link_is_told_again() {
        for (name, given) in [("backlash", [2e-4, 0.3, 4e4, 0.2]), ("transmission_compliance", [4e4, 0.3, 0.1, 0.2])] {
            for side in [Side::Motor, Side::Load] {
                let resolved = Resolved { effect: find(name).unwrap(), form: 1, values: given.to_vec() };
                let (term, own) = known(&resolved, &SCALES, side).unwrap();
                let fit = fit_of(&[term], &own);
                let link = fit.model.law(&fit.values).link.unwrap();
                let gap = if name == "backlash" { 2e-4 } else { 0.0 };
                assert!((link.stiffness / 4e4 - 1.0).abs() < 1e-12 && (link.play - gap).abs() < 1e-16, "{link:?}");
                let mut intervals: Vec<[f64; 2]> = fit.values.iter().map(|value| [*value, *value]).collect();
                intervals[6] = [0.4, 0.75];
                let told = named(&fit, &intervals, 0).unwrap();
                for (value, given) in told.values.iter().zip(given) {
                    assert!((value / given - 1.0).abs() < 1e-12, "{name} {side:?}: {:?}", told.values);
                }
                // The gap goes with 1 / (1 - share), the stiffness with share (1 - share), from the 0.7 that were given: over the shares from 0.2
                // to 0.5 + 1.96 times 0.2 that are believed where the load alone is seen and nothing is touched.
                let most = 0.5 + 0.2 * NORMAL_97_5;
                let expected = match (side, name) {
                    (Side::Motor, "backlash") => [2e-4, 2e-4],
                    (Side::Load, "backlash") => [2e-4 * 0.3 / 0.8, 2e-4 * 0.3 / (1.0 - most)],
                    (Side::Motor, _) => [4e4, 4e4],
                    (Side::Load, _) => [4e4 * most * (1.0 - most) / 0.21, 4e4 * 0.25 / 0.21],
                };
                for (end, expected) in told.intervals[0].iter().zip(expected) {
                    assert!((end / expected - 1.0).abs() < 1e-12, "{name} {side:?}: {:?}", told.intervals[0]);
                }
            }
        }
    }

    /// Each form of a cogging is the same waves in the model, and told as it was but for the form of two harmonics, which is one of two patterns.
    #[test]
    fn what_a_rig_file_holds_of_a_cogging_is_told_again() {
        let waves = [[0.1, -0.2, 0.5], [0.3, 0.0, 0.25], [0.05, 0.02, 0.125]];
        let two = |end: &[f64]| [&waves[0][..2], &waves[1][..2], end].concat();
        let forms = [(0, waves[0].to_vec(), 0), (1, two(&[0.5]), 2), (2, two(&[0.5, 0.25]), 2), (3, waves.concat(), 3)];
        for (form, values, told_form) in forms {
            let resolved = Resolved { effect: find("cogging").unwrap(), form, values: values.clone() };
            let (term, own) = known(&resolved, &SCALES, Side::Motor).unwrap();
            let fit = fit_of(&[term], &own);
            let intervals: Vec<[f64; 2]> = fit.values.iter().map(|value| [value - 0.01, value + 0.01]).collect();
            let told = named(&fit, &intervals, 0).unwrap();
            let expected = if form == 1 { two(&[0.5, 0.25]) } else { values };
            assert_eq!((told.form, told.values.len()), (told_form, expected.len()));
            for ((value, given), ends) in told.values.iter().zip(&expected).zip(&told.intervals) {
                assert!((value - given).abs() < 1e-12 && ends[0] < *value && *value < ends[1], "{:?}", told.values);
            }
        }
    }

    #[test]
    fn every_value_of_a_play_has_the_interval_of_its_fit() {
        let fit = fit_of(&[Term::Play(Side::Motor)], &[4e4, 30.0, 0.6, 2e-4, 0.7]);
        let intervals: Vec<[f64; 2]> = fit.values.iter().map(|value| [value - 0.1, value + 0.1]).collect();
        let play = named(&fit, &intervals, 0).unwrap();
        for ((value, ends), expected) in play.values.iter().zip(&play.intervals).zip([2e-4, 0.4, 4e4, 0.3]) {
            assert!((value / expected - 1.0).abs() < 1e-9, "{value}");
            assert!((ends[0] - (expected - 0.1)).abs() < 1e-9 && (ends[1] - (expected + 0.1)).abs() < 1e-9, "{ends:?}");
        }
    }
}
