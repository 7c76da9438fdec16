//! `palpate listen` and `palpate calibrate` as their user runs them.

use std::process::{Command, Stdio};

use palpate_drive::Calibration;
use palpate_lab::qemu_drive::ClockMode;

use super::rig::{bench, image};

fn palpate() -> Command {
    Command::new(env!("CARGO_BIN_EXE_palpate"))
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn listen_feeds_records_and_shows_and_replay_takes_the_recording() {
    let Some(image) = image() else { return };
    let drive = image.start(ClockMode::Exact, None, &[]).unwrap_or_else(|error| panic!("{error:#}"));
    let folder = tempfile::tempdir().expect("a folder");
    let (rig, recording) = bench(6.0);
    let [rig_path, trial, out] = ["rig.toml", "trial.csv", "heard.csv"].map(|name| folder.path().join(name));
    rig.write(&rig_path).expect("a rig file");
    recording.write(&trial, &rig).expect("a trial");
    let mut listen = palpate();
    listen.args(["listen", "--port"]).arg(drive.socket()).args(["--method", "blmf", "--window", "150", "--counters"]);
    listen.arg("--feed").arg(&trial).arg("--rig").arg(&rig_path).arg("--record").arg(&out);
    let done = listen.output().expect("palpate runs");
    let (shown, said) = (text(&done.stdout), text(&done.stderr));
    assert!(done.status.success(), "{said}");
    assert!(said.contains("on QEMU") && said.contains("calibration"), "{said}");
    assert!(shown.lines().any(|line| line.contains("K 2") || line.contains("K 3")), "{shown}");
    assert!(shown.contains("FAULT calibration") && shown.contains("no contact"), "{shown}");
    assert!(shown.lines().any(|line| line.starts_with("samples used") && line.ends_with("6000")), "{shown}");

    let replayed = folder.path().join("out");
    let mut replay = palpate();
    replay.args(["replay", "--method", "blmf", "--window", "150", "--rig"]).arg(out.with_extension("toml"));
    let done = replay.arg(&out).arg("--out").arg(&replayed).output().expect("palpate runs");
    assert!(done.status.success(), "{}", text(&done.stderr));
    let rows = std::fs::read_to_string(replayed.join("estimates.csv")).expect("estimates").lines().count();
    assert_eq!(rows, 6_001, "a header and a row a sample");
}

#[test]
fn listen_says_what_is_wrong() {
    let missing =
        palpate().args(["listen", "--port", "/dev/no-such-drive", "--for", "1"]).output().expect("palpate runs");
    assert_eq!(missing.status.code(), Some(1));
    assert!(text(&missing.stderr).contains("/dev/no-such-drive"), "{}", text(&missing.stderr));
    let line = palpate().args(["listen", "--port", "x", "--window", "5000"]).output().expect("palpate runs");
    assert_eq!(line.status.code(), Some(2), "{}", text(&line.stderr));
    let Some(image) = image() else { return };
    let drive = image.start(ClockMode::Exact, None, &[]).unwrap_or_else(|error| panic!("{error:#}"));
    let mut refused = palpate();
    refused.args(["listen", "--for", "1", "--forgetting", "1.5", "--port"]).arg(drive.socket());
    let refused = refused.output().expect("palpate runs");
    assert_eq!(refused.status.code(), Some(1));
    assert!(text(&refused.stderr).contains("out of its range"), "{}", text(&refused.stderr));
}

/// A drive that is switched off in the middle of a recording: what was recorded until then is kept, and the status says that it ended early.
#[test]
fn a_recording_outlives_the_port_that_it_came_through() {
    let Some(image) = image() else { return };
    let drive = image.start(ClockMode::Exact, None, &[]).unwrap_or_else(|error| panic!("{error:#}"));
    let folder = tempfile::tempdir().expect("a folder");
    // Far longer than it may take to see the first estimate.
    let (rig, recording) = bench(600.0);
    let [rig_path, trial, out] = ["rig.toml", "trial.csv", "heard.csv"].map(|name| folder.path().join(name));
    rig.write(&rig_path).expect("a rig file");
    recording.write(&trial, &rig).expect("a trial");
    let mut listen = palpate();
    listen.args(["listen", "--port"]).arg(drive.socket()).arg("--feed").arg(&trial).arg("--rig").arg(&rig_path);
    let mut child =
        listen.arg("--record").arg(&out).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("palpate runs");
    let mut shown = std::io::BufReader::new(child.stdout.take().expect("its output"));
    for _ in 0..20 {
        std::io::BufRead::read_line(&mut shown, &mut String::new()).expect("an estimate");
    }
    drop(drive);
    let done = child.wait_with_output().expect("it ends");
    assert_eq!(done.status.code(), Some(1));
    assert!(text(&done.stderr).contains("samples are recorded until then"), "{}", text(&done.stderr));
    let rows = std::fs::read_to_string(&out).expect("a recording").lines().count();
    assert!(rows > 500 && rows < 600_000, "{rows}");
    assert!(out.with_extension("toml").is_file());
}

/// A drive without sensors takes no good sample: the order is told as what it is.
#[test]
fn a_tare_that_is_not_carried_out_is_no_success() {
    let Some(image) = image() else { return };
    let drive = image.start(ClockMode::Exact, None, &[]).unwrap_or_else(|error| panic!("{error:#}"));
    let mut tare = palpate();
    let done = tare.args(["listen", "--tare", "--for", "0", "--port"]).arg(drive.socket()).output().expect("it runs");
    assert_eq!(done.status.code(), Some(1), "{}", text(&done.stderr));
    assert!(text(&done.stderr).contains("no tare: 0 good samples"), "{}", text(&done.stderr));
}

/// Whoever ends the tool by a signal leaves no emulator behind.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_ends_the_emulator_too() {
    if image().is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let (rig, recording) = bench(600.0);
    let [rig_path, trial] = ["rig.toml", "trial.csv"].map(|name| folder.path().join(name));
    rig.write(&rig_path).expect("a rig file");
    recording.write(&trial, &rig).expect("a trial");
    let mut replay = palpate();
    replay.args(["replay", "--on", "qemu", "--rig"]).arg(&rig_path).arg(&trial).env("TMPDIR", folder.path());
    let mut child = replay.stderr(Stdio::null()).stdout(Stdio::null()).spawn().expect("palpate runs");
    let command_line = |process: &str| std::fs::read_to_string(format!("/proc/{process}/cmdline")).unwrap_or_default();
    let emulator = loop {
        assert!(child.try_wait().expect("a process").is_none(), "it ended before the emulator began");
        let children = format!("/proc/{0}/task/{0}/children", child.id());
        let children = std::fs::read_to_string(children).unwrap_or_default();
        let found = children.split_whitespace().find(|process| command_line(process).contains("qemu-system-arm"));
        if let Some(found) = found {
            break found.to_owned();
        }
        std::thread::yield_now();
    };
    Command::new("kill").args(["-TERM", &child.id().to_string()]).status().expect("kill runs");
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    // It was ended before its parent was; the system takes a moment to clear it away.
    while command_line(&emulator).contains("qemu-system-arm") {
        std::thread::yield_now();
    }
    let left = std::fs::read_dir(folder.path()).expect("a folder").flatten();
    let left: Vec<_> =
        left.map(|file| file.file_name()).filter(|name| name != "rig.toml" && name != "trial.csv").collect();
    assert!(left.is_empty(), "{left:?}");
}

/// A pseudo-terminal is a serial port to whoever opens it: the way that a board's is taken.
#[cfg(target_os = "linux")]
#[test]
fn listen_takes_a_serial_port() {
    use std::io::{BufRead as _, BufReader};
    let Some(image) = image() else { return };
    let mut qemu = Command::new("qemu-system-arm");
    qemu.args(["-machine", "netduinoplus2", "-display", "none", "-monitor", "none", "-icount", "shift=3"]);
    let mut child = qemu
        .args(["-serial", "pty", "-kernel"])
        .arg(&image.path)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("QEMU runs");
    let lines = BufReader::new(child.stdout.take().expect("its output")).lines();
    let port = lines.map_while(Result::ok).find_map(|line| {
        let place = line.split_whitespace().find(|word| word.starts_with("/dev/"))?;
        Some(place.to_owned())
    });
    let port = port.expect("QEMU names its terminal");
    let done = palpate().args(["listen", "--for", "1", "--counters", "--port", &port]).output().expect("palpate runs");
    // It may have ended by itself only where something is wrong.
    let ran = child.try_wait().expect("a process").is_none();
    child.kill().expect("it runs");
    child.wait().expect("it ends");
    assert!(ran && done.status.success(), "{}", text(&done.stderr));
    assert!(text(&done.stdout).contains("FAULT position alarm, force parity"), "{}", text(&done.stdout));
}

#[test]
fn calibrate_turns_its_own_example_into_a_block_that_a_drive_reads() {
    let folder = tempfile::tempdir().expect("a folder");
    let [toml, block] = ["calibration.toml", "calibration.bin"].map(|name| folder.path().join(name));
    let example = palpate().args(["calibrate", "--example"]).output().expect("palpate runs");
    assert!(example.status.success(), "{}", text(&example.stderr));
    std::fs::write(&toml, &example.stdout).expect("a file");
    let made = palpate().arg("calibrate").arg(&toml).arg("--out").arg(&block).output().expect("palpate runs");
    assert!(made.status.success(), "{}", text(&made.stderr));
    assert_eq!(Calibration::read(&std::fs::read(&block).expect("a block")), Ok(Calibration::DEFAULT));
    let wrong = text(&example.stdout).replace("travel_per_turn = ", "travel_per_turn = 0.0 #");
    std::fs::write(&toml, wrong).expect("a file");
    let refused = palpate().arg("calibrate").arg(&toml).arg("--out").arg(&block).output().expect("palpate runs");
    assert_eq!(refused.status.code(), Some(1));
    assert!(text(&refused.stderr).contains("travel_per_turn"), "{}", text(&refused.stderr));
}
