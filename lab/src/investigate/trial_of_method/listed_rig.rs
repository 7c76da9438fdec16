//! What a run puts to the test, rig by rig: drawn ones, and those of other authors.

use std::path::Path;

use anyhow::{Context as _, Result, ensure};
use palpate_cases::SimulatorKind;

use super::command::InvestigateChallengeArgs;
use super::comparison::{Comparison, Subject};
use super::own_rig;
use super::row::{OWN, Row};
use super::source_rig::SourceRig;
use crate::challenge::case_list::{ListedCase, sample};
use crate::challenge::external_cases::{self, ExternalCase};
use crate::error::{InputError, UsageError};

/// A rig to be investigated.
pub enum ListedRig {
    /// Drawn by the cases' own generator.
    Drawn(ListedCase),
    /// In the folder of another author.
    OfSource {
        /// Its place in the folder, by name.
        index: u64,
        /// Folder and answer.
        case: ExternalCase,
    },
}

/// Every rig that `args` asks for.
///
/// # Errors
/// None is asked for, a source is no folder of cases with their answers, or two sources have one name.
pub fn listed(args: &InvestigateChallengeArgs) -> Result<Vec<ListedRig>> {
    let expected = "at least one, or --source with a folder of rigs";
    ensure!(args.cases > 0 || !args.source.is_empty(), UsageError::new("--cases", 0, expected));
    let drawn = if args.cases > 0 { sample(args.cases, &[SimulatorKind::Own], args.seed) } else { Vec::new() };
    let mut rigs: Vec<ListedRig> = drawn.into_iter().map(ListedRig::Drawn).collect();
    let mut sets = vec![OWN.to_owned()];
    for folder in &args.source {
        let cases = external_cases::read(folder)?;
        let set = cases.first().map(|case| case.answer.set.clone()).unwrap_or_default();
        // Rows and tables go by this name.
        let expected = "folders of different names, none of them \"own\"";
        ensure!(!sets.contains(&set), UsageError::new("--source", format!("a further \"{set}\""), expected));
        sets.push(set);
        rigs.extend((0..).zip(cases).map(|(index, case)| ListedRig::OfSource { index, case }));
    }
    Ok(rigs)
}

impl ListedRig {
    /// Its name in the folder of a run, which no other rig of the run has.
    pub fn name(&self) -> String {
        match self {
            Self::Drawn(case) => format!("{:04}", case.index),
            // A case may lie deeper in its source: the name is that of one file.
            Self::OfSource { case, .. } => format!("{}-{}", case.answer.set, case.answer.case.replace('/', "-")),
        }
    }

    /// Whether it can be read.
    ///
    /// # Errors
    /// As [`SourceRig::read`].
    pub fn check(&self) -> Result<()> {
        match self {
            Self::Drawn(_) => Ok(()),
            Self::OfSource { case, .. } => SourceRig::read(&case.folder).map(drop),
        }
    }

    /// Investigates it in `folder`, which is made anew.
    ///
    /// # Errors
    /// A file that cannot be read or written, a bed that fails, or a first recording of which no diagnosis can be made.
    pub fn investigate(&self, args: &InvestigateChallengeArgs, folder: &Path) -> Result<Row> {
        // What a run that was broken off has left is no part of this one.
        let _ = std::fs::remove_dir_all(folder);
        std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
        let (index, case) = match self {
            Self::Drawn(case) => return own_rig::investigate(args, case, folder),
            Self::OfSource { index, case } => (*index, case),
        };
        let comparison = compared(case, args.rounds, folder).with_context(|| case.folder.display().to_string())?;
        let answer = case.answer.clone();
        let (source, case, truth, also) = (answer.set, Some(answer.case), answer.truth, answer.also);
        Ok(Row { source, index, case, truth, also, strength: None, comparison })
    }

    /// The row that `file` holds as `text`, against the truth as its source states it now.
    ///
    /// # Errors
    /// It is no row, or that of another rig.
    pub fn row(&self, text: &str, file: &Path) -> Result<Row> {
        let wrong = |found: String, expected: String| InputError::new(file.display(), found, expected);
        let row: Row =
            serde_json::from_str(text).map_err(|error| wrong(error.to_string(), "a scored rig".to_owned()))?;
        let (source, name, answer) = match self {
            Self::Drawn(_) => (OWN, None, None),
            Self::OfSource { case, .. } => (case.answer.set.as_str(), Some(&case.answer.case), Some(&case.answer)),
        };
        let is_it = row.source == source && row.case.as_ref() == name;
        ensure!(is_it, wrong(format!("the rig {}", row.name()), self.name()));
        Ok(match answer {
            None => row,
            Some(answer) => Row { truth: answer.truth.clone(), also: answer.also.clone(), ..row },
        })
    }
}

/// The three ways on the rig of `case`, of whose answer they learn nothing.
fn compared(case: &ExternalCase, rounds: u64, folder: &Path) -> Result<Comparison> {
    let known = SourceRig::read(&case.folder)?;
    case.copy_to(folder)?;
    let origin = case.folder.join("rig.toml").display().to_string();
    let SourceRig { rig, given, limits, .. } = &known;
    let subject = Subject { rig, origin: &origin, given, limits: *limits, folder, rounds };
    Comparison::run(&subject, &mut known.bed()?, &mut known.bed()?)
}

#[cfg(all(test, unix))]
mod tests {
    use std::path::PathBuf;

    use tempfile::TempDir;

    use super::*;
    use crate::investigate::trial_of_method::answer::tests::{answer, names};
    use crate::investigate::trial_of_method::{row, source_rig};

    /// Folders `name` of one rig each, below `home`.
    fn sources(home: &Path, name: &[&str]) -> Vec<PathBuf> {
        let source = |name: &&str| {
            let folder = home.join(name);
            source_rig::tests::write(&folder.join("031"));
            let truth = r#"{"031": {"truth": ["adhesion"], "also": [["hysteresis"]]}}"#;
            std::fs::write(folder.join("truth.json"), truth).unwrap();
            folder
        };
        name.iter().map(source).collect()
    }

    fn args(cases: usize, source: Vec<PathBuf>) -> InvestigateChallengeArgs {
        InvestigateChallengeArgs { cases, source, seed: 1, rounds: 3, minutes: None, out: PathBuf::new() }
    }

    #[test]
    fn without_drawn_rigs_there_are_those_of_the_sources_alone() {
        let home = TempDir::new().unwrap();
        let names = |cases, source| {
            let rigs = listed(&args(cases, source)).unwrap();
            rigs.iter().map(ListedRig::name).collect::<Vec<_>>()
        };
        assert_eq!(names(0, sources(home.path(), &["one", "other"])), ["one-031", "other-031"]);
        let deep = sources(home.path(), &["deep"]);
        source_rig::tests::write(&deep[0].join("hard/032"));
        std::fs::write(deep[0].join("truth.json"), r#"{"hard/032": {"truth": []}}"#).unwrap();
        assert_eq!(names(0, deep), ["deep-hard-032"]);
        let both = names(2, sources(home.path(), &["one"]));
        assert!(both.len() == 3 && both[2] == "one-031" && both[0].len() == 4, "{both:?}");
    }

    #[test]
    fn what_leaves_nothing_or_two_sources_of_one_name_is_refused_by_its_option() {
        let home = TempDir::new().unwrap();
        let refused = |cases, source: Vec<PathBuf>| listed(&args(cases, source)).err().unwrap().to_string();
        assert!(refused(0, Vec::new()).starts_with("--cases: found 0"));
        let twice = refused(0, sources(home.path(), &["a/set", "b/set"]));
        assert!(twice.starts_with("--source: found a further \"set\""), "{twice}");
        assert!(refused(0, sources(home.path(), &["own"])).contains("\"own\""));
    }

    #[test]
    fn a_row_is_held_against_the_truth_of_now_and_not_taken_from_another_rig() {
        let home = TempDir::new().unwrap();
        let rigs = listed(&args(1, sources(home.path(), &["set"]))).unwrap();
        let [drawn, other] = rigs.as_slice() else { panic!("{}", rigs.len()) };
        let old = row::tests::row(&["cogging"], answer(&["hysteresis"], &[]), Vec::new(), answer(&[], &[]));
        let file = Path::new("row-set-031.json");
        let text = serde_json::to_string(&old).unwrap();
        assert_eq!(drawn.row(&text, file).unwrap(), old);
        let error = other.row(&text, file).unwrap_err().to_string();
        assert!(error.contains("row-set-031.json") && error.contains("expected set-031"), "{error}");
        let own = Row { source: "set".to_owned(), case: Some("031".to_owned()), strength: None, ..old };
        let read = other.row(&serde_json::to_string(&own).unwrap(), file).unwrap();
        assert_eq!((&read.truth, &read.also), (&names(&["adhesion"]), &vec![names(&["hysteresis"])]));
        assert!(read.is_right(&read.comparison.first) && !own.is_right(&own.comparison.first));
    }
}
