//! Cases as others get them.

use std::collections::BTreeSet;

use palpate_cases::case_spec::CaseSpec;
use palpate_cases::effect::registry::{ALL, ActsIn, EffectInfo};
use palpate_cases::excitation::Excitation;
use palpate_cases::rng::{Stream, stream};
use palpate_cases::sensors::SensorGrade;
use palpate_cases::simulator::SupportedEffects;
use palpate_cases::{Case, CaseRequest, EffectSelection, draw};

fn request(selection: EffectSelection) -> CaseRequest {
    CaseRequest {
        selection: Some(selection),
        sensors: Some(SensorGrade::Fine),
        excitation: Some(Excitation::Rich),
        effort: Some(true),
        bilateral: Some(false),
        ..CaseRequest::default()
    }
}

fn all_reach(strength: f64, which: impl Fn(&EffectInfo) -> bool) {
    for known in ALL.iter().filter(|known| which(known)) {
        let case = draw(21, 2, &request(EffectSelection::single(known.name, Some(strength)))).unwrap();
        let found = &case.truth.effects[0];
        assert_eq!(found.name, known.name);
        assert!((found.strength / strength - 1.0).abs() < 0.05, "{}: {}", known.name, found.strength);
        assert_eq!(found.strength, case.truth.strength);
        assert!(found.parameters.iter().all(|parameter| parameter.value.is_finite()));
        match known.acts_in {
            // What acts in the drive does not show in the contact.
            ActsIn::Drive => assert!(found.in_force < 0.02 * strength, "{}: {}", known.name, found.in_force),
            ActsIn::Contact => assert!(found.in_effort < 0.02 * strength, "{}: {}", known.name, found.in_effort),
            ActsIn::Sensor => {}
        }
    }
}

#[test]
fn every_effect_of_the_contact_reaches_its_strength() {
    all_reach(2.0, |known| known.acts_in == ActsIn::Contact);
}

#[test]
fn every_effect_of_the_drive_reaches_its_strength() {
    all_reach(8.0, |known| known.acts_in == ActsIn::Drive);
}

#[test]
fn every_effect_of_the_sensor_reaches_its_strength() {
    all_reach(2.0, |known| known.acts_in == ActsIn::Sensor);
}

#[test]
fn the_list_is_the_one_that_was_agreed_on() {
    let count = |acts| ALL.iter().filter(|known| known.listed && known.acts_in == acts).count();
    assert_eq!((count(ActsIn::Contact), count(ActsIn::Drive), count(ActsIn::Sensor)), (12, 9, 8));
    assert!(ALL.iter().filter(|known| !known.listed).count() >= 8);
    assert_eq!(ALL.iter().map(|known| known.name).collect::<BTreeSet<_>>().len(), ALL.len());
}

#[test]
fn no_strength_is_nothing_to_the_bit() {
    let nothing = draw(22, 0, &request(EffectSelection::Nothing)).unwrap();
    assert!(nothing.truth.strength < 1e-2, "{}", nothing.truth.strength);
    for name in ["adhesion", "backlash", "effort_lag", "channel_delay", "thermal_wander"] {
        let none = draw(22, 0, &request(EffectSelection::single(name, Some(0.0)))).unwrap();
        assert_eq!(none.trials, nothing.trials, "{name}");
        assert_eq!(none.rig, nothing.rig, "{name}");
    }
    let names = Some(["backlash".to_owned(), "adhesion".to_owned()]);
    let pair = draw(22, 0, &request(EffectSelection::Pair { names, strength: Some(0.0) })).unwrap();
    assert_eq!(pair.trials, nothing.trials);
}

#[test]
fn a_case_is_its_seed_and_index() {
    let free = CaseRequest::default();
    let one = draw(23, 4, &free).unwrap();
    assert_eq!(one, draw(23, 4, &free).unwrap());
    assert_ne!(one.trials, draw(23, 5, &free).unwrap().trials);
    assert_ne!(one.trials, draw(24, 4, &free).unwrap().trials);
    assert_ne!(one.trials[0], one.trials[1]);
}

fn files(case: &Case, name: &str) -> Vec<(String, String)> {
    let folder = std::env::temp_dir().join(format!("palpate-cases-{}-{name}", std::process::id()));
    case.write(&folder).unwrap();
    let entries = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap());
    let mut all: Vec<_> = entries
        .map(|entry| (entry.file_name().into_string().unwrap(), std::fs::read_to_string(entry.path()).unwrap()))
        .collect();
    all.sort();
    std::fs::remove_dir_all(&folder).unwrap();
    all
}

#[test]
fn the_files_are_as_agreed_and_betray_nothing() {
    for (rotary, header) in [
        (false, "t_s,position_m,force_N,effort_N,reference_m"),
        (true, "t_s,position_rad,torque_Nm,effort_Nm,reference_rad"),
    ] {
        let request = CaseRequest {
            rotary: Some(rotary),
            bench: Some(true),
            ..request(EffectSelection::single("adhesion", Some(3.0)))
        };
        let all = files(&draw(25, 0, &request).unwrap(), header);
        let names: Vec<_> = all.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["rig.toml", "trial-1.csv", "trial-2.csv"]);
        assert!(!all.iter().any(|(_, text)| text.contains("adhesion")));
        let rig: toml::Table = all[0].1.parse().unwrap();
        assert_eq!(rig["rig"]["coordinate"].as_str(), Some(if rotary { "rotary" } else { "linear" }));
        assert!(rig["drive"].get(if rotary { "inertia_kg_m2" } else { "mass_kg" }).is_some());
        for (_, text) in &all[1..] {
            let mut lines = text.lines();
            assert_eq!(lines.next(), Some(header));
            let rows: Vec<Vec<f64>> =
                lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
            assert!((15_000..40_000).contains(&rows.len()), "{}", rows.len());
            assert!(rows.windows(2).all(|two| two[1][0] > two[0][0]));
            assert!(rows.iter().flatten().all(|value| value.is_finite()));
        }
    }
}

#[test]
fn what_is_not_recorded_is_in_no_file() {
    let request = CaseRequest { effort: Some(false), rotary: Some(false), ..request(EffectSelection::Nothing) };
    let all = files(&draw(26, 0, &request).unwrap(), "no-effort");
    assert!(!all[0].1.contains("[drive]"));
    assert!(all[1].1.starts_with("t_s,position_m,force_N,reference_m\n"));
}

#[test]
fn what_is_drawn_can_be_seen() {
    let rng = &mut stream(28, 0, Stream::Spec);
    for _ in 0..300 {
        let pair = EffectSelection::Pair { names: None, strength: None };
        let blind = CaseRequest { selection: Some(pair.clone()), effort: Some(false), ..CaseRequest::default() };
        let effects = CaseSpec::draw(&blind, SupportedEffects::OWN, rng).unwrap().effects;
        assert!(effects.iter().all(|(known, strength)| !known.needs_effort && (0.1..=10.0).contains(strength)));
        let glued = CaseRequest { selection: Some(pair), bilateral: Some(true), ..CaseRequest::default() };
        let effects = CaseSpec::draw(&glued, SupportedEffects::OWN, rng).unwrap().effects;
        assert!(effects.iter().all(|(known, _)| known.bilateral) && effects[0].0 != effects[1].0);
    }
}

#[test]
fn a_wish_that_hides_its_own_effect_is_refused() {
    let hidden = CaseRequest { effort: Some(false), ..request(EffectSelection::single("coulomb_friction", None)) };
    assert!(draw(27, 0, &hidden).unwrap_err().to_string().contains("coulomb_friction"));
    assert!(
        draw(27, 0, &request(EffectSelection::single("no_such", None))).unwrap_err().to_string().contains("no_such")
    );
}
