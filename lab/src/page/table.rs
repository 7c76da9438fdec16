//! The tables: the methods of a recording, and the recordings of a page.

use super::answer::time_in_contact;
use super::embed::colour;
use super::quantity::{count, percent, plain, with_interval};
use super::{Method, Page, Summary, Trial};
use maud::{Markup, html};

/// One row a method, under the values that the rig file states.
pub(super) fn methods(page: &Page, trial: &Trial) -> Markup {
    let best = trial.best().map(|(index, ..)| index);
    html! {
        div.wide tabindex="0" role="region" aria-label="Estimates of every method" {
            table {
                caption { "Medians over the contact with their 95 % intervals; below them, how far they are from the rig file." }
                thead {
                    tr {
                        th scope="col" { "Method" }
                        th scope="col" { "Stiffness K" }
                        th scope="col" { "Damping B" }
                        th scope="col" { abbr title="100 rms(innovation) / rms(force) over contact: what the estimate before each sample did not foresee of its force" { "RMSE" } }
                    }
                }
                tbody {
                    tr.nominal {
                        th scope="row" { "rig file" small { "nominal" } }
                        td { (plain(trial.nominal_stiffness, trial.units.stiffness)) }
                        td { (plain(trial.nominal_damping, trial.units.damping)) }
                        td { "–" }
                    }
                    @for (index, method) in trial.methods.iter().enumerate() {
                        (of_method(page, trial, method, best == Some(index)))
                    }
                }
            }
        }
    }
}

fn of_method(page: &Page, trial: &Trial, method: &Method, best: bool) -> Markup {
    let class = format!("key c{}", colour(page, method.name) % 9);
    html! {
        tr.best[best] {
            th scope="row" {
                span class=(class) {} (method.name)
                @if best { span.mark { "predicts best" } }
                small { (method.title) }
            }
            @match method.summary {
                Some(summary) => (figures(trial, summary)),
                None => td colspan="3" { "no finite interval in contact" },
            }
        }
    }
}

fn figures(trial: &Trial, summary: Summary) -> Markup {
    let Summary { stiffness, stiffness_half_width, damping, damping_half_width, rmse_percent } = summary;
    html! {
        td {
            (with_interval(stiffness, stiffness_half_width, trial.units.stiffness))
            small { (difference(stiffness, trial.nominal_stiffness)) }
        }
        td {
            (with_interval(damping, damping_half_width, trial.units.damping))
            small { (difference(damping, trial.nominal_damping)) }
        }
        td { @if rmse_percent.is_finite() { (percent(rmse_percent)) } @else { "unknown" } }
    }
}

/// How far a value is from the nominal one.
pub(crate) fn difference(value: f64, nominal: f64) -> String {
    let ratio = value / nominal;
    match ratio {
        _ if !ratio.is_finite() => String::new(),
        _ if ratio >= 10.0 => format!("{} times as much", count(ratio.round() as usize)),
        _ if ratio > 0.0 && ratio <= 0.1 => format!("{} times less", count((1.0 / ratio).round() as usize)),
        _ if (ratio - 1.0).abs() < 5e-4 => "as stated".into(),
        _ if ratio > 1.0 => format!("+{}", percent(100.0 * (ratio - 1.0))),
        _ => percent(100.0 * (ratio - 1.0)),
    }
}

/// One row a recording; its name leads to the recording.
pub(super) fn recordings(page: &Page) -> Markup {
    html! {
        div.wide tabindex="0" role="region" aria-label="Answers of every recording" {
            table #recordings {
                caption { "Choose a recording to see it below. Each answer is by the method that predicted the force best." }
                thead {
                    tr {
                        th scope="col" { "Recording" }
                        th scope="col" { "Stiffness K" }
                        th scope="col" { "Damping B" }
                        th scope="col" { "RMSE" }
                        th scope="col" { "Method" }
                        th scope="col" { "In contact" }
                    }
                }
                tbody { @for (index, trial) in page.trials.iter().enumerate() { (recording(index, trial)) } }
            }
        }
    }
}

fn recording(index: usize, trial: &Trial) -> Markup {
    let units = trial.units;
    html! {
        tr {
            th scope="row" { a href={ "#trial-" (index + 1) } { (trial.name) } }
            @if let Some((_, method, summary)) = trial.best() {
                td { (with_interval(summary.stiffness, summary.stiffness_half_width, units.stiffness)) }
                td { (with_interval(summary.damping, summary.damping_half_width, units.damping)) }
                td { (percent(summary.rmse_percent)) }
                td { (method.name) }
            } @else {
                td colspan="4" { "no estimate" }
            }
            td { (time_in_contact(trial)) }
        }
    }
}
