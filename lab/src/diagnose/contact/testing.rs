//! A contact whose truth is known, for tests.

use rand::SeedableRng as _;
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution as _, Normal, StandardNormal};

use super::data::Data;
use super::model::ContactModel;
use super::nominal::{NominalContact, nominal_fit};
use super::trial::ContactTrial;
use crate::diagnose::term::Term;
use crate::effects;
use crate::recording::Recording;
use crate::rig::Contact;
use crate::sensors::{Channel, Figures};

/// Rows a second.
pub const RATE: f64 = 250.0;

/// Noise of the force sensor, N.
pub const FORCE_NOISE: f64 = 0.02;

/// Noise of the encoder, m.
const POSITION_NOISE: f64 = 2e-6;

/// A pad that is pressed eight millimetres deep, at two depths and speeds, by a law beside spring and damper.
pub struct TestContact {
    /// N/m.
    pub stiffness: f64,
    /// N s/m.
    pub damping: f64,
    /// Force of a branch that relaxes, N/m, in 0.4 s.
    pub branch: f64,
    /// Exponent of the spring, whose force at [`DEPTH`] is that of the stiffness.
    pub exponent: f64,
    /// What fades of a step of the spring's force in 0.4 s, over what stays.
    pub fading: f64,
    /// Zero of the sensor, N.
    pub zero: f64,
    /// Greatest force that the sensor shows, N.
    pub limit: f64,
}

/// Depth that the spring's stiffness is stated at, m.
const DEPTH: f64 = 8e-3;

impl TestContact {
    /// Spring and damper alone.
    pub const PLAIN: Self = Self {
        stiffness: 300.0,
        damping: 6.0,
        branch: 0.0,
        exponent: 1.0,
        fading: 0.0,
        zero: 0.0,
        limit: f64::INFINITY,
    };

    /// The rig file of it.
    pub fn nominal() -> NominalContact {
        let contact = Contact { surface: 0.0, stiffness: 280.0, damping: 5.0, bilateral: false };
        NominalContact { contact, force_zero: 0.0, is_rotary: false, effects: Vec::new() }
    }

    /// What is recorded in twelve seconds.
    pub fn recording(&self, seed: u64) -> Recording {
        let mut random = ChaCha12Rng::seed_from_u64(seed);
        let [force_noise, position_noise] = [FORCE_NOISE, POSITION_NOISE].map(|sigma| Normal::new(0.0, sigma).unwrap());
        let time: Vec<f64> = (0..(12.0 * RATE) as usize).map(|row| row as f64 / RATE).collect();
        let depth = |t: f64| 4e-3 * (1.0 - (4.0 * t).cos()) * (1.0 + 0.4 * (1.1 * t).sin()) - 2e-3;
        let spring = |inside: f64| self.stiffness * DEPTH * (inside / DEPTH).powf(self.exponent);
        let strained = |inside: f64| self.branch * inside + self.fading * spring(inside);
        let (mut branch, mut before) = (0.0, strained(depth(0.0).max(0.0)));
        let (mut position, mut force) = (Vec::new(), Vec::new());
        for t in &time {
            let x = depth(*t);
            let v = (depth(t + 1e-5) - depth(t - 1e-5)) / 2e-5;
            let inside = x.max(0.0);
            // Exact for what is strained in a straight line between two rows.
            let ratio = 1.0 / (RATE * 0.4);
            branch = branch * f64::exp(-ratio) + (strained(inside) - before) * (-(-ratio).exp_m1() / ratio);
            before = strained(inside);
            let law = if x > 0.0 { spring(x) + self.damping * v } else { 0.0 };
            let pushed = (law + branch).max(0.0) + self.zero + force_noise.sample(&mut random);
            force.push(pushed.min(self.limit));
            position.push(x + position_noise.sample(&mut random));
        }
        Recording { name: format!("trial-{seed}.csv"), time, position, force: Some(force), ..Recording::default() }
    }

    /// With `more` force by the position, N.
    pub fn trial_with(&self, seed: u64, more: impl Fn(f64) -> f64) -> ContactTrial {
        let mut recording = self.recording(seed);
        let positions = &recording.position;
        recording.force.iter_mut().flatten().zip(positions).for_each(|(force, x)| *force += more(*x));
        Self::seen(&recording)
    }

    /// With `more` force by the motion as it is seen, position and velocity, N.
    pub fn trial_beside(&self, seed: u64, more: impl Fn(f64, f64) -> f64) -> ContactTrial {
        let mut trial = self.trial(seed);
        for row in 0..trial.len() {
            trial.force[row] += more(trial.position[row], trial.velocity[row]);
        }
        trial
    }

    /// With noise beside the sensor's white one, of deviation `size`, N, and a memory of so many `rows`.
    pub fn remembering(&self, rows: f64, size: f64, seed: u64) -> ContactTrial {
        let mut recording = self.recording(seed);
        let mut random = ChaCha12Rng::seed_from_u64(seed + 1000);
        let kept = f64::exp(-1.0 / rows);
        let mut noise = 0.0;
        for force in recording.force.as_mut().unwrap() {
            let new: f64 = StandardNormal.sample(&mut random);
            noise = kept * noise + size * (1.0 - kept * kept).sqrt() * new;
            *force += noise;
        }
        Self::seen(&recording)
    }

    /// The same as the model sees it.
    pub fn trial(&self, seed: u64) -> ContactTrial {
        Self::seen(&self.recording(seed))
    }

    /// `recording` as the model sees it.
    pub fn seen(recording: &Recording) -> ContactTrial {
        Self::seen_in_means(recording, 1)
    }

    /// The recording with a zero that wanders by `per_root_second`, N in a root second.
    pub fn wandering(&self, per_root_second: f64, seed: u64) -> Recording {
        let mut random = ChaCha12Rng::seed_from_u64(seed + 10);
        let normal = Normal::new(0.0, per_root_second / RATE.sqrt()).unwrap();
        let mut recording = self.recording(seed);
        let mut zero = 0.0;
        for force in recording.force.iter_mut().flatten() {
            zero += normal.sample(&mut random);
            *force += zero;
        }
        recording
    }

    /// The recording with a liquid bridge: leaving, the force falls to the `pull`, N, and no lower, and above the surface goes to nothing in a straight line of `length`, m.
    pub fn bridged(&self, seed: u64, pull: f64, length: f64) -> Recording {
        let mut recording = self.recording(seed);
        let mut is_touched = false;
        for (row, force) in recording.force.as_mut().unwrap().iter_mut().enumerate() {
            let x = recording.position[row];
            let [before, after] = [row.saturating_sub(1), (row + 1).min(recording.position.len() - 1)];
            let v = 0.5 * RATE * (recording.position[after] - recording.position[before]);
            is_touched = x > 0.0 || (is_touched && x > -length);
            let law = self.stiffness * x + self.damping * v;
            let least = if v < 0.0 { -pull } else { 0.0 };
            *force += match (x > 0.0, is_touched) {
                (true, _) => law.max(least) - law.max(0.0),
                (false, true) => -pull * (1.0 + x / length),
                (false, false) => 0.0,
            };
        }
        recording
    }

    /// The same in means of `every` rows.
    pub fn seen_in_means(recording: &Recording, every: usize) -> ContactTrial {
        let channel = |noise: f64| Channel { resolution: 0.0, noise };
        let figures = Figures { position: channel(POSITION_NOISE), force: Some(channel(FORCE_NOISE)), effort: None };
        ContactTrial::new(recording, figures, every).unwrap()
    }

    /// The law of this contact with the effect `name` by its form `form`, and its values with `own` for the effect.
    pub fn law_with(&self, name: &str, form: usize, own: &[f64]) -> (ContactModel, Vec<f64>) {
        let trials = [self.trial(1)];
        let plain = nominal_fit(&Data::new(&trials), &Self::nominal());
        let model = plain.model.with(Term { effect: effects::find(name).unwrap(), form });
        (model, plain.values.iter().chain(own).copied().collect())
    }

    /// With the force of the effect `name` by its form `form` and its values `own` along the motion as it is seen.
    pub fn trial_under(&self, seed: u64, (name, form, own): (&str, usize, &[f64])) -> ContactTrial {
        let (model, values) = self.law_with(name, form, own);
        let mut trial = self.trial(seed);
        let trials = [trial.clone()];
        let data = Data::new(&trials);
        let nominal = nominal_fit(&data, &Self::nominal());
        let without = data.residual(&nominal.model, &values[..nominal.values.len()], 0);
        let with = data.residual(&model, &values, 0);
        let rows = trial.force.iter_mut().zip(without.iter().zip(&with));
        rows.for_each(|(force, (without, with))| *force += without - with);
        trial
    }
}
