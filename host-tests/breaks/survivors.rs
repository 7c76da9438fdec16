//! Mutants that no test can notice, held against the sources and against a run of `cargo mutants`.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// A mutation at its place: file, text of its line and column therein, and what is replaced there.
type Mutant = (String, String, usize, String);

fn project() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn source(file: &str) -> String {
    fs::read_to_string(project().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// The mutants that are argued in `.cargo/mutants-survivors.toml`, with the reasons.
fn argued() -> Vec<(Mutant, String)> {
    let list: toml::Table = source(".cargo/mutants-survivors.toml").parse().expect("TOML");
    let entry = |value: &toml::Value| {
        let text = |key: &str| value.get(key).and_then(toml::Value::as_str).expect(key).to_owned();
        let column = value.get("column").and_then(toml::Value::as_integer).expect("column");
        let mutant = (text("file"), text("line"), usize::try_from(column).expect("a column"), text("mutation"));
        (mutant, text("reason"))
    };
    list["survivor"].as_array().expect("entries").iter().map(entry).collect()
}

/// A line of `missed.txt`, "src/window.rs:43:9: replace + with - in Window<N>::push", by the text of the line that it names.
fn missed(line: &str) -> Mutant {
    let mut parts = line.splitn(4, ':');
    let mut part = || parts.next().expect("file:line:column: mutation");
    let (file, row, column, mutation) = (part(), part(), part(), part());
    let row: usize = row.parse().expect("a line");
    let text = source(file).lines().nth(row - 1).expect("a line of the source").trim_start().to_owned();
    let indent = source(file).lines().nth(row - 1).map_or(0, |whole| whole.len() - text.len());
    let column: usize = column.parse().expect("a column");
    (file.to_owned(), text, column - indent, mutation.trim().to_owned())
}

#[test]
fn every_argued_mutant_is_still_in_the_source() {
    for ((file, line, column, mutation), reason) in argued() {
        let text = source(&file);
        let lines = text.lines().filter(|found| found.trim_start() == line).count();
        assert_eq!(lines, 1, "{file}: {line:?}");
        // "replace - with + in encode", "delete ! in ...", "replace NAME -> TYPE with VALUE".
        let words: Vec<&str> = mutation.split(' ').collect();
        let [verb, what, ..] = words.as_slice() else { panic!("{mutation}") };
        assert!(["replace", "delete"].contains(verb), "{mutation}");
        if mutation.contains(" -> ") {
            let name = what.rsplit("::").next().unwrap_or(what);
            assert!(text.contains(&format!("fn {name}")), "{file}: no function {name}");
        } else {
            assert!(line.get(column - 1..).is_some_and(|rest| rest.starts_with(what)), "{file}: {line:?} at {column}");
            let function =
                mutation.rsplit("::").next().and_then(|name| name.split(' ').next_back()).unwrap_or_default();
            assert!(text.contains(&format!("fn {function}")), "{file}: no function {function}");
        }
        assert!(reason.split_whitespace().count() >= 5, "{file}: {mutation}: a reason is a sentence");
    }
}

/// PALPATE_MUTANTS names the folders `mutants.out` of a run, separated by commas: whatever it left is argued, and whatever
/// is argued of the files that it examined was left.
#[test]
#[ignore = "needs a run of cargo mutants, which takes hours"]
fn a_run_leaves_what_is_argued_and_nothing_else() {
    let folders = std::env::var("PALPATE_MUTANTS").expect("PALPATE_MUTANTS=FOLDER[,FOLDER]");
    let (mut left, mut examined) = (BTreeSet::new(), BTreeSet::new());
    for folder in folders.split(',').map(Path::new) {
        let text = |name: &str| fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        left.extend(text("missed.txt").lines().map(missed));
        for name in ["missed.txt", "caught.txt"] {
            examined.extend(text(name).lines().filter_map(|line| Some(line.split(':').next()?.to_owned())));
        }
    }
    let argued: BTreeSet<Mutant> =
        argued().into_iter().map(|(mutant, _)| mutant).filter(|(file, ..)| examined.contains(file)).collect();
    let unargued: Vec<_> = left.difference(&argued).collect();
    assert!(unargued.is_empty(), "no test notices, and nothing is said of: {unargued:#?}");
    let noticed: Vec<_> = argued.difference(&left).collect();
    assert!(noticed.is_empty(), "argued, and noticed by a test: {noticed:#?}");
}
