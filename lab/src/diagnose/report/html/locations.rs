//! Where simulation and recordings differ.

use super::super::diagnosis::{BinnedResidual, Diagnosis, Location, PlotData};
use super::wording::{channel, heading, list, location, share};
use super::{binned_residual, names_physics};
use maud::{Markup, html};

/// More places than these are folded away.
const MAX_LOCATIONS: usize = 6;
/// In the order in which a reader asks.
const CHANNELS: [&str; 2] = ["force", "effort"];

/// Pictures and words; a sentence where there is nothing to locate.
pub(super) fn section(answer: &Diagnosis, pictures: &PlotData) -> Markup {
    let improved = names_physics(answer);
    html! {
        section #where aria-labelledby="where-title" {
            h2 #where-title { "Where it is off" }
            (locations(answer))
            @if pictures.maps.iter().any(|map| !map.labels.is_empty()) && !answer.locations.is_empty() {
                details.along {
                    summary { "By " (list(&quantities(pictures))) }
                    (explanation(improved))
                    @for name in CHANNELS { (maps(pictures, name, improved)) }
                }
            }
        }
    }
}

/// What the pictures go along, each once.
fn quantities(pictures: &PlotData) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for map in pictures.maps.iter().filter(|map| !map.labels.is_empty()) {
        if !names.iter().any(|name| name == map.along) {
            names.push(map.along.to_owned());
        }
    }
    names
}

fn maps(pictures: &PlotData, name: &str, improved: bool) -> Markup {
    let maps: Vec<&BinnedResidual> =
        pictures.maps.iter().filter(|map| map.channel == name && !map.labels.is_empty()).collect();
    html! {
        @if !maps.is_empty() {
            h3.channel { (heading(channel(name))) }
            div.maps { @for map in maps { (binned_residual::figure(map, improved)) } }
        }
    }
}

fn locations(answer: &Diagnosis) -> Markup {
    if answer.locations.is_empty() {
        return html! { p { "No stretch of the recordings stands out from the noise: there is no place at which the simulation is off." } };
    }
    let (first, rest) = answer.locations.split_at(answer.locations.len().min(MAX_LOCATIONS));
    html! {
        ol.places { @for place in first { (sentence(place)) } }
        @if !rest.is_empty() {
            details { summary { (rest.len()) " more places" } ol.places start=(MAX_LOCATIONS + 1) { @for place in rest { (sentence(place)) } } }
        }
    }
}

fn sentence(place: &Location) -> Markup {
    html! {
        li { strong { (share(place.share)) } " of what the simulation misses in the " (channel(place.channel)) " lies " (location(place)) "." }
    }
}

fn explanation(improved: bool) -> Markup {
    html! {
        p.fine {
            "Columns: how strong the error is, as a multiple of the power of the sensors' noise; one that ends at the dashed line is nothing but noise. The percentage over a column is its share of all that is missing. "
            span.keys {
                span { span.key.refitted {} (if improved { "before: values refitted" } else { "values refitted" }) }
                @if improved { span { span.key.improved {} "after: with the named physics" } }
            }
        }
    }
}
