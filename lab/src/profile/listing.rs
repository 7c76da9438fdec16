//! Where the instructions go: a self-contained page with a bar for each function and a listing with its counts.

use std::collections::BTreeMap;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::counts::Case;
use super::figures::Figures;
use super::image::Image;
use super::table::NO_BOARD;
use crate::page::quantity::{count, percent};
use crate::tools::TARGET;

const STYLE: &str = concat!(include_str!("../../assets/page.css"), include_str!("../../assets/profile.css"));

/// Parts below this share of an update are not drawn.
const MIN_SHARE: f64 = 0.002;
/// Parts below this share have no room for a name.
const MIN_NAMED_SHARE: f64 = 0.08;

/// An update that was measured.
#[derive(Clone, Copy)]
struct Update<'a> {
    case: &'a Case,
    figures: &'a Figures,
    /// The place on the page.
    at: usize,
}

/// The page.
pub fn page(image: &Image, cases: &[Case], figures: &[Figures]) -> String {
    let updates: Vec<Update<'_>> = cases
        .iter()
        .skip(1)
        .zip(figures)
        .enumerate()
        .map(|(at, (case, figures))| Update { case, figures, at })
        .collect();
    let empty = cases.first().and_then(|case| case.passes.first()).map_or(0, |pass| pass.instructions);
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "What an update costs – palpate profile" }
                style { (PreEscaped(STYLE)) }
            }
            body { main {
                p.eyebrow { "Palpate profile · " (TARGET) " under QEMU" }
                h1 { "What an update costs, and where its instructions go" }
                (summary(&updates))
                h2 { "Where they go" }
                p.law {
                    "A bar is the mean update, whatever it costs: its parts are shares of it, by the functions that it runs through. "
                    "Each function below opens to its listing: executions in the mean update, address, instruction. A law that the compiler "
                    "put into its caller is counted under the caller, " code { "measurement::call" } ". The parts include what the "
                    "measurement itself takes (" (empty) " instructions), which is subtracted from the figures."
                }
                @for update in &updates { (section(image, *update)) }
            } }
        }
    }
    .into_string()
}

/// The answer, and a line for each update.
fn summary(updates: &[Update<'_>]) -> Markup {
    let share = |update: &Update<'_>| update.figures.share_of_1ms_percent;
    let least = updates.iter().min_by(|a, b| share(a).total_cmp(&share(b)));
    let most = updates.iter().max_by(|a, b| share(a).total_cmp(&share(b)));
    html! {
        @if let (Some(least), Some(most)) = (least, most) {
            p.lead {
                "At worst an update takes between " strong { (percent(share(least))) } " (" (name_of(least.figures)) ") and "
                strong { (percent(share(most))) } " (" (name_of(most.figures)) ") of a millisecond at 168 MHz. "
                span.aside { (NO_BOARD) " No wait for flash or bus is in them." }
            }
        }
        div.wide tabindex="0" role="region" aria-label="Cost of every update" {
            table {
                caption {
                    "Choose an update to see where its instructions go. The millisecond and the cycles are those of the worst update. "
                    "A bare name is the law with its interval, " code { "_alone" } " the estimate without it, " code { "_anew" }
                    " the law summed anew over its window; " code { "identify_" } " and " code { "model_" }
                    " take a sample through front end and law, the latter one of three parameters."
                }
                thead { tr {
                    @for title in ["Update", "Of 1 ms", "Instructions, mean", "worst", "Cycles", "State, bytes"] {
                        th scope="col" { (title) }
                    }
                } }
                tbody { @for update in updates { (line(*update)) } }
            }
        }
    }
}

fn line(Update { figures, at, .. }: Update<'_>) -> Markup {
    html! {
        tr {
            th scope="row" { a href={ "#update-" (at) } { (name_of(figures)) } }
            td { (percent(figures.share_of_1ms_percent)) }
            td { (format!("{:.1}", figures.instructions_mean)) }
            td { (figures.instructions_worst) }
            td { (figures.worst_cycles_lo) " to " (figures.worst_cycles_hi) }
            td { (count(figures.state_bytes as usize)) }
        }
    }
}

fn name_of(figures: &Figures) -> String {
    figures.window.map_or_else(|| figures.name.clone(), |window| format!("{}, window {window}", figures.name))
}

fn section(image: &Image, Update { case, figures, at }: Update<'_>) -> Markup {
    let passes = case.passes.len().max(1) as f64;
    let order = functions(image, case, passes);
    let total: f64 = order.iter().map(|(_, count)| count).sum();
    let name = |start: u32| image.functions.get(&start).map_or("", |function| function.name.as_str());
    html! {
        section #{ "update-" (at) } {
            h3 { (name_of(figures)) }
            p.fine {
                (format!("{:.1}", figures.instructions_mean)) " instructions in the mean (" (figures.cycles_lo) " to "
                (figures.cycles_hi) " cycles), at most " (figures.instructions_worst) ", at sample " (figures.worst_sample)
                " of the recording"
            }
            div.bar aria-hidden="true" {
                @for (part, (start, count)) in order.iter().enumerate().filter(|(_, (_, count))| count / total > MIN_SHARE) {
                    span class=(format!("part p{}", part % 6)) style=(format!("flex-grow:{count:.3}"))
                        title=(format!("{}: {count:.1}", name(*start))) {
                        @if count / total > MIN_NAMED_SHARE { (short(name(*start))) }
                    }
                }
            }
            @for (part, (start, count)) in order.iter().enumerate() {
                details {
                    summary {
                        span class=(format!("swatch p{}", part % 6)) {}
                        (format!("{count:.1} ({})", percent(100.0 * count / total))) " " (name(*start))
                    }
                    pre { (listing(image, case, *start, passes)) }
                }
            }
        }
    }
}

/// Where each function of an update begins, with its instructions in the mean update, the largest first.
fn functions(image: &Image, case: &Case, passes: f64) -> Vec<(u32, f64)> {
    let mut functions: BTreeMap<u32, f64> = BTreeMap::new();
    for (address, times) in &case.times {
        if let Some(function) = image.function_at(*address) {
            *functions.entry(function.start).or_default() += *times as f64 / passes;
        }
    }
    let mut order: Vec<(u32, f64)> = functions.into_iter().collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    order
}

/// The last part of a path, without its generics.
fn short(name: &str) -> &str {
    let end = name.rfind("::").map_or(0, |at| at + 2);
    name.get(end..).unwrap_or(name)
}

fn listing(image: &Image, case: &Case, start: u32, passes: f64) -> Markup {
    let end = image.functions.get(&start).map_or(start, |function| function.end);
    html! {
        @for (address, instruction) in image.code.range(start..end) {
            @let times = case.times.get(address).copied().unwrap_or(0) as f64 / passes;
            @let heat = if times <= 0.0 { "cold" } else if times > 1.5 { "hot" } else { "warm" };
            span class=(heat) {
                (format!("{times:9.3}  {address:08x}  {:<10} {}\n", instruction.mnemonic, instruction.operands))
            }
        }
    }
}
