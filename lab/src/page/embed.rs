//! The data inside the page: one JSON element that describes, and base64 columns that carry the numbers.

use super::{ESTIMATE_COLUMNS, Page, Trial, Units, column};
use serde::Serialize;
use std::io::{self, Write};

/// The names under which the script finds the columns of a method, in the order of `Estimates::columns`.
const OF_A_METHOD: [&str; ESTIMATE_COLUMNS] =
    ["stiffness", "stiffness-half-width", "damping", "damping-half-width", "innovation"];

#[derive(Serialize)]
struct Description<'a> {
    trials: Vec<DescribedTrial<'a>>,
}

#[derive(Serialize)]
struct DescribedTrial<'a> {
    units: DescribedUnits<'a>,
    nominal_stiffness: f64,
    nominal_damping: f64,
    rows: usize,
    best: Option<usize>,
    methods: Vec<DescribedMethod<'a>>,
}

#[derive(Serialize)]
struct DescribedUnits<'a> {
    position: &'a str,
    force: &'a str,
    stiffness: &'a str,
    damping: &'a str,
}

#[derive(Serialize)]
struct DescribedMethod<'a> {
    name: &'a str,
    title: &'a str,
    colour: usize,
}

/// Writes the description and the drawn columns of every trial.
pub(super) fn data(page: &Page, out: &mut impl Write) -> io::Result<()> {
    let trials = page.trials.iter().map(|trial| describe(page, trial)).collect();
    column::description(&Description { trials }, out)?;
    for (index, trial) in page.trials.iter().enumerate() {
        columns(index, trial, out)?;
    }
    Ok(())
}

fn describe<'a>(page: &Page, trial: &'a Trial) -> DescribedTrial<'a> {
    let Units { position, force, stiffness, damping } = trial.units;
    let describe_method =
        |m: &'a super::Method| DescribedMethod { name: m.name, title: m.title, colour: colour(page, m.name) };
    DescribedTrial {
        units: DescribedUnits { position, force, stiffness, damping },
        nominal_stiffness: trial.nominal_stiffness,
        nominal_damping: trial.nominal_damping,
        rows: trial.drawn.time.len(),
        best: trial.best().map(|(method, ..)| method),
        methods: trial.methods.iter().map(describe_method).collect(),
    }
}

/// A method wears one colour on the whole page, even where a trial lacks some of the others.
pub(super) fn colour(page: &Page, name: &str) -> usize {
    let mut seen: Vec<&str> = Vec::new();
    for method in page.trials.iter().flat_map(|trial| &trial.methods) {
        if !seen.contains(&method.name) {
            seen.push(method.name);
        }
    }
    seen.iter().position(|other| *other == name).unwrap_or(0)
}

fn columns(index: usize, trial: &Trial, out: &mut impl Write) -> io::Result<()> {
    let drawn = &trial.drawn;
    let rows: Vec<usize> = (0..drawn.time.len()).collect();
    // Single precision would round a clock that counts from an epoch.
    column::write(out, &format!("t{index}-time"), &rows, |row| drawn.time[row].to_le_bytes())?;
    column::write(out, &format!("t{index}-contact"), &rows, |row| [u8::from(drawn.contact[row])])?;
    column::write(out, &format!("t{index}-penetration"), &rows, |row| drawn.penetration[row].to_le_bytes())?;
    column::write(out, &format!("t{index}-force"), &rows, |row| drawn.force[row].to_le_bytes())?;
    for (number, estimates) in drawn.estimates.iter().enumerate() {
        for (name, values) in OF_A_METHOD.into_iter().zip(estimates.columns()) {
            column::write(out, &format!("t{index}-m{number}-{name}"), &rows, |row| values[row].to_le_bytes())?;
        }
    }
    Ok(())
}
