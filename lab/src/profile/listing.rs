//! Where the instructions go: a self-contained page with a bar for each function and a listing with its counts.

use std::collections::BTreeMap;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::counts::Case;
use super::figures::Figures;
use super::image::Image;
use super::table::NO_BOARD;

const STYLE: &str = include_str!("../../assets/profile.css");

/// Bars below this share of an update are not drawn.
const MIN_SHARE: f64 = 0.002;

/// The page.
pub fn page(image: &Image, cases: &[Case], figures: &[Figures]) -> String {
    let sections: Vec<(usize, &Case, &Figures)> =
        cases.iter().skip(1).zip(figures).enumerate().map(|(at, (case, figures))| (at, case, figures)).collect();
    let empty = cases.first().and_then(|case| case.passes.first()).map_or(0, |pass| pass.instructions);
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "Where the instructions go" }
                style { (PreEscaped(STYLE)) }
            }
            body { main {
                h1 { "Where the instructions go" }
                p { (NO_BOARD) " Each bar is the mean update; its parts are the functions that it runs through, the largest first. Open \
                     one for its listing: executions in the mean update, address, instruction. The parts include the call of the \
                     measurement itself ("
                     (empty) " instructions), which is subtracted from the figure above each bar." }
                @for (_, case, figures) in &sections { (estimator(image, case, figures)) }
            } }
        }
    }
    .into_string()
}

fn estimator(image: &Image, case: &Case, figures: &Figures) -> Markup {
    let passes = case.passes.len().max(1) as f64;
    let mut functions: BTreeMap<u32, f64> = BTreeMap::new();
    for (address, times) in &case.times {
        if let Some(function) = image.function_at(*address) {
            *functions.entry(function.start).or_default() += *times as f64 / passes;
        }
    }
    let total: f64 = functions.values().sum();
    let mut order: Vec<(u32, f64)> = functions.into_iter().collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    let name = |start: u32| image.functions.get(&start).map_or("", |function| function.name.as_str());
    html! {
        section {
            h2 { (figures.name) @if let Some(window) = figures.window { ", window " (window) } }
            p { (format!("{:.1}", figures.instructions_mean)) " instructions in the mean, at most " (figures.instructions_worst)
                ", at sample " (figures.worst_sample) "; " (figures.cycles_lo) " to " (figures.cycles_hi) " cycles" }
            div.bar {
                @for (at, (start, count)) in order.iter().enumerate().filter(|(_, (_, count))| count / total > MIN_SHARE) {
                    span class=(format!("part c{}", at % 6)) style=(format!("flex-grow:{count:.3}"))
                        title=(format!("{}: {count:.1}", name(*start))) { (short(name(*start))) }
                }
            }
            @for (start, count) in &order {
                details {
                    summary { (format!("{count:.1}")) " " (name(*start)) }
                    pre { (listing(image, case, *start, passes)) }
                }
            }
        }
    }
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
