//! The command line of `palpate diagnose-all`.

use std::fs::{self, File, TryLockError};
use std::io::Write as _;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail, ensure};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

use super::changes::{Comparison, compare};
use super::page::FleetPage;
use super::rig_folder::RIGS;
use super::source::{self, Fleet, FleetRig};
use super::table::Table;
use super::worker::{RigResult, Worker};
use crate::error::InputError;
use crate::outfile::OutFile;
use crate::terminal::printable;

/// The page.
const PAGE: &str = "index.html";
/// Held by the run that writes the folder.
const LOCK: &str = ".lock";

/// Diagnose many rigs into one table
#[derive(Debug, Clone, Args)]
pub struct DiagnoseAllArgs {
    /// A folder with a subfolder for each rig (rig.toml and its recordings), or a manifest in TOML or CSV
    #[arg(value_name = "FOLDER|MANIFEST")]
    pub source: PathBuf,
    /// Rigs that are diagnosed at the same time; one a processor where left out. The answers do not depend on it
    #[arg(long, value_name = "N")]
    pub jobs: Option<NonZeroUsize>,
    /// Where everything is written. A run that was interrupted, or whose inputs changed in part, is completed there
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// The output of an earlier run: the page shows what changed since
    #[arg(long, value_name = "EARLIER_DIR")]
    pub against: Option<PathBuf>,
    /// Seed of each diagnosis: the same seed, the same answers
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
}

/// Runs `palpate diagnose-all`. A rig that cannot be diagnosed is a row of the table.
///
/// # Errors
/// There is no rig, the output cannot be written or belongs to something else, the earlier table cannot be read, or none of the
/// rigs could be diagnosed.
pub fn run(args: &DiagnoseAllArgs) -> Result<()> {
    let Fleet { rigs, passed_over } = source::read(&args.source, &args.out)?;
    for folder in &passed_over {
        eprintln!("note: {} is passed over: it has no rig.toml", printable(&folder.display().to_string()));
    }
    // Read before anything is written: it may be the table that this run replaces.
    let earlier = args.against.as_deref().map(Table::read).transpose()?;
    let _lock = open_output(&args.source, &args.out)?;
    let results = diagnose_all(args, &rigs)?;
    let table = Table::of(&results);
    table.write(&args.out)?;
    let comparison = earlier.map(|earlier| compare(&earlier, &table));
    write_page(args, &table, comparison.as_ref())?;
    let failed = results.iter().filter(|result| result.diagnosis.is_err()).count();
    let earlier = results.iter().filter(|result| result.is_earlier).count();
    let changed = comparison.map(|comparison| format!(", {} changed", comparison.rigs.len())).unwrap_or_default();
    eprintln!(
        "{} rigs: {failed} failed, {earlier} done before{changed}; wrote {}",
        results.len(),
        args.out.join(PAGE).display()
    );
    ensure!(failed < results.len(), "none of the {failed} rigs could be diagnosed; the table says why");
    Ok(())
}

/// Diagnoses every rig; results are in the order of `rigs`.
fn diagnose_all(args: &DiagnoseAllArgs, rigs: &[FleetRig]) -> Result<Vec<RigResult>> {
    let processors = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let jobs = args.jobs.map_or(processors, NonZeroUsize::get).min(rigs.len());
    // Rigs side by side waste less than threads within one.
    let worker = Worker::new(args.seed, (processors / jobs).max(1))?;
    let bar = progress(rigs.len());
    let work = |rig: &FleetRig| {
        let result = worker.diagnose(rig, &args.out);
        bar.inc(1);
        bar.suspend(|| eprintln!("{}", printable(&result.line())));
        result
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs).build().context("no threads can be started")?;
    let results = pool.install(|| rigs.par_iter().with_max_len(1).map(work).collect());
    bar.finish_and_clear();
    Ok(results)
}

/// Makes the output and locks it: two runs that write one folder would disturb each other.
fn open_output(source: &Path, out: &Path) -> Result<File> {
    let is_new = !out.exists() || fs::read_dir(out).is_ok_and(|mut entries| entries.next().is_none());
    let is_source = fs::canonicalize(out).is_ok_and(|out| fs::canonicalize(source).is_ok_and(|source| source == out));
    if is_source || !(is_new || [LOCK, RIGS].iter().any(|name| out.join(name).exists())) {
        let expected = "a new or empty folder, or the output of an earlier run";
        bail!(InputError::new(out.display(), if is_source { "the fleet itself" } else { "something else" }, expected));
    }
    fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    let path = out.join(LOCK);
    let lock = File::create(&path).with_context(|| format!("cannot write {}", path.display()))?;
    match lock.try_lock() {
        Ok(()) => Ok(lock),
        Err(TryLockError::WouldBlock) => {
            bail!(InputError::new(out.display(), "another run that is writing it", "one run at a time"))
        }
        Err(TryLockError::Error(error)) => Err(error).with_context(|| format!("cannot lock {}", path.display())),
    }
}

fn write_page(args: &DiagnoseAllArgs, table: &Table, comparison: Option<&Comparison>) -> Result<()> {
    let against = args.against.as_deref().map(|folder| folder.display().to_string()).unwrap_or_default();
    let source = args.source.display().to_string();
    let page =
        FleetPage { source: &source, table, comparison: comparison.map(|comparison| (against.as_str(), comparison)) };
    let mut file = OutFile::create(&args.out.join(PAGE))?;
    page.write(&mut file).map_err(|error| file.fault(&error))?;
    file.flush().map_err(|error| file.fault(&error))?;
    Ok(file.commit()?)
}

/// To standard error, and hidden where that is no terminal.
fn progress(count: usize) -> ProgressBar {
    let bar = ProgressBar::new(count as u64).with_message("diagnosing");
    if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len}, {elapsed}, {eta} to go") {
        bar.set_style(style);
    }
    bar
}
