//! How sharply the analysis looks: one smoothing filter for every channel.
//!
//! Every channel passes the same Gaussian, so that a linear law between them stays what it was. Velocity and
//! acceleration are its derivatives: x, v, a, F and effort are all smoothed by exactly the same filter.
//!
//! A law that is not linear does not stay what it was: play of a smoothed motion is not the smoothed force of play. Where
//! the sensors are better than the rows one can afford, the Gaussian is passed in two: the law acts on the motion behind
//! the first, and what it leaves passes the second.

use super::uniform_trial::UniformTrial;
use crate::diagnose::linalg::dot;
use crate::diagnose::thresholds::derivative_filter::{
    AMPLE_ROWS, CARRIED_MASS_FRACTION, CUTOFF_FRACTION_UNKNOWN_INERTIA, CUTOFF_OVER_TONE, HALF_WIDTH_SIGMAS,
    MAX_ACCELERATION_NOISE_RATIO, MAX_CASCADE_RATIO, MAX_CUTOFF_OVER_RATE, MAX_POSITION_NOISE_RATIO,
    MIN_ROWS_FOR_CASCADE, ROW_BUDGET, ROWS_PER_CUTOFF_PERIOD,
};
use crate::rig::Rig;

/// The filter and the clock of the analysis.
#[derive(Debug, Clone)]
pub struct DerivativeFilter {
    /// Width of the Gaussian, s.
    pub filter_width: f64,
    /// Raw rows a row of the analysis.
    pub stride: usize,
    /// Seconds of a raw row.
    pub period: f64,
    /// Half the support of the filter, rows.
    half_width_rows: usize,
    level: Vec<f64>,
    first_derivative: Vec<f64>,
    second_derivative: Vec<f64>,
    jerk: Vec<f64>,
    snap: Vec<f64>,
    crackle: Vec<f64>,
    held: Vec<f64>,
    held_derivative: Vec<f64>,
    passes: Option<Box<CascadedFilter>>,
}

/// A Gaussian as two, one after the other.
#[derive(Debug, Clone)]
pub struct CascadedFilter {
    /// What laws act behind, on the raw rows.
    pub first: DerivativeFilter,
    /// What their residual passes then, on the rows of the first.
    pub second: DerivativeFilter,
}

/// Width of a Gaussian whose -3 dB frequency is f: `CUTOFF_TIMES_WIDTH / f`.
const CUTOFF_TIMES_WIDTH: f64 = 0.132_5;

/// The frequency down to which the force has to be looked at for a tone that stands out of it.
fn min_cutoff_for_tone(uniform_trials: &[UniformTrial]) -> f64 {
    CUTOFF_OVER_TONE * uniform_trials.iter().filter_map(|raw| raw.hum).fold(0.0, f64::max)
}

impl DerivativeFilter {
    /// The sharpest filter for the contact: what position noise does to the predicted force stays near what force noise
    /// does, within what the clock allows.
    #[must_use]
    pub fn for_contact(rig: &Rig, uniform_trials: &[UniformTrial]) -> Self {
        let (position, force) = sensor_noise(uniform_trials);
        let cutoff_hz = rig.contact.map_or(f64::INFINITY, |contact| {
            let spring = contact.stiffness * position;
            let left = ((MAX_POSITION_NOISE_RATIO * force).powi(2) - spring * spring).max(0.0);
            let damping = contact.damping * position * std::f64::consts::TAU / 3f64.sqrt();
            if damping > 0.0 && force > 0.0 { left.sqrt() / damping } else { f64::INFINITY }
        });
        let calm = rig.drive.map_or(CUTOFF_FRACTION_UNKNOWN_INERTIA * cutoff_hz, |drive| {
            let carried = CARRIED_MASS_FRACTION * drive.inertia * position;
            let calm = (MAX_ACCELERATION_NOISE_RATIO * force * 5f64.sqrt() / carried).sqrt() / std::f64::consts::TAU;
            if carried > 0.0 && force > 0.0 { calm } else { f64::INFINITY }
        });
        let sharpest = uniform_trials.first().map_or(cutoff_hz, |raw| cutoff_hz.min(MAX_CUTOFF_OVER_RATE / raw.period));
        let seconds: f64 = uniform_trials.iter().map(|raw| raw.len() as f64 * raw.period).sum();
        let whole = calm
            .min(0.5 * sharpest)
            .max(MIN_ROWS_FOR_CASCADE / (ROWS_PER_CUTOFF_PERIOD * seconds.max(f64::MIN_POSITIVE)))
            .min(cutoff_hz);
        Self::with_cutoffs(uniform_trials, (cutoff_hz, whole), (0.02, min_cutoff_for_tone(uniform_trials)), ROW_BUDGET)
    }

    /// The sharpest filter for the drive: the same of what position noise does to inertia times acceleration.
    #[must_use]
    pub fn for_drive(rig: &Rig, uniform_trials: &[UniformTrial]) -> Self {
        let (position, force) = sensor_noise(uniform_trials);
        let shaken = rig.drive.map_or(0.0, |drive| drive.inertia * position);
        // Where no force is measured, the effort itself says what the balance is good for: its noise, or a hundredth of it.
        // A fifth of it, for nothing else holds the inertia against the noise of the acceleration.
        let force = if force > 0.0 { force } else { 0.2 * uniform_trials.iter().map(effort_noise).fold(0.0, f64::max) };
        let cutoff_hz = match (shaken > 0.0, force > 0.0) {
            (true, true) => (3.0 * 5f64.sqrt() * force / shaken).sqrt() / std::f64::consts::TAU,
            _ => f64::INFINITY,
        };
        Self::with_cutoffs(uniform_trials, (cutoff_hz, cutoff_hz), (0.01, 0.0), 0.5 * ROW_BUDGET)
    }

    /// Laws act behind the first of `cutoffs_hz` in Hz, what they leave is kept behind the second, as far as clock and `budget`
    /// of rows allow, not below a share of the rate, as far as that is no quicker than it need be, and not below a frequency in
    /// Hz: the two of `least`.
    fn with_cutoffs(uniform_trials: &[UniformTrial], cutoffs_hz: (f64, f64), least: (f64, f64), budget: f64) -> Self {
        let period = uniform_trials.first().map_or(1.0, |raw| raw.period);
        let rate = period.recip();
        let seconds: f64 = uniform_trials.iter().map(|raw| raw.len() as f64 * raw.period).sum();
        let affordable = budget / (ROWS_PER_CUTOFF_PERIOD * seconds.max(period));
        let least = (least.0 * rate.min(AMPLE_ROWS / seconds.max(period))).max(least.1);
        let sharpest = cutoffs_hz.0.max(least).min(MAX_CUTOFF_OVER_RATE * rate);
        let cutoff_hz = cutoffs_hz.1.min(affordable).max(least).min(MAX_CUTOFF_OVER_RATE * rate);
        let stride = |cutoff_hz: f64| ((rate / (ROWS_PER_CUTOFF_PERIOD * cutoff_hz)).round() as usize).max(1);
        let parts = (sharpest / cutoff_hz).min(MAX_CASCADE_RATIO) as usize;
        if parts < 2 {
            return Self::new(CUTOFF_TIMES_WIDTH / cutoff_hz, period, stride(cutoff_hz));
        }
        Self::cascaded(CUTOFF_TIMES_WIDTH / cutoff_hz, period, stride(parts as f64 * cutoff_hz), parts)
    }

    /// The same `times` less sharp, in one pass.
    #[must_use]
    pub fn with_lower_cutoff(&self, times: f64) -> Self {
        let cutoff_hz = self.cutoff_hz() / times;
        let stride = ((1.0 / (self.period * ROWS_PER_CUTOFF_PERIOD * cutoff_hz)).round() as usize).max(1);
        Self::new(CUTOFF_TIMES_WIDTH / cutoff_hz, self.period, stride)
    }

    /// A Gaussian of `filter_width` seconds in two passes: the first a part in `parts` as wide over rows of `period` seconds, looked
    /// at every `stride` rows, the second over every `parts` of those.
    #[must_use]
    pub fn cascaded(filter_width: f64, period: f64, stride: usize, parts: usize) -> Self {
        let first = Self::new(filter_width / parts as f64, period, stride);
        let left = (filter_width * filter_width - first.filter_width * first.filter_width).sqrt();
        let second = Self::new(left, first.step(), parts);
        Self {
            passes: Some(Box::new(CascadedFilter { first, second })),
            ..Self::new(filter_width, period, stride * parts)
        }
    }

    /// The two passes it is made of, where laws act between them.
    #[must_use]
    pub fn passes(&self) -> Option<&CascadedFilter> {
        self.passes.as_deref()
    }

    /// What laws act behind: the first pass, or all of it.
    #[must_use]
    pub fn first(&self) -> &Self {
        self.passes().map_or(self, |passes| &passes.first)
    }

    /// A Gaussian of `filter_width` seconds over rows of `period` seconds, looked at every `stride` rows.
    #[must_use]
    pub fn new(filter_width: f64, period: f64, stride: usize) -> Self {
        let half_width_rows = (HALF_WIDTH_SIGMAS * filter_width / period).ceil().max(1.0) as usize;
        let kernels = |shift: f64| FilterKernels::new(filter_width / period, half_width_rows, shift, period);
        let (plain, held) = (kernels(0.0), kernels(0.5));
        Self {
            filter_width,
            stride,
            period,
            half_width_rows,
            level: plain.level,
            first_derivative: plain.first_derivative,
            second_derivative: plain.second_derivative,
            jerk: plain.jerk,
            snap: plain.snap,
            crackle: plain.crackle,
            held: held.level,
            held_derivative: held.first_derivative,
            passes: None,
        }
    }

    /// The same filter, every row kept.
    #[must_use]
    pub fn every_row(&self) -> Self {
        Self::new(self.filter_width.max(0.6 * self.period), self.period, 1)
    }

    /// Seconds between two rows of the analysis.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.period * self.stride as f64
    }

    /// -3 dB frequency, Hz.
    #[must_use]
    pub fn cutoff_hz(&self) -> f64 {
        CUTOFF_TIMES_WIDTH / self.filter_width
    }

    /// Rows at either end, or beside a bad one, that the filter spoils.
    #[must_use]
    pub fn half_width_rows(&self) -> usize {
        self.half_width_rows
    }

    /// What white noise of deviation one on the raw rows leaves in level, velocity and acceleration.
    #[must_use]
    pub fn noise(&self) -> [f64; 3] {
        [&self.level, &self.first_derivative, &self.second_derivative]
            .map(|kernel| kernel.iter().map(|tap| tap * tap).sum::<f64>().sqrt())
    }

    /// The smoothed values.
    #[must_use]
    pub fn smooth(&self, values: &[f64]) -> Vec<f64> {
        self.through(&self.level, values)
    }

    /// Their first derivative.
    #[must_use]
    pub fn first_derivative(&self, values: &[f64]) -> Vec<f64> {
        self.through(&self.first_derivative, values)
    }

    /// Their second derivative.
    #[must_use]
    pub fn second_derivative(&self, values: &[f64]) -> Vec<f64> {
        self.through(&self.second_derivative, values)
    }

    /// Their third derivative.
    #[must_use]
    pub fn jerk(&self, values: &[f64]) -> Vec<f64> {
        self.through(&self.jerk, values)
    }

    /// Their fourth derivative.
    #[must_use]
    pub fn snap(&self, values: &[f64]) -> Vec<f64> {
        self.through(&self.snap, values)
    }

    /// Their fifth derivative.
    #[must_use]
    pub fn crackle(&self, values: &[f64]) -> Vec<f64> {
        self.through(&self.crackle, values)
    }

    /// The smoothed course of values that are held from their row to the next.
    #[must_use]
    pub fn smooth_held(&self, values: &[f64]) -> Vec<f64> {
        self.through(&self.held, values)
    }

    /// Its first derivative.
    #[must_use]
    pub fn held_derivative(&self, values: &[f64]) -> Vec<f64> {
        self.through(&self.held_derivative, values)
    }

    fn through(&self, kernel: &[f64], values: &[f64]) -> Vec<f64> {
        let last = values.len() as isize - 1;
        let half_width_rows = self.half_width_rows as isize;
        (0..values.len())
            .step_by(self.stride)
            .map(|at| {
                let from = at as isize - half_width_rows;
                if from >= 0 && at as isize + half_width_rows <= last {
                    let piece = &values[from as usize..from as usize + kernel.len()];
                    return dot(kernel, piece);
                }
                // Beyond the ends the course is taken to go on as its end stands.
                let value = |offset: usize| values[(from + offset as isize).clamp(0, last) as usize];
                kernel.iter().enumerate().map(|(offset, tap)| tap * value(offset)).sum()
            })
            .collect()
    }
}

fn effort_noise(raw: &UniformTrial) -> f64 {
    let rows = raw.effort.as_deref().unwrap_or_default();
    let size = (rows.iter().map(|effort| effort * effort).sum::<f64>() / rows.len().max(1) as f64).sqrt();
    raw.figures.effort.map_or(0.0, |effort| effort.noise).max(0.01 * size)
}

/// Greatest noise of position and force.
fn sensor_noise(uniform_trials: &[UniformTrial]) -> (f64, f64) {
    let noise = |raw: &UniformTrial| (raw.figures.position.noise, raw.figures.force.map_or(0.0, |force| force.noise));
    uniform_trials.iter().map(noise).fold((0.0f64, 0.0f64), |a, b| (a.0.max(b.0), a.1.max(b.1)))
}

/// Taps of the third to the fifth derivative: the bell times the polynomials that are orthogonal, under it, to all lower ones.
/// Hermite's are that only for a bell without an end.
fn higher_derivatives(bell: &[f64], places: &[f64], period: f64) -> [Vec<f64>; 3] {
    let moment = |power: i32| bell.iter().zip(places).map(|(tap, x)| tap * x.powi(power)).sum::<f64>();
    let [none, second, fourth, sixth, eighth] = [0, 2, 4, 6, 8].map(moment);
    let square = (sixth * none - fourth * second) / (fourth * none - second * second);
    let level = (fourth - square * second) / none;
    let cube = (fourth * sixth - second * eighth) / (second * sixth - fourth * fourth);
    let line = -(sixth + cube * fourth) / second;
    let taps = |law: &dyn Fn(f64) -> f64, order: i32| {
        let plain: Vec<f64> = bell.iter().zip(places).map(|(tap, x)| tap * law(*x)).collect();
        let factorial = f64::from((1..=order).product::<i32>());
        let size = plain.iter().zip(places).map(|(tap, x)| tap * x.powi(order)).sum::<f64>() * period.powi(order);
        plain.iter().map(|tap| tap * factorial / size).collect()
    };
    [
        taps(&|x| x.powi(3) - fourth / second * x, 3),
        taps(&|x| x.powi(4) - square * x * x - level, 4),
        taps(&|x| x.powi(5) + cube * x.powi(3) + line * x, 5),
    ]
}

struct FilterKernels {
    level: Vec<f64>,
    first_derivative: Vec<f64>,
    second_derivative: Vec<f64>,
    jerk: Vec<f64>,
    snap: Vec<f64>,
    crackle: Vec<f64>,
}

impl FilterKernels {
    /// Taps for rows -reach..=reach, each of which lies `shift` rows later than its number says. Exact for polynomials,
    /// however coarse the rows: level of 1 and x, slope of x, bend of x^2 come out as they should, jerk, snap and crackle of
    /// all up to x^4, x^5 and x^6 where nothing is shifted.
    fn new(width: f64, half_width_rows: usize, shift: f64, period: f64) -> Self {
        let places: Vec<f64> =
            (0..=2 * half_width_rows).map(|tap| tap as f64 - half_width_rows as f64 + shift).collect();
        let bell: Vec<f64> = places.iter().map(|x| (-0.5 * (x / width).powi(2)).exp()).collect();
        let total: f64 = bell.iter().sum();
        let moment =
            |taps: &[f64], power: i32| taps.iter().zip(&places).map(|(tap, x)| tap * x.powi(power)).sum::<f64>();
        let mean = moment(&bell, 1) / total;
        let level: Vec<f64> = bell.iter().map(|tap| tap / total).collect();
        let odd: Vec<f64> = bell.iter().zip(&places).map(|(tap, x)| tap * (x - mean)).collect();
        let rise = moment(&odd, 1) * period;
        let first_derivative = odd.iter().map(|tap| tap / rise).collect();
        let spread = moment(&level, 2) - mean * mean;
        let even: Vec<f64> = level.iter().zip(&places).map(|(tap, x)| tap * ((x - mean).powi(2) - spread)).collect();
        let curve = 0.5 * moment(&even, 2) * period * period;
        let second_derivative = even.iter().map(|tap| tap / curve).collect();
        // A bell that lies between the rows has its mean a little beside zero: tilted, it has it there.
        let level = level.iter().zip(&places).map(|(tap, x)| tap * (1.0 - mean * (x - mean) / spread)).collect();
        let [jerk, snap, crackle] = higher_derivatives(&bell, &places, period);
        Self { level, first_derivative, second_derivative, jerk, snap, crackle }
    }
}
