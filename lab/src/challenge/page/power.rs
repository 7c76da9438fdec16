//! How small an effect may be and still be found: shares against strength.

use maud::{Markup, html};

use super::super::binomial::clopper_pearson;
use super::super::challenge_score::ChallengeScore;
use super::super::single_effect_counts::StrengthBand;

/// px down; shares of the width across.
const TOP: f64 = 14.0;
const BOTTOM: f64 = 214.0;
const LEFT: f64 = 0.1;
const RIGHT: f64 = 0.98;

pub(super) fn section(challenge: &ChallengeScore) -> Markup {
    let bands = &challenge.single.by_strength;
    if bands.is_empty() {
        return html! {};
    }
    html! {
        section {
            h2 { "Detection and naming by strength" }
            p {
                "One effect of the list, by strength (RMS residual of the refitted nominal model over the RMS error of the force sensor). Points: shares; \
                 bars: 95 % confidence intervals."
            }
            p.legend { span.detected { "● detected" } "  " span.right { "● named correctly, and nothing else" } }
            svg.power role="img" aria-label=(label(bands)) height="268" {
                @for tick in [0.0, 0.25, 0.5, 0.75, 1.0] {
                    line.grid x1=(across(LEFT)) x2=(across(RIGHT)) y1=(y(tick)) y2=(y(tick)) {}
                    text.soft x=(across(LEFT - 0.015)) y=(y(tick) + 4.0) text-anchor="end" { (format!("{:.0} %", 100.0 * tick)) }
                }
                @for (at, band) in bands.iter().enumerate() { (column(bands, at, band)) }
            }
        }
    }
}

fn column(bands: &[StrengthBand], at: usize, band: &StrengthBand) -> Markup {
    let pitch = (RIGHT - LEFT) / bands.len() as f64;
    let middle = LEFT + (at as f64 + 0.5) * pitch;
    html! {
        (point("detected", middle - 0.12 * pitch, band.detected, band.n))
        (point("right", middle + 0.12 * pitch, band.named_rightly, band.n))
        text x=(across(middle)) y=(BOTTOM + 22.0) text-anchor="middle" { (name(band)) }
        text.soft x=(across(middle)) y=(BOTTOM + 40.0) text-anchor="middle" { (band.n) @if band.n == 1 { " case" } @else { " cases" } }
    }
}

fn point(class: &str, x: f64, hits: usize, of: usize) -> Markup {
    let [low, high] = clopper_pearson(hits, of);
    let share = hits as f64 / of.max(1) as f64;
    html! {
        g class=(class) {
            title { (hits) " of " (of) }
            line x1=(across(x)) x2=(across(x)) y1=(y(low)) y2=(y(high)) {}
            circle cx=(across(x)) cy=(y(share)) r="5.5" {}
        }
    }
}

fn name(band: &StrengthBand) -> String {
    match (band.from, band.to) {
        (0.0, to) => format!("below {to}"),
        (from, to) if to >= 1000.0 => format!("above {from}"),
        (from, to) => format!("{from} to {to}"),
    }
}

fn label(bands: &[StrengthBand]) -> String {
    let describe = |band: &StrengthBand| {
        format!("{}: {} of {} detected, {} named rightly", name(band), band.detected, band.n, band.named_rightly)
    };
    bands.iter().map(describe).collect::<Vec<_>>().join("; ")
}

fn y(share: f64) -> f64 {
    BOTTOM - share * (BOTTOM - TOP)
}

fn across(share: f64) -> String {
    format!("{:.2}%", 100.0 * share)
}
