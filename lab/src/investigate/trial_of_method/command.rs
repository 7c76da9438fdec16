//! The command line of `palpate investigate-challenge`.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context as _, Result};
use clap::Args;

use super::listed_rig::{ListedRig, listed};
use super::row::Row;
use super::table::table;
use crate::investigate::record::write;
use crate::terminal::printable;

/// Investigate rigs whose missing physics is concealed, against fixed rich recordings of equal length
#[derive(Debug, Clone, Args)]
pub struct InvestigateChallengeArgs {
    /// How many rigs are drawn, an even sample of the cases of our own simulation; 0: only those of --source
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub cases: usize,
    /// Rigs of other authors beside those (--cases 0: alone): folders of NNN/rig.toml, NNN/trial-*.csv, NNN/limits.toml, NNN/rich-*.csv
    /// and the executable NNN/bed, with truth.json as `challenge` reads it; docs/investigate.md says what each holds
    #[arg(long, value_name = "DIR", value_delimiter = ',')]
    pub source: Vec<PathBuf>,
    /// Seed of the rigs that are drawn
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
/// No rig is asked for, a source cannot be read, a folder that cannot be written, a bed that fails, or a rig of which no diagnosis can be
/// made.
pub fn run(args: &InvestigateChallengeArgs) -> Result<()> {
    let begun = Instant::now();
    let rigs = listed(args)?;
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot make {}", args.out.display()))?;
    // A bed is called with absolute paths, whatever folder it works in.
    let out = std::path::absolute(&args.out).with_context(|| format!("no absolute path of {}", args.out.display()))?;
    let file = |rig: &ListedRig| out.join(format!("row-{}.json", rig.name()));
    // A source that is at fault is told before the first rig, and not after a night.
    rigs.iter().filter(|rig| !file(rig).exists()).try_for_each(ListedRig::check)?;
    let mut rows: Vec<Row> = Vec::new();
    for rig in &rigs {
        let row = match std::fs::read_to_string(file(rig)) {
            Ok(text) => rig.row(&text, &file(rig))?,
            Err(_) if args.minutes.is_some_and(|most| begun.elapsed().as_secs() > 60 * most) => continue,
            Err(_) => rig.investigate(args, &out.join(format!("case-{}", rig.name())))?,
        };
        write(&file(rig), serde_json::to_string_pretty(&row)?.as_bytes())?;
        eprintln!("{}", printable(&row.line()));
        rows.push(row);
    }
    write(&out.join("rows.json"), (serde_json::to_string_pretty(&rows)? + "\n").as_bytes())?;
    let table = table(&rows);
    println!("{}", printable(&table));
    write(&out.join("table.md"), table.as_bytes())
}
