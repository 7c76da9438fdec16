//! The values of the fleet: a line for each, a dot for each rig.

use maud::{Markup, html};

use super::changes::with_interval;
use super::some_of;
use super::standing_out::number;
use crate::fleet::outliers::{MAX_Z, Point, Quantity, label};

/// Fewest rigs whose dots tell more than the table of rigs.
const MIN_DOTS: usize = 3;
/// Width and height of the picture's grid, and the radius of a dot.
const SIZE: [f64; 2] = [400.0, 36.0];
const RADIUS: f64 = 3.5;
/// Rows that dots are spread over, so that fewer hide each other.
const ROWS: usize = 5;
/// Names of rigs that are shown of a value.
const MAX_NAMES: usize = 4;

pub(super) fn section(quantities: &[Quantity]) -> Markup {
    let shown: Vec<&Quantity> = quantities.iter().filter(|quantity| quantity.points.len() >= MIN_DOTS).collect();
    html! {
        @if !shown.is_empty() {
            section {
                h2 { "Values over the fleet" }
                p { "Each dot is a rig, the line is the median; a rig whose value stands out is coloured. Values of the rig file are shown as shares of what it states." }
                div.wide tabindex="0" role="region" aria-label="Values over the fleet" { table.quantities {
                    thead { tr { th { "value" } th { "rigs" } th { "median" } th.dots { "lowest to highest" } th.text { "stands out" } } }
                    tbody { @for quantity in shown { (row(quantity)) } }
                } }
            }
        }
    }
}

fn row(quantity: &Quantity) -> Markup {
    let values = || quantity.points.iter().map(|point| point.value[0]);
    let (low, high) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let far: Vec<&str> = quantity.points.iter().filter(|point| is_far(point)).map(|point| point.rig.as_str()).collect();
    let shown = |value: f64| number(value, &quantity.unit, quantity.is_relative);
    html! {
        tr {
            th scope="row" { (label(&quantity.effect, &quantity.parameter)) }
            td { (quantity.points.len()) }
            td { (shown(quantity.median)) }
            td.dots {
                (dots(quantity, low, high))
                span.ends { span { (shown(low)) } span { (shown(high)) } }
            }
            td.text { @if far.is_empty() { "–" } @else { (some_of(&far, MAX_NAMES)) } }
        }
    }
}

fn dots(quantity: &Quantity, low: f64, high: f64) -> Markup {
    let span = if high > low { high - low } else { 1.0 };
    let x = |value: f64| RADIUS + (SIZE[0] - 2.0 * RADIUS) * (value - low) / span;
    let y = |row: usize| RADIUS + (SIZE[1] - 2.0 * RADIUS) * (row % ROWS) as f64 / (ROWS - 1) as f64;
    let named = |point: &Point| format!("{}: {}", point.rig, with_interval(point.value, &quantity.unit));
    let draw = |far: bool| {
        html! {
            @for (at, point) in quantity.points.iter().enumerate().filter(|(_, point)| is_far(point) == far) {
                circle.far[far] cx=(format!("{:.1}", x(point.value[0]))) cy=(format!("{:.1}", y(at))) r=(RADIUS) { title { (named(point)) } }
            }
        }
    };
    let centre = format!("{:.1}", x(quantity.median));
    html! {
        svg role="img" aria-label={ "The rigs by " (label(&quantity.effect, &quantity.parameter)) } viewBox={ "0 0 " (SIZE[0]) " " (SIZE[1]) } {
            line.median x1=(centre) x2=(centre) y1="0" y2=(SIZE[1]) {}
            // Those that stand out last: nothing hides them.
            (draw(false)) (draw(true))
        }
    }
}

fn is_far(point: &Point) -> bool {
    point.z.abs() > MAX_Z
}
