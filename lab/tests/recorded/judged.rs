//! A recording's answer held against what is known of it.

use std::path::Path;

use palpate_lab::diagnose::answer::Answer;
use palpate_lab::diagnose::diagnose;
use palpate_lab::recording::Recording;
use palpate_lab::rig::Rig;

use crate::sets::Set;

/// Names of dry friction.
pub const DRY: [&str; 2] = ["hysteresis", "coulomb_friction"];

/// What `palpate diagnose --rig lab/rigs/RIG.toml FILE` answers.
pub fn diagnosed(rig: &str, file: &Path) -> Result<Answer, String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("rigs").join(format!("{rig}.toml"));
    let rig = Rig::read(&path).map_err(|error| error.to_string())?;
    let trial = Recording::read(file, &rig).map_err(|error| error.to_string())?;
    let found = diagnose(&rig, &path.display().to_string(), &[trial], &[], 1, &|_| ());
    found.map(|found| found.answer).map_err(|error| format!("{error:#}"))
}

/// Names of the physics in the answer.
pub fn named(answer: &Answer) -> Vec<&str> {
    answer.physics.iter().map(|physics| physics.name.as_str()).collect()
}

/// Names of what the answer says it cannot tell from it.
pub fn rivals(answer: &Answer) -> Vec<&str> {
    let mut names: Vec<&str> = answer.rivals.iter().flat_map(|rival| &rival.physics).map(String::as_str).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// Whether the answer itself says that these data do not tell dry friction from damping.
pub fn leaves_friction_open(answer: &Answer) -> bool {
    let says = |text: &str| text.contains("cannot be told from hysteresis") || text.contains("from dry friction");
    !answer.rivals.is_empty() || answer.findings.iter().any(|finding| says(&finding.text))
}

/// named, missed, wrong, or undecidable and said so.
pub fn judgement(set: &Set, answer: &Answer) -> String {
    let (named, rivals) = (named(answer), rivals(answer));
    let is_known = |name: &&&str| set.known.contains(*name);
    let unknown = named.contains(&"unknown");
    let wrong: Vec<&str> = named.iter().filter(|name| !is_known(name) && **name != "unknown").copied().collect();
    if named.is_empty() {
        return "missed".to_owned();
    }
    if !wrong.is_empty() {
        let offered = rivals.iter().any(|rival| is_known(&rival));
        return if offered && wrong.len() == 1 {
            format!("undecidable and said so: {} with what is known among its rivals", wrong[0])
        } else {
            format!("wrong: {}", wrong.join(", "))
        };
    }
    let friction = named.iter().any(|name| DRY.contains(name));
    if friction && set.friction_is_open {
        let said = leaves_friction_open(answer);
        return if said { "undecidable and said so: dry or viscous" } else { "wrong: claims what kind of friction" }
            .to_owned();
    }
    match (named.iter().any(|name| is_known(&name)), unknown) {
        (true, false) => "named".to_owned(),
        (true, true) => "named, and the rest owned".to_owned(),
        (false, _) if set.beyond => "undecidable and said so: the list does not hold all of it".to_owned(),
        (false, _) => "missed, and owned as unknown".to_owned(),
    }
}

/// A line of the table.
pub fn line(set: &Set, name: &str, answer: &Result<Answer, String>) -> String {
    let answer = match answer {
        Ok(answer) => answer,
        Err(error) => return format!("| {name} | not diagnosed: {error} | | | | {} | missed |", set.says),
    };
    let verdict = serde_json::to_value(answer.verdict).expect("a verdict as JSON");
    let fit = &answer.fit;
    let list = |names: Vec<&str>| if names.is_empty() { "-".to_owned() } else { names.join(", ") };
    format!(
        "| {name} | {} | {} | {} | {:.3e} -> {:.3e} ({:.1e}) {} | {} | {} |",
        verdict.as_str().unwrap_or_default(),
        list(named(answer)),
        list(rivals(answer)),
        fit.refitted,
        fit.improved,
        fit.noise_floor,
        fit.unit,
        set.says,
        judgement(set, answer)
    )
}
