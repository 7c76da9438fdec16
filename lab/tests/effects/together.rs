//! All effects by the same rules: off at zero, and each does something.

use crate::bench::{REFERENCE, apart, force, largest, rig, run, with};
use palpate_lab::effects::{ALL, Effect, ExcitationStats, to_table};
use palpate_lab::recording::Recording;
use palpate_lab::rig::{Rig, Sensors};

/// What the bench of these tests measures.
pub fn scene() -> ExcitationStats {
    ExcitationStats {
        depth: 9e-3,
        speed: 0.06,
        acceleration: 2.0,
        force: 3.0,
        pull: 0.0,
        half_pull_height: 0.0,
        effort: 7.0,
        travel: (-10e-3, 9e-3),
        duration: 4.0,
        step: 5e-3,
        sample: 1e-3,
        stiffness: 300.0,
        inertia: 0.8,
        visits: 16,
        releases: 2,
        way_back: 1.0,
        free_span: 0.4,
        longest_contact: 0.2,
        has_force: true,
        has_effort: true,
        is_rotary: false,
        is_bilateral: false,
    }
}

fn furthest(one: &Recording, other: &Recording) -> f64 {
    let effort = |recording: &Recording| recording.effort.clone().unwrap();
    apart(force(one), force(other)).max(apart(&one.position, &other.position)).max(apart(&effort(one), &effort(other)))
}

/// The first start of a form that is looked for from a simpler one alone.
fn refined_start(effect: &dyn Effect, form: usize) -> Option<Vec<f64>> {
    (0..form).find_map(|simpler| {
        let start = effect.starts(simpler, &scene()).into_iter().next().map(|start| start.values);
        let values = start.or_else(|| refined_start(effect, simpler))?;
        let (finer, starts) = effect.refined(simpler, &values, &scene())?;
        starts.into_iter().next().filter(|_| finer == form)
    })
}

#[test]
fn every_effect_runs_at_its_first_start_and_changes_something() {
    // A contact, and what is clamped at both sides: some laws are of the one or of the other.
    let free = rig(REFERENCE, true);
    let mut clamped = free.clone();
    clamped.contact.iter_mut().for_each(|contact| contact.bilateral = true);
    let [free, clamped] = [free, clamped].map(|rig| (run(&rig), rig));
    let mut tried = 0;
    for effect in ALL {
        let spec = effect.spec();
        for form in 0..spec.forms.len() {
            let start =
                |scene: &ExcitationStats| effect.starts(form, scene).into_iter().next().map(|start| start.values);
            let in_contact = start(&scene()).or_else(|| refined_start(effect, form)).map(|values| (values, &free));
            let in_clamp = || Some((start(&ExcitationStats { is_bilateral: true, ..scene() })?, &clamped));
            let Some((values, (truth, nominal))) = in_contact.or_else(in_clamp) else {
                // What is periodic in time starts from the strongest tone of the residual; what is so in position has no start.
                let begins = ["gravity_load", "cogging"].contains(&spec.name)
                    || effect.frequency_search(form, &scene()).is_some();
                assert!(begins, "{} {} has no start", spec.name, spec.forms[form].name);
                continue;
            };
            let table = to_table(effect, form, nominal.coordinate, &values, None);
            let recording = run(&Rig { effects: vec![table], ..nominal.clone() });
            let name = format!("{} {}", spec.name, spec.forms[form].name);
            let is_sound = |values: &[f64]| values.iter().all(|value| value.is_finite());
            assert!(is_sound(&recording.position) && is_sound(force(&recording)), "{name}: not finite");
            // A motor on a spring of 2 Hz, held by the position of its load: that loop does run away.
            let is_tame = largest(&recording.position) < 0.1 || spec.name == "transmission_compliance";
            assert!(is_tame, "{name}: the tool has run away");
            let apart = furthest(truth, &recording);
            assert!(apart > 3e-4, "{name}: {apart:.1e} of anything");
            tried += 1;
        }
    }
    assert!(tried >= 37, "{tried} laws");
}

#[test]
fn effects_of_zero_size_are_the_nominal_rig() {
    let nominal = rig(REFERENCE, true);
    let truth = run(&nominal);
    let off = [
        ("hunt_crossley_damping", "alpha_n_s_m2 = 0"),
        ("nonlinear_stiffness", "cubic_n_m3 = 0"),
        ("quadratic_damping", "quadratic_n_s2_m2 = 0"),
        ("stress_relaxation", "branch_stiffness_n_m = 0\nrelaxation_time_s = 1"),
        ("hysteresis", "loop_force_n = 0\nyield_depth_m = 1e-3"),
        ("plastic_set", "set_ratio = 0"),
        ("lost_motion", "play_m = 0"),
        ("surface_motion", "drift_m_s = 0"),
        ("environment_mass", "moved_mass_kg = 0"),
        ("coulomb_friction", "level_n = 0"),
        ("load_dependent_friction", "load_coefficient = 0"),
        ("gravity_load", "load_n = 0"),
        ("effort_lag", "time_constant_s = 0"),
        ("transmission_compliance", "link_stiffness_n_m = 0\nmotor_share = 0.02\ndamping_ratio = 0.005"),
    ];
    for (name, values) in off {
        let recording = run(&with(&nominal, &format!("[[effect]]\nname = \"{name}\"\n{values}\n")));
        let apart = furthest(&truth, &recording);
        // Another integrator: order two against four, and grazing releases.
        assert!(apart < 1e-4, "{name}: {apart:.1e}");
    }
}

#[test]
fn effects_of_the_sensor_of_zero_size_are_the_nominal_recording_to_the_bit() {
    let sensors = Sensors {
        position_resolution: Some(1e-4),
        force_resolution: Some(0.05),
        force_noise: Some(0.09),
        force_zero: None,
    };
    let nominal = Rig { sensors, ..rig(REFERENCE, true) };
    let off = "[[effect]]\nname = \"force_bias\"\nbias_n = 0\n[[effect]]\nname = \"tool_inertia\"\nbeyond_mass_kg = 0\n\
               [[effect]]\nname = \"channel_delay\"\ndelay_s = 0\n[[effect]]\nname = \"force_lag\"\ntime_constant_s = 0\n\
               [[effect]]\nname = \"force_gain\"\ngain_error = 0\n";
    assert_eq!(run(&with(&nominal, off)), run(&nominal));
}
