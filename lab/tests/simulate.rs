//! The simulated test bed against closed forms, and `palpate simulate` as a user meets it.

use std::path::{Path, PathBuf};

use palpate_lab::plant::{Plant, State};
use palpate_lab::reference::BENCH;
use palpate_lab::rig::{Contact, Drive, Rig};
use palpate_lab::simulate::{SimulateArgs, Trial, run, simulate};

const DRIVE: Drive = Drive { inertia: 0.45, viscous: 2.0, encoder: None, load_scale: 1.0 };
const SURFACE: Contact = Contact { surface: 0.0, stiffness: 3000.0, damping: 6.0, bilateral: false };

/// The contract's example rig, as its author would write it.
const EXAMPLE: &str = r#"
[rig]
name = "bench A"
coordinate = "linear"
[drive]
mass_kg = 0.8
viscous_n_s_m = 4.0
[contact]
model = "kelvin_voigt"
surface_m = 0.0
stiffness_n_m = 300.0
damping_n_s_m = 5.0
bilateral = false
[sensors]
position_resolution_m = 1.0e-4
force_resolution_n = 0.05
"#;

fn close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(error <= tolerance, "{what}: {found} is {error:.2e} from {expected}, more than {tolerance:.1e}");
}

fn trial(text: &str, seed: u64) -> Trial {
    simulate(&Rig::parse(text, "rig.toml").unwrap(), seed, "rig.toml").unwrap()
}

fn refused(text: &str) -> String {
    simulate(&Rig::parse(text, "rig.toml").unwrap(), 1, "rig.toml").unwrap_err().to_string()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn free_motion_under_a_held_effort_is_the_closed_form() {
    let plant = Plant { drive: DRIVE, contact: None };
    let (effort, span) = (1.5, 0.3);
    let end = plant.advance(State { position: -0.2, velocity: 0.1 }, effort, span, plant.steps_for(span) as usize);
    let (lag, terminal) = (DRIVE.inertia / DRIVE.viscous, effort / DRIVE.viscous);
    let left = (-span / lag).exp();
    // 27 steps of 3e-9 relative each at the worst, of about a metre a second.
    close(end.velocity, terminal + (0.1 - terminal) * left, 1e-7, "velocity");
    close(end.position, -0.2 + terminal * span + (0.1 - terminal) * lag * (1.0 - left), 1e-7, "position");
}

#[test]
fn a_bonded_contact_rings_as_the_closed_form_on_both_sides_of_its_surface() {
    let contact = Contact { bilateral: true, ..SURFACE };
    let plant = Plant { drive: DRIVE, contact: Some(contact) };
    let span = 0.5;
    let start = 0.01;
    let end = plant.advance(State { position: start, velocity: 0.0 }, 0.0, span, plant.steps_for(span) as usize);
    let decay = (DRIVE.viscous + contact.damping) / (2.0 * DRIVE.inertia);
    let turn = (contact.stiffness / DRIVE.inertia - decay * decay).sqrt();
    let (sine, cosine) = (turn * span).sin_cos();
    let position = start * (-decay * span).exp() * (cosine + decay / turn * sine);
    // Forty radians at 3e-9 each step of a twentieth: 2e-6 of the amplitude.
    close(end.position, position, 2e-6 * start, "position");
}

/// A fall onto the surface and off it again: every step grid cuts the contact elsewhere.
fn bounce(plant: &Plant, steps: usize) -> State {
    plant.advance(State { position: -0.003, velocity: 0.4 }, -1.0, 0.12, steps)
}

#[test]
fn an_impact_and_a_release_leave_the_integration_at_order_four() {
    let plant = Plant { drive: DRIVE, contact: Some(SURFACE) };
    let truth = bounce(&plant, 8192);
    assert!(truth.position < 0.0 && truth.velocity < 0.0, "the tool is off again: {truth:?}");
    let error = |steps| (bounce(&plant, steps).velocity - truth.velocity).abs();
    let (coarse, fine) = (error(64), error(256));
    println!("velocity error {coarse:.2e} in 64 steps, {:.2e} in 128, {fine:.2e} in 256", error(128));
    // Order four gains 256 over two halvings; order one, which a step across the onset would have, gains 4.
    assert!(coarse / fine > 100.0, "gain {}", coarse / fine);
    let used = plant.steps_for(0.12) as usize;
    let (default, halved) = (bounce(&plant, used), bounce(&plant, 2 * used));
    println!(
        "steps of the default: {used}, halving moves the end by {:.2e} m",
        (default.position - halved.position).abs()
    );
    close(default.position, halved.position, 1e-6 * 0.01, "halving the default step");
}

#[test]
fn a_contact_that_is_not_bonded_never_pulls() {
    let plant = Plant { drive: DRIVE, contact: Some(Contact { damping: 60.0, ..SURFACE }) };
    let mut state = State { position: -0.001, velocity: 0.3 };
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    for _ in 0..2000 {
        state = plant.advance(state, -2.0, 1e-4, 4);
        let force = plant.contact.unwrap().force(state);
        (least, most) = (least.min(force), most.max(force));
    }
    assert_eq!(least, 0.0);
    assert!(most > 10.0, "most {most}");
}

#[test]
fn the_reference_is_where_the_paper_puts_it_and_its_rate_is_its_slope() {
    // Each edge is over by exp(-50) five seconds on; the sine is at a zero crossing at whole tenths of a second.
    close(BENCH.at(10.0).0, -15e-3, 1e-12, "free");
    close(BENCH.at(25.0).0, 13.5e-3, 1e-12, "contact");
    close(BENCH.at(40.0).0, -15e-3, 1e-12, "free again");
    close(BENCH.at(25.025).0, 16.8e-3, 1e-12, "crest of the sine");
    for time in [0.013, 15.07, 15.31, 30.02, 45.5, 3015.07] {
        let slope = (BENCH.at(time + 1e-6).0 - BENCH.at(time - 1e-6).0) / 2e-6;
        // Second difference of the sine: 3.3e-3 (20 pi)^3 1e-12 / 6, and rounding of 1e-17 / 1e-6 (1e-12 of the time at 3015 s).
        close(BENCH.at(time).1, slope, 2e-7, "rate");
    }
    close(BENCH.at(3015.07).0, BENCH.at(15.07).0, 1e-11, "a hundred periods later");
}

#[test]
fn the_contracts_example_runs_as_it_is() {
    let trial = trial(EXAMPLE, 1);
    let recording = &trial.recording;
    assert_eq!(recording.time.len(), 60_000);
    assert_eq!(trial.notices, Vec::<String>::new());
    let force = recording.force.as_ref().unwrap();
    // The drive yields to the surface: 775 (13.5 mm - x) = 300 x gives 9.7 mm and 2.9 N, and the sine on top.
    let held = &force[24_000..29_000];
    close(held.iter().sum::<f64>() / 5000.0, 2.92, 0.1, "mean force in contact");
    let free = &force[1000..14_000];
    let spread = (free.iter().map(|f| f * f).sum::<f64>() / free.len() as f64).sqrt();
    // Noise 0.09 N and rounding 0.05/sqrt(12), each figure known to 1/sqrt(2 * 13000).
    close(spread, 0.09f64.hypot(0.05 / 12f64.sqrt()), 0.003, "noise in free motion");
    assert!(largest(&recording.position) > 5e-3);
    for position in &recording.position {
        close(position / 1e-4, (position / 1e-4).round(), 1e-6, "counts");
    }
}

#[test]
fn the_recorded_effort_drives_the_recorded_motion() {
    // Ideal sensors, fast rows: m a + b v + F = effort must close on the recording itself.
    let text = EXAMPLE.replace("1.0e-4", "0.0").replace("0.05", "0.0\nforce_noise_n = 0.0")
        + "[simulation]\nduration_s = 20.0\nrate_hz = 10000.0\n";
    let recording = trial(&text, 1).recording;
    let (x, effort, force) = (recording.position, recording.effort.unwrap(), recording.force.unwrap());
    let step = 1e-4;
    let (mut worst, mut strongest) = (0.0f64, 0.0f64);
    for i in (160_005..199_995).step_by(10) {
        // In the middle of a hold of ten rows the effort is constant and the motion smooth.
        let velocity = (x[i + 1] - x[i - 1]) / (2.0 * step);
        let acceleration = (x[i + 1] - 2.0 * x[i] + x[i - 1]) / (step * step);
        worst = worst.max((0.8 * acceleration + 4.0 * velocity + force[i] - effort[i]).abs());
        strongest = strongest.max(effort[i].abs());
    }
    let changes = (1..effort.len()).filter(|&row| effort[row] != effort[row - 1]);
    assert!(
        changes.clone().count() > 10_000 && changes.clone().all(|row| row % 10 == 0),
        "a row shows the effort that begins there"
    );
    // Second differences at 0.1 ms: rounding of 1e-18 / 1e-8, curvature of a 4 Hz loop far below; one second after
    // the onset the tool stays in contact.
    assert!(worst < 1e-3 * strongest && strongest > 1.0, "worst {worst:.2e} N of {strongest:.2} N");
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_seed_others() {
    let folder = tempfile::tempdir().unwrap();
    let rig = folder.path().join("rig.toml");
    std::fs::write(&rig, format!("{EXAMPLE}[simulation]\nduration_s = 20\n")).unwrap();
    let bytes = |name: &str, seed| {
        let out = folder.path().join(name);
        run(SimulateArgs { rig: rig.clone(), model: None, seed, out: out.clone() }).unwrap();
        std::fs::read(out).unwrap()
    };
    let first = bytes("a.csv", 7);
    assert_eq!(first, bytes("b.csv", 7));
    assert_ne!(first, bytes("c.csv", 8));
    let text = String::from_utf8(first).unwrap();
    assert!(text.starts_with("t_s,position_m,force_N,effort_N,reference_m\n"), "{}", &text[..60]);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 4, "no temporary file is left");
}

#[test]
fn without_a_drive_the_tool_follows_the_reference_exactly() {
    let (head, tail) = EXAMPLE.split_once("[drive]").unwrap();
    let text = format!("{head}{}", &tail[tail.find("[contact]").unwrap()..]).replace("1.0e-4", "0.0");
    let recording = trial(&text, 1).recording;
    assert_eq!(recording.effort, None);
    assert_eq!(Some(recording.position), recording.reference);
}

#[test]
fn without_a_contact_there_is_no_force() {
    let text = EXAMPLE[..EXAMPLE.find("[contact]").unwrap()].to_owned() + "[simulation]\nduration_s = 1.0\n";
    let recording = trial(&text, 1).recording;
    assert_eq!((recording.force, recording.effort.map(|effort| effort.len())), (None, Some(1000)));
}

#[test]
fn the_drive_gives_no_more_than_its_saturation_and_its_user_is_told() {
    let text = EXAMPLE.to_owned()
        + "[control]\nproportional_n_m = 775\nderivative_n_s_m = 10\neffort_saturation_n = 0.5\n[simulation]\nduration_s = 30\n";
    let trial = trial(&text, 1);
    let effort = trial.recording.effort.unwrap();
    let most = effort.iter().fold(0.0f64, |most, effort| most.max(effort.abs()));
    assert_eq!(most, 0.5);
    assert!(trial.notices.iter().any(|notice| notice.contains("at its limit")), "{:?}", trial.notices);
}

#[test]
fn the_sensor_at_rest_reads_its_zero_in_whole_steps() {
    let text = EXAMPLE.to_owned() + "force_noise_n = 0.0\nforce_zero_n = -0.27\n[simulation]\nduration_s = 5\n";
    let force = trial(&text, 1).recording.force.unwrap();
    // -0.27 lies between -0.25 and -0.30, nearer to the former.
    assert!(force.iter().all(|force| *force == -0.25), "{:?}", &force[..3]);
}

#[test]
fn a_control_clock_that_is_no_multiple_of_the_rows_still_holds_its_effort() {
    let text = EXAMPLE.to_owned()
        + "[control]\nproportional_n_m = 775\nderivative_n_s_m = 10\nrate_hz = 300\n[simulation]\nduration_s = 20\nrate_hz = 1000\n";
    let recording = trial(&text, 1).recording;
    let effort = recording.effort.unwrap();
    let changes = effort.windows(2).filter(|pair| pair[0] != pair[1]).count();
    // 20 s at 300 Hz are 6000 updates; a coarse encoder at rest repeats a few.
    assert!((5000..=6000).contains(&changes), "{changes} changes of effort");
}

#[test]
fn a_tool_that_never_touches_is_told_of() {
    let text = EXAMPLE.to_owned() + "[simulation]\nduration_s = 10.0\n";
    let notices = trial(&text, 1).notices;
    assert!(notices.iter().any(|notice| notice.contains("never touches")), "{notices:?}");
}

#[test]
fn a_scale_of_nanonewtons_and_one_of_kilonewtons_obey_the_same_law() {
    // One bench in three sizes: lengths by l, masses by m, seconds unchanged. Every force must scale by l m.
    let sized = |l: f64, m: f64| {
        let text = format!(
            "[rig]\nname = \"s\"\ncoordinate = \"linear\"\n[drive]\nmass_kg = {}\nviscous_n_s_m = {}\n\
             [contact]\nsurface_m = {}\nstiffness_n_m = {}\ndamping_n_s_m = {}\n\
             [sensors]\nposition_resolution_m = 0\nforce_resolution_n = 0\nforce_noise_n = 0\n\
             [control]\nproportional_n_m = {}\nderivative_n_s_m = {}\n\
             [reference]\nfree_depth_m = {}\ncontact_depth_m = {}\nperiod_s = 2\ncontact_s = 1\nsmoothing_s = 0.05\n\
             sine_amplitude_m = {}\nsine_frequency_hz = 5\n[simulation]\nduration_s = 4\n",
            0.5 * m,
            2.0 * m,
            0.1 * l,
            300.0 * m,
            5.0 * m,
            800.0 * m,
            10.0 * m,
            -0.01 * l,
            0.01 * l,
            0.002 * l
        );
        trial(&text, 1).recording.force.unwrap()
    };
    let bench = sized(1.0, 1.0);
    let peak = largest(&bench);
    assert!(peak > 1.0);
    for (l, m) in [(1e-6, 1e-4), (1e2, 1e3)] {
        for (small, usual) in sized(l, m).iter().zip(&bench) {
            // Same operations on scaled numbers: rounding errors only, grown through a stable loop.
            close(small / (l * m), *usual, 1e-9 * peak, "force");
        }
    }
}

#[test]
fn what_cannot_be_simulated_is_refused_by_name() {
    let says = |text: &str, words: &[&str]| {
        let error = refused(text);
        for word in words {
            assert!(error.contains(word), "{error} lacks {word}");
        }
    };
    says(
        &format!("{EXAMPLE}[[effect]]\nname = \"coulomb_friction\"\nforce_n = 0.3\n"),
        &["rig.toml", "coulomb_friction"],
    );
    says(&EXAMPLE.replace("stiffness_n_m = 300.0", "stiffness_n_m = 1e15"), &["[control]"]);
    let stiff =
        EXAMPLE.replace("mass_kg = 0.8", "mass_kg = 0.02").replace("damping_n_s_m = 5.0", "damping_n_s_m = 1e7");
    says(&stiff, &["time constant", "integration steps"]);
    let rotary = "[rig]\nname = \"r\"\ncoordinate = \"rotary\"\n[contact]\nsurface_rad = 0\nstiffness_n_m_rad = 1\n\
                  damping_n_m_s_rad = 0.1\n";
    says(rotary, &["[reference]", "nothing", "do not fit this rig"]);
    says("[rig]\nname = \"r\"\ncoordinate = \"linear\"\n", &["[drive]", "[contact]"]);
    says(&format!("{EXAMPLE}[simulation]\nduration_s = 1e9\n"), &["[simulation]", "rows"]);
    let pulses = format!(
        "{EXAMPLE}[reference]\nfree_depth_m = -0.01\ncontact_depth_m = 0.01\nperiod_s = 1e-6\ncontact_s = 5e-7\nsmoothing_s = 0.1\n"
    );
    says(&pulses, &["[reference] period_s", "smoothing_s"]);
    let clock = format!("{EXAMPLE}[control]\nproportional_n_m = 1\nderivative_n_s_m = 1\nrate_hz = 1e12\n");
    says(&clock, &["integration steps in all", "rate_hz"]);
}

#[test]
fn the_command_line_is_sound() {
    use clap::{Args, Command, FromArgMatches};
    let command = SimulateArgs::augment_args(Command::new("simulate"));
    command.clone().debug_assert();
    let found = command.try_get_matches_from(["simulate", "--rig", "r.toml", "--seed", "9", "--out", "t.csv"]).unwrap();
    let args = SimulateArgs::from_arg_matches(&found).unwrap();
    assert_eq!((args.rig, args.model, args.seed, args.out), ("r.toml".into(), None, 9, "t.csv".into()));
}

#[test]
fn a_model_replaces_the_rig_and_an_unwritable_place_is_named_before_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| -> PathBuf {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let rig = write("rig.toml", EXAMPLE);
    let drive = EXAMPLE[..EXAMPLE.find("[contact]").unwrap()].to_owned() + "[simulation]\nduration_s = 1\n";
    let model = write("model.toml", &drive);
    let out = folder.path().join("out.csv");
    let go = |model: Option<&Path>, out: &Path| {
        run(SimulateArgs { rig: rig.clone(), model: model.map(Path::to_owned), seed: 1, out: out.to_owned() })
    };
    go(Some(&model), &out).unwrap();
    assert!(std::fs::read_to_string(&out).unwrap().starts_with("t_s,position_m,effort_N,reference_m\n"));
    let nowhere = folder.path().join("absent/out.csv");
    let error = go(None, &nowhere).unwrap_err().to_string();
    assert!(error.contains("absent/out.csv") && error.contains("cannot be written"), "{error}");
    let error = go(None, &rig).unwrap_err().to_string();
    assert!(error.contains("an input of this very run"), "{error}");
    let error = go(Some(&folder.path().join("none.toml")), &out).unwrap_err().to_string();
    assert!(error.contains("none.toml: found no such file"), "{error}");
}

#[test]
fn every_example_rig_reads_round_trips_and_runs_into_its_surface() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("rigs");
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let rig = Rig::read(&path).unwrap();
        assert_eq!(rig, Rig::parse(&rig.to_toml(), "again").unwrap(), "{}", path.display());
        seen += 1;
        if rig.control.is_none() && rig.reference.is_none() {
            // It goes with recordings of a real thing and is not meant to be run.
            continue;
        }
        let trial = simulate(&rig, 1, "rig").unwrap();
        // "note:" says that sensors left to the recording are simulated as ideal; a warning would be a fault of the file.
        assert!(
            trial.notices.iter().all(|notice| notice.starts_with("note:")),
            "{}: {:?}",
            path.display(),
            trial.notices
        );
        assert!(largest(trial.recording.force.as_ref().unwrap()) > 0.0);
    }
    assert!(seen >= 9, "{seen} example rigs");
}
