//! The sentence that tells two effects apart.

use palpate_lab::diagnose::experiment::separated_by;
use palpate_lab::diagnose::term::Term;
use palpate_lab::effects;

fn term(name: &str) -> Term {
    Term { effect: effects::find(name).unwrap(), form: 0 }
}

#[test]
fn what_no_motion_separates_says_so() {
    let says = |one: &str, other: &str, words: &[&str]| {
        for text in [separated_by(&term(one), &term(other)), separated_by(&term(other), &term(one))] {
            assert!(words.iter().all(|word| text.contains(word)), "{one}, {other}: {text}");
        }
    };
    says("transmission_compliance", "stress_relaxation", &["No motion", "drive's effort"]);
    says("force_gain", "nonlinear_stiffness", &["scale of stiffness", "no motion", "drive's effort"]);
    says("force_bias", "surface_motion", &["free space", "sensor"]);
    says("stress_relaxation", "channel_delay", &["hold"]);
    says("hunt_crossley_damping", "quadratic_damping", &["depth"]);
    says("tool_inertia", "environment_mass", &["free space"]);
}

#[test]
fn every_pair_of_effects_has_its_sentence() {
    let all = palpate_lab::effects::ALL;
    for one in all {
        for other in all {
            let [one, other] = [one, other].map(|effect| Term { effect, form: 0 });
            let text = separated_by(&one, &other);
            assert!(text.ends_with('.') && text.len() > 30, "{text}");
        }
    }
}
