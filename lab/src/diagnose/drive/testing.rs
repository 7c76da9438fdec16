//! A drive to identify, for tests: simulated by small steps of its own, with nothing of the model's.

use rand::SeedableRng as _;
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};

use super::criteria::INERTIA_FACTOR;
use super::fit::{Effort, Fit, fit};
use super::law::{DriveLaw, Link, Side};
use super::levenberg_marquardt::Ended;
use super::likelihood::Data;
use super::model::Model;
use super::noise::Noise;
use super::nominal::NominalDrive;
use super::scales::Scales;
use super::selection::Search;
use super::term::Term;
use super::trial::DriveTrial;

/// A pair of bodies with the encoder on its motor, without friction.
pub fn pair_law(stiffness: f64) -> (DriveLaw, Link) {
    let link = Link { stiffness, damping: 0.0, play: 0.0, load_share: 0.3, load_viscous: 0.0, encoder: Side::Motor };
    (DriveLaw { link: Some(link), ..DriveLaw::nominal(0.6, 0.0, 0.0) }, link)
}

/// What a rig file says of a drive along a line, of `inertia` (kg) and `viscous` friction (N s/m), and nothing else.
pub fn nominal(inertia: f64, viscous: f64) -> NominalDrive {
    let inertia_factor = INERTIA_FACTOR.value();
    NominalDrive {
        inertia,
        inertia_factor,
        viscous,
        is_rotary: false,
        encoder: None,
        resolution: 1e-5,
        effects: Vec::new(),
    }
}

/// Sizes of a recording of [`TestDrive::PLAIN`], by and large.
pub const SCALES: Scales = Scales {
    effort: 2.0,
    peak_effort: 5.0,
    usual_effort: 2.3,
    speed: 0.2,
    travel: 0.05,
    lowest: -0.025,
    period_s: 1e-3,
    recorded_period_s: 1e-3,
    latest_effort_s: 0.02,
    duration_s: 3.0,
    inertia: 0.8,
    inertia_factor: 5.0,
    viscous: 4.0,
    resolution: 1e-5,
    is_rotary: false,
    touches: false,
};

/// A drive under a position controller that ticks once a row.
pub struct TestDrive {
    /// kg
    pub mass: f64,
    /// N s/m
    pub viscous: f64,
    /// N, dry friction.
    pub coulomb: f64,
    /// m, length over which dry friction builds up after a turn (Dahl's); zero: at once.
    pub presliding: f64,
    /// N, friction that grows with the root of the speed, at 0.1 m/s.
    pub root: f64,
    /// N, ripple along the way, at a pitch of 5 mm.
    pub ripple: f64,
    /// N, the same at a third of that pitch.
    pub third_ripple: f64,
    /// N, the same at a fifth of that pitch.
    pub fifth_ripple: f64,
    /// N, constant load.
    pub load: f64,
    /// Share of the [`known_load`] that rubs, either way.
    pub geared: f64,
    /// N, what the effort nears, by a hyperbolic tangent; infinite: it is as commanded.
    pub iron: f64,
    /// N, a force at 7.3 Hz, whatever the drive does.
    pub tone: f64,
    /// Share of the viscous friction by which it is more at the start of a trial, and less and less from there, within 2 s.
    pub cold: f64,
    /// Share of the viscous friction by which it is more backward than forward.
    pub one_way: f64,
    /// N/m, of a spring that is relaxed at -40 mm.
    pub spring: f64,
    /// N^2 s, density of a white force.
    pub disturbance: f64,
    /// m, deviation of the encoder's white noise.
    pub encoder: f64,
    /// N, deviation of white noise that is recorded with the effort and does not drive.
    pub effort_noise: f64,
    /// Share of that noise that is left in the next row.
    pub effort_memory: f64,
    /// s, first-order lag of the effort behind what is recorded.
    pub effort_lag_s: f64,
    /// s, less than a row: by how much the effort acts later than it is recorded.
    pub effort_late_s: f64,
    /// Whether the mean of the effort before and after its row is recorded, and not what acts from there.
    pub is_averaged: bool,
    /// Whether it stands still for the second half of a trial.
    pub rests: bool,
    /// What gives between motor and load.
    pub link: Option<TestLink>,
    /// Whether the encoder is on the load beyond that.
    pub sees_load: bool,
}

/// A spring and damper with play between motor and load.
#[derive(Clone, Copy)]
pub struct TestLink {
    /// N/m
    pub stiffness: f64,
    /// N s/m
    pub damping: f64,
    /// m, from one side to the other.
    pub play: f64,
    /// Part of the mass that is the load's.
    pub load_share: f64,
    /// Part of the viscous friction that acts on the load.
    pub friction_share: f64,
}

impl TestDrive {
    /// 0.8 kg, 4 N s/m and an encoder of 5 um.
    pub const PLAIN: Self = Self {
        mass: 0.8,
        viscous: 4.0,
        coulomb: 0.0,
        presliding: 0.0,
        root: 0.0,
        ripple: 0.0,
        third_ripple: 0.0,
        fifth_ripple: 0.0,
        load: 0.0,
        geared: 0.0,
        iron: f64::INFINITY,
        tone: 0.0,
        cold: 0.0,
        one_way: 0.0,
        spring: 0.0,
        disturbance: 0.0,
        encoder: 5e-6,
        effort_noise: 0.0,
        effort_memory: 0.0,
        effort_lag_s: 0.0,
        effort_late_s: 0.0,
        is_averaged: false,
        rests: false,
        link: None,
        sees_load: false,
    };

    /// `seconds` at 1 kHz along three sines, drawn from `seed`.
    pub fn trial(&self, seconds: f64, seed: u64) -> DriveTrial {
        const STEPS: usize = 25;
        let mut rng = ChaCha12Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        let (rows, period) = ((seconds * 1e3) as usize, 1e-3);
        let step = period / STEPS as f64;
        let phases = [normal(), normal(), normal()];
        let reference = |t: f64| {
            let t = if self.rests { t.min(0.5 * seconds) } else { t };
            let sine = |size: f64, hz: f64, phase: f64| size * (std::f64::consts::TAU * hz * t + phase).sin();
            sine(0.02, 0.6, phases[0]) + sine(0.005, 1.7, phases[1]) + sine(0.002, 5.1, phases[2])
        };
        let (mut x, mut v) = (reference(0.0), 0.0);
        let (mut load_x, mut load_v) = (x, v);
        let mut heard = 0.0;
        let (mut command, mut drives, mut bristle) = (0.0, 0.0, 0.0);
        let (mut time, mut position, mut effort) = (Vec::new(), Vec::new(), Vec::new());
        for row in 0..rows {
            let t = row as f64 * period;
            let rate = (reference(t) - reference(t - period)) / period;
            let u = 900.0 * (reference(t) - x) + 38.0 * (rate - v);
            let rubbed = self.coulomb + self.geared * known_load(t, seed).abs();
            time.push(t);
            let seen = if self.sees_load { load_x } else { x };
            position.push(seen + self.encoder * normal());
            let before = command;
            command = u;
            let shown = if self.is_averaged { 0.5 * (before + u) } else { u };
            if self.effort_noise > 0.0 {
                heard = self.effort_memory * heard + (1.0 - self.effort_memory.powi(2)).sqrt() * normal();
            }
            effort.push(shown + self.effort_noise * heard);
            for part in 0..STEPS {
                let acts = if (part as f64 + 0.5) * step < self.effort_late_s { before } else { command };
                drives = if self.effort_lag_s > 0.0 {
                    drives + (acts - drives) * (1.0 - (-step / self.effort_lag_s).exp())
                } else {
                    acts
                };
                let given = if self.iron.is_finite() { self.iron * (drives / self.iron).tanh() } else { drives };
                let white = (self.disturbance / step).sqrt() * normal();
                let (passed, motor) = self.link.map_or((0.0, self.mass), |link| {
                    let apart = x - load_x;
                    let strain = apart - apart.clamp(-0.5 * link.play, 0.5 * link.play);
                    let damping = if strain == 0.0 { 0.0 } else { link.damping * (v - load_v) };
                    (link.stiffness * strain + damping, (1.0 - link.load_share) * self.mass)
                });
                let on_load = self.link.map_or(0.0, |link| link.friction_share * self.viscous);
                if let Some(link) = self.link {
                    load_v += step * (passed - on_load * load_v) / (link.load_share * self.mass);
                    load_x += step * load_v;
                }
                let tone = self.tone * (std::f64::consts::TAU * 7.3 * t + seed as f64).sin();
                let against = if v < 0.0 { self.one_way } else { 0.0 };
                let viscous = self.viscous * (1.0 + against + self.cold * (-0.5 * t).exp());
                let root = self.root * v.signum() * (v.abs() / 0.1).sqrt();
                let wave = |size: f64, pitch: f64| size * (std::f64::consts::TAU * x / pitch).sin();
                let ripple =
                    wave(self.ripple, 5e-3) + wave(self.third_ripple, 5e-3 / 3.0) + wave(self.fifth_ripple, 1e-3);
                let dry = root + bristle;
                let free = v + step
                    * (given - passed - dry - ripple - (viscous - on_load) * v - self.load - self.spring * (x + 0.04)
                        + tone
                        + white)
                    / motor;
                let at_once = if self.presliding > 0.0 { 0.0 } else { rubbed };
                let held = step * at_once / motor;
                v = if free.abs() <= held { 0.0 } else { free - held * free.signum() };
                if self.presliding > 0.0 {
                    bristle += step * (rubbed * v - bristle * v.abs()) / self.presliding;
                }
                x += step * v;
            }
        }
        DriveTrial::new(format!("trial-{seed}.csv"), time, &position, effort, None, 1)
    }
}

/// What a rigid-body model explains of the effort of trial `seed`, N.
#[must_use]
pub fn known_load(time: f64, seed: u64) -> f64 {
    2.0 * (3.0 * time + seed as f64).sin()
}

/// A fit of `terms` with their `own` values beside 0.8 kg and 4 N s/m.
#[must_use]
pub fn fit_of(terms: &[Term], own: &[f64]) -> Fit {
    Fit {
        model: Model { terms: terms.to_vec(), scales: SCALES },
        values: [&[0.8, 4.0, 0.0, 0.0], own].concat(),
        noise: Noise { ln_disturbance: -11.0, ln_encoder: -24.0 },
        log_likelihood: 7.0,
        ended: Ended::Converged,
    }
}

/// A search over `trials` of a drive that the rig file knows rightly, its nominal law fitted.
#[must_use]
pub fn search_over<'a>(trials: &'a [DriveTrial], drive: &TestDrive) -> Search<'a> {
    let data = Data { trials, least_encoder_variance: 0.3 * drive.encoder.powi(2) };
    let model = Model { terms: Vec::new(), scales: SCALES };
    let noise = Noise { ln_disturbance: -8.0, ln_encoder: drive.encoder.powi(2).ln() };
    let nominal = fit(&data, &model, &[0.8, 4.0, 0.0, 0.0], noise, Effort::FULL);
    let (sides, is_asked, effort_noise_density) = (Vec::new(), false, 0.0);
    Search { data, scales: SCALES, nominal, band_hz: 20.0, sides, is_asked, effort_noise_density }
}

/// The nominal law of `search` with dry friction beside it, fitted in full.
#[must_use]
pub fn with_dry_friction(search: &Search<'_>) -> Fit {
    search.polished(&Fit {
        model: search.nominal.model.with(Term::Coulomb),
        values: [search.nominal.values.as_slice(), &[0.3]].concat(),
        ..search.nominal.clone()
    })
}
