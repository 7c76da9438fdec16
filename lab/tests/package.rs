//! What would be published: metadata, files, and the pages that belong to it. Whole packages are built by the command of
//! `docs/internals.md`, which takes minutes.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// What `cargo package` is made for, library first.
const PUBLISHED: [&str; 4] = ["palpate", "palpate-drive", "palpate-cases", "palpate-lab"];

fn project() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn cargo(arguments: &[&str]) -> String {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo).args(arguments).current_dir(project()).output().expect("cargo runs");
    assert!(output.status.success(), "cargo {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

#[test]
fn every_published_package_says_what_it_is_and_depends_on_versions() {
    let metadata: Value =
        serde_json::from_str(&cargo(&["metadata", "--no-deps", "--offline", "--format-version", "1"])).expect("JSON");
    let packages = metadata["packages"].as_array().expect("packages");
    let is_published = |package: &&Value| package["publish"].is_null();
    let published: Vec<&str> =
        packages.iter().filter(is_published).filter_map(|package| package["name"].as_str()).collect();
    assert!(PUBLISHED.iter().all(|name| published.contains(name)), "{published:?}");
    assert_eq!(published.len(), PUBLISHED.len(), "{published:?}: the others say publish = false");
    for package in packages.iter().filter(is_published) {
        let name = &package["name"];
        for key in ["description", "license", "rust_version"] {
            assert!(package[key].is_string(), "{name}: no {key}");
        }
        for key in ["keywords", "categories"] {
            let count = package[key].as_array().map_or(0, Vec::len);
            assert!((1..=5).contains(&count), "{name}: {count} {key}");
        }
        for dependency in package["dependencies"].as_array().expect("dependencies") {
            let anything = dependency["req"] == "*";
            assert!(!anything || dependency["kind"] == "dev", "{name}: {} without a version", dependency["name"]);
        }
    }
}

#[test]
fn a_package_holds_what_it_is_compiled_from_and_nothing_else() {
    for (package, needed) in PUBLISHED.into_iter().zip([
        &["src/lib.rs", "README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"][..],
        &["src/lib.rs"],
        &["src/main.rs", "simulators/requirements.txt", "baselines/requirements.txt"],
        &["src/main.rs", "assets/page.css", "assets/uplot/LICENSE", "rigs/bench.toml", "budget.csv", "README.md"],
    ]) {
        let list = cargo(&["package", "--list", "--allow-dirty", "--offline", "--package", package]);
        let files: Vec<&str> = list.lines().map(|line| line.trim()).collect();
        for file in needed {
            let file = file.replace('/', std::path::MAIN_SEPARATOR_STR);
            assert!(files.contains(&file.as_str()), "{package} lacks {file}");
        }
        let strange = files.iter().find(|file| file.starts_with("results") || file.starts_with("tests"));
        assert_eq!(strange, None, "{package}");
    }
}

#[test]
fn the_page_of_effects_names_every_effect_and_no_other() {
    let page = std::fs::read_to_string(project().join("docs/effects.md")).expect("docs/effects.md");
    let listed: Vec<&str> = page.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next()).collect();
    let json: Value = serde_json::from_str(&palpate(&["effects", "--json", "-"])).expect("JSON");
    let known: Vec<&str> =
        json["effects"].as_array().expect("effects").iter().filter_map(|e| e["name"].as_str()).collect();
    assert_eq!(listed, known, "`palpate effects` has them in this order");
}

#[test]
fn every_link_of_the_pages_leads_to_a_file() {
    let docs = std::fs::read_dir(project().join("docs")).expect("docs").map(|entry| entry.expect("an entry").path());
    let top = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md"].map(|name| project().join(name));
    for page in docs.chain(top).filter(|path| path.extension().is_some_and(|extension| extension == "md")) {
        let text = std::fs::read_to_string(&page).expect("a page");
        for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = target.split('#').next().unwrap_or_default();
            if file.is_empty() || file.contains("://") {
                continue;
            }
            assert!(page.parent().expect("a folder").join(file).exists(), "{}: {target}", page.display());
        }
    }
}

#[test]
fn the_readme_is_short_enough_to_be_read() {
    let readme = std::fs::read_to_string(project().join("README.md")).expect("README.md");
    let prose = readme.split("```").step_by(2).collect::<String>();
    let words = prose.split_whitespace().count();
    assert!(words <= 1_200, "{words} words");
}

fn palpate(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_palpate")).args(arguments).output().expect("palpate");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

#[test]
fn completions_know_every_command() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = palpate(&["completions", shell]);
        assert!(["diagnose", "simulate", "replay", "schema"].iter().all(|name| script.contains(name)), "{shell}");
    }
}

#[test]
fn the_schema_of_a_report_describes_what_is_written() {
    let schema: Value = serde_json::from_str(&palpate(&["schema", "diagnosis"])).expect("JSON");
    for key in ["schema", "verdict", "physics", "rivals", "locations", "fit", "checked"] {
        assert!(schema["properties"][key].is_object(), "{key}");
    }
    let verdicts = schema["$defs"]["Verdict"].to_string();
    assert!(["no_mismatch", "partly_explained"].iter().all(|word| verdicts.contains(word)), "{verdicts}");
    let profile: Value = serde_json::from_str(&palpate(&["schema", "profile"])).expect("JSON");
    assert!(profile["properties"]["methods"].is_object() && profile["$defs"]["Figures"].is_object(), "{profile}");
}
