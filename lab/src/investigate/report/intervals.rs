//! How the intervals of the last answer's values shrank.

use crate::page::effect_name::effect_name;
use maud::{Markup, html};

use crate::investigate::record::{Round, ValueState};
use crate::page::quantity::plain;

/// Width of the picture's grid, and height of one round in it.
const WIDTH: f64 = 600.0;
const LINE: f64 = 22.0;

/// Share of the width that is left free on either side.
const INSET: f64 = 0.04;

pub(super) fn section(rounds: &[Round]) -> Markup {
    let states = || rounds.iter().filter_map(|round| round.state.as_ref().map(|state| (round.number, state)));
    let Some((_, last)) = states().next_back() else { return html! {} };
    let history = |value: &ValueState| -> Vec<(u64, ValueState)> {
        let same = |other: &&ValueState| other.effect == value.effect && other.name == value.name;
        states().filter_map(|(number, state)| Some((number, state.values.iter().find(same)?.clone()))).collect()
    };
    let shown: Vec<Vec<(u64, ValueState)>> =
        last.values.iter().map(history).filter(|history| history.len() > 1).collect();
    html! {
        @if !shown.is_empty() {
            section {
                h2 { "95 % intervals after each round" }
                @for history in &shown { (figure(history)) }
            }
        }
    }
}

fn figure(history: &[(u64, ValueState)]) -> Markup {
    let ends =
        history.iter().flat_map(|(_, value)| value.ci95.unwrap_or([value.value; 2]).into_iter().chain([value.value]));
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let span = if high > low { high - low } else { 1.0 };
    let x = |value: f64| WIDTH * (INSET + (1.0 - 2.0 * INSET) * (value - low) / span);
    let Some((_, last)) = history.last() else { return html! {} };
    html! {
        figure {
            figcaption { (last.name.replace('_', " ")) " of " (effect_name(&last.effect)) ": between " (plain(low, &last.unit)) " and " (plain(high, &last.unit)) }
            @for (number, value) in history {
                div.interval-row {
                    span { "round " (number) }
                    svg role="img" aria-label={ "Interval after round " (number) } height=(LINE) viewBox={ "0 0 " (WIDTH) " " (LINE) } preserveAspectRatio="none" {
                        @if let Some([low, high]) = value.ci95 {
                            line.interval x1=(x(low)) x2=(x(high)) y1=(0.5 * LINE) y2=(0.5 * LINE) vector-effect="non-scaling-stroke" {}
                        }
                        rect.estimate x=(x(value.value) - 1.5) y=(0.15 * LINE) width="3" height=(0.7 * LINE) {}
                    }
                }
            }
        }
    }
}
