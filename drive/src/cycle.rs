//! One tick of the control interrupt: from the raw words of the sensors to a report.

use serde::{Deserialize, Serialize};

use crate::calibration::{Calibration, PositionSensor, Scale};
use crate::channel::PlausibilityMonitor;
use crate::counters::Counters;
use crate::effort::{Bounds, effort, trusted};
use crate::estimator::{Estimator, ValidatedSettings};
use crate::faults::Faults;
use crate::input::{Input, InputStatus};
use crate::quadrature::Quadrature;
use crate::tare::Tare;
use crate::{TICK_HZ, ads8681, as5047p};
use palpate::Estimate;
use palpate::Flags;
use palpate::Sample;

/// Which sample an estimate is based on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Validity {
    /// This tick's sample.
    Live,
    /// An earlier sample, no longer ago than the hold time.
    Held,
    /// No sample: K and B are zero and their intervals infinite.
    Void,
}

/// A command to the interrupt; one is carried out per tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Order {
    /// Zero the force sensor: the present force is defined as zero. Refused in contact, and beyond the calibration's `tare_limit`.
    Tare,
    /// Reset the estimator.
    Restart,
    /// Clear the latched faults.
    Acknowledge,
}

/// The result of a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// Ticks since the start; it wraps.
    pub tick: u32,
    /// The input of the tick.
    pub input: Input,
    /// The sample that the estimator was given, if any.
    pub sample: Option<Sample>,
    /// Every fault that holds, or held within the last ten to twenty ticks.
    pub faults: Faults,
    /// Which sample the estimate is based on.
    pub validity: Validity,
    /// The estimator was reset at this sample.
    pub restarted: bool,
    /// Revision of the settings.
    pub revision: u8,
    /// The estimate.
    pub estimate: Estimate,
    /// CountersMessage of the force sensor without force, as it is now.
    pub zero: f32,
    /// For the current loop [N or N m].
    pub effort: f32,
}

/// The control cycle with its state.
#[derive(Debug)]
pub struct Cycle<'a> {
    calibration: Calibration,
    scale: Scale,
    step: i32,
    bounds: Bounds,
    estimator: &'a mut Estimator,
    counters: &'a Counters,
    quadrature: Quadrature,
    position: PlausibilityMonitor,
    force: PlausibilityMonitor,
    tare: Option<Tare>,
    /// Faults that stay until acknowledged, or for good.
    lasting: Faults,
    /// Faults of the present stretch of [`Faults::LINGER`] ticks and of the one before, and how far the present one is.
    present: Faults,
    before: Faults,
    stretch: u8,
    tick: u32,
    /// Ticks since the estimator was last given a sample, and since an estimate was live.
    owed: u16,
    held: u16,
    stale: bool,
    last: Estimate,
}

/// Counts that the sensors mean.
#[derive(Debug, Clone, Copy)]
struct Counts {
    depth: i32,
    code: i32,
}

impl<'a> Cycle<'a> {
    /// Starts with `found`, the faults present at power-on.
    pub fn new(
        calibration: Calibration,
        estimator: &'a mut Estimator,
        counters: &'a Counters,
        bounds: Bounds,
        found: Faults,
    ) -> Self {
        Self {
            scale: calibration.scale(),
            step: calibration.step(),
            calibration,
            bounds,
            estimator,
            counters,
            quadrature: Quadrature::default(),
            position: PlausibilityMonitor::default(),
            force: PlausibilityMonitor::default(),
            tare: None,
            lasting: found & Faults::LATCHED.union(Faults::STANDING),
            present: Faults::empty(),
            before: Faults::empty(),
            stretch: 0,
            tick: 0,
            owed: 0,
            held: u16::MAX,
            stale: true,
            last: Estimate::UNKNOWN,
        }
    }

    /// One tick: bounded work, no allocation, no panic.
    pub fn tick(&mut self, input: Input) -> Report {
        let elapsed = input.elapsed.max(1);
        self.tick = self.tick.wrapping_add(u32::from(elapsed));
        self.owed = self.owed.saturating_add(u16::from(elapsed));
        self.held = self.held.saturating_add(u16::from(elapsed));
        let mut faults = input.faults();
        let counts = self.read(&input, elapsed, &mut faults);
        let sample = counts.map(|counts| self.sample(counts));
        let restarted = sample.is_some() && core::mem::take(&mut self.stale);
        if restarted {
            self.restart();
        }
        let estimate = sample.and_then(|sample| self.identify(sample, &mut faults));
        self.publish(input, sample, restarted, estimate, faults)
    }

    /// Carries out a command.
    pub fn order(&mut self, order: Order) {
        match order {
            Order::Tare => self.tare = Some(Tare::default()),
            Order::Restart => self.stale = true,
            Order::Acknowledge => self.lasting.remove(Faults::LATCHED),
        }
    }

    /// Replaces the settings and resets the estimator.
    pub fn apply(&mut self, settings: &ValidatedSettings) {
        self.estimator.apply(settings);
        self.stale = true;
    }

    /// The scale at present: a tare moves its zero.
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// The decoded sensor counts, if no fault of this tick invalidates them.
    fn read(&mut self, input: &Input, elapsed: u8, faults: &mut Faults) -> Option<Counts> {
        let depth = self.read_position(input, elapsed, faults);
        let code = self.read_force(input, elapsed, faults);
        let believed = !faults.intersects(Faults::all().difference(Faults::HARMLESS.union(Faults::SAMPLE_LOST)));
        let counts = depth.zip(code).filter(|_| believed).map(|(depth, code)| Counts { depth, code })?;
        self.go_on_taring(counts.code);
        Some(counts)
    }

    fn read_position(&mut self, input: &Input, elapsed: u8, faults: &mut Faults) -> Option<i32> {
        let absent = input.status.intersects(InputStatus::NO_SAMPLE.union(InputStatus::NO_POSITION));
        let depth = match self.calibration.position_sensor {
            _ if absent => None,
            PositionSensor::As5047p => match as5047p::angle(input.angle, input.diagnostics) {
                Ok(angle) => Some(self.calibration.depth_of(angle)),
                Err(fault) => {
                    faults.insert(fault);
                    None
                }
            },
            PositionSensor::Quadrature => {
                Some(self.quadrature.update(input.angle).saturating_sub(self.calibration.surface))
            }
        };
        let Some(depth) = depth else {
            self.position.miss(elapsed);
            return None;
        };
        let [stuck_after, _] = self.calibration.stuck_after;
        let doubts = self.position.take(depth, elapsed, stuck_after, self.step);
        let [first, last] = self.calibration.travel;
        let position = self.scale.position(depth);
        faults.set(Faults::POSITION_STUCK, doubts.stuck);
        faults.set(Faults::POSITION_JUMP, doubts.jumped);
        faults.set(Faults::POSITION_RANGE, !(first..=last).contains(&position));
        self.stale |= doubts.jumped;
        Some(depth)
    }

    fn read_force(&mut self, input: &Input, elapsed: u8, faults: &mut Faults) -> Option<i32> {
        if input.status.intersects(InputStatus::NO_SAMPLE.union(InputStatus::NO_FORCE)) {
            self.force.miss(elapsed);
            return None;
        }
        match ads8681::code(input.force, self.calibration.range) {
            Ok(code) => {
                let [_, stuck_after] = self.calibration.stuck_after;
                let doubts = self.force.take(code, elapsed, stuck_after, i32::MAX);
                faults.set(Faults::FORCE_STUCK, doubts.stuck);
                let force = self.scale.force(code);
                faults.set(Faults::FORCE_RANGE, force.abs() > self.calibration.force_limit);
                Some(code)
            }
            Err(fault) => {
                self.force.miss(elapsed);
                faults.insert(fault);
                None
            }
        }
    }

    /// In SI, with the time since the last sample that the estimator was given.
    fn sample(&mut self, counts: Counts) -> Sample {
        let elapsed = f32::from(self.owed) / f32::from(TICK_HZ);
        self.owed = 0;
        Sample { position: self.scale.position(counts.depth), force: self.scale.force(counts.code), elapsed }
    }

    fn identify(&mut self, sample: Sample, faults: &mut Faults) -> Option<Estimate> {
        let estimate = self.estimator.update(sample);
        faults.set(Faults::REJECTED, estimate.is_err());
        let estimate = estimate.ok()?;
        self.last = estimate;
        self.held = 0;
        Some(estimate)
    }

    fn restart(&mut self) {
        self.estimator.restart();
        self.counters.restart();
    }

    /// Takes a reading into the tare in progress, if there is one. A force of contact is no zero: a tare during which the tool touches is
    /// refused, and with it one that was ordered while the sensors were silent and is carried out in contact.
    fn go_on_taring(&mut self, code: i32) {
        let Some(tare) = self.tare.as_mut() else { return };
        if !self.stale && !self.last.flags.contains(Flags::NO_CONTACT) {
            self.tare = None;
            self.counters.refused_tare();
        } else if let Some(zero) = tare.take(code) {
            self.tare = None;
            self.set_zero(zero);
        }
    }

    fn set_zero(&mut self, zero: f32) {
        let moved = (zero - self.calibration.force_zero) * self.calibration.force_gain;
        if moved.abs() <= self.calibration.tare_limit {
            self.scale.zero = zero;
        } else {
            self.counters.refused_tare();
        }
    }

    fn publish(
        &mut self,
        input: Input,
        sample: Option<Sample>,
        restarted: bool,
        live: Option<Estimate>,
        now: Faults,
    ) -> Report {
        self.counters.tick(now, live.is_some());
        let faults = self.remember(now);
        let (validity, estimate) = match live {
            Some(estimate) => (Validity::Live, estimate),
            None if self.held <= self.estimator.hold() => {
                (Validity::Held, Estimate { flags: self.last.flags | Flags::HELD, ..self.last })
            }
            None => {
                self.stale = true;
                (Validity::Void, Estimate::UNKNOWN)
            }
        };
        let contact = trusted(&estimate, validity, faults, &self.bounds);
        Report {
            tick: self.tick,
            input,
            sample: sample.filter(|_| live.is_some()),
            faults,
            validity,
            restarted,
            revision: self.estimator.revision(),
            estimate,
            zero: self.scale.zero,
            // Place for a force controller: it receives an impedance only while there is no fault.
            effort: effort(contact, sample, &self.bounds, |_, _| 0.0),
        }
    }

    /// All faults that hold: those of now, those of this stretch of ticks and the one before, those that last.
    fn remember(&mut self, now: Faults) -> Faults {
        self.stretch += 1;
        if self.stretch >= Faults::LINGER {
            self.stretch = 0;
            self.before = core::mem::take(&mut self.present);
        }
        self.present |= now.difference(Faults::CONDITIONS);
        now | self.present | self.before | self.lasting
    }
}
