//! One smoothing filter for every channel.
//!
//! Every channel passes the same Gaussian, so that a linear law between them stays what it was. Velocity and
//! acceleration are its derivatives: x, v, a, F and effort are all smoothed by exactly the same filter.

use crate::diagnose::linalg::dot;
use crate::diagnose::thresholds::derivative_filter::HALF_WIDTH_SIGMAS;

/// The filter and the clock of the analysis.
#[derive(Debug, Clone)]
pub struct DerivativeFilter {
    /// Raw rows a row of the analysis.
    pub stride: usize,
    /// Seconds of a raw row.
    pub period: f64,
    /// Half the support of the filter, rows.
    half_width_rows: usize,
    level: Vec<f64>,
    first_derivative: Vec<f64>,
    second_derivative: Vec<f64>,
    held: Vec<f64>,
}

impl DerivativeFilter {
    /// A Gaussian of `filter_width` seconds over rows of `period` seconds, evaluated every `stride` rows.
    #[must_use]
    pub fn new(filter_width: f64, period: f64, stride: usize) -> Self {
        let half_width_rows = (HALF_WIDTH_SIGMAS * filter_width / period).value().ceil().max(1.0) as usize;
        let kernels = |shift: f64| FilterKernels::new(filter_width / period, half_width_rows, shift, period);
        let (plain, held) = (kernels(0.0), kernels(0.5));
        Self {
            stride,
            period,
            half_width_rows,
            level: plain.level,
            first_derivative: plain.first_derivative,
            second_derivative: plain.second_derivative,
            held: held.level,
        }
    }

    /// Seconds between two rows of the analysis.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.period * self.stride as f64
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

    /// The smoothed course of values that are held from their row to the next.
    #[must_use]
    pub fn smooth_held(&self, values: &[f64]) -> Vec<f64> {
        self.through(&self.held, values)
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

struct FilterKernels {
    level: Vec<f64>,
    first_derivative: Vec<f64>,
    second_derivative: Vec<f64>,
}

impl FilterKernels {
    /// Taps for rows -reach..=reach, each of which lies `shift` rows later than its number says. Exact for polynomials,
    /// however coarse the rows: the level of 1 and x, the first derivative of x and the second of x^2 come out as they should.
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
        Self { level, first_derivative, second_derivative }
    }
}
