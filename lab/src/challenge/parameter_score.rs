//! Parameters that mean the same in the cases and in the diagnosis, under names of their own.

use super::case_score::ParameterScore;
use super::diagnosis_json::PhysicsJson;
use palpate_cases::Truth;
use palpate_cases::truth::TrueEffect;

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
pub fn compare(truth: &Truth, physics: &[PhysicsJson]) -> Vec<ParameterScore> {
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
fn is_same_law(effect: &TrueEffect, parameter: &str) -> bool {
    let value = |name: &str| effect.parameters.iter().find(|value| value.name == name).map(|value| value.value);
    match effect.name {
        _ if parameter == "exponent" => true,
        "hunt_crossley_damping" => value("exponent").is_none_or(|exponent| (exponent - 1.0).abs() < 1e-6),
        "quadratic_damping" => value("exponent").is_none_or(|exponent| (exponent - 2.0).abs() < 1e-6),
        "stress_relaxation" => value("second_time_constant").is_none(),
        "gravity_load" => value("angle_zero").is_none(),
        _ => true,
    }
}
