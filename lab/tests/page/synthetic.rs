//! Recordings and estimates that look like the real ones, without running an estimator.

use palpate_lab::page::{self, Drawing, Drawn, Estimates, Page, Row, Summary, Trial, Units};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

pub const LINEAR: Units = Units { position: "m", force: "N", stiffness: "N/m", damping: "N s/m" };

const NAMES: [(&str, &str); 9] = [
    ("bls", "block least squares"),
    ("ewrls", "exponentially weighted recursive least squares"),
    ("sprls", "self-perturbing recursive least squares"),
    ("blmf", "block least mean fourth"),
    ("blms", "block least mean square"),
    ("reset_rls", "covariance-resetting recursive least squares"),
    ("rls", "recursive least squares"),
    ("gradient", "gradient adaptive law"),
    ("descent", "steepest descent"),
];

/// A whole recording and what the estimators made of it. All vectors are of equal length.
#[derive(Clone)]
pub struct Recorded {
    pub name: String,
    pub nominal_stiffness: f64,
    pub nominal_damping: f64,
    pub time: Vec<f64>,
    pub penetration: Vec<f32>,
    pub force: Vec<f32>,
    pub contact: Vec<bool>,
    pub methods: Vec<Method>,
    pub notices: Vec<String>,
}

/// One estimator's trace.
#[derive(Clone)]
pub struct Method {
    pub title: &'static str,
    pub summary: Option<Summary>,
    pub estimates: Estimates,
    name: &'static str,
}

impl Recorded {
    /// What a page shows of it, where at most `rows` are drawn.
    fn trial(self, rows: usize) -> Trial {
        Trial {
            drawn: self.drawn(rows),
            name: self.name,
            units: LINEAR,
            nominal_stiffness: self.nominal_stiffness,
            nominal_damping: self.nominal_damping,
            methods: self
                .methods
                .into_iter()
                .map(|Method { name, title, summary, .. }| page::Method { name, title, summary })
                .collect(),
            notices: self.notices,
        }
    }

    fn drawn(&self, rows: usize) -> Drawn {
        let mut drawing = Drawing::new(self.time.len(), self.methods.len(), rows);
        loop {
            for row in 0..self.time.len() {
                let estimates: Vec<_> = self.methods.iter().map(|method| method.row(row)).collect();
                drawing.take(Row {
                    time: self.time[row],
                    penetration: self.penetration[row],
                    force: self.force[row],
                    contact: self.contact[row],
                    estimates: &estimates,
                });
            }
            if drawing.end_of_pass() {
                return drawing.finish();
            }
        }
    }
}

impl Method {
    fn row(&self, row: usize) -> [f32; page::ESTIMATE_COLUMNS] {
        let of = &self.estimates;
        [&of.stiffness, &of.stiffness_half_width, &of.damping, &of.damping_half_width, &of.innovation]
            .map(|column| column[row])
    }
}

/// A tool that presses a wall of `stiffness` and `damping` for half of every `period` seconds.
#[derive(Clone, Copy)]
pub struct Touching {
    pub seconds: f64,
    pub rate: f64,
    pub period: f64,
    pub depth: f64,
    pub sway: f64,
    pub hertz: f64,
    pub stiffness: f64,
    pub damping: f64,
    pub noise: f64,
    pub methods: usize,
    pub seed: u64,
}

/// The bench of the paper: a second tap of 15 s in every 30 s, swaying at 10 Hz.
pub const BENCH: Touching = Touching {
    seconds: 60.0,
    rate: 1000.0,
    period: 30.0,
    depth: 13.5e-3,
    sway: 3.3e-3,
    hertz: 10.0,
    stiffness: 300.0,
    damping: 5.0,
    noise: 0.09,
    methods: 4,
    seed: 1,
};

/// A cantilever on a cell: nanonewtons on micrometres.
pub const AFM: Touching = Touching {
    seconds: 2.0,
    rate: 5000.0,
    period: 1.0,
    depth: 1.1e-6,
    sway: 0.06e-6,
    hertz: 40.0,
    stiffness: 0.0203,
    damping: 1.6e-6,
    noise: 60e-12,
    methods: 3,
    seed: 2,
};

impl Touching {
    pub fn trial(&self, name: &str) -> Recorded {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        let mut noise = move || -> f64 { StandardNormal.sample(&mut rng) };
        let rows = (self.seconds * self.rate) as usize;
        let mut trial = Recorded {
            name: name.into(),
            nominal_stiffness: 1.05 * self.stiffness,
            nominal_damping: 0.8 * self.damping,
            time: (0..rows).map(|row| row as f64 / self.rate).collect(),
            penetration: Vec::with_capacity(rows),
            force: Vec::with_capacity(rows),
            contact: Vec::with_capacity(rows),
            methods: Vec::new(),
            notices: Vec::new(),
        };
        let mut before = f64::NAN;
        for &time in &trial.time {
            let depth = self.position(time);
            let rate = if before.is_nan() { 0.0 } else { (depth - before) * self.rate };
            before = depth;
            let contact = depth > 0.0;
            let pushed = if contact { (self.stiffness * depth + self.damping * rate).max(0.0) } else { 0.0 };
            trial.penetration.push(depth as f32);
            trial.force.push((pushed + self.noise * noise()) as f32);
            trial.contact.push(contact);
        }
        trial.methods = (0..self.methods).map(|index| self.method(index, &trial, &mut noise)).collect();
        trial
    }

    fn position(&self, time: f64) -> f64 {
        let tau = std::f64::consts::TAU;
        let lift = (6.0 * (tau * (time / self.period - 0.25)).sin()).tanh();
        self.depth * (lift - 0.05) + self.sway * (tau * self.hertz * time).sin()
    }

    /// An estimator thrown far off at each onset, that then converges and keeps its own kind of noise.
    fn method(&self, index: usize, trial: &Recorded, noise: &mut impl FnMut() -> f64) -> Method {
        let (name, title) = NAMES[index % NAMES.len()];
        let settles = [0.15, 0.9, 0.3, 0.2, 0.5, 0.1, 1.2, 1.5, 2.0][index % 9] * self.period / 30.0;
        let jitter = [0.004, 0.006, 0.02, 0.003, 0.01, 0.004, 0.005, 0.01, 0.015][index % 9];
        let mut method = Method { name, title, summary: None, estimates: Estimates::default() };
        let (mut since, mut slow, mut slow_b, mut sign) = (0.0, 0.0, 0.0, 1.0);
        for (&contact, &penetration) in trial.contact.iter().zip(&trial.penetration) {
            if !contact {
                since = 0.0;
                sign = noise().signum();
                method.push([0.0; 5]);
                continue;
            }
            since += 1.0 / self.rate;
            slow += 0.01 * (jitter * 14.0 * noise() - slow);
            slow_b += 0.01 * (jitter * 60.0 * noise() - slow_b);
            let spike = sign * 100.0 * (-since / (0.02 * settles)).exp();
            let missing = (-since / (0.4 * settles)).exp();
            let wide = if since < 0.02 * settles { f64::INFINITY } else { 0.012 + spike.abs() + missing };
            let lacks = (missing + slow) * self.stiffness * f64::from(penetration);
            method.push([
                self.stiffness * (1.0 - missing + slow + spike),
                self.stiffness * wide,
                self.damping * (1.0 - 1.5 * missing + slow_b - spike),
                self.damping * 6.0 * wide,
                lacks + 1.1 * self.noise * noise(),
            ]);
        }
        method.summary = method.summarise(trial);
        method
    }

    pub fn page(&self, rig: &str) -> Page {
        page(rig, vec![self.trial("trial-1.csv")])
    }
}

pub fn page(rig: &str, trials: Vec<Recorded>) -> Page {
    let settings = [
        ("window", "300 samples"),
        ("forgetting factor", "0.9967"),
        ("initial covariance", "10"),
        ("velocity", "matched filter"),
        ("velocity cut-off", "20 Hz"),
    ];
    let settings = settings.iter().map(|(label, value)| (label.to_string(), value.to_string())).collect();
    let methods = trials.iter().map(|trial| trial.methods.len()).max().unwrap_or(0);
    let rows = page::budget(trials.len(), methods);
    let trials = trials.into_iter().map(|trial| trial.trial(rows)).collect();
    Page { rig: rig.into(), ran_on: "host".into(), settings, diagnosis: Some("report.html".into()), trials }
}

/// Three touches in three seconds.
pub fn touching() -> Touching {
    Touching { seconds: 3.0, period: 1.0, ..BENCH }
}

/// Recordings that a picture might stumble over.
pub fn odd() -> Vec<Recorded> {
    let mut vague = touching().trial("no interval is known.csv");
    for method in &mut vague.methods {
        method.summary = None;
        method.estimates.stiffness_half_width.fill(f32::INFINITY);
        method.estimates.damping_half_width.fill(f32::NAN);
    }
    let mut astray = touching().trial("one method diverges.csv");
    astray.methods[2].estimates.stiffness.iter_mut().for_each(|stiffness| *stiffness *= 1e30);
    astray.nominal_stiffness = 3.0e6;
    let mut epoch = touching().trial("clock since 1970.csv");
    epoch.time.iter_mut().for_each(|time| *time += 1.7e9);
    let mut nan = touching().trial("nothing is a number.csv");
    nan.force.fill(f32::NAN);
    nan.penetration.fill(0.0);
    nan.methods.iter_mut().for_each(|method| method.estimates.stiffness.fill(f32::NAN));
    nan.nominal_stiffness = f64::NAN;
    vec![
        vague,
        astray,
        epoch,
        nan,
        Touching { seconds: 0.0, ..touching() }.trial("empty.csv"),
        Touching { seconds: 0.001, ..touching() }.trial("one sample.csv"),
        Touching { methods: 0, ..touching() }.trial("no methods.csv"),
    ]
}

trait Grow {
    fn push(&mut self, values: [f64; 5]);
    fn summarise(&self, trial: &Recorded) -> Option<Summary>;
}

impl Grow for Method {
    fn push(&mut self, values: [f64; 5]) {
        let of = &mut self.estimates;
        let columns = [
            &mut of.stiffness,
            &mut of.stiffness_half_width,
            &mut of.damping,
            &mut of.damping_half_width,
            &mut of.innovation,
        ];
        columns.into_iter().zip(values).for_each(|(column, value)| column.push(value as f32));
    }

    fn summarise(&self, trial: &Recorded) -> Option<Summary> {
        let known = |row: &usize| trial.contact[*row] && self.estimates.stiffness_half_width[*row].is_finite();
        let rows: Vec<usize> = (0..trial.time.len()).filter(known).collect();
        let median = |column: &[f32]| {
            let mut values: Vec<f32> = rows.iter().map(|&row| column[row]).collect();
            values.sort_by(f32::total_cmp);
            values.get(values.len() / 2).map(|&value| f64::from(value))
        };
        let power = |column: &[f32]| -> f64 { rows.iter().map(|&row| f64::from(column[row]).powi(2)).sum() };
        Some(Summary {
            stiffness: median(&self.estimates.stiffness)?,
            stiffness_half_width: median(&self.estimates.stiffness_half_width)?,
            damping: median(&self.estimates.damping)?,
            damping_half_width: median(&self.estimates.damping_half_width)?,
            rmse_percent: 100.0 * (power(&self.estimates.innovation) / power(&trial.force)).sqrt(),
        })
    }
}
