//! Effects in a rig file.

use std::fs;

use assert_cmd::Command;
use palpate_lab::effects::{ALL, Resolved, find, resolve_all, to_table};
use palpate_lab::rig::{Coordinate, Rig};
use predicates::str::contains;

use crate::bench::{REFERENCE, rig};
use crate::together::scene;

#[test]
fn every_effect_comes_back_from_its_table_to_the_bit() {
    let head = |coordinate: Coordinate| {
        Rig::parse(&format!("[rig]\nname = \"r\"\ncoordinate = \"{}\"\n", coordinate.name()), "rig.toml").unwrap()
    };
    for (coordinate, effect) in [Coordinate::Linear, Coordinate::Rotary].into_iter().flat_map(|c| ALL.map(|e| (c, e))) {
        for form in 0..effect.spec().forms.len() {
            for start in effect.starts(form, &scene()) {
                // Numbers with all their digits.
                let values: Vec<_> = start.values.iter().map(|value| value * (1.0 + 1e-3 / 3.0)).collect();
                let intervals: Vec<_> =
                    values.iter().map(|value| (value - 1e-7, f64::INFINITY.min(value + 0.1))).collect();
                let table = to_table(effect, form, coordinate, &values, Some(&intervals));
                let rig = Rig { effects: vec![table], ..head(coordinate) };
                let again = Rig::parse(&rig.to_toml(), "again.toml").unwrap();
                assert_eq!(again, rig, "{}", rig.to_toml());
                let resolved = Resolved::read(&again.effects[0], coordinate, "again.toml").map_err(|e| e.to_string());
                let resolved = resolved.map(|found| (found.effect.spec().name, found.form, found.values));
                assert_eq!(resolved, Ok((effect.spec().name, form, values)), "{}", rig.to_toml());
            }
        }
    }
}

#[test]
fn an_interval_stands_beside_its_value_and_an_open_one_is_left_out() {
    let effect = find("coulomb_friction").unwrap();
    let bounds = [(0.1, 0.3), (0.2, f64::INFINITY)];
    let table = to_table(effect, 1, Coordinate::Linear, &[0.2, 0.4], Some(&bounds));
    let text = Rig { effects: vec![table], ..rig(REFERENCE, true) }.to_toml();
    for line in ["\"form\" = \"asymmetric\"", "\"forward_level_n\" = 0.2", "\"forward_level_ci95_n\" = [0.1, 0.3]"] {
        assert!(text.contains(line), "{text} lacks {line}");
    }
    assert!(!text.contains("backward_level_ci95"), "{text}");
}

#[test]
fn the_form_follows_from_the_keys_where_it_is_not_named() {
    let form = |text: &str| {
        let rig = Rig::parse(&(rig(REFERENCE, true).to_toml() + "[[effect]]\n" + text), "rig.toml").unwrap();
        let effects = resolve_all(&rig, "rig.toml").map_err(|error| error.to_string()).unwrap();
        (effects[0].effect.spec().forms[effects[0].form].name, effects[0].values.clone())
    };
    assert_eq!(form("name = \"force_drift\"\nrate_n_s = 1\n"), ("ramp", vec![1.0]));
    assert_eq!(form("name = \"force_drift\"\nrate_n_s = 1\noffset_n = 2\n"), ("offset_ramp", vec![1.0, 2.0]));
    assert_eq!(form("name = \"plastic_set\"\nset_ratio = 0.5\nyield_depth_m = 1e-3\n"), ("yield", vec![0.5, 1e-3]));
    assert_eq!(form("name = \"time_varying_stiffness\"\nchange = 0.5\ntime_constant_s = 3\n").0, "settling");
    let attraction = "name = \"adhesion\"\nform = \"attraction\"\npull_off_force_n = 1\nrelease_height_m = 1e-3\n";
    assert_eq!(form(attraction).0, "attraction");
    assert_eq!(form(&attraction.replace("form = \"attraction\"\n", "")).0, "neck", "the simplest that fits");
}

/// `palpate simulate` on the bench with `table` ends with status 1 and says all of `words`.
fn refuses(head: &str, table: &str, words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let (path, out) = (folder.path().join("odd.toml"), folder.path().join("out.csv"));
    fs::write(&path, format!("{head}[[effect]]\n{table}\n")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_palpate"));
    let assert = command.args(["simulate", "--rig"]).arg(&path).arg("--out").arg(&out).assert().code(1).stdout("");
    words.iter().fold(assert.stderr(contains("odd.toml: [[effect]]")), |assert, word| assert.stderr(contains(*word)));
    assert!(!out.exists(), "no output is left");
}

#[test]
fn a_table_at_fault_is_told_by_key_finding_and_expectation() {
    let head = rig(REFERENCE, true).to_toml();
    let bench = |table: &str, words: &[&str]| refuses(&head, table, words);
    bench("name = \"hunt_crosley_damping\"\nalpha_n_s_m2 = 1", &["hunt_crosley", "hunt_crossley_damping perhaps"]);
    bench("name = \"hunt_crossley_damping\"\nalpha_n_s_m = 1", &["found an unknown key", "alpha_n_s_m2 perhaps"]);
    bench("name = \"hunt_crossley_damping\"\nalpha_n_m_s_rad2 = 1", &["a rotary rig in a linear one", "alpha_n_s_m2"]);
    bench("name = \"hunt_crossley_damping\"", &["alpha_n_s_m2: found nothing", "growth of the damping with depth"]);
    bench("name = \"hunt_crossley_damping\"\nalpha_n_s_m2 = -1", &["found -1", "0 or above"]);
    bench("name = \"hunt_crossley_damping\"\nalpha_n_s_m2 = \"much\"", &["found \"much\"", "a number"]);
    bench("name = \"plastic_set\"\nset_ratio = 1.5", &["found 1.5", "from 0 to 0.98"]);
    bench("name = \"adhesion\"\nform = \"attracton\"\npull_off_force_n = 1", &["attraction perhaps"]);
    let interval = "name = \"force_bias\"\nbias_n = 1\nbias_ci95_n";
    bench(&format!("{interval} = [2, 1]"), &["bias_ci95_n", "[2, 1]", "the lower first"]);
    bench(&format!("{interval} = 3"), &["bias_ci95_n", "two ends"]);
    let no_drive = rig(REFERENCE, false).to_toml();
    refuses(&no_drive, "name = \"coulomb_friction\"\nlevel_n = 1", &["a rig without [drive]", "a table [drive]"]);
}

#[test]
fn a_model_with_effects_is_simulated_in_the_rigs_place_and_without_any_it_is_the_rig() {
    let folder = tempfile::tempdir().unwrap();
    let simulate = |name: &str, table: &str| {
        let (rig_file, model, out) = ("rig.toml", format!("{name}.toml"), format!("{name}.csv"));
        fs::write(folder.path().join(rig_file), rig(REFERENCE, true).to_toml()).unwrap();
        fs::write(folder.path().join(&model), rig(REFERENCE, true).to_toml() + table).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_palpate"));
        command.current_dir(&folder).args(["simulate", "--rig", rig_file, "--out", &out]);
        if name != "nominal" {
            command.args(["--model", &model]);
        }
        command.assert().success();
        fs::read_to_string(folder.path().join(out)).unwrap()
    };
    let nominal = simulate("nominal", "");
    assert_eq!(simulate("same", ""), nominal);
    assert_ne!(simulate("other", "[[effect]]\nname = \"coulomb_friction\"\nlevel_n = 0.5\n"), nominal);
}
