//! A bench in code: a course of the tool, the forces that follow from it, and what may go wrong with the columns.

use palpate_lab::diagnose::check::check;
use palpate_lab::diagnose::signals::uniform_trial::UniformTrial;
use palpate_lab::recording::Recording;
use palpate_lab::rig::{Contact, Coordinate, Drive, Rig};
use palpate_lab::sensors::Figures;

/// Seconds a row.
const STEP: f64 = 0.002;

/// Stiffness, damping, mass and friction of the bench.
const NATURE: [f64; 4] = [300.0, 5.0, 0.45, 2.0];

/// Presses to three depths at three speeds, each held, and let go: seconds and millimetres.
pub const PRESSES: [(f64, f64); 14] = [
    (0.0, -3.0),
    (2.0, -3.0),
    (2.5, 4.0),
    (4.0, 4.0),
    (4.4, -3.0),
    (6.0, -3.0),
    (6.2, 9.0),
    (9.0, 9.0),
    (10.0, -2.0),
    (11.0, -2.0),
    (13.0, 7.0),
    (16.0, 7.0),
    (17.5, -3.0),
    (20.0, -3.0),
];

/// The other sign.
pub const MINUS: fn(usize, f64) -> f64 = |_, value| -value;

/// A rig and a recording of it.
#[derive(Clone)]
pub struct Bench {
    rig: Rig,
    trial: Recording,
}

/// Repeatable noise of deviation one.
pub fn noise(row: usize) -> f64 {
    let mut state = (row as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mut even = || {
        state ^= state >> 30;
        state = state.wrapping_mul(0xbf58_476d_1ce4_e5b9);
        state ^= state >> 27;
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    (0..6).map(|_| even()).sum::<f64>() * 2f64.sqrt()
}

impl Bench {
    pub fn new() -> Self {
        Self::along(&PRESSES, true)
    }

    /// A tool that goes through `points` of seconds and millimetres, gently or at constant speed between them.
    pub fn along(points: &[(f64, f64)], gently: bool) -> Self {
        let rows = (points[points.len() - 1].0 / STEP) as usize;
        let place = |time: f64| {
            let next = points.partition_point(|point| point.0 <= time).clamp(1, points.len() - 1);
            let ((from, low), (to, high)) = (points[next - 1], points[next]);
            let part = ((time - from) / (to - from)).clamp(0.0, 1.0);
            // A quintic starts and ends without acceleration.
            let part = if gently { part.powi(3) * (10.0 + part * (6.0 * part - 15.0)) } else { part };
            1e-3 * (low + part * (high - low))
        };
        let [stiffness, damping, inertia, viscous] = NATURE;
        let mut trial = Recording { name: "trial-1.csv".to_owned(), ..Recording::default() };
        let (mut force, mut effort) = (Vec::new(), Vec::new());
        for row in 0..rows {
            let time = row as f64 * STEP;
            let (before, now, after) = (place(time - STEP), place(time), place(time + STEP));
            let (v, a) = ((after - before) / (2.0 * STEP), (after - 2.0 * now + before) / (STEP * STEP));
            let push = if now > 0.0 { (stiffness * now + damping * v).max(0.0) } else { 0.0 };
            trial.time.push(time);
            trial.position.push(now + 2e-6 * noise(row + 100_000));
            force.push(push + 0.02 * noise(row));
            effort.push(inertia * a + viscous * v + push);
        }
        (trial.force, trial.effort) = (Some(force), Some(effort));
        let rig = Rig {
            name: "bench".to_owned(),
            drive: Some(Drive { inertia, viscous, encoder: None, load_scale: 1.0 }),
            contact: Some(Contact { surface: 0.0, stiffness, damping, bilateral: false }),
            ..Rig::default()
        };
        Self { rig, trial }
    }

    fn columns(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let trial = &mut self.trial;
        [Some(&mut trial.time), Some(&mut trial.position), trial.force.as_mut(), trial.effort.as_mut()]
            .into_iter()
            .flatten()
    }

    pub fn kept(mut self, keep: impl Fn(usize) -> bool) -> Self {
        for column in self.columns() {
            *column = column.iter().enumerate().filter(|(row, _)| keep(*row)).map(|(_, value)| *value).collect();
        }
        self
    }

    pub fn without(self, rows: std::ops::Range<usize>) -> Self {
        self.kept(|row| !rows.contains(&row))
    }

    pub fn stamped(mut self, stamp: impl Fn(usize, f64, f64) -> f64) -> Self {
        self.trial.time = self.trial.time.iter().enumerate().map(|(row, time)| stamp(row, *time, STEP)).collect();
        self
    }

    pub fn position(mut self, change: impl Fn(usize, f64) -> f64) -> Self {
        alter(&mut self.trial.position, change);
        self
    }

    pub fn force(mut self, change: impl Fn(usize, f64) -> f64) -> Self {
        self.trial.force.iter_mut().for_each(|force| alter(force, &change));
        self
    }

    pub fn effort(mut self, change: impl Fn(usize, f64) -> f64) -> Self {
        self.trial.effort.iter_mut().for_each(|effort| alter(effort, &change));
        self
    }

    pub fn force_held(mut self, from: usize, rows: usize) -> Self {
        self.trial.force.iter_mut().for_each(|force| hold(force, from, rows));
        self
    }

    pub fn position_held(mut self, from: usize, rows: usize) -> Self {
        hold(&mut self.trial.position, from, rows);
        self
    }

    pub fn surface(mut self, at: f64) -> Self {
        self.rig.contact.iter_mut().for_each(|contact| contact.surface = at);
        self
    }

    pub fn resolution(mut self, step: f64) -> Self {
        self.rig.sensors.position_resolution = Some(step);
        self
    }

    pub fn no_effort(mut self) -> Self {
        self.trial.effort = None;
        self
    }

    pub fn no_force(mut self) -> Self {
        self.trial.force = None;
        self
    }

    pub fn measured_velocity(mut self) -> Self {
        let mut velocity: Vec<f64> = self.trial.position.windows(2).map(|pair| (pair[1] - pair[0]) / STEP).collect();
        velocity.push(0.0);
        self.trial.velocity = Some(velocity);
        self
    }

    /// The same bench with all lengths and forces multiplied.
    pub fn scaled(mut self, length: f64, force: f64) -> Self {
        let stiff = force / length;
        alter(&mut self.trial.position, |_, x| length * x);
        self = self.force(|_, f| force * f).effort(|_, f| force * f);
        if let Some(contact) = &mut self.rig.contact {
            (contact.surface, contact.stiffness, contact.damping) =
                (length * contact.surface, stiff * contact.stiffness, stiff * contact.damping);
        }
        if let Some(drive) = &mut self.rig.drive {
            (drive.inertia, drive.viscous) = (stiff * drive.inertia, stiff * drive.viscous);
        }
        self.rig.sensors.position_resolution = self.rig.sensors.position_resolution.map(|step| length * step);
        self
    }
}

/// The same numbers in radians and newton metres.
pub fn rotary(mut bench: Bench) -> Bench {
    bench.rig.coordinate = Coordinate::Rotary;
    bench
}

fn alter(column: &mut [f64], change: impl Fn(usize, f64) -> f64) {
    column.iter_mut().enumerate().for_each(|(row, value)| *value = change(row, *value));
}

fn hold(column: &mut [f64], from: usize, rows: usize) {
    let value = column[from];
    column[from..from + rows].fill(value);
}

/// Findings as "grave|mild place: text" of trials under the rig of the first.
pub fn found(benches: &[Bench]) -> Vec<String> {
    let rig = &benches[0].rig;
    let name =
        |(at, bench): (usize, &Bench)| Recording { name: format!("trial-{}.csv", at + 1), ..bench.trial.clone() };
    let trials: Vec<Recording> = benches.iter().enumerate().map(name).collect();
    let period = trials.iter().map(Recording::period).fold(0.0, f64::max);
    let raws: Vec<UniformTrial> =
        trials.iter().map(|trial| UniformTrial::of(trial, Figures::of(rig, trial), period)).collect();
    let word = |grave: bool| if grave { "grave" } else { "mild" };
    check(rig, &trials, &raws).into_iter().map(|f| format!("{} {}: {}", word(f.grave), f.place, f.text)).collect()
}

/// Whether one of `texts` holds `words`.
pub fn has(texts: &[String], words: &str) -> bool {
    texts.iter().any(|text| text.contains(words))
}
