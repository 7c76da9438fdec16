//! The page of a challenge: one self-contained file.

mod concealed;
mod confusion;
mod failure;
mod power;
mod recorded;
mod rivals;

use std::io::{self, Write};

use maud::{Markup, html};
use palpate_cases::Source;
use palpate_cases::truth::Kind;

use super::aim::{Aim, aims, beside};
use super::interval::of_share;
use super::row::Row;
use super::score::Challenge;
use crate::page::shell;

const STYLE: &str = include_str!("../../assets/challenge.css");

/// Writes the page. It draws one case anew, for the picture of an effect that no eye sees.
///
/// # Errors
/// Whatever `out` reports.
pub fn write(challenge: &Challenge, out: &mut impl Write) -> io::Result<()> {
    shell::open("palpate challenge", STYLE, out)?;
    let body = html! {
        (opening(challenge))
        (table(challenge))
        (power::section(challenge))
        (concealed::section(challenge))
        (rivals::section(challenge))
        (recorded::section(challenge))
        (sources(challenge))
        (confusion::section(challenge))
        (failure::section(challenge))
        (protocol(challenge))
    };
    out.write_all(body.0.as_bytes())?;
    shell::close(&html! {}, "", out)
}

fn opening(challenge: &Challenge) -> Markup {
    html! {
        p.eyebrow { "palpate challenge, seed " (challenge.seed) ", " (challenge.cases) " recordings with concealed physics" }
        h1 { (headline(challenge)) }
        p.lead {
            "Each recording was made by a simulator with physics that its rig file does not know, or with none; the answers were sealed; \
             then each was diagnosed by the command that a user runs, which sees the rig file and two trials and nothing else."
        }
        @for what in &challenge.left_out { p.notices { "Left out: " (what) } }
    }
}

fn headline(challenge: &Challenge) -> String {
    let large: Vec<&Row> = select(challenge, Row::is_large);
    let right = large.iter().filter(|row| row.is_right()).count();
    let mut parts = Vec::new();
    if challenge.none.n > 0 {
        let quiet = challenge.none.n - challenge.none.false_alarms;
        parts.push(format!("Nothing missing: {quiet} of {} left alone.", challenge.none.n));
    }
    if !large.is_empty() {
        let of = large.len();
        parts.push(format!("An effect at least as large as the noise: {right} of {of} named rightly."));
    }
    if parts.is_empty() { "Recordings with concealed physics".to_owned() } else { parts.join(" ") }
}

fn select(challenge: &Challenge, is: impl Fn(&Row) -> bool) -> Vec<&Row> {
    challenge.rows.iter().filter(|row| is(row)).collect()
}

fn table(challenge: &Challenge) -> Markup {
    html! {
        section {
            h2 { "What was aimed at, and what came out" }
            div.wide { table.aims {
                thead { tr { th { "concealed" } th { "hits" } th { "of" } th { "share" } th { "95 % interval" } th { "aim" } th {} } }
                tbody { @for line in aims(challenge).iter().filter(|line| line.of > 0) { (row_of(line)) } }
            } }
            p.fine { (beside(challenge)) }
        }
    }
}

fn row_of(line: &Aim) -> Markup {
    let [low, high] = of_share(line.hits, line.of);
    let share = line.hits as f64 / line.of as f64;
    let told = line.least.map(|least| match () {
        () if share >= least => ("met", "met"),
        () if high >= least => ("open", "within the interval"),
        () => ("missed", "missed"),
    });
    html! {
        tr {
            th { (line.what) } td { (line.hits) } td { (line.of) } td { (percent(share)) }
            td { (percent(low)) " to " (percent(high)) } td { (line.aim) }
            td { @if let Some((class, word)) = told { span class=(class) { (word) } } }
        }
    }
}

fn percent(share: f64) -> String {
    format!("{:.0}\u{a0}%", 100.0 * share)
}

fn sources(challenge: &Challenge) -> Markup {
    let of = |source: Source| select(challenge, |row| row.source == source);
    let cell = |rows: &[&Row], kind: &dyn Fn(&Row) -> bool, is: &dyn Fn(&Row) -> bool| {
        let rows: Vec<_> = rows.iter().filter(|row| kind(row)).collect();
        let hits = rows.iter().filter(|row| is(row)).count();
        if rows.is_empty() { String::new() } else { format!("{hits} of {}", rows.len()) }
    };
    html! {
        section {
            h2 { "Whose simulation" }
            p { "MuJoCo, Drake and Exudyn were written by others, and nobody here tuned what they give." }
            div.wide { table {
                thead { tr { th { "simulator" } th { "cases" } th { "nothing missing: left alone" } th { "one effect, at least the floor: right" } th { "two: right" } th { "outside: owned" } } }
                tbody { @for source in Source::ALL {
                    @let rows = of(source);
                    @if !rows.is_empty() { tr {
                        th { (title(source)) } td { (rows.len()) }
                        td { (cell(&rows, &|row| row.kind == Kind::None, &|row| !row.is_false_alarm())) }
                        td { (cell(&rows, &Row::is_large, &Row::is_right)) }
                        td { (cell(&rows, &|row| row.kind == Kind::Pair, &Row::is_right)) }
                        td { (cell(&rows, &|row| row.kind == Kind::Outside, &Row::is_owned)) }
                    } }
                } }
            } }
        }
    }
}

fn title(source: Source) -> &'static str {
    match source {
        Source::Own => "ours",
        Source::Mujoco => "MuJoCo",
        Source::Drake => "Drake",
        Source::Exudyn => "Exudyn",
    }
}

fn protocol(challenge: &Challenge) -> Markup {
    html! {
        section {
            h2 { "How it was done" }
            ol {
                li { "Cases were drawn from the seed: what is concealed, its form and its strength, the rig and how wrong its file states it, sensors, trajectories, channels." }
                li { "Each was written as a rig file and two recordings, in a folder of its own. The answers were committed to by SHA-256 "
                    code { (challenge.sealed_sha256) } " before the first diagnosis; those to real recordings with them." }
                li { "Each was diagnosed by " code { "palpate diagnose --rig rig.toml trial-1.csv trial-2.csv" } " in its folder." }
                li { "The seal was opened, held against the commitment, and the answers were scored." }
            }
            p.fine {
                "Strength is the root mean square that the nominal physics cannot take up, over the floor of the sensor. The same seed, with the same \
                 real recordings, gives the same cases and the same commitment: " code { "palpate challenge --cases " (challenge.cases) " --seed " (challenge.seed) } "."
            }
        }
    }
}
