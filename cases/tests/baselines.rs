//! The baselines on cases of ours, left out with a word where they have not been set up.

use std::path::PathBuf;

use palpate_cases::baselines::Baseline;
use palpate_cases::excitation::Excitation;
use palpate_cases::python::{self, Python};
use palpate_cases::sensors::SensorGrade;
use palpate_cases::{CaseRequest, EffectSelection, draw};

fn python() -> Option<Python> {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../target/python"));
    let home = std::env::var_os("PALPATE_PYTHON_HOME").map_or_else(beside, PathBuf::from);
    python::find(&home, &python::BASELINES).inspect_err(|missing| eprintln!("left out: {missing}")).ok()
}

fn named(baseline: Baseline, python: &Python, label: &str, selection: EffectSelection) -> (Vec<String>, f64) {
    let request = CaseRequest {
        selection: Some(selection),
        sensors: Some(SensorGrade::Fine),
        excitation: Some(Excitation::Rich),
        effort: Some(true),
        bilateral: Some(false),
        ..CaseRequest::default()
    };
    let folder = std::env::temp_dir().join(format!("palpate-{}-{label}-{}", baseline.name(), std::process::id()));
    draw(41, 0, &request).unwrap().write(&folder).unwrap();
    let finding = baseline.run(python, &folder).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(finding.seconds > 0.0 && finding.held_out > 0.0 && ["N", "N m"].contains(&finding.unit.as_str()));
    (finding.named, finding.held_out / finding.refitted)
}

#[test]
fn a_baseline_names_what_its_library_holds_when_it_is_strong() {
    let Some(python) = python() else { return };
    for baseline in Baseline::ALL {
        for (name, left) in [("hunt_crossley_damping", 0.75), ("tool_inertia", 0.75), ("coulomb_friction", 1.1)] {
            let (names, share) = named(baseline, &python, name, EffectSelection::single(name, Some(8.0)));
            assert!(names.iter().any(|one| one == name), "{baseline:?} {name}: {names:?}");
            assert!(share < left, "{baseline:?} {name}: {share} of the nominal residual");
        }
    }
}

#[test]
fn a_baseline_names_nothing_where_nothing_is_missing() {
    let Some(python) = python() else { return };
    for baseline in Baseline::ALL {
        let (names, share) = named(baseline, &python, "nothing", EffectSelection::Nothing);
        assert!(names.is_empty() && (0.9..1.2).contains(&share), "{baseline:?}: {names:?} {share}");
    }
}

#[test]
fn a_folder_without_a_case_is_an_error() {
    let Some(python) = python() else { return };
    let error = Baseline::Pysindy.run(&python, &std::env::temp_dir().join("palpate-no-case")).unwrap_err();
    assert!(error.to_string().contains("pysindy failed"), "{error}");
}
