//! What `palpate diagnose` says in its JSON, on its page, in the improved rig file and on the console is the same, to the printed digit.

#[path = "consistency/cases.rs"]
mod cases;
#[path = "consistency/page.rs"]
mod page;
#[path = "consistency/printed.rs"]
mod printed;
#[path = "page/reading.rs"]
mod reading;
#[path = "consistency/words.rs"]
mod words;

use std::collections::BTreeSet;
use std::path::Path;

use assert_cmd::Command;
use cases::{CASES, Case};
use printed::{agrees, percent_agrees};
use serde_json::Value;

/// What one diagnosis wrote.
#[derive(Clone)]
struct Written {
    json: Value,
    html: String,
    model: String,
    console: String,
    /// Standard error.
    notes: String,
}

fn diagnosed(case: &Case, folder: &Path) -> Written {
    let trials = case.write(folder);
    let path = |name: &str| folder.join(name);
    let output = Command::cargo_bin("palpate")
        .unwrap()
        .arg("diagnose")
        .arg("--rig")
        .arg(path("rig.toml"))
        .args(trials)
        .args(
            [["--json", "d.json"], ["--report", "d.html"], ["--model", "d.toml"]]
                .map(|[option, name]| std::ffi::OsString::from(format!("{option}={}", path(name).display()))),
        )
        .output()
        .unwrap();
    let [console, notes] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert!(output.status.success(), "{}: {notes}", case.name);
    let read = |name: &str| std::fs::read_to_string(path(name)).unwrap();
    Written {
        json: serde_json::from_str(&read("d.json")).unwrap(),
        html: read("d.html"),
        model: read("d.toml"),
        console,
        notes,
    }
}

/// Everything that does not agree.
fn contradictions(written: &Written) -> Vec<String> {
    let mut wrong = Vec::new();
    if all(&written.json, "channels").first() != Some(&written.json["fit"]) {
        wrong.push("json: the fit is not that of the first channel".to_owned());
    }
    wrong.extend(in_console(written));
    wrong.extend(in_model(written));
    wrong.extend(page::contradictions(&written.json, &written.html));
    wrong.extend(words::contradictions(&written.json, &written.html, &written.model, &written.notes));
    wrong
}

fn all<'a>(json: &'a Value, key: &str) -> &'a [Value] {
    json[key].as_array().map_or(&[], Vec::as_slice)
}

fn text<'a>(json: &'a Value, key: &str) -> &'a str {
    json[key].as_str().unwrap_or_default()
}

/// A number that is none is written as null.
fn float(number: &Value) -> f64 {
    number.as_f64().unwrap_or(f64::NAN)
}

fn in_console(written: &Written) -> Vec<String> {
    let mut wrong = Vec::new();
    let mut lines = written.console.lines();
    if lines.next() != Some(text(&written.json, "summary")) {
        wrong.push("console: another summary".to_owned());
    }
    for physics in all(&written.json, "physics") {
        let head = format!("  {}: {}", text(physics, "name"), text(physics, "statement"));
        if lines.next() != Some(head.as_str()) {
            wrong.push(format!("console: not {head:?}"));
        }
        if let Some((_, shown)) = text(physics, "statement").split_once("learned from the recordings takes ") {
            learned(physics, shown, &mut wrong);
        }
        for value in all(physics, "parameters") {
            let line = lines.next().unwrap_or_default();
            let shown = line.trim().strip_prefix(&format!("{} = ", text(value, "name")));
            let wanted = [&value["value"], &value["ci95"][0], &value["ci95"][1]].map(float);
            if !shown.is_some_and(|shown| agrees(shown, text(value, "unit"), &wanted)) {
                wrong.push(format!("console: {line:?} is not {value}"));
            }
        }
    }
    for other in all(&written.json, "rivals") {
        let names: Vec<&str> = all(other, "physics").iter().filter_map(Value::as_str).collect();
        let wanted = format!("  not ruled out: {}. {}", names.join(" and "), text(other, "separated_by"));
        if lines.next() != Some(wanted.as_str()) {
            wrong.push(format!("console: not {wanted:?}"));
        }
    }
    wrong.extend(lines.map(|line| format!("console: nothing says {line:?}")));
    wrong
}

/// What a learned curve takes, in words and as a number.
fn learned(physics: &Value, shown: &str, wrong: &mut Vec<String>) {
    if !percent_agrees(shown.split(" of it").next().unwrap(), float(&physics["evidence"]["held_out_gain"])) {
        wrong.push(format!("json: {shown:?} is not {}", physics["evidence"]));
    }
}

fn in_model(written: &Written) -> Vec<String> {
    let mut wrong = Vec::new();
    let model: toml::Table = written.model.parse().unwrap();
    let is_good = written.json["verdict"] == "no_mismatch";
    for row in all(&written.json, "nominal") {
        let key = text(row, "name");
        let stated = ["contact", "drive"].iter().find_map(|table| number(model.get(*table)?.get(key)?));
        let changes = [&row["given"], &row["fitted"]].map(float);
        // What a good simulation states is not replaced by what one recording made of it.
        let expected = if is_good { changes[0] } else { changes[1] };
        match stated {
            Some(stated) if same(stated, expected) => {}
            None if key.starts_with("effort_") => {}
            // In a merged diagnosis one channel may be good and keep its values.
            Some(stated) if same(stated, changes[0]) && all(&written.json, "channels").len() > 1 => {}
            _ => wrong.push(format!("model: {key} = {stated:?}, not {expected}")),
        }
        if let Some(comment) =
            written.model.lines().find(|line| line.starts_with(&format!("{key} = ")) && line.contains("95 %: "))
        {
            let ends = comment.split("95 %: ").nth(1).unwrap().split(';').next().unwrap();
            let wanted = [0, 1].map(|end| float(&row["ci95"][end]));
            let shown: Vec<f64> = ends.split(" to ").filter_map(|end| end.trim().parse().ok()).collect();
            let is_open = wanted.iter().any(|end| !end.is_finite());
            if is_open
                || shown.len() != 2
                || shown.iter().zip(wanted).any(|(shown, wanted)| !near(*shown, wanted, 1e-4))
            {
                wrong.push(format!("model: {comment:?} is not {wanted:?}"));
            }
        }
    }
    let effects = model.get("effect").and_then(toml::Value::as_array).cloned().unwrap_or_default();
    for physics in all(&written.json, "physics").iter().filter(|physics| physics["name"] != "unknown") {
        let table =
            effects.iter().find(|table| table.get("name").and_then(toml::Value::as_str) == physics["name"].as_str());
        let Some(table) = table.and_then(toml::Value::as_table) else {
            wrong.push(format!("model: no {}", physics["name"]));
            continue;
        };
        for value in all(physics, "parameters") {
            let name = text(value, "name");
            let keys = table.keys().filter(|key| is_key_of(key, name) && !key.contains("ci95"));
            let stated: Vec<f64> = keys.filter_map(|key| number(table.get(key)?)).collect();
            let wanted = float(&value["value"]);
            if !stated.iter().any(|stated| same(*stated, wanted)) {
                wrong.push(format!("model: {name} = {stated:?}, not {wanted}"));
            }
            let keys = table.keys().filter(|key| key.starts_with(name) && key.contains("ci95"));
            let ends: Vec<Vec<f64>> =
                keys.filter_map(|key| Some(table.get(key)?.as_array()?.iter().filter_map(number).collect())).collect();
            let wanted = [0, 1].map(|end| float(&value["ci95"][end]));
            if !ends.is_empty()
                && !ends.iter().any(|ends| ends.len() == 2 && same(ends[0], wanted[0]) && same(ends[1], wanted[1]))
            {
                wrong.push(format!("model: 95 % of {name} {ends:?}, not {wanted:?}"));
            }
        }
    }
    wrong
}

/// "level" or "level_n".
fn is_key_of(key: &str, name: &str) -> bool {
    key == name || key.strip_prefix(name).is_some_and(|unit| unit.starts_with('_'))
}

fn number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| Some(value.as_integer()? as f64))
}

fn same(one: f64, other: f64) -> bool {
    near(one, other, 1e-12)
}

fn near(one: f64, other: f64, share: f64) -> bool {
    (one - other).abs() <= share * one.abs().max(other.abs())
}

/// The page names every file that was read by its hash, and the seed; standard error names every file that was written.
fn record_of_the_run(written: &Written, folder: &Path) -> Vec<String> {
    use sha2::{Digest as _, Sha256};
    let record = written.html.split_once("id=\"run\"").map_or("", |(_, rest)| rest.split("</section>").next().unwrap());
    let hash = |name: &str| -> String {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect()
    };
    let read = ["rig.toml", "trial-1.csv", "trial-2.csv"].into_iter();
    let mut wrong: Vec<String> =
        read.filter(|name| !record.contains(&hash(name))).map(|name| format!("page: another hash of {name}")).collect();
    if !record.contains("<dt>seed</dt><dd>1</dd>") || !record.contains("--seed 1") {
        wrong.push("page: another seed".to_owned());
    }
    let written_files = ["d.json", "d.html", "d.toml"].into_iter();
    let unnamed = written_files
        .filter(|name| !written.notes.lines().any(|line| line.starts_with("wrote ") && line.ends_with(name)));
    wrong.extend(unnamed.map(|name| format!("console: {name} was written and is not named")));
    wrong
}

/// The improved rig runs.
fn simulated(case: &Case, folder: &Path) -> Result<(), String> {
    let out = folder.join("again.csv");
    let run = Command::cargo_bin("palpate")
        .unwrap()
        .args(["simulate", "--rig"])
        .arg(folder.join("d.toml"))
        .arg("--out")
        .arg(&out)
        .output()
        .unwrap();
    let rows = std::fs::read_to_string(&out).map_or(0, |text| text.lines().count());
    let is_run = run.status.success() && rows > 100;
    is_run.then_some(()).ok_or_else(|| format!("{}: simulate: {}", case.name, String::from_utf8_lossy(&run.stderr)))
}

#[test]
fn every_number_is_the_same_wherever_it_is_told() {
    let mut wrong = Vec::new();
    let mut verdicts = BTreeSet::new();
    let mut named = 0;
    let mut has_learned = false;
    for case in CASES {
        let folder = tempfile::tempdir().unwrap();
        let written = diagnosed(case, folder.path());
        println!("{}: {}", case.name, text(&written.json, "summary"));
        verdicts.insert(text(&written.json, "verdict").to_owned());
        has_learned |= written.model.contains("\"learned\"") && written.html.contains("with a learned curve");
        named += all(&written.json, "physics").iter().map(|physics| all(physics, "parameters").len()).sum::<usize>();
        wrong.extend(contradictions(&written).into_iter().map(|what| format!("{}: {what}", case.name)));
        wrong.extend(simulated(case, folder.path()).err());
        wrong.extend(
            record_of_the_run(&written, folder.path()).into_iter().map(|what| format!("{}: {what}", case.name)),
        );
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(CASES.len() >= 20);
    assert!(has_learned, "nothing was learned");
    // The cases would prove little if they all ended alike.
    assert!(verdicts.len() >= 4 && named >= 12, "{verdicts:?}, {named} parameters");
}

/// One figure changed anywhere is found.
#[test]
fn a_number_that_is_changed_in_one_place_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let case = CASES.iter().find(|case| case.name == "stress relaxation").unwrap();
    let written = diagnosed(case, folder.path());
    assert_eq!(contradictions(&written), Vec::<String>::new());
    let noticed = |what: &str, change: &dyn Fn(&mut Written)| {
        let mut changed = written.clone();
        change(&mut changed);
        assert!(!contradictions(&changed).is_empty(), "{what} was changed and nothing noticed it");
    };
    for at in [
        "/physics/0/parameters/0/value",
        "/physics/0/parameters/1/ci95/1",
        "/physics/0/evidence/held_out_gain",
        "/fit/improved",
        "/channels/0/refitted",
        "/channels/0/noise_floor",
        "/channels/0/explained_share",
        "/nominal/0/fitted",
        "/nominal/1/ci95/0",
        "/locations/0/share",
        "/locations/0/end_s",
    ] {
        noticed(at, &|changed| {
            let number = changed.json.pointer_mut(at).unwrap_or_else(|| panic!("no {at}"));
            *number = (0.93 * number.as_f64().unwrap()).into();
        });
    }
    noticed("the console", &|changed| {
        changed.console = changed.console.replace("branch_stiffness = ", "branch_stiffness = 1")
    });
    noticed("the file", &|changed| {
        changed.model = changed.model.replacen("branch_stiffness_n_m = ", "branch_stiffness_n_m = 1", 1)
    });
    noticed("a fitted value", &|changed| {
        changed.model = changed.model.replacen("\nstiffness_n_m = ", "\nstiffness_n_m = 1", 1)
    });
    for at in ["/fit/as_given", "/physics/0/evidence/p_value", "/correlations/0/matrix/1/0", "/nominal/1/given"] {
        noticed(at, &|changed| {
            let number = changed.json.pointer_mut(at).unwrap_or_else(|| panic!("no {at}"));
            *number = (number.as_f64().unwrap() + 0.3).into();
        });
    }
    noticed("what was written", &|changed| {
        changed.notes = changed.notes.replace("note: ", "").replace("No effort", "An effort")
    });
    noticed("the heading", &|changed| changed.html = changed.html.replace("Explained by", "Partly explained by"));
    noticed("a trace", &|changed| changed.html = page::with_another_trace(&changed.html));
}

#[test]
fn printed_numbers_are_read_back() {
    assert!(agrees("12.345 ± 0.070 kN s/m²", "N s/m^2", &[12_345.2, 12_275.0, 12_415.0]));
    assert!(!agrees("12.345 ± 0.070 kN s/m²", "N s/m^2", &[12_346.2, 12_275.0, 12_415.0]));
    assert!(!agrees("12.345 ± 0.070 kN s/m²", "N s/m^2", &[12_345.2, 12_255.0, 12_435.0]));
    assert!(agrees("(−3.210 ± 0.040) × 10⁻⁷ 1/s", "1/s", &[-3.21e-7, -3.25e-7, -3.17e-7]));
    assert!(agrees("1.12 N (95 %: 0.81 to 1.21 N)", "N", &[1.12, 0.81, 1.21]));
    assert!(!agrees("1.12 N (95 %: 0.81 to 1.21 N)", "N", &[1.12, 0.81, 1.26]));
    assert!(agrees("662 N s/m (95 %: 0.0 to 1.5 kN s/m)", "N s/m", &[662.0, 0.0, 1520.0]));
    assert!(agrees("1.634 (95 %: 1.34 to 1.93)", "1", &[1.6342, 1.34, 1.93]));
    assert!(percent_agrees("92 %", 0.9151) && !percent_agrees("92 %", 0.927) && percent_agrees("99.9 %", 0.99931));
}
