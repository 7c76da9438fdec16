//! The page: the study from top to bottom, in words that need no paper.

mod claims;
mod comparison;
mod force_control;
mod models;
mod tables;

use maud::{Markup, html};
use std::io::{self, Write};

use super::Results;
use super::claim::distance;
use super::figures::Figure;
use super::measure::MeanAndDeviation;
use super::paper_tables::{Study, TRIALS};
use crate::page::shell;

const STYLE: &str = include_str!("../../assets/reproduce.css");

/// Writes the page. It needs nothing but itself.
///
/// # Errors
/// Whatever `out` reports.
pub fn write(results: &Results, out: &mut impl Write) -> io::Result<()> {
    shell::open("The paper, and better – palpate reproduce", STYLE, out)?;
    let body = html! {
        (header(results))
        (bench(results))
        (tables::section(results))
        (figures("figures", "Figures 2 to 12", "One trial of each contact, seed 1. The numbers of the figures are those of the paper's subjects: \
            the motion and the force, each contact's K and B, the windows, the rates.", &results.figures))
        (claims::section(results))
        (comparison::section(results))
        (models::section(&results.models))
        (force_control::section(results))
        (made(results))
    };
    out.write_all(body.0.as_bytes())?;
    shell::close(&html! {}, "", out)
}

fn header(results: &Results) -> Markup {
    let held = results.claims.iter().filter(|claim| claim.findings.iter().any(|finding| finding.holds)).count();
    html! {
        header {
            p.eyebrow { "Palpate reproduce · a simulated bench, no hardware" }
            h1 { "Stiffness and damping by touch: four methods of a paper, and what does better" }
            p.lead {
                "A tool presses on something and measures depth and force. How stiff and how damped is what it touches, and how soon is that known? \
                 A paper compared four methods on a bench; here they run on that bench, simulated. "
                strong { (held) " of its " (results.claims.len()) " claims" } " hold under some reading of what it leaves open, "
                "and " strong { (comparison::in_one_sentence(results)) } "."
            }
            p.law { "The law is F = K x + B v: force, depth and its rate, stiffness K and damping B. RMSE% is what an estimate did not foresee of the force: 100 rms(F − K x − B v) / rms(F), with the K and B from before each sample." }
        }
        nav.contents aria-label="Contents" {
            ul {
                @for (id, title) in [("bench", "The bench"), ("tables", "Tables I to IV"), ("figures", "Figures 2 to 12"), ("claims", "The paper's claims, computed"), ("better", "What does better, and which to take"), ("models", "Beyond K and B"), ("force", "Why a fast estimate matters"), ("made", "How this was made")] {
                    li { a href={ "#" (id) } { (title) } }
                }
            }
        }
    }
}

fn bench(results: &Results) -> Markup {
    html! {
        section #bench aria-labelledby="bench-title" {
            h2 #bench-title { "The bench" }
            p {
                "A motor turns a bar by a cable of 4:1; its end is the tool. The encoder counts steps of 0.1 mm at the tool, the force sensor steps of 0.05 N with a noise of 0.09 N, \
                 and a controller of the position (proportional and derivative, 1 kHz) follows smoothed square pulses with a sine of 10 Hz on top, through 15 s of air into 15 s of contact. \
                 Three things are touched: a soft foam that stiffens and relaxes, bubble wrap that gives way, and a pad of medium stiffness. They are rig files ("
                @for (at, (name, _)) in results.rigs.iter().enumerate() { @if at > 0 { ", " } code { (name) } }
                "), run by " code { "palpate simulate" } "; copy one and change it."
            }
            p {
                "The paper leaves some things open, so each table was made under three readings. How far a reading is from the paper's tables is given as a factor, the mean over all of its figures; 1 would be the paper itself:"
            }
            ul { @for study in &results.studies { li { (study.reading.name) ": " strong { "factor " (format!("{:.2}", distance(study))) } (settings(study)) } } }
        }
    }
}

fn settings(study: &Study) -> String {
    let r = study.reading;
    format!(" (EWRLS from P(0) = {}, SPRLS from {} with gamma = {})", r.covariance, r.sprls_covariance, r.gamma)
}

/// A grid of figures.
fn figures(id: &str, title: &str, words: &str, all: &[Figure]) -> Markup {
    html! {
        section id=(id) aria-labelledby={ (id) "-title" } {
            h2 id={ (id) "-title" } { (title) }
            p { (words) }
            (grid(all))
        }
    }
}

fn grid(all: &[Figure]) -> Markup {
    html! {
        div.figures {
            @for figure in all {
                figure #{ "figure-" (figure.number) } {
                    figcaption { h3 { "Figure " (figure.number) ". " (figure.title) } p { (figure.words) } }
                    (figure.plot.inline(&format!("{}. {}", figure.title, figure.words)))
                }
            }
        }
    }
}

fn made(results: &Results) -> Markup {
    html! {
        section #made aria-labelledby="made-title" {
            h2 #made-title { "How this was made" }
            p {
                "By " code { "palpate reproduce" } ", seeds 1, 2, ...: " (TRIALS) " trials of each contact for the tables, " (super::comparison::SEEDS)
                " of the steps, " (super::models::SEEDS) " for each other law, " (super::force_control::SEEDS) " flights of each controller. Every figure comes from the library that runs on the drive, in its single precision; nothing is written down by hand but the paper's own figures. "
                (results.rates.words) " No board was measured. Docs: " code { "docs/paper.md" } "."
            }
        }
    }
}

/// Mean and spread, to `decimals`.
fn spread(value: &MeanAndDeviation, decimals: usize) -> Markup {
    html! { (number(value.mean, decimals)) small { "± " (number(value.deviation, decimals)) } }
}

fn number(value: f64, decimals: usize) -> String {
    if value.is_finite() { format!("{value:.decimals$}").replace('-', "−") } else { "–".into() }
}

/// A table that scrolls by itself where the window is narrow.
fn wide(label: &str, table: &Markup) -> Markup {
    html! { div.wide tabindex="0" role="region" aria-label=(label) { (table) } }
}
