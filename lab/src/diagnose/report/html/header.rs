//! The answer in one heading and one sentence, the picture that shows it, and what it names.

use super::super::diagnosis::{Diagnosis, PlotData, Verdict};
use super::super::summary::{holds_effort, holds_parasitic_force, is_noise, unexplained};
use super::wording::{channel, largest_part, list, location, multiple, share, title, worst};
use super::{effect, finding, state_plot};
use crate::page::quantity::rounded;
use maud::{Markup, html};

/// The head of the page.
pub(super) fn header(answer: &Diagnosis, pictures: &PlotData) -> Markup {
    let (class, word) = verdict(answer);
    html! {
        header {
            p.eyebrow { "Palpate diagnose · " (pictures.rig) ": what does the simulation leave out?" }
            h1.verdict.(class) { (word) }
            p.lead { (answer.summary) }
            p.aside { (meaning(answer)) }
        }
        (finding::grave(answer))
        (state_plot::section(answer, pictures))
        (effect::section(answer))
    }
}

/// A class of the style and the words for a reader.
fn verdict(answer: &Diagnosis) -> (&'static str, String) {
    let named: Vec<String> =
        answer.physics.iter().filter(|physics| physics.name != "unknown").map(|physics| title(&physics.name)).collect();
    match answer.verdict {
        Verdict::NoMismatch => ("good", "No mismatch".into()),
        Verdict::Parameters => ("values", "Other values, no other physics".into()),
        Verdict::Explained => ("named", format!("Explained by {}", list(&named))),
        Verdict::PartlyExplained => ("partly", format!("Partly explained by {}", list(&named))),
        Verdict::Unknown => ("unknown", "Unknown physics".into()),
    }
}

/// What the verdict means for whoever has to act on it.
fn meaning(answer: &Diagnosis) -> Markup {
    let fit = &answer.fit;
    match answer.verdict {
        Verdict::NoMismatch => html! {
            "The simulation as given differs from these recordings by no more than the sensors' own noise. Nothing is located, and nothing has to be added or changed as far as they can tell."
        },
        Verdict::Parameters => html! {
            "The equations of the simulation are sufficient; its numbers are not. With the " a href="#nominal" { "fitted values" } " it follows the recordings, so no further physics is named."
        },
        Verdict::Explained if is_noise(fit) => html! {
            "With the physics below added, what is left between simulation and recordings is the sensors' own noise."
        },
        Verdict::Explained => html! {
            "The physics below takes away " (share(fit.explained_share)) " of the mean square that refitted values leave in the " (channel(fit.channel))
            " above the noise. What stays, " (rounded(fit.improved, fit.unit, 3)) ", is " (multiple(fit.improved / fit.noise_floor)) ": the real laws are not quite those that are named."
        },
        Verdict::PartlyExplained if holds_parasitic_force(answer) && unexplained(answer).channel == fit.channel => {
            html! {
                "A " a href="#physics" { "force that acts in free motion, too" } ", is no effect of the list. Of the mean square that refitted values leave in the "
                (channel(fit.channel)) " above the noise, the physics below takes away " (share(fit.explained_share)) " with it."
            }
        }
        Verdict::PartlyExplained => html! {
            "The physics below takes away " (share(fit.explained_share)) " of the mean square that refitted values leave in the " (channel(fit.channel))
            " above the noise. "
            @if unexplained(answer).channel != fit.channel {
                "What is left in the " (channel(unexplained(answer).channel)) " is more than noise, and "
            } @else { "The rest is more than noise, and " }
            @if holds_effort(answer) { "some of it " a href="#physics" { "couples into the force reading" } "." } @else { "no effect of the list explains it." }
        },
        Verdict::Unknown => unknown(answer),
    }
}

fn unknown(answer: &Diagnosis) -> Markup {
    html! {
        @if holds_effort(answer) {
            "Effects of the contact that were fitted to the effort in the reading leave more than the effort itself: they are not named. See "
            a href="#physics" { "what couples in" } " below; the drive was judged by the force without it."
        } @else if holds_parasitic_force(answer) {
            "The force sensor shows a force where nothing is touched, which no contact has. It was taken off, and the contact was judged by what is left; see "
            a href="#physics" { "what it goes with" } " below. No effect of the list is that, so it is not named; the improved rig file holds it as a curve."
        } @else {
            "The recordings hold something real that the simulation lacks, and none of the " (answer.checked.len())
            " effects that were tried explains it. So it is not named: a wrong name would be worse than none."
        }
        @if let Some(place) = worst(answer, None).filter(|_| !holds_parasitic_force(answer)) {
            " " (largest_part(place)) (location(place)) "."
        }
    }
}
