//! Rig files and recordings as users bring them: good, odd and broken.

use std::f64::consts::PI;

use std::path::Path;

use palpate_lab::recording::Recording;
use palpate_lab::rig::{Coordinate, Rig};

const LINEAR: &str = "[rig]\nname = \"a\"\ncoordinate = \"linear\"\n";
const ROTARY: &str = "[rig]\nname = \"a\"\ncoordinate = \"rotary\"\n";

fn rig(text: &str) -> Rig {
    Rig::parse(text, "rig.toml").unwrap()
}

fn rig_error(text: &str) -> String {
    Rig::parse(text, "rig.toml").unwrap_err().to_string()
}

fn read(bytes: impl AsRef<[u8]>, rig_text: &str) -> Result<Recording, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("trial.csv");
    std::fs::write(&path, bytes).unwrap();
    Recording::read(&path, &rig(rig_text)).map_err(|error| error.to_string())
}

fn says(error: &str, words: &[&str]) {
    for word in words {
        assert!(error.contains(word), "\"{error}\" lacks \"{word}\"");
    }
}

fn refuses(bytes: impl AsRef<[u8]>, words: &[&str]) {
    says(&read(bytes, LINEAR).unwrap_err(), words);
}

#[test]
fn a_full_rig_survives_writing_and_reading_in_both_coordinates() {
    let linear = r#"
[rig]
name = "quotes \" and \\ and µ"
coordinate = "linear"
[columns]
force = "f meas"
time = "t"
[drive]
mass_kg = 1
viscous_n_s_m = 0
[contact]
surface_m = -1.25e-7
stiffness_n_m = 3e12
damping_n_s_m = 1e-9
bilateral = true
[sensors]
position_resolution_m = 0
force_noise_n = 1.1e-12
force_zero_n = -3
[control]
proportional_n_m = 775
derivative_n_s_m = 10
[reference]
free_depth_m = -1e-6
contact_depth_m = 1e-6
period_s = 2
contact_s = 1
smoothing_s = 0.1
[simulation]
rate_hz = 50000
[[effect]]
name = "adhesion"
force_n = 0.25
force_n_ci95 = [0.2, 0.3]
"odd key" = { a = 1 }
[[effect]]
name = "backlash"
"#;
    let first = rig(linear);
    let text = first.to_toml();
    assert_eq!(Rig::parse(&text, "again").unwrap(), first, "{text}");
    assert_eq!(first.effects.iter().map(|effect| effect.name.as_str()).collect::<Vec<_>>(), ["adhesion", "backlash"]);
    let rotary = rig(&(ROTARY.to_owned()
        + "[drive]\ninertia_kg_m2 = 0.1\nviscous_n_m_s_rad = 1\n[sensors]\ntorque_resolution_n_m = 0.1\n\
           [contact]\nsurface_rad = 1\nstiffness_n_m_rad = 2\ndamping_n_m_s_rad = 3\n"));
    let text = rotary.to_toml();
    assert_eq!(Rig::parse(&text, "again").unwrap(), rotary, "{text}");
    assert!(text.contains("inertia_kg_m2 = 0.1") && text.contains("stiffness_n_m_rad = 2.0"), "{text}");
}

#[test]
fn a_rig_at_fault_is_told_by_line_key_finding_and_expectation() {
    let drive = |lines: &str| format!("{LINEAR}[drive]\n{lines}\n");
    says(
        &rig_error(&drive("mass_kg = 1\nviscous_n_s_m = 1\nmas_kg = 2")),
        &["rig.toml:7: [drive] mas_kg", "unknown", "mass_kg perhaps"],
    );
    says(
        &rig_error(&drive("mass_kg = 0.0\nviscous_n_s_m = 1")),
        &["rig.toml:5: [drive] mass_kg: found 0.0", "above zero"],
    );
    says(&rig_error(&drive("mass_kg = -1\nviscous_n_s_m = 1")), &["found -1"]);
    says(&rig_error(&drive("mass_kg = nan\nviscous_n_s_m = 1")), &["found nan"]);
    says(&rig_error(&drive("mass_kg = 1\nviscous_n_s_m = inf")), &["rig.toml:6", "found inf"]);
    says(&rig_error(&drive("mass_kg = \"1\"\nviscous_n_s_m = 1")), &["the text \"1\"", "a number above zero"]);
    says(&rig_error(&drive("viscous_n_s_m = 1")), &["rig.toml:4: [drive] mass_kg: found nothing"]);
    says(
        &rig_error(&drive("inertia_kg_m2 = 1\nviscous_n_s_m = 1")),
        &["rig.toml:5: [drive] inertia_kg_m2", "rotary", "expected mass_kg"],
    );
    says(&rig_error(&format!("{ROTARY}[drive]\nmass_kg = 1\n")), &["mass_kg", "expected inertia_kg_m2"]);
    says(
        &rig_error(&format!("{LINEAR}[contact]\nsurface_m = 0\nstiffness_n_m = -3\ndamping_n_s_m = 1\n")),
        &["rig.toml:6", "found -3"],
    );
    says(
        &rig_error(&format!("{LINEAR}[contact]\nmodel = \"hertz\"\n")),
        &["rig.toml:5: [contact] model", "\"hertz\"", "kelvin_voigt"],
    );
    says(&rig_error(&format!("{LINEAR}[contacts]\nsurface_m = 0\n")), &["rig.toml:4: contacts", "contact perhaps"]);
    says(&rig_error(&format!("{LINEAR}[columns]\nforce = 3\n")), &["[columns] force: found 3", "text in quotes"]);
    says(&rig_error(&format!("drive = 3\n{LINEAR}")), &["rig.toml:1: drive: found 3", "a table [drive]"]);
    says(&rig_error("[rig]\nname = \"a\"\ncoordinate = \"polar\"\n"), &["rig.toml:3", "\"polar\"", "\"rotary\""]);
    says(&rig_error("name = \"a\"\n"), &["[rig]"]);
    says(&rig_error(&format!("{LINEAR}[drive\n")), &["rig.toml:4", "TOML"]);
    says(&rig_error(&format!("{LINEAR}[[effect]]\nforce_n = 1\n")), &["rig.toml:4: [[effect]] name: found nothing"]);
    says(&rig_error(&format!("{LINEAR}[[effect]]\nname = \"x\"\na = [1.0, nan]\n")), &["[[effect]] a"]);
    let gone = Rig::read(Path::new("no/such.toml")).unwrap_err().to_string();
    says(&gone, &["no/such.toml: found no such file"]);
}

#[test]
fn columns_come_in_any_order_with_extras_a_mark_and_foreign_line_ends() {
    let text = "\u{feff}note,force_N,position_m,t_s,velocity_m_s\r\n\"a, \"\"b\"\"\",1,-2e-3,0,5\r\n,2.5, 1 ,0.5,6\r\n";
    let recording = read(text, LINEAR).unwrap();
    assert_eq!((recording.name.as_str(), &recording.time), ("trial.csv", &vec![0.0, 0.5]));
    assert_eq!((recording.position, recording.force), (vec![-2e-3, 1.0], Some(vec![1.0, 2.5])));
    assert_eq!((recording.velocity, recording.effort), (Some(vec![5.0, 6.0]), None));
    let rotary = format!("{ROTARY}[columns]\neffort = \"torque_Nm\"\n");
    let recording = read("t_s,position_rad,torque_Nm\n0,1,2\n1,3,4\n", &rotary).unwrap();
    assert_eq!(
        (recording.effort, recording.force),
        (Some(vec![2.0, 4.0]), None),
        "a motor's torque is no contact force"
    );
    let borrowed = format!("{LINEAR}[columns]\neffort = \"torque_Nm\"\n");
    let recording = read("t_s,position_m,torque_Nm\n0,1,2\n1,3,4\n", &borrowed).unwrap();
    assert_eq!(recording.effort, Some(vec![2.0, 4.0]), "what the rig file names is taken at its word");
}

#[test]
fn a_recording_at_fault_is_told_by_its_true_line() {
    refuses("", &["trial.csv: found an empty file"]);
    refuses("t_s,position_m,force_N\n", &["a header and no rows"]);
    refuses("t_s,position_m,force_N\n0,1,2\n", &["single row", "at least two"]);
    refuses(
        "t_s,position_m,force_n\n0,1,2\n1,1,2\n",
        &["trial.csv:1", "only the columns t_s, position_m, force_n", "force_N"],
    );
    refuses("time_s,position_m,force_N\n0,1,2\n", &["column t_s", "position_m, force_N"]);
    refuses("t_s,positon_m,force_N\n0,1,2\n", &["column position_m", "perhaps positon_m"]);
    refuses("t_s;position_m;force_N\n0;1;2\n", &["semicolons"]);
    refuses("t_s,t_s,position_m,force_N\n0,0,1,2\n", &["twice, as columns 1 and 2"]);
    refuses("t_s,position_m,force_N\r\n0,1,2\r\n\r\n1,x,2\r\n", &["trial.csv:4: column position_m", "the text \"x\""]);
    refuses("t_s,position_m,force_N\n0,1,2\n1,1,NaN\n", &["trial.csv:3: column force_N", "\"NaN\"", "finite"]);
    refuses("t_s,position_m,force_N\n0,1,2\n1,1e999,2\n", &["trial.csv:3", "finite"]);
    refuses("t_s,position_m,force_N\n0,1,2\n1,,2\n", &["an empty field"]);
    refuses("t_s,position_m,force_N\n0,1,2\n1,1\n", &["trial.csv:3", "2 fields", "expected 3"]);
    refuses(
        "t_s,position_m,force_N,note\n0,1,2,\"a\nb\"\n1,1,2,c\n1,1,2,d\n",
        &["trial.csv:5: column t_s", "1 after 1", "increases"],
    );
    refuses(
        "t_s,position_rad,torque_Nm\n0,1,2\n1,1,2\n",
        &["position_rad, a column of a rotary rig", "expected position_m"],
    );
    refuses("t_s,position_m,torque_Nm\n0,1,2\n1,1,2\n", &["torque_Nm", "force_N"]);
    refuses(b"t_s,position_m,force_N\n0,1,2\n1,\xff,2\n", &["trial.csv:3", "UTF-8"]);
    let named = format!("{LINEAR}[columns]\nforce = \"f_meas\"\n");
    says(&read("t_s,position_m,f_mes\n0,1,2\n1,1,2\n", &named).unwrap_err(), &["column f_meas", "perhaps f_mes"]);
    says(
        &Recording::read(Path::new("no/such.csv"), &rig(LINEAR)).unwrap_err().to_string(),
        &["no/such.csv: found no such file"],
    );
    says(&Recording::read(Path::new("."), &rig(LINEAR)).unwrap_err().to_string(), &["folder"]);
}

#[test]
fn a_recording_survives_writing_to_the_bit() {
    let recording = Recording {
        name: "again.csv".to_owned(),
        time: vec![-0.1, 0.1 + 0.2, 1e9],
        position: vec![1e-300, -f64::MIN_POSITIVE, 0.0],
        force: Some(vec![1.0 / 3.0, 123_456_789.123, -1e22]),
        ..Recording::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("again.csv");
    recording.write(&path, &Rig { coordinate: Coordinate::Rotary, ..Rig::default() }).unwrap();
    assert_eq!(Recording::read(&path, &rig(ROTARY)).unwrap(), recording);
    let error = recording.write(folder.path(), &Rig::default()).unwrap_err().to_string();
    says(&error, &["found a folder"]);
}

const MOTOR: &str = "[drive]\nmass_kg = 1\nviscous_n_s_m = 0\n[effort]\n";

/// Position t^2, so that the velocity is 2 t; current, voltage and duty of 3 t, 0.1 t and t / 100.
fn motor_trial() -> String {
    let row = |k: u32| {
        let t = f64::from(k) * 0.01;
        // On no encoder's grid.
        let place = t * t + t / PI;
        format!("{t},{place},{},{},{},{}\n", 3.0 * t, 0.1 * t, 0.01 * t, place + 0.5 * t)
    };
    "t_s,position_m,current_A,voltage_V,duty,reference_m\n".to_owned() + &(0..100).map(row).collect::<String>()
}

#[test]
fn an_effort_that_is_not_recorded_is_computed_as_the_rig_says() {
    let effort = |table: &str| {
        let recording = read(motor_trial(), &format!("{LINEAR}{MOTOR}{table}")).unwrap();
        (recording.time, recording.effort.unwrap())
    };
    let is = |table: &str, wanted: fn(f64) -> f64| {
        let (time, effort) = effort(table);
        for (t, effort) in time.into_iter().zip(effort).skip(1).take(98) {
            assert!((effort - wanted(t)).abs() < 1e-9, "{table}: {effort} at {t} s, not {}", wanted(t));
        }
    };
    is("model = \"current\"\nmotor_constant_n_a = -2", |t| -6.0 * t);
    is("model = \"voltage\"\nmotor_constant_n_a = 2\nback_emf_v_s_m = 0.3\nresistance_ohm = 0.5", |t| {
        2.0 * (0.1 * t - 0.3 * (2.0 * t + 1.0 / PI)) / 0.5
    });
    is("model = \"duty\"\nsupply_v = 10\nmotor_constant_n_a = 2\nback_emf_v_s_m = 0.3\nresistance_ohm = 0.5", |t| {
        2.0 * (0.1 * t - 0.3 * (2.0 * t + 1.0 / PI)) / 0.5
    });
    is("model = \"pd\"\nproportional_n_m = 4\nderivative_n_s_m = 3", |t| 4.0 * 0.5 * t + 3.0 * 0.5);
    is("model = \"current\"\nmotor_constant_n_a = 2\ncolumn = \"voltage_V\"", |t| 0.2 * t);
    // A recorded effort is taken as it stands.
    let recorded = motor_trial().replace("duty", "effort_N");
    let recording = read(recorded, &format!("{LINEAR}{MOTOR}model = \"current\"\nmotor_constant_n_a = 2")).unwrap();
    assert!((recording.effort.unwrap()[50] - 0.005).abs() < 1e-12);
}

#[test]
fn an_effort_law_survives_writing_and_its_faults_are_named() {
    for table in [
        "model = \"duty\"\nsupply_v = 10\nmotor_constant_n_a = 2\nback_emf_v_s_m = 0.3\nresistance_ohm = 0.5\ncolumn = \"pwm\"",
        "model = \"pd\"\nproportional_n_m = 4\nderivative_n_s_m = 3",
    ] {
        let first = rig(&format!("{LINEAR}{MOTOR}{table}"));
        assert_eq!(Rig::parse(&first.to_toml(), "again").unwrap(), first, "{}", first.to_toml());
    }
    let error = |table: &str| rig_error(&format!("{LINEAR}{MOTOR}{table}"));
    says(&error("model = \"torque\""), &["[effort] model", "torque", "\"pd\""]);
    says(&error("model = \"voltage\"\nmotor_constant_n_a = 2\nback_emf_v_s_m = 1"), &["resistance_ohm", "nothing"]);
    says(&error("model = \"current\"\nmotor_constant_n_a = 2\nsupply_v = 3"), &["supply_v", "unknown key"]);
    let law = format!("{LINEAR}{MOTOR}model = \"current\"\nmotor_constant_n_a = 2\ncolumn = \"curent_A\"");
    says(&read(motor_trial(), &law).unwrap_err(), &["curent_A", "perhaps current_A", "[effort]"]);
    let law = format!("{LINEAR}{MOTOR}model = \"pd\"\nproportional_n_m = 4\nderivative_n_s_m = 3");
    says(&read(motor_trial().replace("reference_m", "r"), &law).unwrap_err(), &["reference_m", "[effort]"]);
}
