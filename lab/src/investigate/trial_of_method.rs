//! `palpate investigate-challenge`: investigations of rigs whose missing physics is concealed from them, against the first recording
//! alone and against as many trials along a fixed rich reference of equal length.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use anyhow::{Context as _, Result};
use clap::Args;
use palpate_cases::excitation::Excitation;
use palpate_cases::truth::CaseKind;
use palpate_cases::{CaseRequest, ConcealedRig, SimulatorKind};
use serde::{Deserialize, Serialize};

use super::concealed_bed::{ConcealedBed, recording};
use super::record::{Investigation, Setup, State, write};
use super::session::Session;
use super::test_bed::{TestBed as _, TrialRequest};
use crate::challenge::binomial::clopper_pearson;
use crate::challenge::case_list::{ListedCase, sample};
use crate::diagnose::diagnose;
use crate::experiment_design::Limits;
use crate::experiment_design::explanation::UNKNOWN;
use crate::recording::Recording;
use crate::rig::Rig;

/// Limits of a rig over what its nominal model reaches along a rich reference.
const LIMIT_OVER_RICH: f64 = 1.5;

/// The same of its travel.
const TRAVEL_OVER_RICH: f64 = 1.3;

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

/// One rig, scored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Its place in the list of cases.
    pub index: u64,
    /// What it conceals; "unknown" where that is outside of the list.
    pub truth: Vec<String>,
    /// RMS residual of the refitted nominal model along the first recording, over the sensor's error.
    pub strength: f64,
    /// After the first recording alone.
    pub first: Answer,
    /// After each designed trial.
    pub rounds: Vec<Answer>,
    /// After the first recording and as many along the fixed reference.
    pub fixed: Answer,
    /// Greatest share of each limit in a designed trial, of the true motion: position, speed, force, effort.
    pub used: [f64; 4],
    /// The same in the fixed trials.
    pub used_by_fixed: [f64; 4],
    /// Trials that the supervisor cut off.
    pub stopped: usize,
    /// Seconds recorded in designed trials, and in fixed ones.
    pub recorded_s: [f64; 2],
    /// Why it ended.
    pub outcome: String,
    /// Seconds of the investigation.
    pub seconds: f64,
}

/// An answer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Answer {
    /// Names.
    pub named: Vec<String>,
    /// Sets of names that the data do not rule out.
    pub alternatives: Vec<Vec<String>>,
}

impl Answer {
    fn of(state: &State) -> Self {
        Self { named: state.physics.clone(), alternatives: state.alternatives.clone() }
    }

    /// Whether `truth` is named and nothing else.
    #[must_use]
    pub fn is_right(&self, truth: &[String]) -> bool {
        let set = |names: &[String]| names.iter().cloned().collect::<BTreeSet<String>>();
        set(&self.named) == set(truth)
    }

    /// The same, and no alternative is left.
    #[must_use]
    pub fn is_right_and_alone(&self, truth: &[String]) -> bool {
        self.is_right(truth) && self.alternatives.is_empty()
    }
}

impl Row {
    /// After the last designed trial.
    #[must_use]
    pub fn last(&self) -> &Answer {
        self.rounds.last().unwrap_or(&self.first)
    }
}

/// Runs `palpate investigate-challenge`.
///
/// # Errors
/// A folder that cannot be written, or a rig of which no diagnosis can be made.
pub fn run(args: &InvestigateChallengeArgs) -> Result<()> {
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot make {}", args.out.display()))?;
    let begun = Instant::now();
    let mut rows = Vec::new();
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
        eprintln!("{}", line(&row));
        rows.push(row);
    }
    write(&args.out.join("rows.json"), (serde_json::to_string_pretty(&rows)? + "\n").as_bytes())?;
    let table = table(&rows);
    println!("{table}");
    write(&args.out.join("table.md"), table.as_bytes())
}

fn investigate(args: &InvestigateChallengeArgs, case: &ListedCase) -> Result<Row> {
    // A rig that follows trajectories has a drive; its file says so where the effort is recorded.
    let request = CaseRequest { excitation: Some(Excitation::Poor), effort: Some(true), ..case.request.clone() };
    let concealed = || ConcealedRig::draw(args.seed, case.index, &request);
    let mut rig_of_case = concealed()?;
    let truth: Vec<String> = match rig_of_case.case.truth.kind {
        CaseKind::Outside => vec![UNKNOWN.to_owned()],
        _ => rig_of_case.case.truth.effects.iter().map(|effect| effect.name.to_owned()).collect(),
    };
    let strength = rig_of_case.case.truth.strength;
    let rig = Rig::parse(&rig_of_case.case.rig, "rig.toml")?;
    let given = vec![recording(&rig_of_case.case.trials[0], "trial-1.csv")];
    let limits = limits(&mut rig_of_case, &given[0]);
    let folder = args.out.join(format!("case-{:04}", case.index));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    write(&folder.join("rig.toml"), rig_of_case.case.rig.as_bytes())?;
    given[0].write(&folder.join("trial-1.csv"), &rig)?;
    let begun = Instant::now();
    let mut bed = ConcealedBed::new(rig_of_case);
    let investigation = designed(args, &rig, &given, limits, &folder, &mut bed)?;
    let seconds = begun.elapsed().as_secs_f64();
    let states: Vec<Answer> =
        investigation.rounds.iter().filter_map(|round| round.state.as_ref()).map(Answer::of).collect();
    let trials = investigation.rounds.len().saturating_sub(1);
    let mut fixed_bed = ConcealedBed::new(concealed()?);
    let fixed = along_fixed(&rig, &given, limits, trials, &folder, &mut fixed_bed)?;
    let stopped = investigation.rounds.iter().filter_map(|round| round.trial.as_ref());
    Ok(Row {
        index: case.index,
        truth,
        strength,
        first: states[0].clone(),
        rounds: states[1..].to_vec(),
        fixed: fixed.unwrap_or_else(|| states[0].clone()),
        used: bed.used,
        used_by_fixed: fixed_bed.used,
        stopped: stopped.filter(|trial| super::concealed_bed::stopped_by(&trial.ending).is_some()).count(),
        recorded_s: [bed.seconds, fixed_bed.seconds],
        outcome: investigation.outcome.map(|outcome| outcome.sentence().to_owned()).unwrap_or_default(),
        seconds,
    })
}

/// What the rig may do: more than a rich reference asks of its nominal model.
fn limits(rig: &mut ConcealedRig, given: &Recording) -> Limits {
    let reference = rig.rich_reference();
    let reached = rig.nominal_excursion(&reference);
    let low = given.position.iter().copied().fold(reached.position.0, f64::min);
    let high = given.position.iter().copied().fold(reached.position.1, f64::max);
    let around = 0.5 * (TRAVEL_OVER_RICH - 1.0) * (high - low);
    let peak = |values: &Option<Vec<f64>>| values.iter().flatten().fold(0.0, |most: f64, value| most.max(value.abs()));
    let speed = Limits::of_recordings(std::slice::from_ref(given)).map_or(0.0, |limits| limits.speed);
    Limits {
        position: [low - around, high + around],
        speed: LIMIT_OVER_RICH * reached.speed.max(speed),
        effort: Some(LIMIT_OVER_RICH * reached.effort.max(peak(&given.effort))),
        force: Some(LIMIT_OVER_RICH * reached.force.max(peak(&given.force))),
        duration_s: reached.duration_s,
        frequency_hz: 25.0,
    }
}

fn designed(
    args: &InvestigateChallengeArgs,
    rig: &Rig,
    given: &[Recording],
    limits: Limits,
    folder: &Path,
    bed: &mut ConcealedBed,
) -> Result<Investigation> {
    let setup = Setup { inputs_sha256: Vec::new(), on: bed.description(), limits, seed: 1 };
    let mut investigation = Investigation::new(setup);
    let session = Session {
        rig,
        origin: "rig.toml",
        given,
        folder,
        rounds: args.rounds,
        interrupted: &AtomicBool::new(false),
        say: &|_| {},
    };
    session.run(&mut investigation, bed)?;
    Ok(investigation)
}

/// The answer after `count` trials along rich references; `None` where there are none, or no diagnosis of them.
fn along_fixed(
    rig: &Rig,
    given: &[Recording],
    limits: Limits,
    count: usize,
    folder: &Path,
    bed: &mut ConcealedBed,
) -> Result<Option<Answer>> {
    let mut trials = given.to_vec();
    for round in 0..count as u64 {
        let reference = bed.rig.rich_reference();
        let request = TrialRequest {
            reference: &reference,
            rate_hz: given[0].rate(),
            limits: &limits,
            reference_file: folder,
            recording_file: folder,
            interrupted: &AtomicBool::new(false),
            round,
        };
        let outcome = bed.run(&request)?;
        trials.extend(outcome.recording.map(|recording| Recording { name: format!("fixed-{round}.csv"), ..recording }));
    }
    if count == 0 {
        return Ok(None);
    }
    let found = diagnose(rig, "rig.toml", &trials, &[], 1, &|_| {}).ok();
    Ok(found.map(|found| Answer::of(&State::of(&found, Vec::new()))))
}

/// For people who watch.
fn line(row: &Row) -> String {
    let mark = |answer: &Answer| match () {
        () if answer.is_right_and_alone(&row.truth) => "alone",
        () if answer.is_right(&row.truth) => "right",
        () => "no",
    };
    let rounds: Vec<&str> = row.rounds.iter().map(mark).collect();
    let most = row.used.iter().fold(0.0, |most: f64, share| most.max(*share));
    format!(
        "{:4} {} ({:.2}): first {}, designed {}, fixed {}; limits used to {most:.2}, {:.0} s; {}",
        row.index,
        row.truth.join(" and "),
        row.strength,
        mark(&row.first),
        rounds.join(" "),
        mark(&row.fixed),
        row.seconds,
        row.last().named.join(" and "),
    )
}

/// The table of all rows.
#[must_use]
pub fn table(rows: &[Row]) -> String {
    type Pick = fn(&Row) -> &Answer;
    let ways: [(&str, Pick); 3] = [
        ("first recording alone", |row| &row.first),
        ("fixed rich trials", |row| &row.fixed),
        ("designed trials", |row| row.last()),
    ];
    type Select = fn(&Row) -> bool;
    let groups: [(&str, Select); 4] = [
        ("all", |_| true),
        ("one effect of strength 1 or more", |row| {
            row.truth.len() == 1 && row.truth[0] != UNKNOWN && row.strength >= 1.0
        }),
        ("one effect, any strength", |row| row.truth.len() == 1 && row.truth[0] != UNKNOWN),
        ("nothing missing", |row| row.truth.is_empty()),
    ];
    let mut text = "| rigs | | named rightly and alone | named rightly |\n|---|---|---|---|\n".to_owned();
    for (group, select) in groups {
        let chosen: Vec<&Row> = rows.iter().filter(|row| select(row)).collect();
        if chosen.is_empty() {
            continue;
        }
        for (way, pick) in ways {
            let count =
                |is: fn(&Answer, &[String]) -> bool| chosen.iter().filter(|row| is(pick(row), &row.truth)).count();
            let cell = |hits: usize| {
                let [low, high] = clopper_pearson(hits, chosen.len());
                format!("{hits} of {} ({:.0} to {:.0} %)", chosen.len(), 100.0 * low, 100.0 * high)
            };
            let (alone, right) = (count(Answer::is_right_and_alone), count(Answer::is_right));
            text += &format!("| {group} | {way} | {} | {} |\n", cell(alone), cell(right));
        }
    }
    let most = |pick: fn(&Row) -> [f64; 4]| rows.iter().flat_map(pick).fold(0.0, f64::max);
    let stopped: usize = rows.iter().map(|row| row.stopped).sum();
    text + &format!(
        "\nGreatest share of a limit that the true motion used: {:.2} in designed trials, {:.2} in fixed ones; {stopped} \
         designed trials were cut off.\n",
        most(|row| row.used),
        most(|row| row.used_by_fixed),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    fn answer(named: &[&str], alternatives: &[&str]) -> Answer {
        Answer { named: names(named), alternatives: alternatives.iter().map(|name| names(&[name])).collect() }
    }

    fn row(truth: &[&str], first: Answer, rounds: Vec<Answer>, fixed: Answer) -> Row {
        Row {
            index: 0,
            truth: names(truth),
            strength: 2.0,
            first,
            rounds,
            fixed,
            used: [0.5, 0.8, 0.1, 0.2],
            used_by_fixed: [0.9, 0.1, 0.1, 0.1],
            stopped: 1,
            recorded_s: [25.0, 25.0],
            outcome: String::new(),
            seconds: 1.0,
        }
    }

    #[test]
    fn an_answer_with_an_alternative_is_right_but_not_alone() {
        let truth = names(&["adhesion"]);
        let judged = |answer: Answer| (answer.is_right(&truth), answer.is_right_and_alone(&truth));
        assert_eq!(judged(answer(&["adhesion"], &[])), (true, true));
        assert_eq!(judged(answer(&["adhesion"], &["hysteresis"])), (true, false));
        assert_eq!(judged(answer(&["adhesion", "hysteresis"], &[])), (false, false));
        assert_eq!(judged(answer(&[], &["adhesion"])), (false, false));
    }

    #[test]
    fn the_table_counts_the_last_round_against_the_first_and_the_fixed() {
        let rows = [
            row(
                &["adhesion"],
                answer(&["adhesion"], &["hysteresis"]),
                vec![answer(&["hysteresis"], &[]), answer(&["adhesion"], &[])],
                answer(&["hysteresis"], &[]),
            ),
            row(&[], answer(&[], &[]), Vec::new(), answer(&["adhesion"], &[])),
        ];
        let table = table(&rows);
        let line = |of: &str| table.lines().find(|line| line.contains(of)).unwrap_or_default().to_owned();
        assert!(line("| all | first recording alone |").contains("| 1 of 2 (1 to 99 %) | 2 of 2"), "{table}");
        assert!(line("| all | designed trials |").contains("| 2 of 2"), "{table}");
        assert!(line("| all | fixed rich trials |").contains("| 0 of 2"), "{table}");
        assert!(table.contains("0.80 in designed trials, 0.90 in fixed ones; 2 designed trials"), "{table}");
    }
}
