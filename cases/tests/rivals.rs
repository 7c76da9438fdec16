//! The rivals on cases of ours, left out with a word where they have not been set up.

use std::path::PathBuf;

use palpate_cases::python::{self, Python};
use palpate_cases::reference::Kind;
use palpate_cases::rivals::Rival;
use palpate_cases::sensors::Grade;
use palpate_cases::{What, Wish, draw};

fn python() -> Option<Python> {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../target/python"));
    let home = std::env::var_os("PALPATE_PYTHON_HOME").map_or_else(beside, PathBuf::from);
    python::find(&home, &python::RIVALS).inspect_err(|missing| eprintln!("left out: {missing}")).ok()
}

fn named(rival: Rival, python: &Python, label: &str, what: What) -> (Vec<String>, f64) {
    let wish = Wish {
        what: Some(what),
        sensors: Some(Grade::Fine),
        reference: Some(Kind::Rich),
        effort: Some(true),
        bilateral: Some(false),
        ..Wish::default()
    };
    let folder = std::env::temp_dir().join(format!("palpate-{}-{label}-{}", rival.name(), std::process::id()));
    draw(41, 0, &wish).unwrap().write(&folder).unwrap();
    let finding = rival.look(python, &folder).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(finding.seconds > 0.0 && finding.held_out > 0.0 && ["N", "N m"].contains(&finding.unit.as_str()));
    (finding.named, finding.held_out / finding.refitted)
}

#[test]
fn a_rival_names_what_its_library_holds_when_it_is_strong() {
    let Some(python) = python() else { return };
    for rival in Rival::ALL {
        for (name, left) in [("hunt_crossley_damping", 0.75), ("tool_inertia", 0.75), ("coulomb_friction", 1.1)] {
            let (names, share) = named(rival, &python, name, What::single(name, Some(8.0)));
            assert!(names.iter().any(|one| one == name), "{rival:?} {name}: {names:?}");
            assert!(share < left, "{rival:?} {name}: {share} of the nominal residual");
        }
    }
}

#[test]
fn a_rival_says_nothing_of_nothing() {
    let Some(python) = python() else { return };
    for rival in Rival::ALL {
        let (names, share) = named(rival, &python, "nothing", What::Nothing);
        assert!(names.is_empty() && (0.9..1.2).contains(&share), "{rival:?}: {names:?} {share}");
    }
}

#[test]
fn a_folder_without_a_case_is_an_error() {
    let Some(python) = python() else { return };
    let error = Rival::Pysindy.look(&python, &std::env::temp_dir().join("palpate-no-case")).unwrap_err();
    assert!(error.to_string().contains("pysindy failed"), "{error}");
}
