//! The concealed proof, held as a user holds it: cases drawn, answers sealed, diagnosed, opened, scored.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use palpate_lab::challenge::challenge_score::ChallengeScore;
use palpate_lab::challenge::recordings;
use palpate_lab::challenge::summary;
use serde_json::Value;
use tempfile::TempDir;

/// Of a run that tests can wait for: ten cases of our own simulation.
const SEED: &str = "2026";
const CASES: usize = 10;

fn palpate() -> Command {
    Command::new(env!("CARGO_BIN_EXE_palpate"))
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// Holds a challenge of `cases` and `seed` in `folder`; returns the score and what was said.
fn held(folder: &Path, cases: usize, seed: &str) -> (Value, String) {
    let arguments = ["challenge", "--source", "own", "--seed", seed, "--out", "kept", "--json", "score.json"];
    let arguments = arguments.into_iter().chain(["--recordings", "none"]);
    let output = palpate().current_dir(folder).args(arguments).args(["--cases", &cases.to_string()]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && output.stdout.is_empty(), "{said}");
    (json(&folder.join("score.json")), said)
}

#[test]
fn ten_cases_are_sealed_diagnosed_opened_and_scored() {
    let folder = TempDir::new().unwrap();
    let (score, said) = held(folder.path(), CASES, SEED);
    println!("{said}");
    assert_eq!((&score["schema"], &score["cases"]), (&"palpate.challenge/1".into(), &CASES.into()));

    // The commitment is that of the answers, by another implementation of the hash, and was published before any diagnosis.
    let sealed = score["sealed_sha256"].as_str().unwrap();
    if let Ok(other) = std::process::Command::new("sha256sum").arg(folder.path().join("kept/answers.jsonl")).output() {
        assert_eq!(String::from_utf8(other.stdout).unwrap().split_whitespace().next().unwrap(), sealed);
    }
    assert!(said.find(sealed).unwrap() < said.find("case-").unwrap(), "{said}");

    // What the command was given is the rig file and the trials, and nothing that betrays the rest.
    for case in fs::read_dir(folder.path().join("kept")).unwrap().map(|entry| entry.unwrap().path()) {
        if !case.is_dir() {
            continue;
        }
        let mut files: Vec<_> =
            fs::read_dir(&case).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        files.sort();
        assert_eq!(files, ["diagnosis.json", "rig.toml", "trial-1.csv", "trial-2.csv"], "{}", case.display());
        assert!(!fs::read_to_string(case.join("rig.toml")).unwrap().contains("effect"), "{}", case.display());
    }

    // The score is that of its rows.
    let rows = score["rows"].as_array().unwrap();
    let (none, single): (Vec<&Value>, Vec<&Value>) = rows
        .iter()
        .filter(|row| row["kind"] != "pair" && row["kind"] != "outside")
        .partition(|row| row["kind"] == "none");
    let named = |row: &&&Value| row["named"] != Value::Array(Vec::new());
    assert_eq!(score["none"]["false_alarms"], none.iter().filter(named).count());
    assert_eq!(score["single"]["detected"], single.iter().filter(named).count());
    let right = |row: &&&Value| row["named"] == row["truth"];
    assert_eq!(score["single"]["named_rightly"], single.iter().filter(right).count());

    // And the diagnosis does what it is for: no alarm, half of what is larger than the floor by name and nothing beside, and
    // all of it among the names offered.
    assert_eq!(score["none"]["false_alarms"], 0, "{said}");
    let large: Vec<&&Value> = single.iter().filter(|row| row["strength"].as_f64().unwrap() >= 1.0).collect();
    let hits = large.iter().filter(|row| row["named"] == row["truth"]).count();
    assert!(large.len() >= 2 && 2 * hits >= large.len(), "{hits} of {}: {said}", large.len());
    let offered = |row: &&&&Value| row["named"].as_array().unwrap().contains(&row["truth"][0]);
    assert_eq!(large.iter().filter(offered).count(), large.len(), "{said}");
}

#[test]
fn the_same_seed_is_the_same_challenge_and_another_is_another() {
    let sealed = |seed: &str| {
        let folder = TempDir::new().unwrap();
        held(folder.path(), 1, seed).0["sealed_sha256"].clone()
    };
    assert_eq!(sealed("5"), sealed("5"));
    assert_ne!(sealed("5"), sealed("6"));
}

#[test]
fn a_score_is_redrawn_without_a_run_and_a_broken_one_is_refused() {
    let folder = TempDir::new().unwrap();
    let (score, _) = held(folder.path(), 2, "5");
    let redraw = |from: &str| {
        let mut command = palpate();
        command.current_dir(&folder).args(["challenge", "--from", from, "--json", "-", "--report", "page.html"]);
        command.output().unwrap()
    };
    let again = redraw("score.json");
    assert!(again.status.success());
    assert_eq!(serde_json::from_slice::<Value>(&again.stdout).unwrap(), score);
    let page = fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(page.contains(score["sealed_sha256"].as_str().unwrap()) && page.ends_with("</html>\n"));

    fs::write(folder.path().join("broken.json"), "{\"schema\": \"palpate.challenge/1\"}").unwrap();
    let refused = redraw("broken.json");
    assert_eq!(refused.status.code(), Some(1));
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.contains("broken.json") && said.contains("missing field"), "{said}");
}

#[test]
fn no_case_is_a_fault_of_the_command_line() {
    let refused = palpate().args(["challenge", "--cases", "0", "--recordings", "none"]).output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
}

#[test]
fn the_page_of_the_diagnosis_shows_the_run_of_its_aims() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let run: ChallengeScore = serde_json::from_value(json(&project.join("results/aims.json"))).unwrap();
    let page = fs::read_to_string(project.join("docs/diagnosis.md")).unwrap();
    assert!(page.contains(summary::table(&run).trim()), "the table is of another run");
}

#[test]
fn the_readme_shows_the_published_score() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let published = json(&project.join("results/challenge.json"));
    let challenge: ChallengeScore = serde_json::from_value(published).unwrap();
    let readme = fs::read_to_string(project.join("README.md")).unwrap();
    let table = summary::table(&challenge);
    assert_eq!(summary::replaced(&readme, &table).as_deref(), Some(readme.as_str()), "made by hand?");
    let page = fs::read_to_string(project.join("results/challenge.html")).unwrap();
    assert!(page.contains(&challenge.sealed_sha256), "the page is of another run");
    // A run that was published before there were real recordings in it has none, and is read all the same.
    if let Some(real) = &challenge.recorded {
        let diagnosis = fs::read_to_string(project.join("docs/diagnosis.md")).unwrap();
        assert_eq!(
            summary::replaced(&diagnosis, &recordings::table::section(real)).as_deref(),
            Some(diagnosis.as_str()),
            "made by hand?"
        );
    }
}
