//! The motion of a round: commanded and recorded position over time, within the limits.

use std::fmt::Write as _;
use std::path::Path;

use maud::{Markup, html};

use crate::experiment_design::Limits;
use crate::page::quantity::{rounded, seconds};
use crate::page::thin;
use crate::recording::Recording;
use crate::rig::Rig;

/// More points than these a picture of this width cannot show.
const POINTS: usize = 1500;

/// The grid that lines are drawn in; the window stretches it.
const GRID: (f64, f64) = (1000.0, 200.0);

/// Height of the picture in pixels.
const HEIGHT: usize = 220;

/// Time and position of a reference file; `None` where it is none.
pub(super) fn commanded(path: &Path) -> Option<(Vec<f64>, Vec<f64>)> {
    let mut reader = csv::Reader::from_path(path).ok()?;
    let rows = reader.deserialize::<(f64, f64)>().collect::<Result<Vec<_>, _>>().ok()?;
    (rows.len() > 1).then(|| rows.into_iter().unzip())
}

/// What is drawn: the ends of time and of position.
struct Frame {
    until: f64,
    low: f64,
    high: f64,
}

impl Frame {
    fn x(&self, time: f64) -> f64 {
        GRID.0 * time / self.until
    }

    fn y(&self, position: f64) -> f64 {
        GRID.1 * (self.high - position) / (self.high - self.low)
    }

    fn path(&self, time: &[f64], position: &[f64]) -> String {
        let narrow: Vec<f32> = position.iter().map(|value| *value as f32).collect();
        let mut text = String::new();
        for row in thin::rows(time.len(), &[], &[&narrow], POINTS) {
            let pen = if text.is_empty() { 'M' } else { 'L' };
            // Writing to a string cannot fail.
            let _ = write!(text, "{pen}{:.1} {:.2}", self.x(time[row] - time[0]), self.y(position[row]));
        }
        text
    }
}

/// The picture.
pub(super) fn figure(
    (time, reference): &(Vec<f64>, Vec<f64>),
    recorded: Option<&Recording>,
    limits: &Limits,
    rig: &Rig,
) -> Markup {
    let unit = rig.coordinate.position_unit();
    let all = || reference.iter().chain(&limits.position).copied();
    let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let frame = Frame { until: time[time.len() - 1] - time[0], low, high };
    let surface = rig.contact.map(|contact| contact.surface).filter(|surface| (low..=high).contains(surface));
    let line = |class: &str, position: f64| {
        let y = frame.y(position);
        html! { line.(class) x1="0" x2=(GRID.0) y1=(y) y2=(y) vector-effect="non-scaling-stroke" {} }
    };
    html! {
        figure {
            p.key-line { span.commanded { "commanded" } ", " span.recorded { "recorded" } " position; dashed: limits of the recorded position (a command may lie beyond them where the contact holds the tool back), dotted: surface of the rig file" }
            svg role="img" aria-label="Commanded and recorded position over time" height=(HEIGHT)
                viewBox={ "0 -2 " (GRID.0) " " (GRID.1 + 4.0) } preserveAspectRatio="none" {
                @for limit in limits.position { (line("limit", limit)) }
                @if let Some(surface) = surface { (line("surface", surface)) }
                path.commanded d=(frame.path(time, reference)) vector-effect="non-scaling-stroke" {}
                @if let Some(recorded) = recorded {
                    path.recorded d=(frame.path(&recorded.time, &recorded.position)) vector-effect="non-scaling-stroke" {}
                }
            }
            figcaption { "From " (rounded(low, unit, 3)) " to " (rounded(high, unit, 3)) ", " (seconds(frame.until)) "." }
        }
    }
}
