//! Excitation: the depth trajectory of a trial, and the reference that makes the closed loop follow it.

use std::f64::consts::TAU;

use rand::RngExt;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use crate::closed_loop::SAMPLE_PERIOD_S;
use crate::nominal::{NominalParameters, PdGains};
use crate::rng::CaseRng;

/// How much of the dynamics a trajectory excites.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Excitation {
    /// Free motion, taps, holds and frequencies at several depths, slow reversals.
    Rich,
    /// A few taps and one sine at one depth.
    Poor,
}

/// A path of depths, m, being written.
struct DepthPath {
    depths: Vec<f64>,
    deepest: f64,
    free: f64,
    /// Amplitude that a frequency of 1 rad/s could have, m: heavy tools are not shaken far.
    amplitude_at_1_rad_s: f64,
}

impl DepthPath {
    fn last(&self) -> f64 {
        self.depths.last().copied().unwrap_or(self.free)
    }

    /// To `depth` within `seconds`, smooth to the second derivative.
    fn move_to(&mut self, depth: f64, seconds: f64) {
        let (from, rows) = (self.last(), rows(seconds));
        self.depths.extend((1..=rows).map(|row| {
            let u = row as f64 / rows as f64;
            from + (depth - from) * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
        }));
    }

    fn hold(&mut self, seconds: f64) {
        let depth = self.last();
        self.depths.extend(std::iter::repeat_n(depth, rows(seconds)));
    }

    /// About the present depth, faded in and out.
    fn sine(&mut self, hz: f64, amplitude: f64, seconds: f64) {
        let (middle, rows) = (self.last(), rows(seconds));
        let amplitude = amplitude.min(self.amplitude_at_1_rad_s / (TAU * hz).powi(2));
        let fade = (0.4 / hz).clamp(0.1, 0.3 * seconds);
        self.depths.extend((1..=rows).map(|row| {
            let t = row as f64 * SAMPLE_PERIOD_S;
            let edge = (t.min(seconds - t).max(0.0) / fade).min(1.0);
            let window = edge * edge * edge * (10.0 - 15.0 * edge + 6.0 * edge * edge);
            middle + amplitude * window * (TAU * hz * t).sin()
        }));
    }

    /// To and fro with even speed and rounded turns, `cycles` times.
    fn triangle(&mut self, amplitude: f64, period: f64, cycles: f64) {
        let middle = self.last();
        let full = 0.98f64.asin();
        self.depths.extend((1..=rows(period * cycles)).map(|row| {
            let t = row as f64 * SAMPLE_PERIOD_S;
            middle + amplitude * (0.98 * (TAU * t / period).sin()).asin() / full
        }));
    }

    fn tap(&mut self, rng: &mut CaseRng) {
        let depth = self.deepest * rng.random_range(0.4..0.9);
        self.move_to(depth, rng.random_range(0.1..0.25));
        self.hold(rng.random_range(0.02..0.1));
        let free = self.free;
        self.move_to(free, rng.random_range(0.1..0.25));
        self.hold(rng.random_range(0.15..0.3));
    }
}

fn rows(seconds: f64) -> usize {
    (seconds / SAMPLE_PERIOD_S).round().max(1.0) as usize
}

/// A segment of a rich trajectory.
#[derive(Debug, Clone, Copy)]
enum Segment {
    Free,
    Taps,
    Deep,
    Shallow,
    Slow,
}

/// Depths, m, one a period, of a trial of about 25 s.
#[must_use]
pub fn depth_path(excitation: Excitation, nominal: &NominalParameters, deepest: f64, rng: &mut CaseRng) -> Vec<f64> {
    let retreat = deepest.max(0.003) * rng.random_range(0.6..1.2);
    let free = if nominal.bilateral { -0.6 * deepest } else { -retreat };
    let amplitude_at_1_rad_s = 0.5 * nominal.stiffness * deepest / nominal.mass;
    let mut path = DepthPath { depths: vec![free], deepest, free, amplitude_at_1_rad_s };
    path.hold(0.4);
    match excitation {
        Excitation::Rich => rich(&mut path, rng),
        Excitation::Poor => poor(&mut path, rng),
    }
    path.depths
}

fn rich(path: &mut DepthPath, rng: &mut CaseRng) {
    let mut segments = [Segment::Free, Segment::Taps, Segment::Deep, Segment::Shallow, Segment::Slow];
    segments.shuffle(rng);
    for segment in segments {
        append(segment, path, rng);
    }
    path.tap(rng);
}

fn append(segment: Segment, path: &mut DepthPath, rng: &mut CaseRng) {
    let (deepest, free) = (path.deepest, path.free);
    match segment {
        Segment::Free => {
            path.sine(rng.random_range(0.8..1.6), 0.8 * free.abs(), 2.5);
            path.sine(rng.random_range(3.0..7.0), 0.4 * free.abs(), 0.8);
            path.triangle(0.7 * free.abs(), 1.6, 1.0);
        }
        Segment::Taps => (0..4).for_each(|_| path.tap(rng)),
        Segment::Deep => {
            path.move_to(deepest * rng.random_range(0.65..0.75), rng.random_range(0.2..0.5));
            path.hold(rng.random_range(2.0..3.0));
            path.sine(rng.random_range(0.8..1.3), 0.22 * deepest, 2.0);
            path.sine(rng.random_range(2.5..4.0), 0.2 * deepest, 1.4);
            path.sine(rng.random_range(8.0..12.0), 0.12 * deepest, 0.8);
            path.sine(rng.random_range(20.0..28.0), 0.06 * deepest, 0.6);
        }
        Segment::Shallow => {
            path.move_to(deepest * rng.random_range(0.25..0.4), rng.random_range(0.2..0.6));
            path.hold(rng.random_range(1.5..2.5));
            path.sine(rng.random_range(2.5..4.0), 0.15 * deepest, 1.4);
            path.sine(rng.random_range(8.0..12.0), 0.1 * deepest, 0.8);
        }
        Segment::Slow => {
            path.move_to(deepest * 0.55, rng.random_range(0.3..0.8));
            path.triangle(deepest * rng.random_range(0.25..0.4), rng.random_range(1.5..2.5), 2.0);
        }
    }
    path.move_to(free, rng.random_range(0.25..0.6));
    path.hold(0.4);
}

fn poor(path: &mut DepthPath, rng: &mut CaseRng) {
    (0..rng.random_range(2..4)).for_each(|_| path.tap(rng));
    path.move_to(path.deepest * rng.random_range(0.5..0.7), 0.4);
    path.sine(rng.random_range(3.0..10.0), 0.2 * path.deepest, rng.random_range(12.0..16.0));
    path.move_to(path.free, 0.4);
    path.hold(1.0);
}

/// The reference, m, whose tracking error makes the controller push as the path needs: `kp e + kd e' = m a + b v + F`.
#[must_use]
pub fn reference_for(depths: &[f64], nominal: &NominalParameters, control: &PdGains) -> Vec<f64> {
    let rate = control.proportional / control.derivative;
    let kept = (-rate * SAMPLE_PERIOD_S).exp();
    let mut error = 0.0;
    let at = |row: usize| depths[row.min(depths.len() - 1)];
    (0..depths.len())
        .map(|row| {
            let (before, now, next) = (at(row.saturating_sub(1)), at(row), at(row + 1));
            let (v, a) = (
                (next - before) / (2.0 * SAMPLE_PERIOD_S),
                (next - 2.0 * now + before) / (SAMPLE_PERIOD_S * SAMPLE_PERIOD_S),
            );
            let contact = nominal.stiffness * now + nominal.damping * v;
            let contact = if nominal.bilateral || (now > 0.0 && contact > 0.0) { contact } else { 0.0 };
            let needed = (nominal.mass * a + nominal.viscous * v + contact) / control.proportional;
            if row == 0 {
                error = needed;
            }
            error = needed + kept * (error - needed);
            nominal.surface + now + error
        })
        .collect()
}
