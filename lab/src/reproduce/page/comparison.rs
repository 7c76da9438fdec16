//! What does better, and which to take.

use maud::{Markup, html};

use super::super::Results;
use super::super::comparison::{ComparisonRow, SEEDS};
use super::super::estimator::Estimator;
use super::{grid, number, spread, wide};

/// What was aimed at: words, and whether a row meets it.
type Aim = (&'static str, fn(&ComparisonRow) -> bool);

const AIMS: [Aim; 10] = [
    ("", |_| true),
    ("≤ 30", |row| row.onset.mean <= 30.0),
    ("≤ 45", |row| row.up.mean <= 45.0),
    ("≤ 45", |row| row.down.mean <= 45.0),
    ("≤ 0.1", |row| row.deviation.mean <= 0.1),
    ("", |_| true),
    ("within 1", |row| row.bias_damping.mean.abs() <= 1.0),
    ("", |_| true),
    ("90 to 99", |row| (90.0..=99.0).contains(&row.covered_stiffness.mean)),
    ("90 to 99", |row| (90.0..=99.0).contains(&row.covered_damping.mean)),
];

fn taken(results: &Results) -> Option<&ComparisonRow> {
    results.better.iter().find(|row| row.estimator == Estimator::Cusum)
}

/// The gain, for the head of the page.
pub(super) fn in_one_sentence(results: &Results) -> String {
    let paper = results.better.iter().filter(|row| !row.matched);
    let best = |value: fn(&ComparisonRow) -> f64| paper.clone().map(value).fold(f64::INFINITY, f64::min);
    match taken(results) {
        Some(row) => format!(
            "a recursion that begins again at a change knows K {:.0} ms after the touch and {:.0} ms after a jump of it, where the best of the four need {:.0} and {:.0} ms",
            row.onset.mean,
            row.up.mean.max(row.down.mean),
            best(|row| row.onset.mean),
            best(|row| row.up.mean.max(row.down.mean)),
        ),
        None => String::new(),
    }
}

pub(super) fn section(results: &Results) -> Markup {
    html! {
        section #better aria-labelledby="better-title" {
            h2 #better-title { "What does better" }
            p {
                "Here the truth is known: a linear contact of 250 N/m and 5 N s/m whose stiffness jumps to 900 N/m and back, on the same bench (" code { "paper_steps.toml" } "), "
                (SEEDS) " trials, the surface anywhere within one count of where it is believed. First the four methods as the paper has them, then, behind the matched filter, what is better."
            }
            (table(results))
            p.fine {
                "Onset and jumps: ms until K stays within 10 %; a method whose noise leaves that band again settles only there. Standard deviation and bias: at 900 N/m, from 2 s after the jump. \
                 RMSE%: over the contact, jumps among it; behind the matched filter, of the filtered force. Covered: share of samples, from 0.1 s after each event, whose nominal 95 % interval holds the truth. \
                 Device: instructions of the worst update. Green meets the aim, red misses it."
            }
            (steps())
            (advice(results))
            (grid(&results.better_figures))
        }
    }
}

fn table(results: &Results) -> Markup {
    let table = html! {
        table.better {
            caption { "Mean ± spread over trials" }
            thead { tr {
                th scope="col" { "Method" } th scope="col" { "onset, ms" } th scope="col" { "jump up, ms" } th scope="col" { "jump down, ms" } th scope="col" { "std of K, %" }
                th scope="col" { "bias of K, %" } th scope="col" { "bias of B, %" } th scope="col" { "RMSE%" } th scope="col" { "K covered, %" } th scope="col" { "B covered, %" } th scope="col" { "false alarms" } th scope="col" { "device" }
            } }
            tbody {
                tr.aim { th scope="row" { "aim" } @for (words, _) in AIMS.iter().skip(1) { td { (words) } } td {} td {} }
                @for row in &results.better { (line(results, row)) }
            }
        }
    };
    wide("Methods where the truth is known", &table)
}

fn line(results: &Results, row: &ComparisonRow) -> Markup {
    let values = [
        (&row.onset, 0),
        (&row.up, 0),
        (&row.down, 0),
        (&row.deviation, 3),
        (&row.bias_stiffness, 2),
        (&row.bias_damping, 2),
        (&row.rmse, 2),
        (&row.covered_stiffness, 1),
        (&row.covered_damping, 1),
    ];
    let (update, window) = row.estimator.update();
    html! {
        tr.best[row.estimator == Estimator::Cusum] {
            th scope="row" { (row.name()) }
            @for (at, ((value, decimals), (words, meets))) in values.into_iter().zip(AIMS.iter().skip(1)).enumerate() {
                td.met[!words.is_empty() && meets(row)].missed[!words.is_empty() && !meets(row)] {
                    (spread(value, decimals))
                    // A mean in time is no comfort to the trial that was late.
                    @if at < 3 { small { "worst " (number(value.greatest, 0)) } }
                }
            }
            td { (row.false_alarms) }
            td { @match results.rates.cost(update, window) { Some(cost) => (cost.instructions_worst), None => "–" } }
        }
    }
}

/// What each improvement is.
fn steps() -> Markup {
    html! {
        h3 { "What each of them is" }
        ul {
            li { strong { "Matched filter. " } "The paper low-passes the velocity alone and so delays it against the force; that biases B. Passed through the same filter, depth, velocity and force keep the law between them." }
            li { strong { "EWRLS without its start. " } "How much of K = 0 is still in the estimate is known from its gains, and is taken off: the onset comes for nothing, a jump does not." }
            li { strong { "A ridge that carries the prior. " } "K and B are taken to be zero, give or take 1000 N/m and 30 N s/m, worth one sample 0.1 mm deep: no minimum fill is waited for, and no P(0) is believed for a second." }
            li { strong { "A window that shrinks. " } "A cumulative sum of the innovation says that the material has changed; then only the newest 20 samples count, and the window grows again from there." }
            li { strong { "CUSUM-reset RLS. " } "The same sum, and a recursion that begins again from its prior." }
            li { strong { "Newton BLMF. " } "The same line search along Newton's direction: one step where the steepest descent takes dozens." }
            li { strong { "Directional forgetting. " } "Forgets only along the newest sample, and so keeps B while the tool is held; but consecutive samples point the same way, and a jump takes it seconds." }
            li { strong { "Intervals that cover. " } "Inflated for the filter's colour, with the surface anywhere within a count." }
        }
    }
}

fn advice(results: &Results) -> Markup {
    let figure = |value: fn(&ComparisonRow) -> f64, decimals| {
        taken(results).map_or_else(String::new, |row| number(value(row), decimals))
    };
    html! {
        div.advice {
            h3 { "Which to take" }
            p {
                "Where K may change, and nobody says when, take " strong { "CUSUM-reset RLS behind the matched filter" } ", the library's default ("
                code { "CusumRls" } ", " code { "Identifier::recommended" } "): K within 10 % "
                (figure(|row| row.onset.mean, 0)) " ms after the touch and " (figure(|row| row.up.mean, 0)) " ms after a jump, a scatter of "
                (figure(|row| row.deviation.mean, 3)) " %, no window to keep. Where the estimate has to rest on a stretch of time that you can name, or a contact that is no spring drives the recursion into resets, take "
                strong { "the shrinking window" } " (" code { "AdaptiveWindow" } "), or plain " strong { "BLS" } " with a short window where even its detector is unwelcome. Where nothing ever changes and B matters most, take "
                strong { "EWRLS with a factor near 1" } ". Take a mean fourth (" strong { "Newton BLMF" } ", never the steepest descent) only where the noise is bounded, rounding say: it is quieter there and ruined by spikes. "
                "For a tool that is often held still, " strong { "directional forgetting" } " keeps what it knew of B. Use SPRLS, the gradient law and the paper's velocity filter to compare with others' results, not on a new machine."
            }
        }
    }
}
