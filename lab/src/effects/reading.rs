//! The force sensor over a whole trial, as effects see it and change it.

use super::first_order_lag::lagged;

/// What the force sensor shows, sample by sample at equal steps.
#[derive(Debug)]
pub struct Reading<'a> {
    /// Seconds of the first sample since the trial began.
    pub start: f64,
    /// Seconds from one sample to the next.
    pub step: f64,
    /// Width of the smoothing filter that what the sensor adds has passed, s: standard deviation; zero in a simulation.
    pub filter_width: f64,
    /// Position of the tool, m or rad.
    pub position: &'a [f64],
    /// Velocity of the tool.
    pub velocity: &'a [f64],
    /// Acceleration of the tool.
    pub acceleration: &'a [f64],
    /// In: the force at the sensor. Out: its reading.
    pub force: &'a mut [f64],
}

impl Reading<'_> {
    /// The force `lag` seconds earlier, by the polynomial through the six samples around that instant; the first sample
    /// before the trial.
    pub fn delay(&mut self, lag: f64) {
        let back = lag / self.step;
        let whole = back.floor();
        let part = back - whole;
        // Lagrange's weights of the samples 2 later to 3 earlier than the whole lag: at a fifth of the rate they keep a
        // wave to two thousandths, where a cubic loses two hundredths.
        let nodes = [-2.0, -1.0, 0.0, 1.0, 2.0, 3.0];
        let weight = |i: usize| -> f64 {
            let others = nodes.iter().enumerate().filter(|(j, _)| *j != i);
            others.map(|(_, node)| (part - node) / (nodes[i] - node)).product()
        };
        let weights: [f64; 6] = std::array::from_fn(weight);
        let source = self.force.to_vec();
        let last = source.len() as isize - 1;
        for (at, force) in self.force.iter_mut().enumerate() {
            let at = at as isize - whole as isize;
            let pick = |node: f64| source[(at - node as isize).max(0).min(last) as usize];
            *force = nodes.iter().zip(weights).map(|(node, weight)| weight * pick(*node)).sum();
        }
    }

    /// A first-order low-pass of time constant `lag`, exact for a force that is straight between samples.
    pub fn low_pass(&mut self, lag: f64) {
        if lag <= 0.0 || self.force.is_empty() {
            return;
        }
        let ratio = self.step / lag;
        let mut state = self.force[0];
        let mut before = state;
        for force in &mut self.force[1..] {
            state = lagged(state, [before, *force], ratio);
            before = std::mem::replace(force, state);
        }
    }

    /// What the smoothing filter leaves of a sine of that frequency that the sensor adds.
    #[must_use]
    pub fn passes(&self, frequency: f64) -> f64 {
        (-0.5 * (std::f64::consts::TAU * frequency * self.filter_width).powi(2)).exp()
    }
}
