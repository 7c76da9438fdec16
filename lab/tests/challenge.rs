//! The concealed proof, held as a user holds it: cases drawn, answers sealed, diagnosed, opened, scored.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use palpate_cases::truth::CaseKind;
use palpate_cases::{CaseRequest, EffectSelection, draw};
use palpate_lab::challenge::case_score::CaseScore;
use palpate_lab::challenge::challenge_score::ChallengeScore;
use palpate_lab::challenge::page;
use palpate_lab::challenge::scored_case::ScoredCase as _;
use palpate_lab::challenge::summary;
use serde_json::Value;
use statrs::distribution::{Binomial, DiscreteCDF as _};
use tempfile::TempDir;

/// Of a run that tests can wait for: sixteen cases of our own simulation, eight of them with one effect of strength 1 or more.
const SEED: &str = "15";
const CASES: usize = 16;

/// A count this improbable under the published rate, on either side, is another diagnosis than the published one.
const IMPROBABLE: f64 = 0.01;

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
    // How it goes on standard error, the answer on standard output.
    let answer = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && answer.contains("| concealed |"), "{said}{answer}");
    (json(&folder.join("score.json")), said)
}

#[test]
fn sixteen_cases_are_committed_to_diagnosed_opened_and_scored() {
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

    // And the diagnosis is as good as published, neither worse nor suspiciously better.
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let published: ChallengeScore = serde_json::from_value(json(&project.join("results/challenge.json"))).unwrap();
    let run: ChallengeScore = serde_json::from_value(score.clone()).unwrap();
    let none = |row: &CaseScore| row.kind == CaseKind::None;
    let single = |row: &CaseScore| row.kind == CaseKind::Single;
    as_published(&published, &run, none, CaseScore::is_false_alarm);
    as_published(&published, &run, single, CaseScore::is_detected);
    as_published(&published, &run, single, CaseScore::is_right);
    as_published(&published, &run, CaseScore::is_large, CaseScore::is_right);
    as_published(&published, &run, CaseScore::is_large, CaseScore::is_within);
}

/// Holds how often the rows `of` a kind are something in `run` against the binomial distribution of the published share.
fn as_published(
    published: &ChallengeScore,
    run: &ChallengeScore,
    of: impl Fn(&CaseScore) -> bool,
    is: impl Fn(&CaseScore) -> bool,
) {
    let [at_most, at_least] = tails(published, run, of, is);
    assert!(at_most > IMPROBABLE && at_least > IMPROBABLE, "P(at most) {at_most:.4}, P(at least) {at_least:.4}");
}

/// How probable it is that as few, and as many, of the rows `of` a kind are something as in `run`, by the published share.
fn tails(
    published: &ChallengeScore,
    run: &ChallengeScore,
    of: impl Fn(&CaseScore) -> bool,
    is: impl Fn(&CaseScore) -> bool,
) -> [f64; 2] {
    let count = |score: &ChallengeScore| {
        let rows: Vec<&CaseScore> = score.rows.iter().filter(|row| of(row)).collect();
        (rows.iter().filter(|row| is(row)).count() as u64, rows.len() as u64)
    };
    let ((hits, n), (before, all)) = (count(run), count(published));
    assert!(n > 2 && all > 20, "{n} and {all} cases show nothing");
    // Laplace's rule: what was always so among few is not always so.
    let share = (before as f64 + 1.0) / (all as f64 + 2.0);
    let binomial = Binomial::new(share, n).unwrap();
    println!("{hits} of {n}, published {before} of {all}");
    [binomial.cdf(hits), if hits == 0 { 1.0 } else { binomial.sf(hits - 1) }]
}

#[test]
fn half_right_is_not_what_is_published() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let published: ChallengeScore = serde_json::from_value(json(&project.join("results/challenge.json"))).unwrap();
    let large: Vec<&CaseScore> = published.rows.iter().filter(|row| row.is_large()).collect();
    let right: Vec<CaseScore> = large.into_iter().filter(|row| row.is_right()).cloned().collect();
    let wrong = right.iter().cloned().map(|mut row| {
        row.answer.named.clear();
        row
    });
    let mut run = published.clone();
    run.rows = right.iter().take(8).cloned().chain(wrong.take(8)).collect();
    let [at_most, _] = tails(&published, &run, CaseScore::is_large, CaseScore::is_right);
    assert!(at_most < IMPROBABLE, "eight of sixteen pass: {at_most}");
}

/// The text of a score with every measured time zero: nothing else may differ between two runs.
fn without_times(score: &Value) -> String {
    fn clear(value: &mut Value) {
        match value {
            Value::Object(map) => {
                for (key, value) in map.iter_mut() {
                    if key.starts_with("seconds") { *value = 0.into() } else { clear(value) }
                }
                // It is the hash of rows that hold times.
                map.remove("rows_sha256");
            }
            Value::Array(values) => values.iter_mut().for_each(clear),
            _ => {}
        }
    }
    let mut score = score.clone();
    clear(&mut score);
    score.to_string()
}

#[test]
fn an_interrupted_run_goes_on_where_it_was_and_ends_as_if_it_had_not_been_interrupted() {
    let folder = TempDir::new().unwrap();
    let (whole, _) = held(folder.path(), 3, "5");
    let kept = folder.path().join("kept");
    let read = |name: &str| fs::read_to_string(kept.join(name)).unwrap();
    let (answers, results) = (read("answers.jsonl"), read("results.jsonl"));
    assert_eq!((answers.lines().count(), results.lines().count()), (3, 3));

    // Killed in the second diagnosis: one line is whole, the next cut short.
    let first = results.lines().next().unwrap();
    fs::write(kept.join("results.jsonl"), format!("{first}\n{{\"case\": \"ca")).unwrap();
    let (resumed, said) = held(folder.path(), 3, "5");
    assert_eq!(without_times(&resumed), without_times(&whole));
    let done: Value = serde_json::from_str(first).unwrap();
    assert!(!said.contains(&format!("\n{}: [", done["case"].as_str().unwrap())), "diagnosed twice: {said}");
    assert_eq!(read("results.jsonl").lines().next().unwrap(), first);

    // Killed while cases were drawn: one is complete, one is half written, one is not there.
    let cases: Vec<Value> = answers.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let name = |at: usize| cases[at]["case"].as_str().unwrap();
    for file in ["answers.jsonl", "commitment.json", "results.jsonl"] {
        fs::remove_file(kept.join(file)).unwrap();
    }
    for at in 0..3 {
        fs::remove_file(kept.join(name(at)).join("diagnosis.json")).unwrap();
    }
    fs::write(kept.join("drawn.jsonl"), answers.lines().next().unwrap().to_owned() + "\n{").unwrap();
    fs::write(kept.join(name(1)).join("trial-1.csv"), "t_s").unwrap();
    fs::remove_dir_all(kept.join(name(2))).unwrap();
    let (again, _) = held(folder.path(), 3, "5");
    assert_eq!(without_times(&again), without_times(&whole));
    assert_eq!(read("answers.jsonl"), answers);

    // Another run does not go on from it, nor does this one where a recording or an answer has changed.
    let refused = |seed: &str, expected: &str| {
        let arguments = ["challenge", "--source", "own", "--cases", "3", "--recordings", "none", "--out", "kept"];
        let output = palpate().current_dir(&folder).args(arguments).args(["--seed", seed]).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(1) && said.contains(expected), "{expected}: {said}");
    };
    refused("6", "run.json");
    fs::write(kept.join("results.jsonl"), first.to_owned() + "\n").unwrap();
    let changed = (0..3).map(name).find(|name| done["case"] != *name).unwrap();
    let trial = fs::read_to_string(kept.join(changed).join("trial-2.csv")).unwrap();
    fs::write(kept.join(changed).join("trial-2.csv"), trial.clone() + "\n").unwrap();
    refused("5", "changed after its SHA-256");
    fs::write(kept.join(changed).join("trial-2.csv"), trial).unwrap();
    fs::write(kept.join("answers.jsonl"), answers.replacen("\"kind\":\"", "\"kind\": \"", 1)).unwrap();
    refused("5", "expected those committed to by");
}

#[test]
fn cases_of_another_author_are_scored_above_our_own() {
    let folder = TempDir::new().unwrap();
    let set = folder.path().join("elsewhere");
    let strong = EffectSelection::single("coulomb_friction", Some(8.0));
    for (name, selection) in [("000", EffectSelection::Nothing), ("001", strong)] {
        let request = CaseRequest { selection: Some(selection), effort: Some(true), ..CaseRequest::default() };
        draw(21, 0, &request).unwrap().write(&set.join(name)).unwrap();
    }
    let truth = r#"{"000": {"truth": [], "also": []}, "001": {"truth": ["coulomb_friction"], "note": "strong"}}"#;
    fs::write(set.join("truth.json"), truth).unwrap();
    let arguments =
        ["challenge", "--source", "elsewhere", "--recordings", "none", "--json", "score.json", "--out", "kept"];
    let output = palpate().current_dir(&folder).args(arguments).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    let score: ChallengeScore = serde_json::from_value(json(&folder.path().join("score.json"))).unwrap();
    let [external] = score.sources.as_slice() else { panic!("{:?}", score.sources) };
    assert_eq!((external.name.as_str(), external.cases, score.cases), ("elsewhere", 2, 0));
    assert_eq!((external.none.n, external.none.false_alarms), (1, 0), "{said}");
    // Something is found; whether by name is a matter of the diagnosis, and here only of its count.
    let right =
        external.rows.iter().filter(|row| row.case == "001" && row.answer.named == ["coulomb_friction"]).count();
    let counts = (external.single.n, external.single.detected, external.single.named_rightly);
    assert_eq!(counts, (1, 1, right), "{said}");
    score.check().unwrap();
    // The answers were committed to, and no case shows its own.
    assert_eq!(fs::read_to_string(folder.path().join("kept/answers.jsonl")).unwrap().lines().count(), 2);
    let mut files: Vec<_> = fs::read_dir(folder.path().join("kept/external-0001")).unwrap().collect();
    files.sort_by_key(|entry| entry.as_ref().unwrap().file_name());
    let files: Vec<_> = files.into_iter().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(files, ["diagnosis.json", "rig.toml", "trial-1.csv", "trial-2.csv"]);
    let own = ChallengeScore { cases: 1, ..score };
    let table = summary::table(&own);
    assert!(table.find("| `elsewhere` |").unwrap() < table.find("| concealed |").unwrap(), "{table}");
    // What fails of them is what the README says, of one case each nothing or all, and of which run.
    let readme = summary::readme(&own);
    for row in [
        format!("| other authors' cases: one effect, not named rightly | {} of 1 |", 1 - right),
        format!(
            "| nothing missing: something named or `unknown` | others 0 of 1; ours {} of {} |",
            own.none.false_alarms, own.none.n
        ),
        "| outside the list: not reported as unknown | others 0 of 0; ours 0 of 0 |".to_owned(),
    ] {
        assert!(readme.find(&row).unwrap() < readme.find(&own.sealed_sha256).unwrap(), "{readme}");
    }
    // And the page speaks of them in its heading.
    let mut page = Vec::new();
    page::write(&own, &mut page).unwrap();
    let page = String::from_utf8(page).unwrap();
    let heading =
        format!("<h1>Other authors' cases: one effect named correctly in {right} of 1, no false alarm in 1 of 1.</h1>");
    assert!(page.contains(&heading), "{}", &page[page.find("<h1>").unwrap()..][..200]);
    assert!(page.contains("2 cases of other authors and 1 of our own with concealed physics"));
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
    // Where it is no terminal, a line a step.
    let said = String::from_utf8_lossy(&again.stderr);
    assert!(said.contains("challenge: reading the score") && said.contains("challenge: the page"), "{said}");
    assert_eq!(serde_json::from_slice::<Value>(&again.stdout).unwrap(), score);
    let page = fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(page.contains(score["sealed_sha256"].as_str().unwrap()) && page.ends_with("</html>\n"));

    fs::write(folder.path().join("broken.json"), "{\"schema\": \"palpate.challenge/1\"}").unwrap();
    let refused = redraw("broken.json");
    assert_eq!(refused.status.code(), Some(1));
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.contains("broken.json") && said.contains("missing field"), "{said}");

    let mut edited = score;
    edited["rows"][0]["named"] = edited["rows"][0]["truth"].clone();
    edited["rows"][0]["seconds"] = 0.5.into();
    fs::write(folder.path().join("edited.json"), edited.to_string()).unwrap();
    let refused = redraw("edited.json");
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(refused.status.code() == Some(1) && said.contains("edited.json"), "{said}");
}

#[test]
fn no_case_is_a_fault_of_the_command_line() {
    let refused = palpate().args(["challenge", "--cases", "0", "--recordings", "none"]).output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
}

#[test]
fn the_page_of_what_was_measured_shows_the_run_of_its_aims() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let run: ChallengeScore = serde_json::from_value(json(&project.join("results/aims.json"))).unwrap();
    let page = fs::read_to_string(project.join("docs/measured.md")).unwrap();
    assert!(page.contains(summary::table(&run).trim()), "the table is of another run");
}

#[test]
fn readme_and_documentation_show_the_published_score() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let published = json(&project.join("results/challenge.json"));
    let challenge: ChallengeScore = serde_json::from_value(published).unwrap();
    for (name, part) in
        [("README.md", summary::readme(&challenge)), ("docs/measured.md", summary::documented(&challenge))]
    {
        let text = fs::read_to_string(project.join(name)).unwrap();
        assert_eq!(summary::replaced(&text, &part).as_deref(), Some(text.as_str()), "{name}: made by hand?");
    }
    let page = fs::read_to_string(project.join("results/challenge.html")).unwrap();
    assert!(page.contains(&challenge.sealed_sha256), "the page is of another run");
}
