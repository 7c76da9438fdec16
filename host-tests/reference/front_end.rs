//! The front end by the textbook: bilinear transform with the exact tangent, direct form II transposed.

use super::RegressionRow;
use palpate::Sample;
use std::f64::consts::{PI, SQRT_2};

/// Second-order Butterworth coefficients; the leading denominator is one.
#[derive(Debug, Clone, Copy)]
struct Butterworth {
    b: [f64; 3],
    a: [f64; 2],
}

impl Butterworth {
    fn new(cutoff: f64, period: f64) -> Self {
        let w = (PI * cutoff * period).tan();
        let scale = 1.0 / (1.0 + SQRT_2 * w + w * w);
        let gain = w * w * scale;
        Self { b: [gain, 2.0 * gain, gain], a: [2.0 * (w * w - 1.0) * scale, (1.0 - SQRT_2 * w + w * w) * scale] }
    }

    fn filter(&self, memory: &mut [f64; 2], input: f64) -> f64 {
        let output = self.b[0] * input + memory[0];
        memory[0] = self.b[1] * input - self.a[0] * output + memory[1];
        memory[1] = self.b[2] * input - self.a[1] * output;
        output
    }

    /// The memory of a filter that has rested at `value` for ever.
    fn rest(&self, value: f64) -> [f64; 2] {
        let second = (self.b[2] - self.a[1]) * value;
        [(self.b[1] - self.a[0]) * value + second, second]
    }
}

/// Penetration, rate and force from positions and forces at a steady period; the contact is for others to judge.
#[derive(Debug, Clone)]
pub struct FrontEnd {
    filter: Butterworth,
    period: f64,
    surface: f64,
    matched: bool,
    memories: [[f64; 2]; 3],
    before: Option<Reading>,
    fresh: bool,
}

#[derive(Debug, Clone, Copy)]
struct Reading {
    position: f64,
    depth: f64,
    force: f64,
}

impl FrontEnd {
    pub fn new(config: &palpate::FrontEndConfig) -> Self {
        let period = f64::from(config.period);
        Self {
            filter: Butterworth::new(config.cutoff.into(), period),
            period,
            surface: config.surface.into(),
            matched: config.velocity == palpate::Velocity::Matched,
            memories: [[0.0; 2]; 3],
            before: None,
            fresh: true,
        }
    }

    /// One sample, in SI.
    pub fn update(&mut self, sample: &Sample) -> RegressionRow {
        let position = f64::from(sample.position) - self.surface;
        let (depth, force) = (position.max(0.0), f64::from(sample.force));
        let filter = self.filter;
        let Some(before) = self.before.replace(Reading { position, depth, force }) else {
            return RegressionRow { x: depth, v: 0.0, force };
        };
        let way = if self.matched { depth - before.depth } else { position - before.position };
        let inputs = [0.5 * (depth + before.depth), way / self.period, 0.5 * (force + before.force)];
        if std::mem::take(&mut self.fresh) {
            self.memories = inputs.map(|value| filter.rest(value));
        }
        let [mut x, mut v, mut f] = [0.0; 3];
        for ((output, memory), input) in [&mut x, &mut v, &mut f].into_iter().zip(&mut self.memories).zip(inputs) {
            *output = filter.filter(memory, input);
        }
        if self.matched { RegressionRow { x, v, force: f } } else { RegressionRow { x: depth, v, force } }
    }
}
