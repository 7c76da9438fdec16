//! The answer in one sentence, and what it names.

use super::super::diagnosis::{Diagnosis, PlotData, Verdict};
use super::wording::{channel, location, share, worst};
use super::{effect, finding};
use maud::{Markup, html};

/// The head of the page.
pub(super) fn header(answer: &Diagnosis, pictures: &PlotData) -> Markup {
    let (class, word) = verdict(answer.verdict);
    html! {
        header {
            p.eyebrow { "Palpate diagnose · simulation against recordings" }
            h1 { (pictures.rig) ": what does the simulation leave out?" }
            p.verdict.(class) { (word) }
            p.lead { (answer.summary) }
            p.aside { (meaning(answer)) }
        }
        (finding::grave(answer))
        (effect::section(answer))
    }
}

/// A class of the style and the words for a reader.
fn verdict(verdict: Verdict) -> (&'static str, &'static str) {
    match verdict {
        Verdict::NoMismatch => ("good", "No mismatch"),
        Verdict::Parameters => ("values", "Other values, no other physics"),
        Verdict::Explained => ("named", "Explained"),
        Verdict::PartlyExplained => ("partly", "Partly explained"),
        Verdict::Unknown => ("unknown", "Unknown physics"),
    }
}

/// What the verdict means for whoever has to act on it.
fn meaning(answer: &Diagnosis) -> Markup {
    match answer.verdict {
        Verdict::NoMismatch => html! {
            "The simulation as given differs from these recordings by no more than the sensors' own noise. Nothing is located, and nothing has to be added or changed as far as they can tell."
        },
        Verdict::Parameters => html! {
            "The equations of the simulation are sufficient; its numbers are not. With the " a href="#nominal" { "fitted values" } " it follows the recordings, so no further physics is named."
        },
        Verdict::Explained => {
            html! { "With the physics below added, what is left between simulation and recordings is the sensors' own noise." }
        }
        Verdict::PartlyExplained => html! {
            "The physics below takes away " (share(answer.fit.explained_share)) " of what refitted values leave in the "
            (channel(answer.fit.channel)) ". The rest is more than noise, and no effect of the list explains it."
        },
        Verdict::Unknown => unknown(answer),
    }
}

fn unknown(answer: &Diagnosis) -> Markup {
    html! {
        "The recordings hold something real that the simulation lacks, and none of the " (answer.checked.len())
        " effects that were tried explains it. So it is not named: a wrong name would be worse than none."
        @if let Some(place) = worst(answer, None) {
            " Most of it, " (share(place.share)) " in the " (channel(place.channel)) ", lies " (location(place)) "."
        }
    }
}
