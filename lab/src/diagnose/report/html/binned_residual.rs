//! Where the mismatch lies along one quantity, as a small picture of columns.

use super::super::diagnosis::BinnedResidual;
use super::axis::across;
use super::wording::{share, times};
use crate::page::quantity::unit;
use maud::{Markup, html};

/// The picture: px down, and shares of the width across, so that words keep their size in every window.
const HEIGHT: f64 = 212.0;
const TOP: f64 = 22.0;
const BOTTOM: f64 = 156.0;
const LEFT: f64 = 0.13;
const RIGHT: f64 = 0.995;
/// Words under the columns fit a picture of this many px.
const MIN_WIDTH_PX: f64 = 262.0;
const LETTER_PX: f64 = 6.4;
/// A share from which on it is written over its column.
const MIN_LABELLED_SHARE: f64 = 0.1;
/// A share of what hardly rises above the noise is a share of nothing.
const MIN_POWER_OVER_NOISE: f64 = 1.5;
/// Powers over the noise beyond this need a logarithmic scale.
const WIDEST_LINEAR: f64 = 20.0;

/// The picture; `improved` where a model with named physics is to be shown beside the one without.
pub(super) fn figure(map: &BinnedResidual, improved: bool) -> Markup {
    let scale = Scale::of(map, improved);
    html! {
        figure.map {
            figcaption { h3 { (title(map)) } p { (most(map)) } }
            svg.columns role="img" aria-label=(label(map, improved)) height=(HEIGHT) {
                @for tick in scale.ticks() { (rule(&scale, tick)) }
                @for bin in 0..map.labels.len() { (column(map, &scale, bin, improved)) }
                (noise(&scale))
                (ticks(map))
            }
        }
    }
}

fn title(map: &BinnedResidual) -> String {
    let along = match map.along {
        "phase" => "By phase of contact",
        "depth" => "By depth",
        "position" => "By position",
        "speed" => "By speed",
        "time" => "By time",
        "frequency" => "By frequency",
        other => other,
    };
    let unit = unit(&map.unit);
    if unit.is_empty() { along.into() } else { format!("{along}, {unit}") }
}

fn most(map: &BinnedResidual) -> String {
    let bins = map.share.iter().zip(&map.labels).zip(&map.before);
    let risen =
        bins.filter(|((share, _), before)| share.is_finite() && **before >= MIN_POWER_OVER_NOISE).map(|(bin, _)| bin);
    match risen.max_by(|a, b| a.0.total_cmp(b.0)) {
        Some((most, label)) if *most >= MIN_LABELLED_SHARE => {
            let unit = unit(&map.unit);
            let known = unit.is_empty() || label.ends_with(&unit);
            let unit = if known { String::new() } else { format!("\u{a0}{unit}") };
            format!("Most at {label}{unit}: {}", share(*most))
        }
        _ => "No bin stands out".into(),
    }
}

fn label(map: &BinnedResidual, improved: bool) -> String {
    let bins = (0..map.labels.len()).map(|bin| bin_label(map, bin, improved));
    format!("{}, residual power over the noise. {}.", title(map), bins.collect::<Vec<_>>().join("; "))
}

fn bin_label(map: &BinnedResidual, bin: usize, improved: bool) -> String {
    let after = if improved { format!(", {} after", times(map.after[bin])) } else { String::new() };
    format!(
        "{}: {} times noise before{after}, {} of what is missing",
        map.labels[bin],
        times(map.before[bin]),
        share(map.share[bin])
    )
}

/// From residual power over the noise to px.
struct Scale {
    low: f64,
    high: f64,
    logarithmic: bool,
}

impl Scale {
    fn of(map: &BinnedResidual, improved: bool) -> Self {
        let after = map.after.iter().filter(|_| improved);
        let most = map.before.iter().chain(after).filter(|value| value.is_finite()).fold(2.0_f64, |a, b| a.max(*b));
        let logarithmic = most > WIDEST_LINEAR;
        if logarithmic {
            Self { low: 0.3, high: 1.3 * most, logarithmic }
        } else {
            Self { low: 0.0, high: 1.1 * most, logarithmic }
        }
    }

    fn y(&self, value: f64) -> Option<f64> {
        let share = match self.logarithmic {
            true => (value.max(self.low) / self.low).ln() / (self.high / self.low).ln(),
            false => value.max(0.0) / self.high,
        };
        value.is_finite().then(|| BOTTOM - share.clamp(0.0, 1.0) * (BOTTOM - TOP))
    }

    /// Besides the noise itself.
    fn ticks(&self) -> Vec<f64> {
        if self.logarithmic {
            let last = self.high.log10().floor() as i32;
            let step = (last / 4 + 1) as usize;
            return (0..=last).step_by(step).skip(1).map(|power| 10f64.powi(power)).collect();
        }
        let rough = self.high / 3.0;
        let decade = 10f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].iter().map(|m| m * decade).find(|step| *step >= rough).unwrap_or(rough).max(1.0);
        (1..=3).map(|n| f64::from(n) * step).filter(|tick| *tick < self.high && *tick > 1.0).collect()
    }
}

fn rule(scale: &Scale, tick: f64) -> Markup {
    let y = scale.y(tick).unwrap_or(TOP);
    html! {
        line.decade x1=(across(LEFT)) x2=(across(RIGHT)) y1=(px(y)) y2=(px(y)) {}
        text.soft x=(across(LEFT - 0.015)) y=(px(y + 4.0)) text-anchor="end" { (times(tick)) "×" }
    }
}

fn noise(scale: &Scale) -> Markup {
    let y = scale.y(1.0).unwrap_or(BOTTOM);
    html! {
        line.noise x1=(across(LEFT)) x2=(across(RIGHT)) y1=(px(y)) y2=(px(y)) {}
        text.strong x=(across(LEFT - 0.015)) y=(px(y + 4.0)) text-anchor="end" { "noise" }
    }
}

fn column(map: &BinnedResidual, scale: &Scale, bin: usize, improved: bool) -> Markup {
    let pitch = (RIGHT - LEFT) / map.labels.len() as f64;
    let (start, inner) = (LEFT + (bin as f64 + 0.1) * pitch, 0.8 * pitch);
    let each = if improved { 0.5 * inner } else { inner };
    let top = scale.y(map.before[bin]).unwrap_or(BOTTOM);
    html! {
        g {
            title { (bin_label(map, bin, improved)) }
            (pillar("refitted", start, each, scale.y(map.before[bin])))
            @if improved { (pillar("improved", start + each, each, scale.y(map.after[bin]))) }
            @if is_labelled(map, bin) {
                text.share x=(across(start + 0.5 * inner)) y=(px(top.min(BOTTOM - 8.0) - 5.0)) text-anchor="middle" { (share(map.share[bin])) }
            }
        }
    }
}

/// Whether the share of a bin is written: if it is big, and if beside it there is room or nothing bigger.
fn is_labelled(map: &BinnedResidual, bin: usize) -> bool {
    let neighbours = [bin.checked_sub(1), Some(bin + 1)].into_iter().flatten();
    let bigger = neighbours.filter_map(|other| map.share.get(other).map(|share| (other, *share)));
    // Of two that are equal the first is written.
    let is_peak =
        bigger.into_iter().all(|(other, share)| map.share[bin] > share || (map.share[bin] == share && bin < other));
    let roomy = MIN_WIDTH_PX / map.labels.len() as f64 > 5.0 * LETTER_PX;
    map.share[bin] >= MIN_LABELLED_SHARE && map.before[bin] >= MIN_POWER_OVER_NOISE && (roomy || is_peak)
}

fn pillar(class: &str, start: f64, width: f64, top: Option<f64>) -> Markup {
    html! {
        @if let Some(top) = top {
            rect.(class) x=(across(start)) y=(px(top)) width=(across(width)) height=(px(BOTTOM - top)) {}
        } @else {
            text.soft x=(across(start + 0.5 * width)) y=(px(BOTTOM - 4.0)) text-anchor="middle" { "?" }
        }
    }
}

/// Labels of the bins. Where they do not fit side by side they take two rows, and where these do not do either, only
/// every n-th is written.
fn ticks(map: &BinnedResidual) -> Markup {
    let bins = map.labels.len();
    let longest = map.labels.iter().map(|label| label.chars().count()).max().unwrap_or(0) as f64;
    let crowd = (longest + 1.5) * LETTER_PX * bins as f64 / MIN_WIDTH_PX;
    let every = (0.5 * crowd).ceil().max(1.0) as usize;
    let pitch = (RIGHT - LEFT) / bins.max(1) as f64;
    html! {
        @for (n, bin) in (0..bins).step_by(every).enumerate() {
            @let y = if crowd > 1.0 && n % 2 == 1 { BOTTOM + 36.0 } else { BOTTOM + 18.0 };
            text x=(across(LEFT + (bin as f64 + 0.5) * pitch)) y=(px(y)) text-anchor="middle" { (map.labels[bin]) }
        }
    }
}

fn px(value: f64) -> String {
    format!("{value:.1}")
}
