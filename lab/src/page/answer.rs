//! The answer in plain words, of one recording and of many.

use super::quantity::{percent, plain, rounded, seconds, with_interval};
use super::{ContactSpan, Method, Page, Summary, Trial};
use maud::{Markup, html};

/// What one recording says.
pub(super) fn of_trial(trial: &Trial) -> Markup {
    let contact = trial.drawn.span;
    if trial.drawn.samples == 0 {
        return html! { "The recording is empty: there is nothing to identify." };
    }
    if contact.touches == 0 {
        return html! {
            "The tool touched nothing in the " (seconds(contact.duration)) " of this recording, so there was no stiffness and no damping to identify."
        };
    }
    let lasted = html! { (seconds(contact.seconds)) " in contact (" (touches(contact.touches)) ")" };
    if trial.methods.is_empty() {
        return html! { "The recording holds " (lasted) ", but no estimator was run on it." };
    }
    match trial.best() {
        Some((_, method, summary)) => found(trial, method, summary, &lasted),
        None => html! {
            "After " (lasted) " no estimator could bound stiffness and damping: the contact was too short or moved too little."
        },
    }
}

fn found(trial: &Trial, method: &Method, summary: Summary, lasted: &Markup) -> Markup {
    let units = trial.units;
    let best = match trial.methods.len() {
        1 => html! { "which predicted the measured force with an error of " (percent(summary.rmse_percent)) },
        n => {
            html! { "which of " (n) " methods predicted the measured force best, with an error of " (percent(summary.rmse_percent)) }
        }
    };
    html! {
        "The tool touched something with a stiffness of "
        strong { (with_interval(summary.stiffness, summary.stiffness_half_width, units.stiffness)) }
        " and a damping of "
        strong { (with_interval(summary.damping, summary.damping_half_width, units.damping)) }
        (doubt(summary)) ". "
        span.aside {
            "So says " (method.title) ", " (best) ", over " (lasted) " of a " (seconds(trial.drawn.span.duration)) " recording; ± spans 95 %. "
            "The rig file says " (plain(trial.nominal_stiffness, units.stiffness)) " and "
            (plain(trial.nominal_damping, units.damping)) "."
        }
    }
}

/// An interval that includes zero is no finding, whatever the figure before it.
fn doubt(summary: Summary) -> &'static str {
    let vague = |value: f64, half_width: f64| half_width >= value.abs();
    match (vague(summary.stiffness, summary.stiffness_half_width), vague(summary.damping, summary.damping_half_width)) {
        (true, true) => ", neither of which is distinguishable from zero",
        (true, false) => " (this stiffness is not distinguishable from zero)",
        (false, true) => " (this damping is not distinguishable from zero)",
        (false, false) => "",
    }
}

/// What all recordings together say.
pub(super) fn of_page(page: &Page) -> Markup {
    let answered: Vec<(&Trial, Summary)> =
        page.trials.iter().filter_map(|trial| trial.best().map(|(_, _, summary)| (trial, summary))).collect();
    let Some((first, _)) = answered.first() else {
        return match page.trials.len() {
            0 => html! { "No recording was replayed." },
            n => html! { "None of the " (n) " recordings holds a contact that bounds stiffness and damping." },
        };
    };
    let stiffness = span(answered.iter().map(|(_, summary)| summary.stiffness), first.units.stiffness);
    let damping = span(answered.iter().map(|(_, summary)| summary.damping), first.units.damping);
    html! {
        "What the tool touched had a stiffness " strong { (stiffness) } " and a damping " strong { (damping) } ". "
        span.aside {
            "These are the answers of " (answered.len()) " of " (page.trials.len()) " recordings, each by the method that predicted its measured force best."
        }
    }
}

fn span(values: impl Iterator<Item = f64> + Clone, unit: &str) -> String {
    let least = rounded(values.clone().fold(f64::INFINITY, f64::min), unit, 3);
    let greatest = rounded(values.fold(f64::NEG_INFINITY, f64::max), unit, 3);
    if least == greatest { format!("of {least}") } else { format!("between {least} and {greatest}") }
}

/// Time in contact, as a cell of the table of recordings.
pub(super) fn time_in_contact(trial: &Trial) -> String {
    match trial.drawn.span {
        ContactSpan { touches: 0, .. } => "none".into(),
        span => seconds(span.seconds),
    }
}

fn touches(count: usize) -> String {
    if count == 1 { "one touch".into() } else { format!("{count} touches") }
}
