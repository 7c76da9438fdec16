//! Structure without a name: would any smooth dependence on depth, speed, time or phase take something away?
//!
//! What effects are asked one by one, these coarse shapes are asked together. Where they find what no effect explains,
//! the honest answer is `unknown`.

use super::levenberg_marquardt::Data;
use super::projection::Remainder;
use crate::diagnose::linalg::dot;
use crate::diagnose::linalg::solve;
use crate::diagnose::model::{Model, Rest, index};
use crate::diagnose::signals::filtered_trial::Track;
use crate::effects::Scene;

/// What a family of shapes takes away.
#[derive(Debug, Clone)]
pub struct Texture {
    /// "depth".
    pub name: &'static str,
    /// Whitened energy that its shapes take away together.
    pub gain: f64,
}

/// What of a row a shape depends on.
type Pick<'a> = Box<dyn Fn(&Track, usize) -> Option<f64> + Sync + 'a>;

struct Family<'a> {
    name: &'static str,
    effort: bool,
    count: usize,
    pick: Pick<'a>,
    range: (f64, f64),
}

/// What each family takes from `remainder`.
#[must_use]
pub fn textures(
    remainder: &Remainder<'_>,
    data: Data<'_>,
    model: &Model,
    values: &[f64],
    scene: &Scene,
) -> Vec<Texture> {
    families(model, values, scene)
        .iter()
        .map(|family| {
            let shapes = (0..family.count).filter_map(|at| remainder.own(shape(family, at, data)));
            let shapes: Vec<(usize, Vec<f64>)> = shapes.enumerate().collect();
            let gain = solve(&shapes, &remainder.free).map_or(0.0, |parts| {
                shapes.iter().zip(parts.iter()).map(|((_, shape), part)| part * dot(shape, &remainder.free)).sum()
            });
            Texture { name: family.name, gain }
        })
        .collect()
}

fn families<'a>(model: &Model, values: &[f64], scene: &Scene) -> Vec<Family<'a>> {
    let mut all: Vec<Family<'a>> = Vec::new();
    let surface = values[index::SURFACE];
    let (depth, speed, blur) = (scene.depth, scene.speed, 4.0 * scene.step);
    let bilateral = scene.is_bilateral;
    let inside = move |track: &Track, at: usize| bilateral || track.position[at] > surface;
    let low = if bilateral { scene.travel.0 - surface } else { 0.0 };
    let mut add = |name, effort, count, range, pick: Pick<'a>| all.push(Family { name, effort, count, pick, range });
    if model.contact.is_some() {
        let reach = scene.travel.1 - surface;
        let of = move |track: &Track, at: usize| inside(track, at).then(|| track.position[at] - surface);
        add(
            "depth going in",
            false,
            7,
            (low, reach),
            Box::new(move |t, at| of(t, at).filter(|_| t.velocity[at] > 0.0)),
        );
        add(
            "depth coming out",
            false,
            7,
            (low, reach),
            Box::new(move |t, at| of(t, at).filter(|_| t.velocity[at] <= 0.0)),
        );
        let rate = move |track: &Track, at: usize| inside(track, at).then(|| track.velocity[at]);
        add("speed in contact", false, 7, (-2.5 * speed, 2.5 * speed), Box::new(rate));
        let early = move |t: &Track, at: usize| inside(t, at).then_some(at as f64 * t.step);
        add("time in contact", false, 12, (0.0, scene.duration), Box::new(early));
        let free = move |t: &Track, at: usize| (!inside(t, at)).then_some(at as f64 * t.step);
        add("time in the free", false, 6, (0.0, scene.duration), Box::new(free));
        let height = move |t: &Track, at: usize| (!inside(t, at)).then(|| surface - t.position[at]);
        add("height above the surface", false, 5, (0.0, 0.5 * depth + blur * speed), Box::new(height));
        let shake = 2.5 * scene.acceleration;
        add("acceleration", false, 5, (-shake, shake), Box::new(|t, at| Some(t.acceleration[at])));
    }
    if model.drive {
        let (from, to) = scene.travel;
        let fast = 2.5 * scene.speed;
        let shake = 2.5 * scene.acceleration;
        add("position of the drive", true, 9, (from, to), Box::new(|t, at| Some(t.position[at])));
        add("speed of the drive", true, 9, (-fast, fast), Box::new(|t, at| Some(t.velocity[at])));
        add("time of the drive", true, 12, (0.0, scene.duration), Box::new(|t, at| Some(at as f64 * t.step)));
        add("acceleration of the drive", true, 5, (-shake, shake), Box::new(|t, at| Some(t.acceleration[at])));
    }
    all
}

/// Hat number `at` of a family, whitened.
fn shape(family: &Family<'_>, at: usize, data: Data<'_>) -> Vec<f64> {
    let (low, high) = family.range;
    let width = (high - low) / (family.count - 1) as f64;
    let centre = low + at as f64 * width;
    let rests: Vec<Rest> = data
        .trials
        .iter()
        .map(|trial| {
            let track = trial.track(family.effort);
            let hat = |row: usize| {
                (family.pick)(track, row).map_or(0.0, |value| {
                    let value = value.clamp(low, high);
                    (1.0 - (value - centre).abs() / width).max(0.0)
                })
            };
            let values: Vec<f64> = (0..track.len()).map(hat).collect();
            if family.effort {
                Rest { force: Vec::new(), effort: values }
            } else {
                Rest { force: values, effort: Vec::new() }
            }
        })
        .collect();
    let mut white = data.whitener.white(&rests);
    if let Some(rows) = data.rows {
        white.iter_mut().zip(rows).filter(|(_, counts)| !**counts).for_each(|(value, _)| *value = 0.0);
    }
    debug_assert!(white.len() >= data.whitener.force_rows());
    white
}

/// How much of what is left remembers itself: the sum of the squared correlations over a few rows, in either channel.
#[must_use]
pub fn memory(remainder: &Remainder<'_>, data: Data<'_>) -> f64 {
    let split = data.whitener.force_rows();
    let (force, effort) = remainder.free.split_at(split);
    [force, effort].into_iter().map(portmanteau).fold(0.0, f64::max)
}

fn portmanteau(values: &[f64]) -> f64 {
    let energy = dot(values, values);
    if energy <= 0.0 {
        return 0.0;
    }
    let lags = 1..=20.min(values.len().saturating_sub(1));
    lags.map(|lag| (dot(&values[lag..], &values[..values.len() - lag]) / energy).powi(2)).sum::<f64>()
        * values.len() as f64
}
