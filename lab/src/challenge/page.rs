//! The page of a challenge: one self-contained file.

mod baselines;
mod confusion;
mod failures;
mod power;
mod recordings;
mod smallest_effect;

use std::io::{self, Write};

use maud::{Markup, html};
use palpate_cases::SimulatorKind;
use palpate_cases::truth::CaseKind;

use super::binomial::clopper_pearson;
use super::case_score::CaseScore;
use super::challenge_score::ChallengeScore;
use super::scored_case::ScoredCase as _;
use super::targets::{Target, external_lines, statistics, targets};
use crate::page::shell;

const STYLE: &str = include_str!("../../assets/challenge.css");

/// Writes the page. It draws one case anew, for the picture of an effect that no eye sees.
///
/// # Errors
/// Whatever `out` reports.
pub fn write(challenge: &ChallengeScore, out: &mut impl Write) -> io::Result<()> {
    shell::open("palpate challenge", STYLE, out)?;
    let body = html! {
        (opening(challenge))
        (table(challenge))
        (power::section(challenge))
        (smallest_effect::section(challenge))
        (baselines::section(challenge))
        (recordings::section(challenge))
        (sources(challenge))
        (confusion::section(challenge))
        (failures::section(challenge))
        (protocol(challenge))
    };
    out.write_all(body.0.as_bytes())?;
    shell::close(&html! {}, "", out)
}

fn opening(challenge: &ChallengeScore) -> Markup {
    html! {
        p.eyebrow { "palpate challenge, seed " (challenge.seed) ", " (concealed(challenge)) }
        h1 { (headline(challenge)) }
        p.lead {
            "Each recording was made by a simulator with physics that its rig file does not know, or with none; a SHA-256 over the true answers was \
             published; then each was diagnosed by the command that a user runs, which sees the rig file and the trials and nothing else."
        }
        @for what in &challenge.left_out { p.notices { "Left out: " (what) } }
    }
}

/// How many cases there are, and whose.
fn concealed(challenge: &ChallengeScore) -> String {
    let others: usize = challenge.sources.iter().map(|set| set.cases).sum();
    if others == 0 {
        return format!("{} recordings with concealed physics", challenge.cases);
    }
    format!("{others} cases of other authors and {} of our own with concealed physics", challenge.cases)
}

/// What was found, of other authors' cases first: proof on what we wrote ourselves is the weaker one.
fn headline(challenge: &ChallengeScore) -> String {
    let sets = &challenge.sources;
    let [single, right, none, alarms] = [
        sets.iter().map(|set| set.single.n).sum::<usize>(),
        sets.iter().map(|set| set.single.named_rightly).sum(),
        sets.iter().map(|set| set.none.n).sum(),
        sets.iter().map(|set| set.none.false_alarms).sum(),
    ];
    if single > 0 && none > 0 {
        return format!(
            "Other authors' cases: one effect named correctly in {right} of {single}, no false alarm in {} of {none}.",
            none - alarms
        );
    }
    let large: Vec<&CaseScore> = select(challenge, CaseScore::is_large);
    let right = large.iter().filter(|row| row.is_right()).count();
    let mut parts = Vec::new();
    if challenge.none.n > 0 {
        let quiet = challenge.none.n - challenge.none.false_alarms;
        parts.push(format!("No effect: no false alarm in {quiet} of {}.", challenge.none.n));
    }
    if !large.is_empty() {
        let of = large.len();
        parts.push(format!("One effect of strength 1 or more: {right} of {of} named correctly."));
    }
    if parts.is_empty() { "Recordings with concealed physics".to_owned() } else { parts.join(" ") }
}

fn select(challenge: &ChallengeScore, is: impl Fn(&CaseScore) -> bool) -> Vec<&CaseScore> {
    challenge.rows.iter().filter(|row| is(row)).collect()
}

fn table(challenge: &ChallengeScore) -> Markup {
    html! {
        section {
            h2 { "Targets and results" }
            div.wide { table.targets {
                thead { tr { th { "concealed" } th { "hits" } th { "of" } th { "share" } th { "95 % interval" } th { "target" } th {} } }
                tbody { @for line in external_lines(challenge).iter().chain(&targets(challenge)).filter(|line| line.of > 0) { (row_of(line)) } }
            } }
            p.fine { (statistics(challenge)) }
        }
    }
}

fn row_of(line: &Target) -> Markup {
    let [low, high] = clopper_pearson(line.hits, line.of);
    let share = line.hits as f64 / line.of as f64;
    let met = line.least.map(|least| match () {
        () if share >= least => ("met", "met"),
        () if high >= least => ("open", "within the interval"),
        () => ("missed", "missed"),
    });
    html! {
        tr {
            th { (line.what.replace('`', "")) } td { (line.hits) } td { (line.of) } td { (percent(share)) }
            td { (percent(low)) " to " (percent(high)) } td { (line.target) }
            td { @if let Some((class, word)) = met { span class=(class) { (word) } } }
        }
    }
}

fn percent(share: f64) -> String {
    format!("{:.0}\u{a0}%", 100.0 * share)
}

fn sources(challenge: &ChallengeScore) -> Markup {
    let of = |source: SimulatorKind| select(challenge, |row| row.source == source);
    let cell = |rows: &[&CaseScore], kind: &dyn Fn(&CaseScore) -> bool, is: &dyn Fn(&CaseScore) -> bool| {
        let rows: Vec<_> = rows.iter().filter(|row| kind(row)).collect();
        let hits = rows.iter().filter(|row| is(row)).count();
        if rows.is_empty() { String::new() } else { format!("{hits} of {}", rows.len()) }
    };
    html! {
        section {
            h2 { "Results by simulator" }
            p { "MuJoCo, Drake and Exudyn are independent of this project." }
            div.wide { table {
                thead { tr { th { "simulator" } th { "cases" } th { "no effect: no false alarm" } th { "one effect of strength 1 or more: correct" } th { "two effects: correct" } th { "outside the list: reported as unknown" } } }
                tbody { @for source in SimulatorKind::ALL {
                    @let rows = of(source);
                    @if !rows.is_empty() { tr {
                        th { (title(source)) } td { (rows.len()) }
                        td { (cell(&rows, &|row| row.kind == CaseKind::None, &|row| !row.is_false_alarm())) }
                        td { (cell(&rows, &CaseScore::is_large, &CaseScore::is_right)) }
                        td { (cell(&rows, &|row| row.kind == CaseKind::Pair, &CaseScore::is_right)) }
                        td { (cell(&rows, &|row| row.kind == CaseKind::Outside, &CaseScore::is_owned)) }
                    } }
                } }
            } }
        }
    }
}

fn title(source: SimulatorKind) -> &'static str {
    match source {
        SimulatorKind::Own => "ours",
        SimulatorKind::Mujoco => "MuJoCo",
        SimulatorKind::Drake => "Drake",
        SimulatorKind::Exudyn => "Exudyn",
    }
}

fn protocol(challenge: &ChallengeScore) -> Markup {
    html! {
        section {
            h2 { "Protocol" }
            ol {
                li { "Cases were drawn from the seed: what is concealed, its form and its strength, the rig and how wrong its file states it, sensors, trajectories, channels." }
                li { "Each was written as a rig file and two recordings, in a folder of its own. The answers were committed to by SHA-256 "
                    code { (challenge.sealed_sha256) } " before the first diagnosis; those to real recordings with them." }
                li { "Each was diagnosed by " code { "palpate diagnose --rig rig.toml trial-1.csv trial-2.csv" } " in its folder." }
                li { "The answers were checked against the commitment, and the diagnoses were scored." }
            }
            p.fine {
                "Strength is the RMS residual of the refitted nominal model over the RMS error of the force sensor. The same seed, with the same \
                 real recordings, gives the same cases and the same commitment: " code { "palpate challenge --cases " (challenge.cases) " --seed " (challenge.seed) } "."
            }
        }
    }
}
