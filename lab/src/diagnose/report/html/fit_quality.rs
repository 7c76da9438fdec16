//! How well the models fit: up to five bars a channel.

use super::super::diagnosis::{Diagnosis, FitQuality, Verdict};
use super::super::summary::{MOST_OVER_NOISE, holds_parasitic_force, refit_is_worse};
use super::axis::{Axis, across};
use super::names_physics;
use super::wording::{channel, heading, multiple, share, times};
use crate::page::quantity::{plain, rounded};
use maud::{Markup, html};

/// Height of a bar with its words, px.
const ROW: usize = 46;

/// One picture a channel.
pub(super) fn section(answer: &Diagnosis) -> Markup {
    let channels: Vec<&FitQuality> =
        if answer.channels.is_empty() { vec![&answer.fit] } else { answer.channels.iter().collect() };
    html! {
        section #fit aria-labelledby="fit-title" {
            h2 #fit-title { "How well it fits" }
            p.fine {
                "Each bar is the typical error (root mean square) of a simulation: as given, with the same physics and refitted values"
                @if names_physics(answer) { ", and with the named physics added" }
                @if answer.fit.learned.is_some() { ", and with a curve that was learned for what no name explains" }
                ". Shorter is better, and the expected noise is what the sensors alone would leave. Every figure is from stretches of the recordings that no fit saw, so more numbers to turn do not by themselves shorten a bar."
            }
            div.pair { @for goodness in channels { (figure(answer, goodness)) } }
        }
    }
}

fn figure(answer: &Diagnosis, goodness: &FitQuality) -> Markup {
    let bars = bars(answer, goodness);
    let axis = Axis::over(bars.iter().map(|bar| bar.value));
    let described: Vec<String> =
        bars.iter().map(|bar| format!("{}: {}", bar.name, plain(bar.value, goodness.unit))).collect();
    let label = format!("Typical error of the {}. {}.", channel(goodness.channel), described.join("; "));
    html! {
        figure {
            figcaption {
                h3 { (heading(channel(goodness.channel))) }
                p { (analysed(goodness)) @if axis.logarithmic { "Logarithmic: each tick is ten times the one before it." } }
            }
            svg.bars role="img" aria-label=(label) height=(ROW * bars.len()) {
                @for (row, bar) in bars.iter().enumerate() { (drawn(&axis, goodness, bar, row)) }
            }
            p { (explained(answer, goodness)) }
        }
    }
}

struct Bar {
    name: &'static str,
    class: &'static str,
    value: f64,
}

fn bars(answer: &Diagnosis, goodness: &FitQuality) -> Vec<Bar> {
    let mut bars = vec![
        Bar { name: "as given", class: "given", value: goodness.as_given },
        Bar { name: "values refitted", class: "refitted", value: goodness.refitted },
    ];
    if names_physics(answer) {
        bars.push(Bar { name: "with named physics", class: "improved", value: goodness.improved });
    }
    if let Some(value) = goodness.learned {
        bars.push(Bar { name: "with a learned curve", class: "learned", value });
    }
    bars.push(Bar { name: "expected noise", class: "floor", value: goodness.noise_floor });
    bars
}

fn drawn(axis: &Axis, goodness: &FitQuality, bar: &Bar, row: usize) -> Markup {
    let top = row * ROW;
    let times_floor = bar.value / goodness.noise_floor;
    html! {
        text x="0" y=(top + 17) { (bar.name) }
        text.figure x="100%" y=(top + 17) text-anchor="end" {
            (plain(bar.value, goodness.unit))
            @if bar.class != "floor" && times_floor.is_finite() { tspan.soft { " = " (times(times_floor)) " × noise" } }
        }
        rect.track x="0" y=(top + 24) width="100%" height="14" {}
        @for decade in axis.decades() { (grid(axis, decade, top + 21)) }
        @if let Some(length) = axis.at(bar.value) {
            rect.(bar.class) x="0" y=(top + 24) width=(across(length)) height="14" {}
        }
    }
}

fn grid(axis: &Axis, decade: f64, top: usize) -> Markup {
    let at = axis.at(decade).unwrap_or_default();
    html! { line.decade x1=(across(at)) x2=(across(at)) y1=(top) y2=(top + 20) {} }
}

fn analysed(goodness: &FitQuality) -> String {
    let known = goodness.band_hz.is_finite() && goodness.band_hz > 0.0;
    if known { format!("Analysed up to {}. ", rounded(goodness.band_hz, "Hz", 3)) } else { String::new() }
}

/// Whether refitted values alone leave what the sensors do.
fn is_within_noise(goodness: &FitQuality) -> bool {
    goodness.refitted < MOST_OVER_NOISE * goodness.noise_floor
}

fn explained(answer: &Diagnosis, goodness: &FitQuality) -> Markup {
    let left = multiple(goodness.refitted / goodness.noise_floor);
    let name = channel(goodness.channel);
    let is_named = answer.physics.iter().any(|one| one.name != "unknown" && one.channel == goodness.channel);
    html! {
        @if !is_named && goodness.channel == "force" && holds_parasitic_force(answer) {
            "Of the mean square that refitted values leave in the " (name) " above the noise, the force of free motion takes away "
            strong { (share(goodness.explained_share)) } "."
        } @else if !is_named && is_within_noise(goodness) {
            "Refitted values leave no more in the " (name) " than the expected noise: nothing is missing there."
        } @else if names_physics(answer) {
            "Of the mean square that refitted values leave in the " (name) " above the noise, the named physics takes away "
            strong { (share(goodness.explained_share)) } "."
        } @else if answer.verdict == Verdict::Unknown {
            "Refitted values still leave " strong { (left) } " in the " (name) ", and no effect that was tried takes that away."
        } @else {
            "Refitted values leave " strong { (left) } " in the " (name) ", which is no sign of missing physics."
        }
        @if refit_is_worse(goodness) && !is_within_noise(goodness) {
            " On rows that no fit saw, refitted values leave more than those of the rig file: without what is missing, each half of the recordings teaches values that do not suit the other."
        }
        @if let Some(rest) = goodness.learned {
            " A curve that was learned from the recordings, and has no name, leaves " strong { (multiple(rest / goodness.noise_floor)) } "."
        }
    }
}
