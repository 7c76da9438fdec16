//! The command line of `palpate diagnose`: files in, files out.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Context as _, Result, bail};
use clap::Args;
use sha2::{Digest as _, Sha256};

use super::{Found, diagnose, thresholds};
use crate::diagnose::experiment::Experiment;
use crate::diagnose::report::diagnosis::{Diagnosis, Run};
use crate::diagnose::report::html;
use crate::diagnose::report::model_file::model_file;
use crate::diagnose::report::recorded_motion::runnable;
use crate::error::{InputError, UsageError};
use crate::investigate::separating_trial::separating_trial;
use crate::outfile::OutFile;
use crate::output_paths;
use crate::page::{neighbour, quantity};
use crate::progress::Steps;
use crate::recording::Recording;
use crate::replay::REPLAY_PAGE;
use crate::rig::Rig;
use crate::terminal::printable;
use crate::threshold::vary;
use crate::threshold_margin::{ThresholdMargin, note_margins, noted_margins};

/// Find where simulation and recordings differ, and which physics is missing
#[derive(Debug, Clone, Args)]
pub struct DiagnoseArgs {
    /// The rig file: the simulation
    #[arg(long, value_name = "RIG.toml")]
    pub rig: PathBuf,
    /// Recordings of the real thing, one file a trial
    #[arg(required = true, value_name = "TRIAL.csv")]
    pub trials: Vec<PathBuf>,
    /// What your own simulator gave for each trial, in the same order, in the columns of a recording
    #[arg(long, value_name = "SIM.csv", num_args = 1..)]
    pub simulation: Vec<PathBuf>,
    /// Write the diagnosis as JSON; `-`: to standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write the report, one self-contained page
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Write the improved rig file, which `palpate simulate` runs
    #[arg(long, value_name = "FILE.toml")]
    pub model: Option<PathBuf>,
    /// Write the reference trajectory that would separate the alternatives, where there are any
    #[arg(long, value_name = "FILE.csv")]
    pub experiment: Option<PathBuf>,
    /// Seed of the noise that is drawn to estimate what the sensors alone would show in the drive: the same seed, the same answer
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Multiply a threshold of the diagnosis by a factor, to see what hangs on it; `palpate sweep-thresholds --list` names them
    #[arg(long, value_name = "NAME=FACTOR", hide_short_help = true)]
    pub vary: Option<String>,
    /// Write as JSON between which factors each threshold could be multiplied, alone, with the same answer to the byte
    #[arg(long, value_name = "FILE", hide_short_help = true, conflicts_with = "vary")]
    pub margins: Option<PathBuf>,
}

/// Runs `palpate diagnose`.
///
/// # Errors
/// A rig file or recording at fault, a wrong count of simulations, or an output that cannot be written.
pub fn run(args: &DiagnoseArgs) -> Result<()> {
    if let Some(setting) = &args.vary {
        vary(setting, thresholds())?;
    }
    if args.margins.is_some() {
        note_margins();
    }
    let rig = Rig::read(&args.rig)?;
    let origin = args.rig.display().to_string();
    if !args.simulation.is_empty() && args.simulation.len() != args.trials.len() {
        let expected = format!("one a trial, {} in all", args.trials.len());
        bail!(UsageError::new("--simulation", format!("{} files", args.simulation.len()), expected));
    }
    check_outputs(args)?;
    let read = |paths: &[PathBuf]| paths.iter().map(|path| Recording::read(path, &rig)).collect::<Result<Vec<_>, _>>();
    let (trials, simulation) = (read(&args.trials)?, read(&args.simulation)?);
    args.simulation.iter().zip(&simulation).zip(&trials).try_for_each(|((path, run), trial)| fits(path, run, trial))?;
    // Opened before the work: a place that cannot be written is reported at once.
    let open = |path: &Option<PathBuf>| {
        path.as_deref().filter(|path| path.as_os_str() != "-").map(OutFile::create).transpose()
    };
    let (json, page, model_place) = (open(&args.json)?, open(&args.report)?, open(&args.model)?);
    let (experiment, margins) = (open(&args.experiment)?, open(&args.margins)?);
    let steps = Steps::new("diagnose");
    let say = |step: &str| steps.say(step);
    let mut found = diagnose(&rig, &origin, &trials, &simulation, args.seed, &say)?;
    if (page.is_some() || experiment.is_some()) && !found.answer.alternatives.is_empty() {
        say("the trial that would decide");
        // Without a recorded reference the loop is not known: then the motion that suits the recorded one stays.
        let designed = separating_trial(&rig, &found, &trials);
        found.pictures.experiment = designed.or(found.pictures.experiment);
    }
    found.pictures.run = Some(run_record(args)?);
    drop(steps);
    if let Some(file) = model_place {
        commit(file, model(args, &rig, &found, &trials)?.as_bytes())?;
    }
    if let Some(mut file) = page {
        html::write(&found.answer, &found.pictures, &mut file).map_err(|error| file.fault(&error))?;
        file.commit()?;
    }
    let is_designed = found.pictures.experiment.is_some();
    if let (Some(file), Some(next)) = (experiment, &found.pictures.experiment) {
        commit(file, trajectory(next, &rig).as_bytes())?;
    }
    let text = serde_json::to_string_pretty(&found.answer).context("the diagnosis cannot be written as JSON")? + "\n";
    if let Some(file) = json {
        commit(file, text.as_bytes())?;
    }
    if let Some(file) = margins {
        let text =
            serde_json::to_string_pretty(&margins_of_all()).context("the margins cannot be written as JSON")? + "\n";
        commit(file, text.as_bytes())?;
    }
    print(&found.answer, &text, args.json.as_deref().is_some_and(|path| path.as_os_str() == "-"))?;
    if args.experiment.is_some() && !is_designed {
        let why = if found.answer.alternatives.is_empty() {
            "no alternative is left to be told from the answer"
        } else {
            "no motion within what was recorded would tell the alternatives apart; what would is said above"
        };
        eprintln!("note: no experiment is written: {why}");
    }
    let experiment = args.experiment.as_ref().filter(|_| is_designed);
    for path in [args.json.as_ref(), args.report.as_ref(), args.model.as_ref(), experiment].into_iter().flatten() {
        if path.as_os_str() != "-" {
            eprintln!("wrote {}", printable(&path.display().to_string()));
        }
    }
    Ok(())
}

/// The margin of every threshold, those included that nothing was compared with.
fn margins_of_all() -> BTreeMap<&'static str, ThresholdMargin> {
    let noted = noted_margins();
    let of = |name: &str| noted.get(name).copied().unwrap_or(ThresholdMargin::UNUSED);
    thresholds().map(|threshold| (threshold.name, of(threshold.name))).collect()
}

/// The text of the improved rig file.
fn model(args: &DiagnoseArgs, rig: &Rig, found: &Found, recorded: &[Recording]) -> Result<String> {
    let text = std::fs::read_to_string(&args.rig).with_context(|| format!("{}: cannot be read", args.rig.display()))?;
    let trials: Vec<String> = args.trials.iter().map(|path| file_name(path)).collect();
    let source = trials.join(", ");
    let improved = recorded.first().map_or_else(|| found.improved.clone(), |one| runnable(rig, &found.improved, one));
    model_file(&text, rig, &improved, &found.answer.nominal, &source)
        .with_context(|| format!("{}: has changed and is no rig file any more", args.rig.display()))
}

fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    // A comment ends with its line, and a terminal obeys control characters.
    name.chars().map(|letter| if letter.is_control() { '?' } else { letter }).collect()
}

/// What it takes to make this diagnosis again.
fn run_record(args: &DiagnoseArgs) -> Result<Run> {
    let inputs = || std::iter::once(&args.rig).chain(&args.trials).chain(&args.simulation);
    let hashed = |path: &PathBuf| -> Result<(String, String)> {
        let bytes = std::fs::read(path).with_context(|| format!("{}: cannot be read", path.display()))?;
        let hash = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        Ok((file_name(path), hash))
    };
    let mut words = vec!["palpate diagnose --rig".to_owned(), quoted(&args.rig)];
    words.extend(args.trials.iter().map(|path| quoted(path)));
    if !args.simulation.is_empty() {
        words.push("--simulation".to_owned());
        words.extend(args.simulation.iter().map(|path| quoted(path)));
    }
    words.push(format!("--seed {}", args.seed));
    Ok(Run {
        date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        version: env!("CARGO_PKG_VERSION"),
        command: words.join(" "),
        seed: args.seed,
        inputs: inputs().map(hashed).collect::<Result<_>>()?,
        replay_page: args.report.as_deref().and_then(|page| neighbour::beside(page, &[REPLAY_PAGE], "palpate replay")),
    })
}

/// A path as a shell takes it.
fn quoted(path: &Path) -> String {
    let text = path.display().to_string();
    let is_plain = text.chars().all(|letter| letter.is_alphanumeric() || "/._-+:,".contains(letter));
    if is_plain { text } else { format!("'{}'", text.replace('\'', r"'\''")) }
}

/// Refuses a simulation that ends before its trial does, or lacks one of its channels: a residual against nothing is none.
fn fits(path: &Path, run: &Recording, trial: &Recording) -> Result<(), InputError> {
    let length = |of: &Recording| of.time.last().copied().unwrap_or(0.0) - of.time.first().copied().unwrap_or(0.0);
    let (found, wanted) = (length(run), length(trial));
    let error = |found: String, expected: String| Err(InputError::new(path.display(), found, expected));
    if found + 1.5 * run.period().max(trial.period()) < wanted {
        return error(format!("{found} s of it"), format!("as long as its trial, {} with {wanted} s", trial.name));
    }
    let pairs = [("force", &run.force, &trial.force), ("effort", &run.effort, &trial.effort)];
    match pairs.iter().find(|(_, run, trial)| run.is_none() && trial.is_some()) {
        Some((channel, ..)) => error(format!("no {channel}"), format!("the channels of its trial, {}", trial.name)),
        None => Ok(()),
    }
}

/// No file is read and written, and none is written twice.
fn check_outputs(args: &DiagnoseArgs) -> Result<()> {
    let inputs: Vec<&Path> =
        std::iter::once(&args.rig).chain(&args.trials).chain(&args.simulation).map(PathBuf::as_path).collect();
    let outputs = [
        ("--json", &args.json),
        ("--report", &args.report),
        ("--model", &args.model),
        ("--experiment", &args.experiment),
        ("--margins", &args.margins),
    ];
    let given = outputs.iter().filter_map(|(option, path)| Some((*option, path.as_deref()?)));
    output_paths::check(&inputs, &given.collect::<Vec<_>>())
}

fn commit(mut file: OutFile, bytes: &[u8]) -> Result<()> {
    file.write_all(bytes).map_err(|error| file.fault(&error))?;
    Ok(file.commit()?)
}

/// The answer to standard output, what else is to be known to standard error; where standard output is for the JSON `text`, all but that.
fn print(answer: &Diagnosis, text: &str, json_only: bool) -> Result<()> {
    let mut out = std::io::stdout().lock();
    if json_only {
        out.write_all(text.as_bytes())?;
        eprint!("{}", printable(&console_text(answer)));
    } else {
        out.write_all(printable(&console_text(answer)).as_bytes())?;
    }
    for finding in &answer.findings {
        let place = if finding.place.is_empty() { String::new() } else { format!("{}: ", finding.place) };
        let kind = if finding.grave { "warning" } else { "note" };
        eprintln!("{kind}: {}", printable(&format!("{place}{}", finding.text)));
    }
    Ok(())
}

/// Summary, effects with their values, and what else would do, a line each.
fn console_text(answer: &Diagnosis) -> String {
    let mut lines = vec![answer.summary.clone()];
    for physics in &answer.physics {
        lines.push(format!("  {}: {}", physics.name, physics.statement));
        lines.extend(physics.parameters.iter().map(|value| {
            let [low, high] = value.ci95;
            let (number, unit) = (quantity::plain(value.value, &value.unit), &value.unit);
            if low == high {
                return format!("    {} = {number} (chosen, not fitted)", value.name);
            }
            if !(low.is_finite() && high.is_finite()) {
                return format!("    {} = {number} (not bounded by these recordings)", value.name);
            }
            format!("    {} = {number} (95 %: {})", value.name, quantity::between(low, high, unit))
        }));
    }
    let alternatives = answer.alternatives.iter();
    lines.extend(
        alternatives.map(|other| format!("  not ruled out: {}. {}", other.physics.join(" and "), other.separated_by)),
    );
    lines.join("\n") + "\n"
}

fn trajectory(next: &Experiment, rig: &Rig) -> String {
    let name = if rig.coordinate == crate::rig::Coordinate::Rotary { "reference_rad" } else { "reference_m" };
    let mut text = format!("t_s,{name}\n");
    for (time, reference) in next.time.iter().zip(&next.reference) {
        text += &format!("{time},{reference}\n");
    }
    text
}
