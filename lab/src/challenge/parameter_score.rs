//! Parameters that mean the same in the cases and in the diagnosis, under names of their own.

use super::case_score::ParameterScore;
use super::diagnosis_json::PhysicsJson;
use super::drawn_answer::{ConcealedEffect, DrawnAnswer};

/// Effect, parameter in the truth, parameter in the answer: the same law and the same unit.
const SAME_PARAMETERS: [[&str; 3]; 35] = [
    ["nonlinear_stiffness", "exponent", "exponent"],
    ["nonlinear_stiffness", "stiffening", "stiffening"],
    ["nonlinear_stiffness", "hardening", "cubic"],
    ["layered_stiffness", "layer_depth", "layer_depth"],
    ["hunt_crossley_damping", "alpha", "alpha"],
    ["hunt_crossley_damping", "exponent", "exponent"],
    ["quadratic_damping", "coefficient", "quadratic"],
    ["quadratic_damping", "exponent", "exponent"],
    ["stress_relaxation", "branch_stiffness", "branch_stiffness"],
    ["stress_relaxation", "time_constant", "relaxation_time"],
    ["hysteresis", "amplitude", "loop_force"],
    ["plastic_set", "set_ratio", "set_ratio"],
    ["adhesion", "pull_off", "pull_off_force"],
    ["lost_motion", "gap", "play"],
    ["time_varying_stiffness", "jump_time", "instant"],
    ["time_varying_stiffness", "time_constant", "time_constant"],
    ["surface_motion", "frequency", "frequency"],
    ["surface_motion", "velocity", "drift"],
    ["environment_mass", "mass", "moved_mass"],
    ["coulomb_friction", "coulomb", "level"],
    ["coulomb_friction", "coulomb_forward", "forward_level"],
    ["coulomb_friction", "coulomb_backward", "backward_level"],
    ["stribeck_friction", "coulomb", "level"],
    ["load_dependent_friction", "coefficient", "load_coefficient"],
    ["gravity_load", "load", "load"],
    ["cogging", "period", "pitch"],
    ["backlash", "gap", "gap"],
    ["transmission_compliance", "stiffness", "link_stiffness"],
    ["force_bias", "bias", "bias"],
    ["force_drift", "rate", "rate"],
    ["force_drift", "drift", "settled"],
    ["force_drift", "time_constant", "time_constant"],
    ["tool_inertia", "mass", "beyond_mass"],
    ["channel_delay", "delay", "delay"],
    ["mains_hum", "frequency", "frequency"],
];

/// Effects with one parameter of one name.
const SAME_NAMES: [[&str; 2]; 4] = [
    ["effort_saturation", "limit"],
    ["effort_lag", "time_constant"],
    ["force_lag", "time_constant"],
    ["force_saturation", "limit"],
];

/// What the answer's parameters are, held against the truth of the one effect concealed.
#[must_use]
pub fn compare(truth: &DrawnAnswer, physics: &[PhysicsJson]) -> Vec<ParameterScore> {
    // Several tables of one name are several branches: which is which is nobody's word.
    let ([effect], [found]) = (truth.effects.as_slice(), physics) else { return Vec::new() };
    let same = SAME_PARAMETERS.iter().map(|[name, theirs, ours]| (*name, *theirs, *ours));
    let alike = SAME_NAMES.iter().map(|[name, both]| (*name, *both, *both));
    same.chain(alike)
        .filter(|(name, theirs, _)| *name == effect.name && is_same_law(effect, theirs))
        .filter_map(|(name, theirs, ours)| {
            let truth = effect.parameters.iter().find(|value| value.name == theirs)?;
            let value = found.parameters.iter().find(|value| value.name == ours)?;
            let [low, high] = value.ci95;
            let covered = low.is_none_or(|low| low <= truth.value) && high.is_none_or(|high| truth.value <= high);
            // Another unit is another quantity, whatever the table says.
            let estimate = value.value.filter(|_| truth.unit == value.unit)?;
            Some(ParameterScore { name: format!("{name} {ours}"), truth: truth.value, value: estimate, covered })
        })
        .filter(|compared| compared.truth != 0.0)
        .collect()
}

/// A damping in another power of depth or speed, two branches seen as one and a weight by angle have other parameters;
/// the power itself is the same everywhere.
fn is_same_law(effect: &ConcealedEffect, parameter: &str) -> bool {
    let value = |name: &str| effect.parameters.iter().find(|value| value.name == name).map(|value| value.value);
    match effect.name.as_str() {
        _ if parameter == "exponent" => true,
        "hunt_crossley_damping" => value("exponent").is_none_or(|exponent| (exponent - 1.0).abs() < 1e-6),
        "quadratic_damping" => value("exponent").is_none_or(|exponent| (exponent - 2.0).abs() < 1e-6),
        "stress_relaxation" => value("second_time_constant").is_none(),
        "gravity_load" => value("angle_zero").is_none(),
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn concealed(name: &str, parameters: &[(&str, f64, &str)]) -> DrawnAnswer {
        let parameter = |(name, value, unit): &(&str, f64, &str)| json!({"name": name, "value": value, "unit": unit});
        let parameters: Vec<_> = parameters.iter().map(parameter).collect();
        let effects = json!([{"name": name, "parameters": parameters, "strength_asked": 2.0}]);
        let answer = json!({
            "source": "own", "seed": 1, "index": 7, "kind": "single", "strength": 2.0, "grade": "fine", "reference": "rich",
            "effects": effects, "channels": [],
        });
        serde_json::from_value(answer).unwrap()
    }

    fn found(name: &str, parameter: &str, value: f64, unit: &str, ci95: Value) -> Vec<PhysicsJson> {
        let parameter = json!({"name": parameter, "value": value, "unit": unit, "ci95": ci95});
        serde_json::from_value(json!([{"name": name, "parameters": [parameter]}])).unwrap()
    }

    #[test]
    fn an_interval_covers_the_truth_or_does_not() {
        let truth = concealed("adhesion", &[("pull_off", 2.0, "N")]);
        for (ci95, covered) in [
            (json!([1.5, 2.5]), true),
            (json!([2.0, 2.5]), true),
            (json!([1.5, 2.0]), true),
            (json!([2.1, 2.5]), false),
            (json!([1.5, 1.9]), false),
            (json!([null, 2.5]), true),
            (json!([null, 1.9]), false),
            (json!([1.5, null]), true),
            (json!([2.1, null]), false),
            (json!([null, null]), true),
        ] {
            let scored = compare(&truth, &found("adhesion", "pull_off_force", 2.2, "N", ci95.clone()));
            let [one] = scored.as_slice() else { panic!("{scored:?}") };
            assert_eq!((one.covered, one.truth, one.value), (covered, 2.0, 2.2), "{ci95}");
            assert!((one.error() - 0.1).abs() < 1e-12);
        }
    }

    #[test]
    fn only_the_same_parameter_of_the_same_law_in_the_same_unit_is_compared() {
        let interval = || json!([1.0, 3.0]);
        let count = |truth: &DrawnAnswer, name: &str, parameter: &str, unit: &str| {
            compare(truth, &found(name, parameter, 2.0, unit, interval())).len()
        };
        let adhesion = concealed("adhesion", &[("pull_off", 2.0, "N")]);
        assert_eq!(count(&adhesion, "adhesion", "pull_off_force", "N"), 1);
        assert_eq!(count(&adhesion, "adhesion", "pull_off_force", "N m"), 0, "another unit");
        assert_eq!(count(&adhesion, "adhesion", "length", "N"), 0, "another parameter");
        assert_eq!(count(&concealed("adhesion", &[("pull_off", 0.0, "N")]), "adhesion", "pull_off_force", "N"), 0);
        let damping =
            |exponent| concealed("hunt_crossley_damping", &[("alpha", 2.0, "u"), ("exponent", exponent, "1")]);
        assert_eq!(count(&damping(1.0), "hunt_crossley_damping", "alpha", "u"), 1);
        assert_eq!(count(&damping(1.3), "hunt_crossley_damping", "alpha", "u"), 0, "another power, another alpha");
        assert_eq!(count(&damping(1.3), "hunt_crossley_damping", "exponent", "1"), 1);
    }

    #[test]
    fn a_law_with_a_parameter_of_its_own_is_another_law() {
        let count = |name: &str, theirs: &str, ours: &str, own: Option<(&str, f64)>| {
            let parameters = [Some((theirs, 2.0)), own].into_iter().flatten().map(|(name, value)| (name, value, "u"));
            let truth = concealed(name, &parameters.collect::<Vec<_>>());
            compare(&truth, &found(name, ours, 2.0, "u", json!([1.0, 3.0]))).len()
        };
        let drag = |exponent| count("quadratic_damping", "coefficient", "quadratic", Some(("exponent", exponent)));
        assert_eq!([drag(2.0), drag(1.5), drag(2.5)], [1, 0, 0]);
        let branch = |own| count("stress_relaxation", "branch_stiffness", "branch_stiffness", own);
        assert_eq!([branch(None), branch(Some(("second_time_constant", 3.0)))], [1, 0]);
        let weight = |own| count("gravity_load", "load", "load", own);
        assert_eq!([weight(None), weight(Some(("angle_zero", 3.0)))], [1, 0]);
        assert_eq!(count("adhesion", "pull_off", "pull_off_force", Some(("angle_zero", 3.0))), 1);
    }
}
