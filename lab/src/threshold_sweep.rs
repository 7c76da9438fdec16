//! `palpate sweep-thresholds`: how much the answers to fresh cases hang on each tuned number of the diagnosis.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context as _, Result};
use clap::Args;
use palpate_cases::truth::CaseKind;
use palpate_cases::{Case, SimulatorKind, draw};
use serde::{Deserialize, Serialize};

use crate::challenge::case_list::sample;
use crate::challenge::run_diagnosis::run_command;
use crate::diagnose::thresholds;
use crate::error::UsageError;
use crate::experiment_design::explanation::UNKNOWN;
use crate::own_program;
use crate::threshold::Threshold;
use crate::threshold_margin::ThresholdMargin;

/// Beside a case: between which factors each threshold changes nothing in it.
const MARGINS: &str = "margins.json";

/// What each threshold is multiplied by.
const FACTORS: [f64; 2] = [0.7, 1.3];

/// Vary each threshold of the diagnosis by 30 % to either side, one at a time, and count the answers that change
#[derive(Debug, Clone, Args)]
pub struct SweepThresholdsArgs {
    /// How many cases, an even sample of those of our own simulation
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub cases: usize,
    /// Seed of the cases
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Only thresholds whose names begin so, as `drive.` or `contact.LEAST_GAIN`; all where left out
    #[arg(long, value_name = "NAME")]
    pub only: Vec<String>,
    /// Begin no diagnosis after so many minutes
    #[arg(long, value_name = "N")]
    pub minutes: Option<u64>,
    /// Only list the thresholds: value, unit, origin, meaning
    #[arg(long)]
    pub list: bool,
    /// Folder for cases and answers; what it holds already is not run again
    #[arg(long, value_name = "DIR", required_unless_present = "list")]
    pub out: Option<PathBuf>,
}

/// An answer that was given under one setting.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Answer {
    /// NAME=FACTOR; empty where nothing is varied.
    pub setting: String,
    /// Folder of the case.
    pub case: String,
    /// What is missing, in a word.
    pub verdict: String,
    /// Names, sorted.
    pub named: BTreeSet<String>,
    /// Whether it was asked; an answer is known without where no comparison with the threshold would come out otherwise.
    pub was_asked: bool,
}

/// A case in its folder.
struct SweptCase {
    name: String,
    truth: BTreeSet<String>,
    trials: Vec<String>,
}

/// Runs `palpate sweep-thresholds`.
///
/// # Errors
/// A folder that cannot be written, a case that cannot be drawn, or a name that no threshold has.
pub fn run(args: &SweepThresholdsArgs) -> Result<()> {
    let chosen = chosen(&args.only)?;
    let Some(folder) = args.out.as_deref().filter(|_| !args.list) else {
        print!("{}", list(&chosen));
        return Ok(());
    };
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let cases = draw_cases(args, folder)?;
    let mut answers = Answers::open(folder)?;
    let begun = Instant::now();
    let settings = chosen.iter().flat_map(|threshold| FACTORS.map(|factor| Some((threshold, factor))));
    for varied in std::iter::once(None).chain(settings) {
        for case in &cases {
            if args.minutes.is_some_and(|most| begun.elapsed().as_secs() > 60 * most) {
                eprintln!("note: not all was run; the same command goes on from here");
                return report(folder, &chosen, &cases, &answers);
            }
            answers.ask(folder, varied, case)?;
        }
        if let Some((threshold, factor)) = varied {
            let setting = setting(threshold, factor);
            eprintln!("{setting}: {} of {} answers changed", answers.changed(&setting), answers.of(&setting).len());
        }
    }
    report(folder, &chosen, &cases, &answers)
}

/// The thresholds whose names begin with one of `only`.
fn chosen(only: &[String]) -> Result<Vec<Threshold>> {
    for start in only {
        if !thresholds().any(|threshold| threshold.name.starts_with(start.as_str())) {
            let expected = "the beginning of a name that --list has";
            return Err(UsageError::new("--only", start, expected).into());
        }
    }
    let is_chosen =
        |threshold: &Threshold| only.is_empty() || only.iter().any(|start| threshold.name.starts_with(start.as_str()));
    Ok(thresholds().filter(is_chosen).collect())
}

fn setting(threshold: &Threshold, factor: f64) -> String {
    format!("{}={factor}", threshold.name)
}

/// The cases, each in a folder of its own.
fn draw_cases(args: &SweepThresholdsArgs, folder: &Path) -> Result<Vec<SweptCase>> {
    let drawn = |listed: crate::challenge::case_list::ListedCase| {
        let case = draw(args.seed, listed.index, &listed.request)?;
        let name = format!("case-{:04}", listed.index);
        case.write(&folder.join(&name))?;
        Ok(SweptCase { name, ..SweptCase::of(&case) })
    };
    sample(args.cases, &[SimulatorKind::Own], args.seed).into_iter().map(drawn).collect()
}

impl SweptCase {
    fn of(case: &Case) -> Self {
        let truth = match case.truth.kind {
            CaseKind::Outside => BTreeSet::from([UNKNOWN.to_owned()]),
            _ => case.truth.effects.iter().map(|effect| effect.name.to_owned()).collect(),
        };
        let trials = (1..=case.trials.len()).map(|number| format!("trial-{number}.csv")).collect();
        Self { name: String::new(), truth, trials }
    }
}

/// All answers, and the file that keeps them.
struct Answers {
    file: std::fs::File,
    given: Vec<Answer>,
}

impl Answers {
    fn open(folder: &Path) -> Result<Self> {
        let path = folder.join("answers.jsonl");
        let place = || format!("cannot open {}", path.display());
        let file = OpenOptions::new().create(true).append(true).open(&path).with_context(place)?;
        let text = std::fs::read_to_string(&path).with_context(place)?;
        // A line that an interrupted run left half is asked again.
        let given = text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
        Ok(Self { file, given })
    }

    /// The answer to `case` with `threshold` times `factor`, or with none varied: asked, unless it was or is known by the margins.
    fn ask(&mut self, folder: &Path, varied: Option<(&Threshold, f64)>, case: &SweptCase) -> Result<()> {
        let setting = varied.map_or_else(String::new, |(threshold, factor)| setting(threshold, factor));
        if self.given.iter().any(|answer| answer.setting == setting && answer.case == case.name) {
            return Ok(());
        }
        let place = folder.join(&case.name);
        let known =
            varied.filter(|(threshold, factor)| margin(&place, threshold).is_some_and(|one| one.holds(*factor)));
        let plain = self.given.iter().find(|answer| answer.setting.is_empty() && answer.case == case.name);
        let answer = match (known, plain) {
            (Some(_), Some(plain)) => Answer { setting, was_asked: false, ..plain.clone() },
            _ => asked(&place, setting, case)?,
        };
        writeln!(self.file, "{}", serde_json::to_string(&answer)?).context("cannot note an answer")?;
        self.given.push(answer);
        Ok(())
    }

    /// Answers under `setting`, by case.
    fn of(&self, setting: &str) -> BTreeMap<&str, &Answer> {
        let under = self.given.iter().filter(|answer| answer.setting == setting);
        under.map(|answer| (answer.case.as_str(), answer)).collect()
    }

    /// How many answers under `setting` name other things than without it.
    fn changed(&self, setting: &str) -> usize {
        let plain = self.of("");
        self.of(setting)
            .iter()
            .filter(|(case, answer)| plain.get(*case).is_some_and(|plain| plain.named != answer.named))
            .count()
    }
}

/// Diagnoses `case` in `place` under `setting`.
fn asked(place: &Path, setting: String, case: &SweptCase) -> Result<Answer> {
    let mut command = own_program::find()?.command();
    command.args(["diagnose", "--rig", "rig.toml", "--json", "diagnosis.json"]).args(&case.trials);
    if setting.is_empty() {
        command.args(["--margins", MARGINS]);
    } else {
        command.args(["--vary", &setting]);
    }
    let (diagnosis, _) = run_command(command.current_dir(place), &place.join("diagnosis.json"))?;
    let (verdict, named) = match diagnosis {
        Ok(found) => (found.verdict.clone(), found.physics.into_iter().map(|physics| physics.name).collect()),
        Err(error) => (error, BTreeSet::new()),
    };
    Ok(Answer { setting, case: case.name.clone(), verdict, named, was_asked: true })
}

/// Between which factors `threshold` changes nothing in the case at `place`, where that was noted.
fn margin(place: &Path, threshold: &Threshold) -> Option<ThresholdMargin> {
    let text = std::fs::read_to_string(place.join(MARGINS)).ok()?;
    let margins: BTreeMap<String, ThresholdMargin> = serde_json::from_str(&text).ok()?;
    margins.get(threshold.name).copied()
}

/// Right answers and false alarms under a setting, with the settings' own cases alone counted in the plain ones.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Count {
    asked: usize,
    right: usize,
    alarms: usize,
}

impl Count {
    fn of<'a>(answers: impl Iterator<Item = &'a Answer>, truths: &BTreeMap<&str, &BTreeSet<String>>) -> Self {
        let mut count = Self::default();
        for answer in answers {
            let Some(truth) = truths.get(answer.case.as_str()) else { continue };
            count.asked += 1;
            count.right += usize::from(**truth == answer.named);
            count.alarms += usize::from(truth.is_empty() && !answer.named.is_empty());
        }
        count
    }
}

fn report(folder: &Path, chosen: &[Threshold], cases: &[SweptCase], answers: &Answers) -> Result<()> {
    let truths = cases.iter().map(|case| (case.name.as_str(), &case.truth)).collect();
    let table = table(chosen, &truths, answers);
    print!("{table}");
    let path = folder.join("table.md");
    std::fs::write(&path, table).with_context(|| format!("cannot write {}", path.display()))
}

fn table(chosen: &[Threshold], truths: &BTreeMap<&str, &BTreeSet<String>>, answers: &Answers) -> String {
    let plain = answers.of("");
    let mut text = "| threshold | value | origin | cases | right at 0.7, 1, 1.3 times | false alarms | answers that change at 0.7, 1.3 |\n|---|---|---|---|---|---|---|\n".to_owned();
    for threshold in chosen {
        let [low, high] = FACTORS.map(|factor| setting(threshold, factor));
        let (below, above) = (answers.of(&low), answers.of(&high));
        let both: Vec<&str> = below.keys().filter(|case| above.contains_key(*case)).copied().collect();
        if both.is_empty() {
            continue;
        }
        let count = |under: &BTreeMap<&str, &Answer>| {
            Count::of(both.iter().filter_map(|case| under.get(case).copied()), truths)
        };
        let counts = [count(&below), count(&plain), count(&above)];
        let each = |pick: fn(&Count) -> usize| {
            counts.iter().map(|count| pick(count).to_string()).collect::<Vec<_>>().join(", ")
        };
        let unit = if threshold.unit == "1" { String::new() } else { format!(" {}", threshold.unit) };
        let _ = writeln!(
            text,
            "| `{}` | {}{unit} | {} | {} | {} | {} | {}, {} |",
            threshold.name,
            threshold.nominal,
            threshold.origin.name(),
            both.len(),
            each(|count| count.right),
            each(|count| count.alarms),
            answers.changed(&low),
            answers.changed(&high),
        );
    }
    text
}

fn list(chosen: &[Threshold]) -> String {
    let line = |threshold: &Threshold| {
        format!(
            "{} = {} ({}; {})\n   {}\n",
            threshold.name,
            threshold.nominal,
            threshold.unit,
            threshold.origin.name(),
            threshold.meaning
        )
    };
    chosen.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(setting: &str, case: &str, named: &[&str]) -> Answer {
        let named = named.iter().map(|name| (*name).to_owned()).collect();
        Answer { setting: setting.to_owned(), case: case.to_owned(), verdict: String::new(), named, was_asked: true }
    }

    #[test]
    fn names_are_unique_and_each_threshold_says_what_it_decides() {
        let names: Vec<&str> = thresholds().map(|threshold| threshold.name).collect();
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
        assert!(names.len() > 60, "{}", names.len());
        assert!(thresholds().all(|threshold| threshold.nominal > 0.0 && threshold.meaning.len() > 10));
        assert!(chosen(&["contact.".to_owned()]).unwrap().iter().all(|one| one.name.starts_with("contact.")));
        assert!(chosen(&["kontakt".to_owned()]).unwrap_err().to_string().contains("found kontakt"));
    }

    #[test]
    fn the_table_counts_right_answers_alarms_and_changes_of_the_cases_that_were_asked() {
        let gain = thresholds().find(|threshold| threshold.name == "contact.LEAST_GAIN").unwrap();
        let (low, high) = ("contact.LEAST_GAIN=0.7", "contact.LEAST_GAIN=1.3");
        let given = vec![
            answer("", "a", &["adhesion"]),
            answer("", "b", &[]),
            answer("", "c", &["adhesion"]),
            answer(low, "a", &["adhesion"]),
            answer(low, "b", &["hysteresis"]),
            answer(high, "a", &[]),
            answer(high, "b", &[]),
        ];
        let folder = tempfile::tempdir().unwrap();
        let answers = Answers { given, ..Answers::open(folder.path()).unwrap() };
        let (adhesion, nothing) = (BTreeSet::from(["adhesion".to_owned()]), BTreeSet::new());
        let truths = BTreeMap::from([("a", &adhesion), ("b", &nothing), ("c", &adhesion)]);
        let table = table(&[gain], &truths, &answers);
        let row = table.lines().last().unwrap();
        assert_eq!(row, "| `contact.LEAST_GAIN` | 10 nats | derived | 2 | 1, 2, 1 | 1, 0, 0 | 1, 1 |");
    }

    #[test]
    fn an_answer_that_is_there_is_not_asked_again_and_half_a_line_is() {
        let folder = tempfile::tempdir().unwrap();
        let whole = serde_json::to_string(&answer("", "a", &["adhesion"])).unwrap();
        std::fs::write(folder.path().join("answers.jsonl"), format!("{whole}\n{}", &whole[..20])).unwrap();
        let mut answers = Answers::open(folder.path()).unwrap();
        assert_eq!(answers.given.len(), 1);
        let case = SweptCase { name: "a".to_owned(), truth: BTreeSet::new(), trials: Vec::new() };
        answers.ask(folder.path(), None, &case).unwrap();
        assert_eq!(answers.given.len(), 1);
    }
}
