//! What was found, in the user's own model: `palpate export` as a user drives it.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use tempfile::TempDir;

const RIG: &str = "[rig]\nname = \"a\"\n[drive]\nmass_kg = 0.8\nviscous_n_s_m = 4.5\n[contact]\nsurface_m = 0.0\n\
                   stiffness_n_m = 300.0\ndamping_n_s_m = 5.0\n";
const COULOMB: &str =
    "[[effect]]\nname = \"coulomb_friction\"\nform = \"symmetric\"\nlevel_n = 0.45\nlevel_ci95_n = [0.44, 0.46]\n";

const MJCF: &str = r#"<!-- mine -->
<mujoco>
  <option timestep="0.001"/>
  <default><default class="rubs"><joint frictionloss="0.3"/></default></default>
  <worldbody>
    <body name="arm">   <!-- odd   blanks -->
      <joint name="axis"   type='slide' axis="1 0 0"
             damping="2"/>
      <body childclass="rubs"><joint name="second" type="slide"/></body>
      <body><joint name="hinge" axis="0 1 0"/></body>
    </body>
  </worldbody>
  <actuator>
    <motor name="drive" joint="axis" gear="2"/>
  </actuator>
  <sensor>
    <force name="wrist" site="tip"/>
  </sensor>
</mujoco>
"#;

const URDF: &str = "<robot name=\"r\">\n  <joint name=\"axis\" type=\"prismatic\">\n    <limit effort=\"9\" lower=\"0\"/>\n  </joint>\n</robot>\n";
const SDF: &str = "<sdf version=\"1.9\">\n  <model name=\"m\">\n    <joint name=\"axis\" type=\"prismatic\">\n      <axis>\n        \
                   <dynamics><damping>1</damping></dynamics>\n      </axis>\n    </joint>\n  </model>\n</sdf>\n";

fn export_as(to: &str, model: &str, effects: &str, options: &[&str]) -> (TempDir, Command) {
    let folder = TempDir::new().expect("a folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).expect("a file");
        path
    };
    let (rig, model) = (write("improved.toml", &format!("{RIG}{effects}")), write("model.xml", model));
    let mut command = Command::new(env!("CARGO_BIN_EXE_palpate"));
    command.args(["export", "--to", to]).arg(rig).arg("--into").arg(model).args(options);
    if !options.contains(&"--joint") {
        command.args(["--joint", "axis"]);
    }
    (folder, command)
}

/// The model with `effects` in it.
fn exported(to: &str, model: &str, effects: &str, options: &[&str]) -> String {
    let (_folder, mut command) = export_as(to, model, effects, options);
    let output = command.output().expect("palpate");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

fn refuses(to: &str, model: &str, effects: &str, options: &[&str], words: &[&str]) {
    let (_folder, mut command) = export_as(to, model, effects, options);
    let assert = command.assert().code(1).stdout("");
    words.iter().fold(assert, |assert, word| assert.stderr(contains(*word)));
}

fn without_palpate_comments(text: &str) -> String {
    text.lines().filter(|line| !line.contains("<!-- palpate:")).map(|line| line.to_owned() + "\n").collect()
}

#[test]
fn friction_is_written_at_the_joint_and_nothing_else_changes() {
    let text = exported("mjcf", MJCF, COULOMB, &[]);
    let attributes = "damping=\"4.5\" frictionloss=\"0.45\" solreffriction=\"0.002 1\"/>";
    assert_eq!(without_palpate_comments(&text), MJCF.replace("damping=\"2\"/>", attributes));
    assert!(text.contains("level 0.45000 N (95 %: 0.44000 to 0.46000); from improved.toml -->"), "{text}");
    assert!(text.contains("(before: 2.0000)"), "{text}");
}

#[test]
fn loads_that_repeat_along_the_way_are_passive_motors() {
    let cogging =
        "[[effect]]\nname = \"cogging\"\nform = \"first_harmonic\"\nsine_n = 0.3\ncosine_n = 0.4\npitch_m = 0.005\n";
    let text = exported("mjcf", MJCF, cogging, &[]);
    let line = text.lines().find(|line| line.contains("axis_cogging")).expect("a motor");
    let number = |key: &str| -> Vec<f64> {
        let value =
            line.split(&format!("{key}=\"")).nth(1).and_then(|rest| rest.split('"').next()).expect("an attribute");
        value.split(' ').map(|number| number.parse().expect("a number")).collect()
    };
    let (gear, ripple) = (number("gear")[0], number("cogging"));
    // The force at the joint is -(0.3 sin k x + 0.4 cos k x), k = 2 pi / 5 mm.
    for x in [0.0, 0.001, 0.0033_f64] {
        let k = std::f64::consts::TAU / 0.005;
        let wanted = -(0.3 * (k * x).sin() + 0.4 * (k * x).cos());
        let force = gear * ripple[0] * (ripple[1] * gear * x + ripple[2]).sin();
        assert!((force - wanted).abs() < 1e-9, "{force}, not {wanted}");
    }
    assert!(text.contains("input=\"none\"") && text.contains("<!-- palpate: cogging"), "{text}");
}

#[test]
fn lag_and_limit_are_the_actuators_and_a_play_is_a_second_joint() {
    let effects = "[[effect]]\nname = \"effort_lag\"\ntime_constant_s = 0.004\n[[effect]]\nname = \"effort_saturation\"\nlimit_n = 6.0\n\
                   [[effect]]\nname = \"backlash\"\ngap_m = 0.0004\nmotor_share = 0.25\nlink_stiffness_n_m = 1e6\n";
    let text = exported("mjcf", MJCF, effects, &[]);
    // Gear 2: 6 N at the joint are 3 at the actuator.
    let actuator = "<general name=\"drive\" joint=\"axis\" gear=\"2\" dyntype=\"filterexact\" dynprm=\"0.004\" forcerange=\"-3 3\"";
    assert!(text.contains(actuator), "{text}");
    assert!(text.contains("armature=\"0.2\"") && text.contains("range=\"-0.0002 0.0002\""), "{text}");
    assert!(text.contains("<joint name=\"axis_play\" type=\"slide\" axis=\"1 0 0\" pos=\"0.001 0 0\""), "{text}");
}

#[test]
fn effects_of_the_sensor_need_its_name() {
    let delay = "[[effect]]\nname = \"channel_delay\"\ndelay_s = 0.0035\n";
    refuses("mjcf", MJCF, delay, &[], &["--sensor", "wrist"]);
    refuses("mjcf", MJCF, delay, &["--sensor", "elbow"], &["elbow", "only the sensors wrist"]);
    let text = exported("mjcf", MJCF, delay, &["--sensor", "wrist"]);
    assert!(text.contains("site=\"tip\" delay=\"0.0035\" nsample=\"6\" interp=\"linear\"/>"), "{text}");
}

#[test]
fn what_cannot_be_said_is_refused_by_name_and_left_to_the_stepper() {
    let sublinear =
        "[[effect]]\nname = \"sublinear_friction\"\nlevel_n = 2.0\nexponent = 0.4\nreference_speed_m_s = 0.1\n";
    let both = format!("{COULOMB}{sublinear}");
    refuses("mjcf", MJCF, &both, &[], &["sublinear_friction", "whole powers", "--partial", "--to python"]);
    let text = exported("mjcf", MJCF, &both, &["--partial"]);
    assert!(text.contains("frictionloss=\"0.45\"") && !text.contains("sublinear"), "{text}");
    let module = exported("python", MJCF, &both, &[]);
    assert!(
        module.contains(
            "(\"sublinear_friction\", \"power\", {\"level\": 2.0, \"exponent\": 0.4, \"reference_speed\": 0.1})"
        ),
        "{module}"
    );
    assert!(!module.contains("coulomb"), "{module}");
    let carried = "[[effect]]\nname = \"gravity_load\"\nload_n = 3.0\n";
    let gear = "[[effect]]\nname = \"load_dependent_friction\"\nload_coefficient = 0.2\n";
    let weight = "(\"gravity_load\", \"constant\", {\"load\": 3.0})";
    assert!(exported("python", MJCF, &format!("{gear}{carried}"), &[]).contains(weight));
    assert!(!exported("python", MJCF, &format!("{sublinear}{carried}"), &[]).contains(weight));
    let cable = "[[effect]]\nname = \"parasitic_force\"\nform = \"by_speed\"\nspeed_m_s = 0.1\nlinear_n = 0.2\nsquare_n = 0.0\n";
    refuses("mjcf", MJCF, cable, &[], &["parasitic_force", "model the cable"]);
    assert!(exported("python", MJCF, cable, &[]).contains("(\"parasitic_force\", \"by_speed\", {\"speed\": 0.1,"));
    let carried = "[[effect]]\nname = \"environment_mass\"\nmoved_mass_kg = 0.2\n";
    refuses("python", MJCF, carried, &[], &["environment_mass", "not in the stepper either", "give it this mass"]);
}

#[test]
fn a_contact_is_a_rig_file_within_the_stepper() {
    let effects = "[[effect]]\nname = \"adhesion\"\nform = \"neck\"\npull_off_force_n = 0.2\nrelease_height_m = 0.001\n\
                   [[effect]]\nname = \"force_gain\"\ngain_error = 0.05\n";
    refuses("mjcf", MJCF, effects, &[], &["adhesion", "not a law of depth and rate", "force_gain"]);
    let module = exported("python", MJCF, &format!("{COULOMB}{effects}"), &[]);
    let tables = module.split("\"\"\"").nth(3).expect("the contact");
    let contact = palpate_lab::rig::Rig::parse(tables, "CONTACT").expect("a rig file");
    // Its contact, and of its effects those of the contact: the drive's are the model's, the sensor's come after the contact.
    assert_eq!(contact.contact.expect("a contact").stiffness, 300.0);
    assert_eq!(contact.effects.iter().map(|effect| effect.name.as_str()).collect::<Vec<_>>(), ["adhesion"]);
    assert!(contact.drive.is_none() && module.contains("(\"force_gain\", "), "{module}");
}

#[test]
fn a_limit_of_the_effort_beside_a_load_is_the_actuators() {
    let limit = "[[effect]]\nname = \"effort_saturation\"\nlimit_n = 6.0\n[columns]\nload = \"inverse_dynamics\"\n";
    assert!(exported("mjcf", MJCF, limit, &[]).contains("forcerange=\"-3 3\""));
    assert!(exported("urdf", URDF, limit, &[]).contains("effort=\"6\""));
}

#[test]
fn what_the_recordings_add_to_the_inertia_becomes_armature() {
    let (folder, mut command) = export_as("mjcf", MJCF, COULOMB, &[]);
    let nominal = folder.path().join("rig.toml");
    fs::write(&nominal, RIG.replace("mass_kg = 0.8", "mass_kg = 0.7")).expect("a file");
    let output = command.arg("--nominal").arg(&nominal).output().expect("palpate");
    let text = String::from_utf8(output.stdout).expect("text");
    let armature: f64 = text
        .split("armature=\"")
        .nth(1)
        .and_then(|rest| rest.split('"').next())
        .expect("one")
        .parse()
        .expect("a number");
    assert!((armature - 0.1).abs() < 1e-12, "{armature}");
    assert!(text.contains("inertia 0.80000, given 0.70000") && output.stderr.is_empty(), "{text}");
    // Half a hundredth more than the armature that is there is left in the bodies, and said; more cannot be taken away.
    fs::write(&nominal, RIG.replace("mass_kg = 0.8", "mass_kg = 0.804")).expect("a file");
    let output = command.output().expect("palpate");
    let told = String::from_utf8(output.stderr).expect("text");
    assert!(output.status.success() && told.contains("take 0.0040000 kg away"), "{told}");
    assert!(!String::from_utf8(output.stdout).expect("text").contains("armature"));
    fs::write(&nominal, RIG.replace("mass_kg = 0.8", "mass_kg = 0.9")).expect("a file");
    command.assert().code(1).stderr(contains("armature 0 kg").and(contains("take 0.10000 away")));
}

#[test]
fn urdf_sdf_and_drake_say_damping_friction_and_limit() {
    let effects = format!("{COULOMB}[[effect]]\nname = \"effort_saturation\"\nlimit_n = 6.0\n");
    let text = exported("urdf", URDF, &effects, &[]);
    let wanted = URDF.replace(
        "effort=\"9\" lower=\"0\"/>\n",
        "effort=\"6\" lower=\"0\"/>\n    <dynamics damping=\"4.5\" friction=\"0.45\"/>\n",
    );
    assert_eq!(without_palpate_comments(&text), wanted);
    let text = exported("sdf", SDF, &effects, &[]);
    assert!(text.contains("<damping>4.5</damping>") && text.contains("<friction>0.45</friction>"), "{text}");
    assert!(text.contains("<limit><effort>6</effort></limit>"), "{text}");
    refuses("drake", URDF, &effects, &[], &["coulomb_friction", "Drake"]);
    let text = exported("drake", URDF, &effects, &["--partial"]);
    assert!(text.contains("<dynamics damping=\"4.5\"/>"), "{text}");
    let cogging = "[[effect]]\nname = \"cogging\"\nsine_n = 0.3\ncosine_n = 0.4\npitch_m = 0.005\n";
    refuses("urdf", URDF, cogging, &[], &["cogging", "effort limit alone"]);
}

#[test]
fn a_model_at_fault_is_named() {
    refuses("mjcf", MJCF, COULOMB, &["--joint", "axsi"], &["joint axsi", "axis, second, hinge", "perhaps axis"]);
    refuses("mjcf", MJCF, COULOMB, &["--joint", "hinge"], &["model.xml:10: joint hinge", "a hinge joint", "slide"]);
    // From the default class of the body.
    refuses("mjcf", MJCF, COULOMB, &["--joint", "second"], &["joint second", "frictionloss 0.3", "coulomb_friction"]);
    refuses("mjcf", URDF, COULOMB, &[], &["<robot>", "<mujoco>"]);
    refuses("urdf", MJCF, COULOMB, &[], &["<mujoco>", "<robot>"]);
    refuses("mjcf", "<mujoco>\n<body>\n</mujoco>", COULOMB, &[], &["model.xml:3", "XML"]);
    let rubs = URDF.replace("<limit", "<dynamics friction=\"1\"/><limit");
    refuses("urdf", &rubs, COULOMB, &[], &["friction 1", "without dry friction"]);
    let lag = "[[effect]]\nname = \"effort_lag\"\ntime_constant_s = 0.004\n";
    refuses("mjcf", &MJCF.replace("<motor", "<position"), lag, &[], &["drive", "a position actuator", "motor"]);
    refuses("mjcf", &MJCF.replace("joint=\"axis\"", "joint=\"second\""), lag, &[], &["actuator of joint axis", "none"]);
}

#[test]
fn the_users_model_is_never_overwritten() {
    let (folder, mut command) = export_as("mjcf", MJCF, COULOMB, &[]);
    let model = folder.path().join("model.xml");
    command.arg("--out").arg(&model).assert().code(2).stderr(contains("--out").and(contains("input of this very run")));
    assert_eq!(fs::read_to_string(Path::new(&model)).expect("a file"), MJCF);
}
