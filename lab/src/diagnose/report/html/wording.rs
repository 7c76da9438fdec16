//! Names and figures as a mechanic says them.

use super::super::diagnosis::{Diagnosis, Location, Phase};
use super::super::summary::MAJORITY_SHARE;
use crate::page::effect_name::effect_name;
use crate::page::quantity::{between, percent, plain, rounded, with_interval};
use maud::{Markup, html};

/// "Hunt-Crossley damping".
pub(super) fn title(name: &str) -> String {
    effect_name(name)
}

/// The same as a heading.
pub(super) fn heading(name: &str) -> String {
    let name = title(name);
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A share of one, never more than all nor less than nothing.
pub(super) fn share(value: f64) -> String {
    match value.clamp(0.0, 1.0) {
        value if value.is_nan() => "an unknown share".into(),
        value if value > 0.0 && value < 0.001 => "less than 0.1\u{a0}%".into(),
        // No rounding shall make "all" of nearly all.
        value if value > 0.99 && value < 1.0 => format!("{:.1}\u{a0}%", 100.0 * value.min(0.999)),
        value => percent(100.0 * value),
    }
}

/// A gain, which may be a loss.
pub(super) fn gain(value: f64) -> String {
    match value {
        value if !value.is_finite() => "unknown".into(),
        value if value < 0.0 => "none: fits worse".into(),
        value => share(value),
    }
}

/// A probability as anybody says it.
pub(super) fn odds(p: f64) -> String {
    match p {
        p if !p.is_finite() || p < 0.0 => "how often chance alone does as much is unknown".into(),
        p if p < 0.001 => "chance alone does as much in fewer than 1 of 1000 cases".into(),
        p if p < 0.5 => format!("chance alone does as much in 1 of {:.0} cases", 1.0 / p),
        _ => "chance alone does as much more often than not".into(),
    }
}

/// How many times one is the other: "38 times", "1.2 times".
pub(super) fn times(ratio: f64) -> String {
    match ratio {
        ratio if !ratio.is_finite() => "unknown".into(),
        ratio if ratio >= 1e6 => "over a million".into(),
        ratio => rounded(ratio, "1", 2),
    }
}

/// An error as a multiple of the noise, for a sentence.
pub(super) fn multiple(ratio: f64) -> String {
    match ratio {
        ratio if ratio.is_finite() && ratio < 1.15 => "no more than noise".into(),
        ratio if ratio.is_finite() => format!("{} times the noise", times(ratio)),
        _ => "an unknown part of noise".into(),
    }
}

/// A value with its 95 % interval: by its half-width where it reaches as far to both sides, by its ends otherwise.
pub(super) fn estimate(value: f64, [low, high]: [f64; 2], unit: &str) -> String {
    let (below, above) = (value - low, high - value);
    if below == 0.0 && above == 0.0 {
        return format!("{} (chosen, not fitted)", plain(value, unit));
    }
    if !(below.is_finite() && above.is_finite()) {
        return format!("{} (not bounded by these recordings)", plain(value, unit));
    }
    let even = below > 0.0 && above > 0.0 && (below - above).abs() <= 0.2 * below.max(above);
    if even {
        with_interval(value, 0.5 * (below + above), unit)
    } else {
        format!("{} (95\u{a0}%: {})", rounded(value, unit, 3), between(low, high, unit))
    }
}

/// What the simulation fails to give.
pub(super) fn channel(name: &str) -> &str {
    match name {
        "effort" => "drive effort",
        other => other,
    }
}

/// "at onset".
pub(super) fn phase(phase: Phase) -> &'static str {
    match phase {
        Phase::Free => "in free motion",
        Phase::Onset => "at onset, as the contact begins",
        Phase::Loading => "while pressing in",
        Phase::Hold => "while holding still in contact",
        Phase::Unloading => "while drawing back",
        Phase::Release => "at release, as the contact ends",
    }
}

/// "at onset, as the contact begins, in trial-1.csv, 2.31 to 2.35 s, x 0-2 mm".
pub(super) fn location(location: &Location) -> Markup {
    html! { (place_words(location)) "in " span.file { (location.trial) "," } " " (stretch(location)) }
}

/// "at onset, as the contact begins, "; nothing of a drive without contact.
pub(super) fn place_words(location: &Location) -> String {
    match location.phase {
        Phase::Free if location.channel == "effort" => String::new(),
        known => format!("{}, ", phase(known)),
    }
}

/// "2.31 to 2.35 s, x 0-2 mm".
pub(super) fn stretch(location: &Location) -> Markup {
    html! {
        (between(location.start_s, location.end_s, "s"))
        @if !location.states.is_empty() { ", " (location.states) }
    }
}

/// The location that holds the most; of one trial where one is named.
pub(super) fn worst<'a>(answer: &'a Diagnosis, trial: Option<&str>) -> Option<&'a Location> {
    let of_trial = answer.locations.iter().filter(|location| trial.is_none_or(|trial| location.trial == trial));
    of_trial.filter(|location| location.share.is_finite()).max_by(|a, b| a.share.total_cmp(&b.share))
}

/// "Most of it, 64 % in the force, lies "; of less than half, "The largest part in one place, ...".
pub(super) fn largest_part(place: &Location) -> String {
    let part = if place.share >= MAJORITY_SHARE { "Most of it" } else { "The largest part of it in one place" };
    format!("{part}, {} in the {}, lies ", share(place.share), channel(place.channel))
}

/// "a, b and c".
pub(super) fn list(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [only] => only.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}
