//! The command line of `palpate challenge`.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};
use clap::Args;

use super::case_source::CaseSource;
use super::challenge_score::ChallengeScore;
use super::recordings::table::table;
use super::{page, protocol, summary};
use crate::error::{InputError, UsageError};
use crate::outfile::OutFile;
use crate::output_paths;
use crate::progress::Steps;
use crate::qemu_bench::project;

/// Put the diagnosis to recordings whose missing effect is concealed from it
#[derive(Debug, Clone, Args)]
pub struct ChallengeArgs {
    /// How many of the 1580 cases, an even sample; all of them take hours. 0: only real recordings and the cases of folders
    #[arg(long, value_name = "N", default_value_t = 60)]
    pub cases: usize,
    /// Seed of the cases: the same seed, the same recordings
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Write the score as JSON; `-`: to standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write the page
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Where cases come from: simulators (own, mujoco, drake, exudyn; all where left out; all but own take 560 MB of Python packages,
    /// which are installed into a folder of their own: asked for on a terminal, announced elsewhere, never with PALPATE_NO_INSTALL=1), and
    /// folders of another author (NNN/rig.toml, NNN/trial-*.csv, truth.json with `truth` and `also` of each case)
    #[arg(long, value_name = "NAME|DIR", value_delimiter = ',')]
    pub source: Vec<CaseSource>,
    /// Real recordings beside the cases: `all`, `none`, or those whose names begin so, as `tissue_indentation/soft`
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_value = "all")]
    pub recordings: Vec<String>,
    /// Run the baselines on the same files: plain BIC, PySINDy and SysIdentPy
    #[arg(long, alias = "rivals")]
    pub baselines: bool,
    /// Begin no case after so many minutes of diagnosing; those not reached are listed as left out
    #[arg(long, value_name = "N")]
    pub minutes: Option<u64>,
    /// Keep recordings, committed answers and diagnoses here; a run that was interrupted goes on from them
    #[arg(long, alias = "keep", value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Run nothing: redraw page and tables of a score that was written by --json
    #[arg(long, value_name = "FILE", conflicts_with_all = ["cases", "seed", "source", "recordings", "baselines", "minutes", "out"])]
    pub from: Option<PathBuf>,
    /// Put the score into results/challenge.json of this project, its page beside it, what fails into the README, all counts
    /// into docs/measured.md
    #[arg(long)]
    pub publish: bool,
}

/// What takes the time of a page: a case is drawn and diagnosed for a picture.
const DRAWING: &str = "the page, for which one case is drawn and diagnosed anew";

/// Runs `palpate challenge`.
///
/// # Errors
/// A file that cannot be read or written, a seal that does not hold, or a diagnosis that cannot be started.
pub fn run(args: &ChallengeArgs) -> Result<()> {
    let real = args.recordings.iter().any(|name| name != "none");
    let folders = args.source.iter().any(|source| matches!(source, CaseSource::Folder(_)));
    let expected = "at least one, or real recordings, or a folder of cases";
    ensure!(args.cases > 0 || real || folders, UsageError::new("--cases", 0, expected));
    let outputs = [("--json", &args.json), ("--report", &args.report)];
    let outputs: Vec<_> = outputs.iter().filter_map(|(option, path)| Some((*option, path.as_deref()?))).collect();
    // A score may be written anew over itself: it is read as a whole before.
    output_paths::check(&[], &outputs)?;
    let open = |path: &Option<PathBuf>| {
        path.as_deref().filter(|path| path.as_os_str() != "-").map(OutFile::create).transpose()
    };
    let (json, report) = (open(&args.json)?, open(&args.report)?);
    let challenge = match &args.from {
        Some(path) => {
            let steps = Steps::new("challenge");
            steps.say("reading the score, and holding its counts against its rows");
            read(path)?
        }
        None => protocol::run(args)?,
    };
    let summary = summary::table(&challenge);
    let mut text = summary.clone() + "\n";
    if let Some(recorded) = &challenge.recorded {
        text += &(table(recorded) + "\n");
    }
    if args.json.as_deref().is_some_and(|path| path.as_os_str() == "-") {
        eprint!("{text}");
    } else {
        std::io::stdout().write_all(text.as_bytes()).context("standard output")?;
    }
    let text = serde_json::to_string_pretty(&challenge).context("the score cannot be written as JSON")? + "\n";
    if let Some(mut file) = report {
        let steps = Steps::new("challenge");
        steps.say(DRAWING);
        page::write(&challenge, &mut file).map_err(|error| file.fault(&error))?;
        file.commit()?;
    }
    if args.publish {
        let steps = Steps::new("challenge");
        steps.say(DRAWING);
        publish(&challenge, &text)?;
    }
    match json {
        Some(file) => commit(file, text.as_bytes()),
        None if args.json.is_some() => Ok(std::io::stdout().write_all(text.as_bytes())?),
        None => Ok(()),
    }
}

/// A score as `--json` wrote it.
fn read(path: &Path) -> Result<ChallengeScore> {
    let text = std::fs::read_to_string(path).map_err(|error| InputError::new(path.display(), error, "a score"))?;
    let wrong = |found: String| InputError::new(path.display(), found, "a score of palpate.challenge/1");
    let challenge: ChallengeScore = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    ensure!(challenge.schema == "palpate.challenge/1", wrong(challenge.schema));
    challenge.check().with_context(|| format!("{}: not as it was scored", path.display()))?;
    Ok(challenge)
}

/// Puts the score where the project shows it.
fn publish(challenge: &ChallengeScore, text: &str) -> Result<()> {
    let project = project()?;
    let results = project.join("results");
    let mut page = Vec::new();
    page::write(challenge, &mut page).context("the page cannot be written")?;
    let files = [
        filled(project.join("README.md"), &summary::readme(challenge))?,
        filled(project.join("docs/measured.md"), &summary::documented(challenge))?,
        (results.join("challenge.json"), text.as_bytes().to_vec()),
        (results.join("challenge.html"), page),
    ];
    files.into_iter().try_for_each(|(path, bytes)| commit(OutFile::create(&path)?, &bytes))
}

/// The file at `path` and its new text: `part` between the marks.
fn filled(path: PathBuf, part: &str) -> Result<(PathBuf, Vec<u8>)> {
    let old = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let lacking = || InputError::new(path.display(), "no place for the table", summary::BEGIN);
    let new = summary::replaced(&old, part).ok_or_else(lacking)?;
    Ok((path, new.into_bytes()))
}

fn commit(mut file: OutFile, bytes: &[u8]) -> Result<()> {
    file.write_all(bytes).map_err(|error| file.fault(&error))?;
    Ok(file.commit()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_score_of_another_schema_is_refused_by_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("score.json");
        let score = crate::challenge::challenge_score::tests::score();
        let text = serde_json::to_string(&score).unwrap();
        std::fs::write(&path, &text).unwrap();
        assert_eq!(read(&path).unwrap().rows_sha256, score.rows_sha256);
        std::fs::write(&path, text.replacen("palpate.challenge/1", "palpate.challenge/2", 1)).unwrap();
        let error = read(&path).unwrap_err().to_string();
        assert!(error.contains("palpate.challenge/2"), "{error}");
    }
}
