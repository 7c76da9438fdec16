//! The document around the numbers.

use super::quantity::count;
use super::{Page, Trial, answer, shell, table};
use maud::{Markup, html};
use std::io::{self, Write};

const STYLE: &str = include_str!("../../assets/replay.css");
const SCRIPT: &str = include_str!("../../assets/replay.js");

/// Everything before the first recording.
pub(super) fn open(page: &Page, out: &mut impl Write) -> io::Result<()> {
    shell::open(&format!("{} – palpate replay", page.rig), STYLE, out)?;
    out.write_all(opening(page).into_string().as_bytes())
}

fn opening(page: &Page) -> Markup {
    html! {
        header {
            p.eyebrow { "Palpate replay · estimated on " (page.ran_on) }
            h1 { (page.rig) ": how stiff, how damped?" }
            p.lead { @if let [only] = page.trials.as_slice() { (answer::of_trial(only)) } @else { (answer::of_page(page)) } }
            p.law {
                "The law is F = K x + B v. Stiffness K is the force that each bit of depth adds; damping B is the force that each bit of pressing speed adds."
            }
        }
        @if page.trials.iter().any(|trial| trial.best().is_some()) { (limits(page)) }
        @if page.trials.len() > 1 {
            section aria-labelledby="all" { h2 #all { (page.trials.len()) " recordings" } (table::recordings(page)) }
            (settings(page))
        }
    }
}

/// What the intervals do not hold, and where the same recordings are asked for more than a spring and a damper.
fn limits(page: &Page) -> Markup {
    let names: Vec<&str> = page.trials.iter().take(2).map(|trial| trial.name.as_str()).collect();
    html! {
        p.law {
            "Intervals are those that the drive computes: they hold where the contact is such a spring and damper and the noise is white, and ignore what other physics leaves. "
            "Whether other physics acts: " code { "palpate diagnose --rig RIG.toml " (names.join(" ")) @if page.trials.len() > 2 { " ..." } }
            @if let Some(diagnosis) = &page.diagnosis { " (" a href=(diagnosis) { "the diagnosis beside this page" } ")" }
            ". Its K and B are those of one law for all recordings, with intervals widened by what the law leaves; here they are medians over the contact. Where it names physics, the two differ."
        }
    }
}

fn settings(page: &Page) -> Markup {
    html! {
        @if !page.settings.is_empty() {
            section.settings aria-label="Settings" {
                dl { @for (label, value) in &page.settings { div { dt { (label) } dd { (value) } } } }
            }
        }
    }
}

/// The section of one recording.
pub(super) fn trial(page: &Page, index: usize, trial: &Trial) -> Markup {
    let alone = page.trials.len() == 1;
    html! {
        article.trial #{ "trial-" (index + 1) } data-trial=(index) aria-labelledby={ "name-" (index + 1) } {
            h2 #{ "name-" (index + 1) } { (trial.name) }
            @if !alone {
                (neighbours(page, index))
                p.lead { (answer::of_trial(trial)) }
            }
            @if !trial.methods.is_empty() { (table::methods(page, trial)) }
            (notices(trial))
            @if alone { (settings(page)) }
            @if !trial.drawn.time.is_empty() { (pictures(trial)) }
        }
    }
}

fn neighbours(page: &Page, index: usize) -> Markup {
    html! {
        nav.neighbours aria-label="Recordings beside this one" {
            @if index > 0 { a href={ "#trial-" (index) } { "← previous" } }
            span { (index + 1) " of " (page.trials.len()) }
            @if index + 1 < page.trials.len() { a href={ "#trial-" (index + 2) } { "next →" } }
        }
    }
}

fn notices(trial: &Trial) -> Markup {
    html! {
        @if !trial.notices.is_empty() {
            ul.notices aria-label="Notices" { @for notice in &trial.notices { li { (notice) } } }
        }
    }
}

fn pictures(trial: &Trial) -> Markup {
    let (total, shown) = (trial.drawn.samples, trial.drawn.time.len());
    html! {
        section.pictures aria-label={ "Pictures of " (trial.name) } {
            noscript { p.notices { "The pictures need JavaScript. All figures above stand without it, and every sample is in estimates.csv." } }
        }
        @if shown < total {
            p.fine {
                "1 of " (total.div_ceil(shown)) " samples shown (" (count(shown)) " of " (count(total))
                "): of every stretch of time the extremes of position, force and innovation, and the edges of contact. All samples are in estimates.csv."
            }
        } @else {
            p.fine { "Samples shown: all " (count(total)) ". The same numbers are in estimates.csv." }
        }
    }
}

/// Everything after the data: what the script draws into, and the script.
pub(super) fn close(out: &mut impl Write) -> io::Result<()> {
    let templates = html! { (toolbar()) (figures()) };
    shell::close(&templates, SCRIPT, out)
}

fn toolbar() -> Markup {
    html! {
        template #toolbar {
            div.toolbar role="group" aria-label="What the pictures show" {
                div.choice.methods role="group" aria-label="Methods shown" {}
                div.choice {
                    label { "95 % bands " select.bands {} }
                    button.range type="button" aria-pressed="false" title="Show every spike instead of the usual range" { "Full height" }
                }
                div.choice.time role="group" aria-label="Time shown" {
                    button type="button" data-move="back" aria-label="Earlier" { "←" }
                    button type="button" data-move="forth" aria-label="Later" { "→" }
                    button type="button" data-move="in" aria-label="Zoom in" { "+" }
                    button type="button" data-move="out" aria-label="Zoom out" { "−" }
                    button type="button" data-move="all" aria-label="Whole recording" { "all" }
                    output.clock { "drag to zoom" }
                }
            }
        }
    }
}

fn figures() -> Markup {
    let figures = [
        (
            "position",
            "Position",
            "Depth of the tool: above the dashed line it is below the surface. Shaded: in contact.",
        ),
        ("force", "Force", "What the sensor felt, positive when the tool pushes."),
        (
            "stiffness",
            "Stiffness K",
            "What each method believes, its 95 % interval as a band; dashed: the rig file. A good one settles soon and stays.",
        ),
        (
            "damping",
            "Damping B",
            "The same for damping, which needs movement to show: while the tool holds still, nothing tells it.",
        ),
        (
            "innovation",
            "Innovation",
            "Measured force minus what the estimate before this sample predicted. Only noise around zero means that the law explains the touch.",
        ),
    ];
    html! {
        template #figures {
            @for (key, title, explanation) in figures {
                figure data-chart=(key) {
                    figcaption { h3 { (title) } p { (explanation) } }
                    div.legend aria-hidden="true" {}
                    div.plot role="img" aria-label={ (title) " over time. " (explanation) } {}
                }
            }
        }
    }
}
