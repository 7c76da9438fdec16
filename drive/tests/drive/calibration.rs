//! The calibration in flash: whole, or refused.

use palpate_drive::{CALIBRATION_BYTES, Calibration, CalibrationFault, PositionSensor};

use super::link::{Random, fuzz_count};

fn block() -> Vec<u8> {
    let mut buffer = [0; CALIBRATION_BYTES];
    Calibration::DEFAULT.write(&mut buffer).expect("room").to_vec()
}

#[test]
fn what_was_written_is_read_and_what_stands_behind_it_does_not_matter() {
    let mut flash = block();
    assert_eq!(Calibration::read(&flash), Ok(Calibration::DEFAULT));
    flash.resize(256, 0xff);
    assert_eq!(Calibration::read(&flash), Ok(Calibration::DEFAULT));
    let other =
        Calibration { position_sensor: PositionSensor::Quadrature, counts_per_turn: 4096, ..Calibration::DEFAULT };
    let mut buffer = [0; CALIBRATION_BYTES];
    assert_eq!(Calibration::read(other.write(&mut buffer).expect("room")), Ok(other));
}

#[test]
fn every_single_bit_that_tips_is_found() {
    let whole = block();
    for bit in 0..8 * whole.len() {
        let mut damaged = whole.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert!(Calibration::read(&damaged).is_err(), "bit {bit}");
    }
    for length in 0..whole.len() {
        assert!(Calibration::read(&whole[..length]).is_err(), "cut to {length}");
    }
}

#[test]
fn flash_without_a_calibration_has_none_and_another_version_is_named() {
    for empty in [[0xff; 256], [0x00; 256]] {
        assert_eq!(Calibration::read(&empty), Err(CalibrationFault::Absent));
    }
    let mut next = block();
    next[4] = 2;
    assert_eq!(Calibration::read(&next), Err(CalibrationFault::Version(2)));
}

#[test]
fn a_whole_block_of_values_that_cannot_be_is_refused() {
    let d = Calibration::DEFAULT;
    for wrong in [
        Calibration { travel_per_turn: 0.0, ..d },
        Calibration { travel_per_turn: f32::NAN, ..d },
        Calibration { counts_per_turn: 0, ..d },
        Calibration { counts_per_turn: 4096, ..d },
        Calibration { centre: 1 << 14, ..d },
        Calibration { surface: i32::MIN + 1, ..d },
        Calibration { travel: [0.1, -0.1], ..d },
        Calibration { travel: [f32::NAN, 0.1], ..d },
        Calibration { max_speed: f32::INFINITY, ..d },
        Calibration { force_gain: 0.0, ..d },
        Calibration { force_zero: f32::NAN, ..d },
        Calibration { force_limit: -1.0, ..d },
        Calibration { force_noise: 0.0, ..d },
        Calibration { tare_limit: f32::NAN, ..d },
    ] {
        let mut buffer = [0; CALIBRATION_BYTES];
        let read = Calibration::read(wrong.write(&mut buffer).expect("room"));
        assert!(matches!(read, Err(CalibrationFault::OutOfRange(_))), "{wrong:?}: {read:?}");
    }
}

/// A block whose values are upset, with the length and CRC that they then have.
fn resealed(whole: &[u8], random: &mut Random) -> Vec<u8> {
    let values = random.damaged(&whole[8..whole.len() - 4]);
    let length = u16::try_from(values.len()).expect("short").to_le_bytes();
    let mut block = [&whole[..6], &length, &values].concat();
    let check = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&block);
    block.extend(check.to_le_bytes());
    block
}

/// `PALPATE_FUZZ=10000000 cargo test -p palpate --test host -- fuzz --nocapture` for ten million.
#[test]
fn fuzz_whatever_stands_in_flash_the_reader_returns_and_takes_nothing_that_cannot_be() {
    let (mut random, whole) = (Random::new(7), block());
    let count = fuzz_count();
    let mut taken = 0_u64;
    for k in 0..count {
        // Every other time the damage is done before the CRC is taken, so that it reaches the values.
        let bytes = if k % 2 == 0 { random.damaged(&whole) } else { resealed(&whole, &mut random) };
        if let Ok(found) = Calibration::read(&bytes) {
            found.check().expect("values that can be");
            taken += 1;
        }
    }
    eprintln!("{count} blocks, {taken} taken");
    assert!(taken > 0 && taken < count / 2, "{taken} of {count}: some are whole, most are not");
}
