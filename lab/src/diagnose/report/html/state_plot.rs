//! The measurement that shows the answer: points of the recording over depth or speed, and what each simulation gives.

use super::super::diagnosis::{Diagnosis, PlotData, StatePlot};
use super::axis::across;
use super::trial::{Line, lines};
use super::wording::{channel, heading};
use crate::page::quantity::{between, prefixed_unit};
use crate::page::thin;
use maud::{Markup, html};
use std::fmt::Write as _;

/// The picture, px down; across it is as wide as the page.
const HEIGHT: f64 = 380.0;
const TOP: f64 = 10.0;
const BOTTOM: f64 = 330.0;
/// Room for the numbers at the left, as a share of the width.
const LEFT: f64 = 0.09;
/// The grid that lines are drawn in; the window stretches it.
const GRID: f64 = 1000.0;
/// Points of the recording, and of a line: more a screen cannot show.
const POINTS: usize = 900;
const LINE_POINTS: usize = 1600;
/// Lines of the grid each way.
const TICKS: f64 = 5.0;

/// One picture a channel, the answer's first; nothing where nothing can be drawn.
pub(super) fn section(answer: &Diagnosis, pictures: &PlotData) -> Markup {
    let lines = lines(answer, pictures);
    let drawable: Vec<&StatePlot> = pictures.evidence.iter().filter(|plot| Frame::of(plot).is_some()).collect();
    html! {
        @if !drawable.is_empty() {
            section #shown aria-label="The measurement that shows it" { @for plot in drawable { (figure(plot, &lines)) } }
        }
    }
}

fn figure(plot: &StatePlot, all: &[Line]) -> Markup {
    let Some(frame) = Frame::of(plot) else { return html! {} };
    let lines: Vec<&Line> = all.iter().filter(|line| !column(plot, line.key).is_empty()).collect();
    let title = format!("{} over {}", heading(&plot.ordinate.replace("effort", channel("effort"))), plot.along);
    let time = between(plot.drawn_s[0], plot.drawn_s[1], "s");
    let names: Vec<&str> = lines.iter().map(|line| line.name.as_str()).collect();
    html! {
        figure.state {
            figcaption { h3 { (title) } p { (plot.trial) ", " (time) ". Points are measured; lines are simulated on held-out rows." } }
            p.keys {
                span { span.key.dot {} "measured" }
                @for line in &lines { span { span.stroke.(line.key) {} (line.name) @if frame.is_beyond(column(plot, line.key)) { " (beyond this picture)" } } }
            }
            svg.state role="img" aria-label={ (title) ": measured, and simulated " (names.join(", ")) "." } height=(HEIGHT) {
                (grid(&frame, plot))
                svg x=(across(LEFT)) y=(TOP) width=(across(1.0 - LEFT)) height=(BOTTOM - TOP) viewBox={ "0 0 " (GRID) " " (GRID) } preserveAspectRatio="none" {
                    @for line in &lines { path.(line.key) d=(curve(plot, column(plot, line.key), &frame)) vector-effect="non-scaling-stroke" {} }
                    path.dot d=(points(plot, &frame)) vector-effect="non-scaling-stroke" {}
                }
            }
        }
    }
}

fn column<'a>(plot: &'a StatePlot, key: &str) -> &'a [f32] {
    match key {
        "given" => &plot.as_given,
        "refitted" => &plot.refitted,
        "improved" => &plot.improved,
        _ => &plot.learned,
    }
}

/// The ends of both axes.
struct Frame {
    x: [f64; 2],
    y: [f64; 2],
}

impl Frame {
    /// All that was measured, with what the best simulation gives; one that is far off is cut. `None` where nothing can be drawn.
    fn of(plot: &StatePlot) -> Option<Self> {
        let best = if plot.learned.is_empty() { &plot.improved } else { &plot.learned };
        let (x, measured, best) = (range(&plot.state)?, range(&plot.measured)?, range(best));
        let [low, high] = measured;
        let reach = 0.5 * (high - low);
        let [best_low, best_high] = best.unwrap_or(measured);
        let y = [low.min(best_low.max(low - reach)), high.max(best_high.min(high + reach))];
        let is_drawable = x[1] > x[0] && y[1] > y[0];
        is_drawable.then(|| Self { x: padded(x), y: padded(y) })
    }

    /// Whether no point of a line lies within the picture.
    fn is_beyond(&self, values: &[f32]) -> bool {
        let [low, high] = self.y;
        !values.iter().any(|value| (low..=high).contains(&f64::from(*value)))
    }

    fn place(&self, x: f32, y: f32) -> Option<(f64, f64)> {
        let along = |value: f32, [low, high]: [f64; 2]| GRID * (f64::from(value) - low) / (high - low);
        // Far outside nothing is seen, and a renderer need not count that far.
        let (x, y) = (along(x, self.x), GRID - along(y, self.y).clamp(-GRID, 2.0 * GRID));
        (x.is_finite() && y.is_finite()).then_some((x, y))
    }
}

fn range(values: &[f32]) -> Option<[f64; 2]> {
    let numbers = values.iter().filter(|value| value.is_finite()).map(|value| f64::from(*value));
    let (low, high) = numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    (low <= high).then_some([low, high])
}

fn padded([low, high]: [f64; 2]) -> [f64; 2] {
    let margin = 0.05 * (high - low);
    [low - margin, high + margin]
}

fn points(plot: &StatePlot, frame: &Frame) -> String {
    let mut text = String::new();
    for row in thin::rows(plot.state.len(), &[], &[&plot.measured], POINTS) {
        if let Some((x, y)) = frame.place(plot.state[row], plot.measured[row]) {
            // Writing to a string cannot fail.
            let _ = write!(text, "M{x:.1} {y:.1}h0");
        }
    }
    text
}

fn curve(plot: &StatePlot, values: &[f32], frame: &Frame) -> String {
    let (mut text, mut pen) = (String::new(), 'M');
    // Every n-th row: extremes alone would turn loops into stars.
    for row in (0..plot.state.len()).step_by(plot.state.len().div_ceil(LINE_POINTS).max(1)) {
        let Some((x, y)) = frame.place(plot.state[row], values[row]) else {
            pen = 'M';
            continue;
        };
        let _ = write!(text, "{pen}{x:.1} {y:.1}");
        pen = 'L';
    }
    text
}

fn grid(frame: &Frame, plot: &StatePlot) -> Markup {
    let largest = |[low, high]: [f64; 2]| low.abs().max(high.abs());
    let (x_factor, x_unit) = prefixed_unit(largest(frame.x), plot.unit);
    let (y_factor, y_unit) = prefixed_unit(largest(frame.y), plot.ordinate_unit);
    let share = |value: f64, [low, high]: [f64; 2]| (value - low) / (high - low);
    html! {
        @for tick in ticks(frame.y, y_factor) {
            @let (tick, label) = tick;
            @let y = format!("{:.1}", BOTTOM - share(tick, frame.y) * (BOTTOM - TOP));
            line.decade.zero[tick == 0.0] x1=(across(LEFT)) x2="100%" y1=(y) y2=(y) {}
            text.soft x=(across(LEFT - 0.012)) y=(y) dy="4" text-anchor="end" { (label) }
        }
        @for tick in ticks(frame.x, x_factor) {
            @let (tick, label) = tick;
            @let along = share(tick, frame.x);
            @let x = across(LEFT + along * (1.0 - LEFT));
            // A number in the middle of the last line would be cut by the edge.
            @let anchor = if along > 0.96 { "end" } else { "middle" };
            line.decade.zero[tick == 0.0] x1=(x) x2=(x) y1=(TOP) y2=(BOTTOM) {}
            text.soft x=(x) y=(BOTTOM + 18.0) text-anchor=(anchor) { (label) }
        }
        text x=(across(LEFT)) dx="6" y=(TOP + 12.0) { (plot.ordinate) ", " (y_unit) }
        text x="100%" y=(BOTTOM + 38.0) text-anchor="end" { (plot.along) ", " (x_unit) }
    }
}

/// Round numbers within both ends, in units of `factor`, each with its label, which has the decimals of their distance.
fn ticks([low, high]: [f64; 2], factor: f64) -> Vec<(f64, String)> {
    let rough = (high - low) / factor / TICKS;
    let decade = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * decade).into_iter().find(|step| *step >= rough).unwrap_or(rough);
    let (first, last) = ((low / factor / step).ceil() as i64, (high / factor / step).floor() as i64);
    let decimals = (-(step * 1.000_001).log10().floor()).clamp(0.0, 9.0) as usize;
    let label = |value: f64| format!("{value:.decimals$}").replace('-', "−");
    (first..=last).map(|nth| (nth as f64 * step * factor, label(nth as f64 * step))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_numbers_of_an_axis_differ() {
        let labels = |ends, factor| ticks(ends, factor).into_iter().map(|(_, label)| label).collect::<Vec<_>>();
        assert_eq!(labels([2.918, 2.961], 1.0), ["2.92", "2.93", "2.94", "2.95", "2.96"]);
        assert_eq!(labels([-3e-3, 5e-3], 1e-3), ["−2", "0", "2", "4"]);
        assert_eq!(labels([0.0, 0.2], 1.0), ["0.00", "0.05", "0.10", "0.15", "0.20"]);
    }
}
