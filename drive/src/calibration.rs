//! Calibration: conversion of counts to metres and newtons, stored in flash with a version and a CRC.

use serde::{Deserialize, Serialize};

use crate::ads8681::Range;
use crate::as5047p;
use crate::{CRC, TICK_HZ};
use palpate::error::{ConfigError, require, require_not_negative, require_positive};

/// What measures the position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum PositionSensor {
    /// The magnetic encoder: absolute within the one turn that `centre` is the middle of.
    As5047p,
    /// A quadrature encoder on a timer: relative, zero at power-on, over any number of turns.
    Quadrature,
}

/// A calibration. Lengths are metres and forces newtons, or radians and newton metres on a rotary joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// When it was made, as 20261121.
    pub date: u32,
    /// What measures the position.
    pub position_sensor: PositionSensor,
    /// Counts of a turn of the encoder: 16384, or four times the lines of a quadrature encoder.
    pub counts_per_turn: u32,
    /// The transmission: way of the tool in a turn of the encoder, negative where they run against each other, m.
    pub travel_per_turn: f32,
    /// Reading of the absolute encoder in the middle of the travel, so that the travel does not cross its seam.
    pub centre: u16,
    /// Counts from `centre` (from power-on with a quadrature encoder) at which contact begins.
    pub surface: i32,
    /// Positions that can be, from the surface, m: first and last.
    pub travel: [f32; 2],
    /// Fastest way the tool can go [m/s].
    pub max_speed: f32,
    /// Force of one count, negative where a push lowers the count, N.
    pub force_gain: f32,
    /// Counts of the converter without any force, from zero volt.
    pub force_zero: f32,
    /// Largest force that the sensor is calibrated for, N.
    pub force_limit: f32,
    /// Standard deviation of the measured force, the converter's rounding included, N.
    pub force_noise: f32,
    /// Furthest that a tare may move the zero, N.
    pub tare_limit: f32,
    /// Span of the converter's input.
    pub range: Range,
    /// Ticks of one and the same reading after which position and force are stuck; 0: never.
    pub stuck_after: [u16; 2],
}

/// Bytes of an encoded calibration at most.
pub const CALIBRATION_BYTES: usize = 128;

/// Why a block is no calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CalibrationFault {
    /// It does not begin as one: flash that was never written, say.
    Absent,
    /// It is of another version: this one was found.
    Version(u16),
    /// Its length or CRC is wrong.
    Damaged,
    /// It is whole, and a value is out of range.
    OutOfRange(ConfigError),
}

const MAGIC: [u8; 4] = *b"PALP";
const VERSION: u16 = 1;
const HEADER: usize = 8;
const CHECK: usize = 4;

impl Calibration {
    /// What is used where there is none: a slow actuator and a small force sensor, in units that mean nothing.
    pub const DEFAULT: Self = Self {
        date: 0,
        position_sensor: PositionSensor::As5047p,
        counts_per_turn: as5047p::COUNTS as u32,
        travel_per_turn: 0.08,
        centre: as5047p::COUNTS / 2,
        surface: 0,
        travel: [-0.04, 0.04],
        max_speed: 2.0,
        force_gain: 1e-3,
        force_zero: 0.0,
        force_limit: 32.0,
        force_noise: 0.01,
        tare_limit: 5.0,
        range: Range::Volts5,
        stuck_after: [2_000, 500],
    };

    /// Reads the block at the beginning of `bytes`, whatever they are:
    /// `PALP`, version and length (u16), the values by postcard, CRC-32 of all before it; little-endian.
    ///
    /// # Errors
    /// Why there is none.
    pub fn read(bytes: &[u8]) -> Result<Self, CalibrationFault> {
        let (header, rest) = bytes.split_first_chunk::<HEADER>().ok_or(CalibrationFault::Absent)?;
        let [m0, m1, m2, m3, v0, v1, l0, l1] = *header;
        if [m0, m1, m2, m3] != MAGIC {
            return Err(CalibrationFault::Absent);
        }
        let version = u16::from_le_bytes([v0, v1]);
        if version != VERSION {
            return Err(CalibrationFault::Version(version));
        }
        let length = usize::from(u16::from_le_bytes([l0, l1]));
        let whole = rest.get(..length).zip(rest.get(length..).and_then(|rest| rest.first_chunk::<CHECK>()));
        let (values, check) = whole.filter(|_| length <= CALIBRATION_BYTES).ok_or(CalibrationFault::Damaged)?;
        let mut digest = CRC.digest();
        digest.update(header);
        digest.update(values);
        if digest.finalize() != u32::from_le_bytes(*check) {
            return Err(CalibrationFault::Damaged);
        }
        let (found, left) = postcard::take_from_bytes::<Self>(values).map_err(|_| CalibrationFault::Damaged)?;
        if !left.is_empty() {
            return Err(CalibrationFault::Damaged);
        }
        found.check().map_err(CalibrationFault::OutOfRange)?;
        Ok(found)
    }

    /// The block of this calibration; `None` where `buffer` is too short.
    pub fn write<'a>(&self, buffer: &'a mut [u8; CALIBRATION_BYTES]) -> Option<&'a [u8]> {
        let (header, rest) = buffer.split_first_chunk_mut::<HEADER>()?;
        let length = postcard::to_slice(self, rest).ok()?.len();
        let [v0, v1] = VERSION.to_le_bytes();
        let [l0, l1] = u16::try_from(length).ok()?.to_le_bytes();
        let [m0, m1, m2, m3] = MAGIC;
        *header = [m0, m1, m2, m3, v0, v1, l0, l1];
        let end = HEADER + length;
        let check = CRC.checksum(buffer.get(..end)?).to_le_bytes();
        buffer.get_mut(end..end + CHECK)?.copy_from_slice(&check);
        buffer.get(..end + CHECK)
    }

    /// Whether every value can be.
    ///
    /// # Errors
    /// The first that cannot.
    pub fn check(&self) -> Result<(), ConfigError> {
        let a_count = "counts that a machine can have";
        require((16..=1 << 24).contains(&self.counts_per_turn), "counts_per_turn", "16 to 16777216")?;
        if self.position_sensor == PositionSensor::As5047p {
            let counts = u32::from(as5047p::COUNTS);
            require(self.counts_per_turn == counts, "counts_per_turn", "16384 with an AS5047P")?;
        }
        require((1e-7..=1e3).contains(&self.travel_per_turn.abs()), "travel_per_turn", "1e-7 to 1000, of either sign")?;
        require(self.centre < as5047p::COUNTS, "centre", "a reading of 14 bits")?;
        require(self.surface.abs() <= 1 << 23, "surface", a_count)?;
        let [first, last] = self.travel;
        require(first.is_finite() && last.is_finite() && first < last, "travel", "first before last")?;
        require_positive(self.max_speed, "max_speed")?;
        require((1e-9..=1e3).contains(&self.force_gain.abs()), "force_gain", "1e-9 to 1000, of either sign")?;
        require(self.force_zero.abs() <= 32_768.0, "force_zero", a_count)?;
        require_positive(self.force_limit, "force_limit")?;
        require_positive(self.force_noise, "force_noise")?;
        require_not_negative(self.tare_limit, "tare_limit")
    }

    /// Way of the tool in one count of the encoder, signed, m.
    pub fn position_per_count(&self) -> f32 {
        self.travel_per_turn / self.counts_per_turn as f32
    }

    /// Most counts that the encoder can go in a tick, and some for its noise.
    pub(super) fn step(&self) -> i32 {
        const NOISE: i32 = 16;
        let counts = self.max_speed / (self.position_per_count().abs() * f32::from(TICK_HZ));
        // A cast saturates.
        (counts as i32).saturating_add(NOISE)
    }

    /// Counts from the surface, of a reading of the absolute encoder.
    pub fn depth_of(&self, angle: u16) -> i32 {
        // Shifted up so that 14 bits wrap as 16 do.
        let way = (angle.wrapping_sub(self.centre) << 2).cast_signed() >> 2;
        i32::from(way) - self.surface
    }

    /// The reading of the absolute encoder `depth` counts from the surface.
    pub fn angle_of(&self, depth: i32) -> u16 {
        (depth.wrapping_add(self.surface).wrapping_add(i32::from(self.centre)) & 0x3fff) as u16
    }

    /// The scale, with the zero of the calibration.
    pub fn scale(&self) -> Scale {
        Scale { position: self.position_per_count(), force: self.force_gain, zero: self.force_zero }
    }
}

/// Counts to SI, by single-precision multiplications that a host repeats to the bit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Scale {
    /// Of one count of the encoder, m.
    pub position: f32,
    /// Of one count of the converter, N.
    pub force: f32,
    /// Counts without force.
    pub zero: f32,
}

impl Scale {
    /// Position from the surface, m.
    pub fn position(&self, depth: i32) -> f32 {
        depth as f32 * self.position
    }

    /// Force, N.
    pub fn force(&self, code: i32) -> f32 {
        (code as f32 - self.zero) * self.force
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_is_counted_from_its_zero() {
        let scale = Scale { position: 0.5, force: 0.25, zero: 100.0 };
        assert_eq!([scale.force(100), scale.force(104), scale.force(-100)], [0.0, 1.0, -50.0]);
        assert_eq!([scale.position(0), scale.position(-3)], [0.0, -1.5]);
    }

    #[test]
    fn a_surface_and_a_travel_are_accepted_up_to_their_limits() {
        let (d, far) = (Calibration::DEFAULT, 1 << 23);
        let accepted = |calibration: Calibration| calibration.check().is_ok();
        assert!([far, -far].into_iter().all(|surface| accepted(Calibration { surface, ..d })));
        assert!([far + 1, -far - 1].into_iter().all(|surface| !accepted(Calibration { surface, ..d })));
        let travels = [[0.0, 0.0], [f32::NEG_INFINITY, 0.0], [0.0, f32::INFINITY], [0.1, 0.0]];
        assert!(travels.into_iter().all(|travel| !accepted(Calibration { travel, ..d })));
        assert!(accepted(Calibration { travel: [0.0, 1e-6], ..d }));
    }
}
