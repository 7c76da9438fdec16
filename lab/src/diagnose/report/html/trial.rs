//! Before and after: what is drawn of each trial.

use super::super::diagnosis::{Diagnosis, Location, PlotData, Trace, Verdict};
use super::names_physics;
use super::wording::{channel, heading, list, place_words, share, stretch, title, worst};
use maud::{Markup, html};

/// The channels of one trial.
pub(super) struct Trial<'a> {
    /// File name.
    pub(super) name: &'a str,
    /// With their place among all traces.
    pub(super) traces: Vec<(usize, &'a Trace)>,
    /// Where it differs, the largest first.
    pub(super) places: Vec<&'a Location>,
}

/// A simulation that is drawn.
pub(super) struct Line {
    /// As the script finds its column.
    pub(super) key: &'static str,
    /// For the reader.
    pub(super) name: String,
}

/// The simulations that differ from each other.
pub(super) fn lines(answer: &Diagnosis, pictures: &PlotData) -> Vec<Line> {
    let line = |key, name: &str| Line { key, name: name.to_owned() };
    let mut lines = vec![line("given", "as given"), line("refitted", "values refitted")];
    if names_physics(answer) {
        lines.push(line("improved", &format!("with {}", named(answer))));
    }
    if pictures.traces.iter().any(|trace| !trace.learned.is_empty()) {
        lines.push(line("learned", "with a learned curve"));
    }
    lines
}

/// The named effects, where they are few enough for a legend.
fn named(answer: &Diagnosis) -> String {
    let names: Vec<String> =
        answer.physics.iter().filter(|physics| physics.name != "unknown").map(|physics| title(&physics.name)).collect();
    if names.len() > 2 { "named physics".to_owned() } else { list(&names) }
}

/// Those whose residuals are compared: what the answer changes.
pub(super) fn compared(answer: &Diagnosis, pictures: &PlotData) -> Vec<&'static str> {
    let keys: Vec<&'static str> = lines(answer, pictures).iter().map(|line| line.key).collect();
    if keys.len() > 2 { keys[1..].to_vec() } else { keys }
}

/// Traces by trial, in the order in which they came.
pub(super) fn group<'a>(answer: &'a Diagnosis, pictures: &'a PlotData) -> Vec<Trial<'a>> {
    let mut trials: Vec<Trial<'a>> = Vec::new();
    for (index, trace) in pictures.traces.iter().enumerate().filter(|(_, trace)| !trace.time.is_empty()) {
        match trials.iter_mut().find(|trial| trial.name == trace.trial) {
            Some(trial) => trial.traces.push((index, trace)),
            None => trials.push(Trial { name: &trace.trial, traces: vec![(index, trace)], places: Vec::new() }),
        }
    }
    for trial in &mut trials {
        trial.places = answer.locations.iter().filter(|place| place.trial == trial.name).collect();
        // A share that is no number counts as the least.
        trial.places.sort_by(|a, b| b.share.max(-1.0).total_cmp(&a.share.max(-1.0)));
    }
    trials
}

/// One fold a trial; the one with the largest place is open.
pub(super) fn section(trials: &[Trial<'_>], answer: &Diagnosis) -> Markup {
    let opened = worst(answer, None)
        .and_then(|place| trials.iter().position(|trial| trial.name == place.trial))
        .unwrap_or_default();
    html! {
        @if trials.is_empty() {
            p.nothing { "There is no recording to draw beside the simulation." }
        } @else {
            section #trials aria-labelledby="trials-title" {
                h2 #trials-title { "Before and after" }
                p.fine {
                    @if trials.iter().any(|trial| !trial.places.is_empty()) { "Each trial opens on the shortest stretch that shows the answer, or on the place where most of its mismatch lies; places are shaded. " }
                    "Drag across a picture to zoom, double-click or press “whole trial” to see all of it."
                }
                noscript { p.notices { "These pictures need JavaScript. All other pictures and figures stand without it." } }
                @for (index, trial) in trials.iter().enumerate() { (fold(trial, index, index == opened)) }
            }
        }
    }
}

fn fold(trial: &Trial<'_>, index: usize, opened: bool) -> Markup {
    html! {
        details.trial data-trial=(index) open[opened] {
            summary {
                strong.file { (trial.name) } " "
                span.where { @if let Some(place) = trial.places.first() { (share(place.share)) " of the " (channel(place.channel)) "'s mismatch lies " (place_words(place)) (stretch(place)) } @else { "no place stands out" } }
            }
            div.pictures {}
            @let rows = trial.traces.iter().map(|(_, trace)| trace.time.len()).max().unwrap_or_default();
            p.fine.rows data-rows=(rows) {}
        }
    }
}

/// What the script copies into a trial.
pub(super) fn templates(answer: &Diagnosis) -> Markup {
    html! {
        template #toolbar { (toolbar()) }
        @for name in ["force", "effort"] {
            template #{ "figures-" (name) } {
                (figure("model", &format!("{}: measured and simulated", heading(channel(name))), "Points are measured; lines are what each simulation gives for the same motion."))
                (figure("residual", &format!("{}: what is left", heading(channel(name))), left(answer)))
            }
        }
        template #figures-depth {
            (figure("depth", "Depth", "Where the tool was: above the dashed line it is below the surface."))
        }
        template #figures-position { (figure("depth", "Position", "Where the machine was.")) }
    }
}

fn left(answer: &Diagnosis) -> &'static str {
    match answer.verdict {
        Verdict::NoMismatch => {
            "Measured minus simulated. The grey band is ± 2 standard deviations of the expected noise: nothing leaves it for long."
        }
        _ => {
            "Measured minus simulated. The grey band is ± 2 standard deviations of the expected noise: a good simulation stays within."
        }
    }
}

fn figure(kind: &str, title: &str, explanation: &str) -> Markup {
    html! {
        figure data-chart=(kind) {
            figcaption { h3 { (title) } p { (explanation) } }
            div.legend aria-hidden="true" {}
            div.plot role="img" aria-label={ (title) " over time. " (explanation) } {}
        }
    }
}

fn toolbar() -> Markup {
    html! {
        div.toolbar role="group" aria-label="What the pictures show" {
            div.choice.lines role="group" aria-label="Simulations shown" {}
            div.choice.time role="group" aria-label="Time shown" {
                button.worst type="button" data-move="worst" { "closest look" }
                button.whole type="button" data-move="all" { "whole trial" }
                button type="button" data-move="back" aria-label="Earlier" { "←" }
                button type="button" data-move="forth" aria-label="Later" { "→" }
                button type="button" data-move="in" aria-label="Zoom in" { "+" }
                button type="button" data-move="out" aria-label="Zoom out" { "−" }
                output.clock { "drag to zoom" }
            }
        }
    }
}
