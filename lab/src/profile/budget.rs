//! What each update may cost: a file of the tree that a test holds the figures against.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use super::figures::Figures;

/// The file, in the folder of the sources.
pub const BUDGET_FILE: &str = "lab/budget.csv";

/// What one update costs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Its name.
    pub update: String,
    /// Its window, where it has one.
    pub window: Option<u16>,
    /// Instructions on the mean.
    pub instructions_mean: f64,
    /// The most of any update.
    pub instructions_worst: u32,
    /// Bytes of stack along the deepest call.
    pub stack_bytes: u32,
    /// Bytes of state and of the samples in its window.
    pub state_bytes: u32,
    /// Modelled cycles of the worst update, at least; informative only, because they follow from the instructions.
    pub worst_cycles_lo: u32,
    /// The same, at most.
    pub worst_cycles_hi: u32,
}

impl Cost {
    pub(super) fn of(figures: &Figures) -> Self {
        Self {
            update: figures.name.clone(),
            window: figures.window,
            instructions_mean: (figures.instructions_mean * 10.0).round() / 10.0,
            instructions_worst: figures.instructions_worst,
            stack_bytes: figures.stack_bytes,
            state_bytes: figures.state_bytes,
            worst_cycles_lo: figures.worst_cycles_lo,
            worst_cycles_hi: figures.worst_cycles_hi,
        }
    }

    fn numbers(&self) -> [(&'static str, f64); 4] {
        [
            ("instructions on the mean", self.instructions_mean),
            ("instructions at worst", f64::from(self.instructions_worst)),
            ("bytes of stack", f64::from(self.stack_bytes)),
            ("bytes of state", f64::from(self.state_bytes)),
        ]
    }
}

/// What the sources hold of every update.
///
/// # Errors
/// The file is none.
pub fn kept() -> Result<Vec<Cost>> {
    let mut reader = csv::Reader::from_reader(include_str!("../../budget.csv").as_bytes());
    reader.deserialize().collect::<Result<_, _>>().context(BUDGET_FILE)
}

/// Where the file stands.
pub fn path(project: &Path) -> PathBuf {
    project.join(BUDGET_FILE)
}

/// The file's new text.
///
/// # Errors
/// None: it is written to memory.
pub fn text(figures: &[Figures]) -> Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for figures in figures {
        writer.serialize(Cost::of(figures))?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

/// Share by which a figure may differ from its budget: another compiler may allot a register otherwise, the same one gives
/// the same bits.
const RELATIVE_TOLERANCE: f64 = 0.02;

/// Every figure that is not within its budget, in words; empty where all are.
///
/// # Errors
/// The file is not there or is none.
pub fn differences(figures: &[Figures], path: &Path) -> Result<String> {
    let mut reader = csv::Reader::from_path(path).with_context(|| format!("{}", path.display()))?;
    let budget: Vec<Cost> =
        reader.deserialize().collect::<Result<_, _>>().with_context(|| format!("{}", path.display()))?;
    let mut words = String::new();
    for row in figures.iter().map(Cost::of) {
        let allowed = budget.iter().find(|b| b.update == row.update && b.window == row.window);
        let name = row.window.map_or_else(|| row.update.clone(), |window| format!("{} {window}", row.update));
        let Some(allowed) = allowed else {
            let _ = writeln!(words, "{name} has no budget");
            continue;
        };
        for ((what, now), (_, then)) in row.numbers().into_iter().zip(allowed.numbers()) {
            if (now - then).abs() > RELATIVE_TOLERANCE * then {
                let _ = writeln!(words, "{name}: {now} {what}, the budget is {then}");
            }
        }
    }
    let gone = |b: &&Cost| !figures.iter().any(|f| f.name == b.update && f.window == b.window);
    for row in budget.iter().filter(gone) {
        let window = row.window.map_or_else(String::new, |window| format!(" of {window} samples"));
        let _ = writeln!(words, "{}{window} has a budget and was not measured", row.update);
    }
    Ok(words)
}
