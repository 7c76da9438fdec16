//! The sign of the effort: where nothing else pushes, effort and motion go together.

use super::checked_trial::{CheckedTrial, range};
use super::ranked_finding::RankedFinding;
use super::wording::digits;
use crate::diagnose::thresholds::check_drive::{AVERAGED_ROWS, MIN_CORRELATION, MIN_ROWS};
use crate::rig::{Coordinate, Rig};

/// Effort that works against the acceleration it should cause.
pub fn wrong_sign(rig: &Rig, view: &CheckedTrial<'_>) -> Option<RankedFinding> {
    rig.drive?;
    let effort = view.effort.as_ref()?;
    let rows = free(rig, view);
    if rows.len() < MIN_ROWS {
        return None;
    }
    let pick = |values: &[f64]| -> Vec<f64> { rows.iter().map(|row| values[*row]).collect() };
    let (effort, speed, bend) = (pick(effort), pick(&view.speed), pick(&view.bend));
    let depth = pick(&view.depth);
    // Loads that hang on position, and friction, are no fault of sign: they are taken off first.
    let swift = range(&speed);
    let mut known = vec![
        vec![1.0; rows.len()],
        depth.clone(),
        speed.clone(),
        speed.iter().map(|v| (20.0 * v / swift).tanh()).collect(),
    ];
    if rig.coordinate == Coordinate::Rotary {
        let angle = |turn: fn(f64) -> f64| depth.iter().map(|depth| turn(depth + rig.surface())).collect::<Vec<_>>();
        known.extend([angle(f64::sin), angle(f64::cos)]);
    }
    // Noise of effort or acceleration hides the sign; means over longer stretches lay it bare.
    let link = AVERAGED_ROWS
        .into_iter()
        .filter(|size| rows.len() / size >= MIN_ROWS)
        .map(|size| {
            let known: Vec<Vec<f64>> = known.iter().map(|column| means(column, size)).collect();
            remaining(&known, &means(&effort, size), &means(&bend, size))
        })
        .fold(0.0f64, |most, link| if link.abs() > most.abs() { link } else { most });
    let text = format!(
        "Where nothing touches, the tool speeds up against the effort (correlation {}): effort or position has the wrong sign. The effort is positive \
         when it drives the tool towards higher positions; multiply the effort column by -1 if it is not.",
        digits(link),
    );
    (link < -MIN_CORRELATION)
        .then(|| RankedFinding::grave("effort_sign", format!("{}, effort", view.name()), -link, text))
}

/// Rows in which nothing pushes on the tool but the drive.
fn free(rig: &Rig, view: &CheckedTrial<'_>) -> Vec<usize> {
    let touching = view.touching(rig);
    let zero = view.zero(rig).unwrap_or(0.0);
    let idle = |row: usize| view.force.as_ref().is_none_or(|force| (force[row] - zero).abs() < 5.0 * view.noise[2]);
    (0..view.depth.len()).filter(|&row| !touching[row] && idle(row)).collect()
}

/// Means of `size` rows each.
fn means(column: &[f64], size: usize) -> Vec<f64> {
    column.chunks_exact(size).map(|piece| piece.iter().sum::<f64>() / size as f64).collect()
}

/// Correlation of `a` and `b` once `known` is taken off both.
fn remaining(known: &[Vec<f64>], a: &[f64], b: &[f64]) -> f64 {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for column in known {
        let size = norm(column);
        let left = without(&basis, column);
        // Columns that say nothing new would only add rounding.
        if norm(&left) > 1e-6 * size {
            let size = norm(&left);
            basis.push(left.into_iter().map(|value| value / size).collect());
        }
    }
    let (a, b) = (without(&basis, a), without(&basis, b));
    let (size_a, size_b) = (norm(&a), norm(&b));
    if size_a > 0.0 && size_b > 0.0 { dot(&a, &b) / (size_a * size_b) } else { 0.0 }
}

fn without(basis: &[Vec<f64>], column: &[f64]) -> Vec<f64> {
    let mut left = column.to_vec();
    for unit in basis {
        let part = dot(unit, &left);
        left.iter_mut().zip(unit).for_each(|(value, unit)| *value -= part * unit);
    }
    left
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
