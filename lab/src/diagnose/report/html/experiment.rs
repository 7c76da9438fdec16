//! The motion to run next.

use super::super::diagnosis::{Experiment, PlotData};
use crate::page::quantity::{rounded, seconds};
use crate::page::thin;
use maud::{Markup, html};
use std::fmt::Write as _;

/// More points than these a small picture cannot show.
const POINTS: usize = 1500;
/// The grid that the line is drawn in; the window stretches it.
const GRID: (f64, f64) = (1000.0, 100.0);
const HEIGHT: usize = 180;

/// The reference with its text.
pub(super) fn figure(next: &Experiment, pictures: &PlotData) -> Markup {
    let finite = |values: &[f64]| {
        let numbers = values.iter().filter(|value| value.is_finite());
        numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
    };
    let (from, until) = finite(&next.time);
    let (low, high) = finite(&next.reference);
    let drawable = until > from && high >= low;
    html! {
        figure.reference {
            figcaption { h3 { "The experiment that would decide" } p { (next.text) } }
            @if drawable {
                @let words = [low, high].map(|end| rounded(end, pictures.position_unit, 3));
                @let lasts = seconds(until - from);
                svg.line role="img" aria-label={ "Commanded position over " (lasts) ", from " (words[0]) " to " (words[1]) ". " (next.text) } height=(HEIGHT) {
                    text.soft x="0" y="14" { (words[1]) ", commanded position" }
                    text.soft x="0" y=(HEIGHT - 20) { (words[0]) }
                    text.soft x="100%" y=(HEIGHT - 20) text-anchor="end" { "time, " (lasts) }
                    line.base x1="0" x2="100%" y1=(HEIGHT - 36) y2=(HEIGHT - 36) {}
                    svg x="0" y="22" width="100%" height=(HEIGHT - 60) viewBox={ "0 -1 " (GRID.0) " " (GRID.1 + 2.0) } preserveAspectRatio="none" {
                        path d=(path(next, (from, until), (low, high))) vector-effect="non-scaling-stroke" {}
                    }
                }
            }
        }
    }
}

fn path(next: &Experiment, (from, until): (f64, f64), (low, high): (f64, f64)) -> String {
    let narrow: Vec<f32> = next.reference.iter().map(|value| *value as f32).collect();
    let rows = thin::rows(next.time.len(), &[], &[&narrow], POINTS);
    let height = if high > low { high - low } else { 1.0 };
    let mut text = String::new();
    let mut pen = 'M';
    for row in rows {
        let x = GRID.0 * (next.time[row] - from) / (until - from);
        let y = GRID.1 * (1.0 - (next.reference[row] - low) / height);
        if x.is_finite() && y.is_finite() {
            // Writing to a string cannot fail.
            let _ = write!(text, "{pen}{x:.1} {y:.2}");
            pen = 'L';
        } else {
            pen = 'M';
        }
    }
    text
}
