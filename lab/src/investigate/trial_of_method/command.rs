//! The command line of `palpate investigate-challenge`.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context as _, Result};
use clap::Args;
use palpate_cases::SimulatorKind;

use super::own_rig::investigate;
use super::row::Row;
use super::table::table;
use crate::challenge::case_list::sample;
use crate::investigate::record::write;

/// Investigate rigs whose missing physics is concealed, against fixed rich recordings of equal length
#[derive(Debug, Clone, Args)]
pub struct InvestigateChallengeArgs {
    /// How many rigs, an even sample of the cases of our own simulation
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub cases: usize,
    /// Seed of the rigs
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Most trials for each
    #[arg(long, value_name = "N", default_value_t = 3)]
    pub rounds: u64,
    /// Begin no rig after so many minutes
    #[arg(long, value_name = "N")]
    pub minutes: Option<u64>,
    /// Folder for each investigation and the scores; what it holds already is not run again
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Runs `palpate investigate-challenge`.
///
/// # Errors
/// A folder that cannot be written, or a rig of which no diagnosis can be made.
pub fn run(args: &InvestigateChallengeArgs) -> Result<()> {
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot make {}", args.out.display()))?;
    let begun = Instant::now();
    let mut rows: Vec<Row> = Vec::new();
    for case in sample(args.cases, &[SimulatorKind::Own], args.seed) {
        let file = args.out.join(format!("row-{:04}.json", case.index));
        let row = match std::fs::read_to_string(&file) {
            Ok(text) => serde_json::from_str(&text).with_context(|| format!("{} is no score", file.display()))?,
            Err(_) if args.minutes.is_some_and(|most| begun.elapsed().as_secs() > 60 * most) => break,
            Err(_) => {
                let row = investigate(args, &case)?;
                write(&file, serde_json::to_string_pretty(&row)?.as_bytes())?;
                row
            }
        };
        eprintln!("{}", row.line());
        rows.push(row);
    }
    write(&args.out.join("rows.json"), (serde_json::to_string_pretty(&rows)? + "\n").as_bytes())?;
    let table = table(&rows);
    println!("{table}");
    write(&args.out.join("table.md"), table.as_bytes())
}
