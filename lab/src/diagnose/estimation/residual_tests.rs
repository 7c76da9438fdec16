//! Structure without a name: would any smooth dependence on depth, speed, time or phase take something away?
//!
//! What effects are asked one by one, these coarse shapes are asked together. Where they find what no effect explains,
//! the honest answer is `unknown`.

use super::levenberg_marquardt::FitData;
use super::projection::ProjectedResidual;
use crate::diagnose::linalg::dot;
use crate::diagnose::linalg::solve;
use crate::diagnose::model::{Model, Residual, index};
use crate::diagnose::signals::filtered_trial::FilteredTrial;
use crate::effects::ExcitationStats;

/// What a family of shapes takes away.
#[derive(Debug, Clone)]
pub struct ResidualTest {
    /// "depth".
    pub name: &'static str,
    /// Whitened energy that its shapes take away together.
    pub gain: f64,
}

/// What of a row a shape depends on.
type Pick<'a> = Box<dyn Fn(&FilteredTrial, usize) -> Option<f64> + Sync + 'a>;

struct BasisFamily<'a> {
    name: &'static str,
    effort: bool,
    count: usize,
    pick: Pick<'a>,
    range: (f64, f64),
}

/// What each family takes from `projected`.
#[must_use]
pub fn residual_tests(
    projected: &ProjectedResidual<'_>,
    data: FitData<'_>,
    model: &Model,
    values: &[f64],
    excitation: &ExcitationStats,
) -> Vec<ResidualTest> {
    families(model, values, excitation)
        .iter()
        .map(|family| {
            let shapes = (0..family.count).filter_map(|at| projected.orthogonal(shape(family, at, data)));
            let shapes: Vec<(usize, Vec<f64>)> = shapes.enumerate().collect();
            let gain = solve(&shapes, &projected.free).map_or(0.0, |parts| {
                shapes.iter().zip(parts.iter()).map(|((_, shape), part)| part * dot(shape, &projected.free)).sum()
            });
            ResidualTest { name: family.name, gain }
        })
        .collect()
}

fn families<'a>(model: &Model, values: &[f64], excitation: &ExcitationStats) -> Vec<BasisFamily<'a>> {
    let mut all: Vec<BasisFamily<'a>> = Vec::new();
    let surface = values[index::SURFACE];
    let (depth, speed, filter_width) = (excitation.depth, excitation.speed, 4.0 * excitation.step);
    let bilateral = excitation.is_bilateral;
    let inside = move |filtered: &FilteredTrial, at: usize| bilateral || filtered.position[at] > surface;
    let low = if bilateral { excitation.travel.0 - surface } else { 0.0 };
    let mut add =
        |name, effort, count, range, pick: Pick<'a>| all.push(BasisFamily { name, effort, count, pick, range });
    if model.contact.is_some() {
        let reach = excitation.travel.1 - surface;
        let of =
            move |filtered: &FilteredTrial, at: usize| inside(filtered, at).then(|| filtered.position[at] - surface);
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
        let rate = move |filtered: &FilteredTrial, at: usize| inside(filtered, at).then(|| filtered.velocity[at]);
        add("speed in contact", false, 7, (-2.5 * speed, 2.5 * speed), Box::new(rate));
        let early = move |t: &FilteredTrial, at: usize| inside(t, at).then_some(at as f64 * t.step);
        add("time in contact", false, 12, (0.0, excitation.duration), Box::new(early));
        let free = move |t: &FilteredTrial, at: usize| (!inside(t, at)).then_some(at as f64 * t.step);
        add("time in the free", false, 6, (0.0, excitation.duration), Box::new(free));
        let height = move |t: &FilteredTrial, at: usize| (!inside(t, at)).then(|| surface - t.position[at]);
        add("height above the surface", false, 5, (0.0, 0.5 * depth + filter_width * speed), Box::new(height));
        let shake = 2.5 * excitation.acceleration;
        add("acceleration", false, 5, (-shake, shake), Box::new(|t, at| Some(t.acceleration[at])));
    }
    if model.drive {
        let (from, to) = excitation.travel;
        let fast = 2.5 * excitation.speed;
        let shake = 2.5 * excitation.acceleration;
        add("position of the drive", true, 9, (from, to), Box::new(|t, at| Some(t.position[at])));
        add("speed of the drive", true, 9, (-fast, fast), Box::new(|t, at| Some(t.velocity[at])));
        add("time of the drive", true, 12, (0.0, excitation.duration), Box::new(|t, at| Some(at as f64 * t.step)));
        add("acceleration of the drive", true, 5, (-shake, shake), Box::new(|t, at| Some(t.acceleration[at])));
    }
    all
}

/// Hat number `at` of a family, whitened.
fn shape(family: &BasisFamily<'_>, at: usize, data: FitData<'_>) -> Vec<f64> {
    let (low, high) = family.range;
    let width = (high - low) / (family.count - 1) as f64;
    let centre = low + at as f64 * width;
    let residuals: Vec<Residual> = data
        .trials
        .iter()
        .map(|trial| {
            let filtered = trial.filtered(family.effort);
            let hat = |row: usize| {
                (family.pick)(filtered, row).map_or(0.0, |value| {
                    let value = value.clamp(low, high);
                    (1.0 - (value - centre).abs() / width).max(0.0)
                })
            };
            let values: Vec<f64> = (0..filtered.len()).map(hat).collect();
            if family.effort {
                Residual { force: Vec::new(), effort: values }
            } else {
                Residual { force: values, effort: Vec::new() }
            }
        })
        .collect();
    let mut white = data.whitener.whiten(&residuals);
    if let Some(rows) = data.rows {
        white.iter_mut().zip(rows).filter(|(_, counts)| !**counts).for_each(|(value, _)| *value = 0.0);
    }
    debug_assert!(white.len() >= data.whitener.force_rows());
    white
}

/// How much of what is left is autocorrelated: the sum of the squared correlations over a few rows, in either channel.
#[must_use]
pub fn memory(projected: &ProjectedResidual<'_>, data: FitData<'_>) -> f64 {
    let split = data.whitener.force_rows();
    let (force, effort) = projected.free.split_at(split);
    [force, effort].into_iter().map(box_pierce_statistic).fold(0.0, f64::max)
}

fn box_pierce_statistic(values: &[f64]) -> f64 {
    let energy = dot(values, values);
    if energy <= 0.0 {
        return 0.0;
    }
    let lags = 1..=20.min(values.len().saturating_sub(1));
    lags.map(|lag| (dot(&values[lag..], &values[..values.len() - lag]) / energy).powi(2)).sum::<f64>()
        * values.len() as f64
}
