//! Synthetic signals: a tool that presses into something whose damping grows with depth.

use palpate_lab::diagnose::report::diagnosis::{BinnedResidual, Phase, Trace};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// How large things are.
#[derive(Clone, Copy)]
pub struct Size {
    pub depth: f64,
    pub force: f64,
    pub rows: usize,
    pub rate: f64,
    /// What the simulation as given, refitted and improved lacks, as shares of the missing term.
    pub lacks: [f64; 3],
}

pub fn trace(size: &Size, trial: &str, channel: &'static str, seed: u64) -> Trace {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut noise = || -> f64 { StandardNormal.sample(&mut rng) };
    let floor = 0.01 * size.force;
    let mut trace = Trace {
        trial: trial.into(),
        channel,
        time: Vec::new(),
        depth: Vec::new(),
        measured: Vec::new(),
        as_given: Vec::new(),
        refitted: Vec::new(),
        improved: Vec::new(),
        learned: Vec::new(),
        expected_noise: Vec::new(),
        valid: Vec::new(),
    };
    for row in 0..size.rows {
        let time = row as f64 / size.rate;
        let (swing, rate) =
            ((5.0 * time).sin() - 0.2 * (31.0 * time).cos(), (5.0 * time).cos() + 1.2 * (31.0 * time).sin());
        let depth = swing.max(0.0);
        let touches = f64::from(u8::from(swing > 0.0));
        let known = size.force * (0.8 * depth + 0.04 * rate * touches);
        let missing = size.force * 0.12 * depth * rate;
        trace.time.push(time);
        trace.depth.push((size.depth * swing) as f32);
        trace.measured.push((known + missing + floor * noise()) as f32);
        let [given, refitted, improved] = size.lacks.map(|share| known + (1.0 - share) * missing);
        trace.as_given.push((given * (1.0 - 0.15 * size.lacks[0])) as f32);
        trace.refitted.push(refitted as f32);
        trace.improved.push(improved as f32);
        trace.expected_noise.push((floor * (1.0 + 0.5 * touches)) as f32);
        trace.valid.push(row > 9 && row + 10 < size.rows);
    }
    trace
}

/// Of the phases, of depth, speed, time and frequency; `loud` times the noise where it is most.
pub fn maps(size: &Size, channel: &'static str, unit: &str, loud: f64, cured: f64) -> Vec<BinnedResidual> {
    let shape = |weights: &[f64], along: &'static str, unit: String, labels: Vec<String>| {
        let total: f64 = weights.iter().sum();
        BinnedResidual {
            channel,
            along,
            unit,
            labels,
            before: weights.iter().map(|weight| 1.0 + (loud - 1.0) * weight).collect(),
            after: weights.iter().enumerate().map(|(n, w)| 1.0 + (cured - 1.0) * w + 0.1 * (n as f64).sin()).collect(),
            share: weights.iter().map(|weight| weight / total).collect(),
        }
    };
    let numbers = |n: usize, step: f64| (0..n).map(|k| format!("{}", (k as f64 + 0.5) * step)).collect();
    let phases = [Phase::Free, Phase::Onset, Phase::Loading, Phase::Hold, Phase::Unloading, Phase::Release];
    let names = phases.map(|phase| serde_json::to_value(phase).expect("a name").as_str().expect("text").to_owned());
    let (prefix, depth) = if size.depth < 1e-4 { ("µ", size.depth * 1e6) } else { ("m", size.depth * 1e3) };
    let ranges = (0..6).map(|k| format!("{:.1}–{:.1}", depth * k as f64 / 6.0, depth * (k + 1) as f64 / 6.0)).collect();
    vec![
        shape(&[0.0, 1.0, 0.3, 0.02, 0.25, 0.1], "phase", String::new(), names.to_vec()),
        shape(&[0.05, 0.1, 0.3, 0.5, 0.8, 1.0], "depth", format!("{prefix}{unit}"), ranges),
        shape(&[0.0, 0.02, 0.1, 0.3, 0.6, 0.9, 1.0, 0.95], "speed", format!("{prefix}{unit}/s"), numbers(8, 0.25)),
        shape(&[0.1, 1.0, 0.2, 0.0, 0.7, 0.1, 0.0, 0.8, 0.3, 0.1, 0.5, 0.1], "time", "s".into(), numbers(12, 0.5)),
        shape(&[1.0, 0.8, 0.2, 0.05, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], "frequency", "Hz".into(), numbers(10, 10.0)),
    ]
}
