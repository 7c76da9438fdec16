//! The whole proof: everything left to chance but what is concealed.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use palpate_cases::effect::name::ALL;
use palpate_cases::{What, Wish};

use crate::case;
use crate::row::Row;
use crate::table;

/// Draws, diagnoses and scores all; what is done is on disk after each case.
pub fn run() -> Vec<Row> {
    let seed = number("PALPATE_PROOF_SEED", 1);
    let all = plan();
    let (page, lines) = (target().join("proof.md"), target().join("proof.jsonl"));
    let mut file = fs::File::create(&lines).expect("a file of lines that can be written");
    println!("{} cases of seed {seed}; {} and {}", all.len(), page.display(), lines.display());
    let mut rows = Vec::new();
    for (index, wish) in (0..).zip(&all) {
        let row = case::prove(seed, index, wish, 1);
        println!("{}/{} {}", index + 1, all.len(), row.line());
        let line = serde_json::to_string(&row).expect("a row as JSON");
        writeln!(file, "{line}").and_then(|()| file.flush()).expect("a line that can be written");
        rows.push(row);
        fs::write(&page, table::report(&rows)).expect("a page that can be written");
    }
    println!("{}", table::report(&rows));
    rows
}

/// The groups in turn, each spread over the whole: an interrupted run has seen something of all.
fn plan() -> Vec<Wish> {
    let each = number("PALPATE_PROOF_EACH", 20);
    let mut groups = vec![(number("PALPATE_PROOF_NONE", 300), What::Nothing)];
    let single = |name: &str| What::Single { name: Some(name.to_owned()), strength: fixed("PALPATE_PROOF_STRENGTH") };
    groups.extend(ALL.iter().filter(|known| known.listed).map(|known| (each, single(known.name))));
    groups.push((number("PALPATE_PROOF_OUTSIDE", 40), What::Outside { name: None, strength: None }));
    groups.push((number("PALPATE_PROOF_PAIRS", 20), What::Pair { names: None, strength: None }));
    let place = |nth: u64, count: u64| (nth as f64 + 0.5) / count as f64;
    let spread = |(count, what): (u64, What)| (0..count).map(move |nth| (place(nth, count), what.clone()));
    let mut cases: Vec<(f64, What)> = groups.into_iter().flat_map(spread).collect();
    cases.sort_by(|one, other| one.0.total_cmp(&other.0));
    cases.into_iter().map(|(_, what)| Wish { what: Some(what), ..Wish::default() }).collect()
}

fn number(variable: &str, otherwise: u64) -> u64 {
    let Ok(text) = std::env::var(variable) else { return otherwise };
    text.parse().unwrap_or_else(|_| panic!("{variable} is {text}; expected a whole number"))
}

/// A strength for all single effects instead of one drawn for each.
fn fixed(variable: &str) -> Option<f64> {
    let text = std::env::var(variable).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{variable} is {text}; expected a number")))
}

/// Where cargo builds.
fn target() -> PathBuf {
    let own = Path::new(env!("CARGO_TARGET_TMPDIR"));
    own.parent().unwrap_or(own).to_path_buf()
}
