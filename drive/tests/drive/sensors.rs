//! Drivers against frames of their data sheets.

use embedded_hal::spi::{ErrorKind, Operation, SpiDevice};
use embedded_hal_mock::eh1::delay::{CheckedDelay, NoopDelay, Transaction as Wait};
use embedded_hal_mock::eh1::digital::{Mock as Pin, State, Transaction as Level};
use embedded_hal_mock::eh1::spi::{Mock as Spi, Transaction as Frame};
use embedded_hal_nb::nb;
use embedded_hal_nb::spi::FullDuplex;
use palpate_drive::ads8681::{self, Ads8681, Range, SetUpFault};
use palpate_drive::as5047p::{self, As5047p};
use palpate_drive::{BoundedSpi, BusFault, Calibration, Faults, Quadrature};

/// One frame with the select line low: what goes out, what comes in.
fn frame(out: &[u8], back: &[u8]) -> [Frame<u8>; 3] {
    [Frame::transaction_start(), Frame::transfer_in_place(out.to_vec(), back.to_vec()), Frame::transaction_end()]
}

/// Frames of the encoder: the select line is low for a while before the first clock.
fn angles(pairs: &[(&[u8], &[u8])]) -> Spi<u8> {
    let all: Vec<_> = pairs
        .iter()
        .flat_map(|(out, back)| {
            let [start, words, end] = frame(out, back);
            [start, Frame::delay(350), words, end]
        })
        .collect();
    Spi::new(&all)
}

fn frames(pairs: &[(&[u8], &[u8])]) -> Spi<u8> {
    let all: Vec<_> = pairs.iter().flat_map(|(out, back)| frame(out, back)).collect();
    Spi::new(&all)
}

#[test]
fn the_commands_of_the_encoder_are_those_that_other_drivers_send() {
    // 0xFFFF reads ANGLECOM in the firmware of ODrive and SimpleFOC; 0x3FFC and 0x0001 with the read bit and their parity.
    assert_eq!(
        [as5047p::READ_ANGLE, as5047p::READ_DIAGNOSTICS, as5047p::READ_ERRORS],
        [0xffff, 0x7ffc | 0x8000, 0x4001]
    );
    for word in 0..=u16::MAX {
        assert_eq!(as5047p::with_parity(word).count_ones() % 2, 0, "{word:#x}");
    }
}

#[test]
fn a_tick_brings_angle_and_diagnostics_in_two_frames_with_the_pause_between() {
    // The first frame brings what the tick before asked for last, the second the angle.
    let mut spi = angles(&[(&[0xff, 0xff], &[0x01, 0x80]), (&[0xff, 0xfc], &[0x12, 0x34])]);
    let mut delay = CheckedDelay::new(&[Wait::delay_ns(350), Wait::delay_ns(350)]);
    let mut encoder = As5047p::new(spi.clone(), delay.clone());
    let (angle, diagnostics) = encoder.read().expect("a bus");
    assert_eq!((angle, diagnostics), (0x1234, 0x0180));
    // 0x1234 has five ones: a bit was lost on the way. With the bit that was meant it is an angle.
    assert_eq!(as5047p::angle(angle, diagnostics), Err(Faults::POSITION_PARITY));
    assert_eq!(as5047p::angle(angle | 0x8000, diagnostics), Ok(0x1234), "LF set, gain 0x80");
    spi.done();
    delay.done();
}

#[test]
fn after_a_complaint_the_encoder_is_asked_for_its_errors_which_clears_them() {
    let complaint = as5047p::with_parity(0x4000 | 0x0123).to_be_bytes();
    let sound = as5047p::with_parity(0x0180).to_be_bytes();
    let mut spi = angles(&[
        (&[0xff, 0xff], &sound),
        (&[0xff, 0xfc], &complaint),
        (&[0xff, 0xff], &sound),
        (&[0x40, 0x01], &[0x01, 0x23]),
        (&[0xff, 0xff], &[0x00, 0x03]),
        (&[0xff, 0xfc], &[0x01, 0x23]),
    ]);
    let mut encoder = As5047p::new(spi.clone(), NoopDelay::new());
    let read = [(); 3].map(|()| encoder.read().expect("a bus"));
    assert_eq!(as5047p::angle(read[0].0, read[0].1), Err(Faults::POSITION_ALARM));
    // What ERRFL answered is no diagnostics: its LF bit is clear, so the tick is a fault and no angle.
    assert_eq!(as5047p::angle(read[2].0, read[2].1), Err(Faults::POSITION_ALARM));
    spi.done();
}

#[test]
fn a_complaint_in_both_words_is_a_complaint() {
    let complaint = as5047p::with_parity(0x4000 | 0x0123).to_be_bytes();
    let mut spi = angles(&[
        (&[0xff, 0xff], &complaint),
        (&[0xff, 0xfc], &complaint),
        (&[0xff, 0xff], &[0x00, 0x03]),
        (&[0x40, 0x01], &[0x01, 0x23]),
    ]);
    let mut encoder = As5047p::new(spi.clone(), NoopDelay::new());
    assert!((0..2).all(|_| encoder.read().is_ok()));
    spi.done();
}

#[test]
fn every_state_of_the_encoder_that_is_no_angle_is_told() {
    let angle = as5047p::with_parity(1000);
    let with = |bits: u16| as5047p::with_parity(0x0080 | bits);
    assert_eq!(as5047p::angle(angle, with(0x0100)), Ok(1000));
    for (state, why) in
        [(0x0000, "loops not ready"), (0x0300, "overflow"), (0x0500, "too strong"), (0x0900, "too weak")]
    {
        assert_eq!(as5047p::angle(angle, with(state)), Err(Faults::POSITION_ALARM), "{why}");
    }
    assert_eq!(as5047p::angle(0x0000, 0x0000), Err(Faults::POSITION_ALARM), "a line that hangs low");
    assert_eq!(as5047p::angle(0xffff, 0xffff), Err(Faults::POSITION_ALARM), "a line that hangs high");
    let complaint = 0x4000;
    let (upset, unsound) = (as5047p::with_parity(1000 | complaint), with(0x0100 | complaint));
    for (angle, diagnostics) in [(upset, with(0x0100)), (angle, unsound), (upset, unsound)] {
        assert_eq!(as5047p::angle(angle, diagnostics), Err(Faults::POSITION_ALARM), "error flag");
    }
    for bit in 0..16 {
        assert_eq!(as5047p::angle(angle ^ 1 << bit, with(0x0100)), Err(Faults::POSITION_PARITY), "bit {bit} upset");
    }
}

#[test]
fn the_converter_is_set_up_read_back_and_read() {
    let none: &[u8] = &[0; 4];
    let word = ads8681::word(0xa686, Range::Volts5).to_be_bytes();
    let mut spi = frames(&[
        // WRITE 0x14 RANGE_SEL = 3 (1.25 x 4.096 V), READ 0x14, and what it reads comes with the next frame.
        (&[0xd0, 0x14, 0x00, 0x03], none),
        (&[0xc8, 0x14, 0x00, 0x00], none),
        (none, &[0x00, 0x03, 0x00, 0x00]),
        // WRITE 0x10 DATAOUT_CTL = device address, both alarms, range, parity.
        (&[0xd0, 0x10, 0x7d, 0x08], none),
        (&[0xc8, 0x10, 0x00, 0x00], none),
        (none, &[0x7d, 0x08, 0x00, 0x00]),
        (none, none),
        (none, &word),
    ]);
    let mut converter = Ads8681::new(spi.clone(), NoopDelay::new());
    converter.set_up(Range::Volts5).expect("a converter");
    converter.begin().expect("a bus");
    assert_eq!(ads8681::code(converter.read().expect("a bus"), Range::Volts5), Ok(0xa686 - 0x8000));
    spi.done();
}

#[test]
fn a_converter_that_is_not_there_is_no_converter() {
    let none: &[u8] = &[0; 4];
    let mut spi = frames(&[(&[0xd0, 0x14, 0x00, 0x03], none), (&[0xc8, 0x14, 0x00, 0x00], none), (none, none)]);
    let fault = Ads8681::new(spi.clone(), NoopDelay::new()).set_up(Range::Volts5).expect_err("nobody there");
    assert_eq!(fault, SetUpFault::Register { address: 0x14, written: 3, read: 0 });
    spi.done();
    for range in [Range::Volts12, Range::Volts10, Range::Volts6, Range::Volts5, Range::Volts2] {
        assert_eq!(ads8681::code(u32::MAX, range), Err(Faults::FORCE_PARITY), "a line that hangs high");
    }
    assert_eq!(ads8681::code(0, Range::Volts5), Err(Faults::FORCE_PARITY), "a line that hangs low");
}

#[test]
fn the_parity_is_that_of_the_frame_that_texas_instruments_shows() {
    // Forum, "ADS8689: sampling data": the result 0xA686 is followed by 11b.
    let word = ads8681::word(0xa686, Range::Volts12);
    assert_eq!(word >> 16, 0xa686);
    assert_eq!(word >> 2 & 0b11, 0b11, "with a range of no ones, as without one");
    for code in (0x0100..=0xfeff_u16).step_by(97) {
        for range in [Range::Volts12, Range::Volts10, Range::Volts6, Range::Volts5, Range::Volts2] {
            let word = ads8681::word(code, range);
            assert_eq!(ads8681::code(word, range), Ok(i32::from(code) - 0x8000));
            for bit in 0..32 {
                assert!(ads8681::code(word ^ 1 << bit, range).is_err(), "bit {bit} of {word:#x} upset");
            }
        }
    }
}

#[test]
fn saturation_and_alarms_of_the_converter_are_told() {
    let range = Range::Volts5;
    for code in [0, 7, 0xfff8, 0xffff] {
        assert_eq!(ads8681::code(ads8681::word(code, range), range), Err(Faults::FORCE_SATURATED), "{code:#x}");
    }
    let flagged = |bits: u32| {
        let word = ads8681::word(0x9000, range) | bits;
        // The flags count in the parity of the frame.
        word ^ (bits.count_ones() & 1) << 2
    };
    assert_eq!(ads8681::code(flagged(0b01 << 4), range), Err(Faults::FORCE_SATURATED), "input alarm");
    assert_eq!(ads8681::code(flagged(0b10 << 6), range), Err(Faults::FORCE_ALARM), "supply alarm");
    assert_eq!(ads8681::code(flagged(0b11 << 6), range), Err(Faults::FORCE_ALARM), "supply alarms");
}

/// A bus that never answers, and one that tells of an overrun.
struct Sick(Option<ErrorKind>, usize);

impl embedded_hal_nb::spi::ErrorType for Sick {
    type Error = ErrorKind;
}

impl FullDuplex<u8> for Sick {
    fn read(&mut self) -> nb::Result<u8, ErrorKind> {
        self.1 += 1;
        Err(self.0.map_or(nb::Error::WouldBlock, nb::Error::Other))
    }

    fn write(&mut self, _: u8) -> nb::Result<(), ErrorKind> {
        Ok(())
    }
}

#[test]
fn a_bus_that_never_answers_costs_so_many_looks_and_lets_go_of_the_line() {
    for (told, fault) in [(None, BusFault::Timeout), (Some(ErrorKind::Overrun), BusFault::Bus(ErrorKind::Overrun))] {
        let mut select = Pin::new(&[Level::set(State::High), Level::set(State::Low), Level::set(State::High)]);
        let mut spi = BoundedSpi::new(Sick(told, 0), select.clone(), NoopDelay::new(), 50).expect("a pin");
        assert_eq!(spi.transfer_in_place(&mut [1, 2, 3]), Err(fault));
        select.done();
        let (bus, ..) = spi.release();
        assert!(bus.1 <= 51, "{} looks", bus.1);
    }
}

#[test]
fn a_bus_that_answers_moves_every_kind_of_operation() {
    let mut select = Pin::new(&[Level::set(State::High), Level::set(State::Low), Level::set(State::High)]);
    let wire = [
        // The byte that may be left over, then each operation byte by byte.
        Frame::read(0xee),
        Frame::write(1),
        Frame::read(0),
        Frame::write(0),
        Frame::read(7),
        Frame::write(2),
        Frame::read(8),
        Frame::write(0),
        Frame::read(9),
        Frame::write(3),
        Frame::read(10),
    ];
    let mut bus = Spi::new(&wire);
    let mut spi = BoundedSpi::new(bus.clone(), select.clone(), NoopDelay::new(), 3).expect("a pin");
    let (mut read, mut longer, mut place) = ([0], [0; 2], [3]);
    let mut operations = [
        Operation::Write(&[1]),
        Operation::Read(&mut read),
        Operation::Transfer(&mut longer, &[2]),
        Operation::TransferInPlace(&mut place),
        Operation::DelayNs(100),
    ];
    spi.transaction(&mut operations).expect("a bus");
    assert_eq!((read, longer, place), ([7], [8, 9], [10]));
    bus.done();
    select.done();
}

#[test]
fn a_quadrature_count_goes_on_beyond_its_wraps() {
    let mut encoder = Quadrature::default();
    assert_eq!(encoder.update(65_000), 0, "zero is where it stands at power-on");
    let mut position = 0_i64;
    for step in [500, 400, 30_000, 32_767, -32_768, -20_000, -20_000, -20_000, 1] {
        position += i64::from(step);
        let count = (65_000 + position).rem_euclid(65_536) as u16;
        assert_eq!(i64::from(encoder.update(count)), position, "after {step}");
    }
}

#[test]
fn the_absolute_encoder_is_linear_about_its_centre() {
    for centre in [0_u16, 1, 8_000, 16_383] {
        for surface in [-2_000, 0, 3_000] {
            let c = Calibration { centre, surface, ..Calibration::DEFAULT };
            for depth in -6_000..6_000 {
                let wrapped = c.depth_of(c.angle_of(depth - surface));
                assert_eq!(wrapped, depth - surface, "centre {centre}, surface {surface}");
            }
        }
    }
}
