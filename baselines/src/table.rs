//! The table, whole and as docs/profile.md has it.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result};
use palpate::Observation;
use palpate_lab::profile::{Figures, Profile, observations};
use palpate_lab::tools::Leave;

use crate::accuracy;

const HEAD: &str = "| update | window | instructions, mean / worst | cycles, modelled | bytes | rms error of K |
|---|---|---|---|---|---|
";

const BEGIN: &str = "<!-- written by `palpate-baselines --document`; not by hand -->";
const END: &str = "<!-- end of what `palpate-baselines` writes -->";

/// A row of the table of docs/profile.md: what it is called there, whether it is of `palpate`, and the name and window it was measured by.
type Row = (&'static str, bool, &'static str, Option<u16>);

const ROWS: [Row; 16] = [
    ("nalgebra", false, "nalgebra", None),
    ("kfilter", false, "kfilter", None),
    ("adskalman", false, "adskalman", None),
    ("minikalman", false, "minikalman", None),
    ("palpate `ewrls`, the estimate alone", true, "ewrls_alone", None),
    ("palpate `ewrls`, with interval and flags", true, "ewrls", None),
    ("palpate `cusum_rls`, the estimate alone", true, "cusum_rls_alone", None),
    ("palpate `cusum_rls`, with interval and flags", true, "cusum_rls", None),
    ("nalgebra, window summed anew", false, "nalgebra_window", Some(50)),
    ("palpate `bls`, with interval and flags", true, "bls", Some(50)),
    ("nalgebra, window summed anew", false, "nalgebra_window", Some(300)),
    ("palpate `bls`, the estimate alone", true, "bls_alone", Some(300)),
    ("palpate `bls`, with interval and flags", true, "bls", Some(300)),
    ("palpate `bls`, summed anew", true, "bls_anew", Some(300)),
    ("palpate `blmf`, with interval and flags", true, "blmf", Some(300)),
    ("palpate `blmf`, summed anew", true, "blmf_anew", Some(300)),
];

/// What was measured of both.
struct Measured {
    ours: Profile,
    baselines: Profile,
    rows: Vec<Observation>,
}

impl Measured {
    fn take() -> Result<Self> {
        let ours = Profile::take(Leave::Install, &|step| eprintln!("ours: {step}"))?;
        Ok(Self {
            ours,
            baselines: Profile::of(Leave::Install, "palpate-baselines", "--example", "baselines", &|step| {
                eprintln!("baselines: {step}")
            })?,
            rows: observations()?,
        })
    }

    fn line(&self, label: &str, figures: &Figures) -> String {
        let error = accuracy::of(&figures.name, figures.window, &self.rows);
        line(label, figures, &error.map_or_else(String::new, |error| format!("{error:.1e} ")))
    }

    fn document(&self) -> Result<String> {
        let mut table = HEAD.to_owned();
        for (label, ours, name, window) in ROWS {
            let figures = if ours { &self.ours.figures } else { &self.baselines.figures };
            let found = figures.iter().find(|f| f.name == name && f.window == window);
            table += &self.line(label, found.with_context(|| format!("{name} was not measured"))?);
        }
        Ok(table)
    }
}

fn line(label: &str, f: &Figures, error: &str) -> String {
    let mut line = String::new();
    let window = f.window.map_or_else(String::new, |window| format!("{window} "));
    // A string takes whatever is written to it.
    let _ = writeln!(
        line,
        "| {label} | {window}| {:.0} / {} | {} to {} | {} | {error}|",
        f.instructions_mean, f.instructions_worst, f.cycles_lo, f.cycles_hi, f.state_bytes
    );
    line
}

/// `text` with what stands between the marks replaced by `table`; `None` where the marks are not there.
fn replaced(text: &str, table: &str) -> Option<String> {
    let (before, rest) = text.split_once(BEGIN)?;
    let (_, after) = rest.split_once(END)?;
    Some(format!("{before}{BEGIN}\n\n{}\n\n{END}{after}", table.trim()))
}

/// Prints the whole table.
///
/// # Errors
/// A tool is missing, or an image fails.
pub fn print() -> Result<()> {
    let measured = Measured::take()?;
    print!("{HEAD}");
    let whole = |f: &&Figures| !f.name.starts_with("identify") && !f.name.starts_with("front");
    let compared = measured.ours.figures.iter().filter(whole).map(|figures| ("palpate ", figures));
    for (by, f) in measured.baselines.figures.iter().map(|figures| ("", figures)).chain(compared) {
        if accuracy::of(&f.name, f.window, &measured.rows).is_some() {
            print!("{}", measured.line(&format!("{by}{}", f.name), f));
        }
    }
    let passes = measured.ours.passes() + measured.baselines.passes();
    println!("\nCounted twice alike on {passes} passes. No board was measured.");
    Ok(())
}

/// Writes the rows of docs/profile.md into it.
///
/// # Errors
/// As [`print`]; or docs/profile.md has no place for them.
pub fn write() -> Result<()> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/profile.md");
    let document = std::fs::read_to_string(&path).context("docs/profile.md")?;
    let text =
        replaced(&document, &Measured::take()?.document()?).context("docs/profile.md: the marks of the table")?;
    std::fs::write(&path, text).context("docs/profile.md")
}

#[cfg(test)]
mod tests {
    use super::*;
    use palpate_lab::profile::kept_costs;
    use palpate_lab::tools::{self, MissingTools};

    /// Mean and worst instructions of the row of docs/profile.md that begins with `start`.
    fn told(document: &str, start: &str) -> [f64; 2] {
        let row =
            document.lines().find_map(|line| line.strip_prefix(start)).unwrap_or_else(|| panic!("no row {start}"));
        let (mean, worst) = row.split('|').next().and_then(|cell| cell.split_once('/')).expect("mean / worst");
        [mean, worst].map(|figure| figure.trim().parse().expect("a number"))
    }

    #[test]
    fn the_document_tells_the_instructions_that_are_counted() {
        let document = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/profile.md"))
            .expect("docs/profile.md");
        assert_eq!(
            replaced(&document, "x").map(|text| text.matches("| nalgebra |").count()),
            Some(0),
            "rows beside the marks"
        );
        // Of our own rows another test sees to it that they cost what the budget says.
        let budget = kept_costs().expect("the budget");
        let baselines = match tools::for_profiling(Leave::Look) {
            Ok(_) => Some(
                Profile::of(Leave::Look, "palpate-baselines", "--example", "baselines", &|_| ())
                    .unwrap_or_else(|error| panic!("{error:#}")),
            ),
            Err(MissingTools(missing)) => {
                assert!(std::env::var_os("PALPATE_DEVICE").is_none(), "{missing:?}");
                eprintln!("left out: the baselines; {missing:?}");
                None
            }
        };
        for (label, ours, name, window) in ROWS {
            let counted = if ours {
                budget
                    .iter()
                    .find(|c| c.update == name && c.window == window)
                    .map(|c| [c.instructions_mean, c.instructions_worst.into()])
            } else {
                let Some(baselines) = &baselines else { continue };
                baselines
                    .figures
                    .iter()
                    .find(|f| f.name == name && f.window == window)
                    .map(|f| [f.instructions_mean, f.instructions_worst.into()])
            };
            let counted = counted.unwrap_or_else(|| panic!("{name} is not measured"));
            let window = window.map_or_else(String::new, |window| format!("{window} "));
            let told = told(&document, &format!("| {label} | {window}|"));
            for (told, counted) in told.into_iter().zip(counted) {
                assert!((told - counted).abs() <= 0.02 * counted, "{label}: docs/profile.md {told}, counted {counted}");
            }
        }
    }
}
