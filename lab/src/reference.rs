//! The commanded trajectory: square pulses smoothed twice, and a sine on top (the paper's eq. 15).

use crate::rig::{Contact, Drive, Reference, Rig};

/// Lags after which an edge is over: exp(-60) is below the last bit of anything it is added to.
const SETTLED_LAGS: f64 = 60.0;

/// The paper's bench: to and fro through a soft surface every 30 s, 10 Hz on top.
pub const BENCH: Reference = Reference {
    free_depth: -15e-3,
    contact_depth: 13.5e-3,
    period_s: 30.0,
    contact_s: 15.0,
    smoothing_s: 0.1,
    sine_amplitude: 3.3e-3,
    sine_frequency_hz: 10.0,
};

impl Reference {
    /// Depth and its rate at `time` >= 0.
    ///
    /// r(t) = free + (contact - free) sum_k [S(t - on_k) - S(t - off_k)] + a sin(2 pi f t), where S(u) = 1 - (1 + u/T) exp(-u/T)
    /// is a step behind two lags of time constant T, on_k = (k+1) period - contact and off_k = (k+1) period. At t = 0 the
    /// smoothed square rests at the free depth. Closed form: no state, no step, no error to grow.
    #[must_use]
    pub fn at(&self, time: f64) -> (f64, f64) {
        let (pulse, pulse_rate) = self.pulses(time);
        let travel = self.contact_depth - self.free_depth;
        let turn = std::f64::consts::TAU * self.sine_frequency_hz;
        let (sine, cosine) = (turn * time).sin_cos();
        let depth = self.free_depth + travel * pulse + self.sine_amplitude * sine;
        (depth, travel * pulse_rate + self.sine_amplitude * turn * cosine)
    }

    /// The smoothed square between 0 (free) and 1 (contact), and its rate.
    fn pulses(&self, time: f64) -> (f64, f64) {
        let free = self.period_s - self.contact_s;
        let newest = (time / self.period_s).floor();
        // Older pulses have come and gone: their two edges cancel.
        let oldest = (newest - (SETTLED_LAGS * self.smoothing_s / self.period_s).ceil() - 1.0).max(0.0);
        let (mut sum, mut rate) = (0.0, 0.0);
        let mut number = oldest;
        while number <= newest {
            let start = number * self.period_s;
            let (on, on_rate) = self.step(time - start - free);
            let (off, off_rate) = self.step(time - start - self.period_s);
            sum += on - off;
            rate += on_rate - off_rate;
            number += 1.0;
        }
        (sum, rate)
    }

    fn step(&self, since: f64) -> (f64, f64) {
        if since <= 0.0 {
            return (0.0, 0.0);
        }
        let lags = since / self.smoothing_s;
        let left = (-lags).exp();
        (1.0 - (1.0 + lags) * left, lags * left / self.smoothing_s)
    }
}

/// Whether the bench's millimetres, newtons and gains can make sense for `rig`: linear, 10 g to 100 kg, a stiffness from
/// 1 N/m to 100 kN/m (10 mN to 1.4 kN at the bench's depth), and a trajectory, if it has one, of 1 mm to 1 m.
#[must_use]
pub fn is_bench_sized(rig: &Rig) -> bool {
    let drive = |drive: Drive| (1e-2..=1e2).contains(&drive.inertia);
    let contact = |contact: Contact| (1.0..=1e5).contains(&contact.stiffness);
    let travel = |reference: Reference| (1e-3..=1.0).contains(&(reference.contact_depth - reference.free_depth).abs());
    rig.coordinate == crate::rig::Coordinate::Linear
        && rig.drive.is_none_or(drive)
        && rig.contact.is_none_or(contact)
        && rig.reference.is_none_or(travel)
}
