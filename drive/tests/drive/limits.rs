//! Limits at their exact value: hold time, ranges, parity of each word, reset of the estimator.

use palpate::{Flags, Impedance, Sample};
use palpate_drive::{
    Bounds, Calibration, Faults, Input, InputStatus, Order, Settings, ValidatedSettings, Validity, ads8681, as5047p,
    effort,
};

use super::{CALIBRATION, SOUND, dithered, with_calibrated_cycle, with_cycle, words};

#[test]
fn an_estimate_is_held_for_exactly_the_hold_time_and_the_estimator_restarts_after_a_void() {
    let settings = Settings { hold: 3, ..Settings::default() };
    with_cycle(settings, Faults::empty(), |cycle, _| {
        (0..50).for_each(|k| assert_eq!(cycle.tick(dithered(k)).restarted, k == 0, "tick {k}"));
        let without_samples: Vec<Validity> = (0..5).map(|_| cycle.tick(Input::NOTHING).validity).collect();
        let [held, void] = [Validity::Held, Validity::Void];
        assert_eq!(without_samples, [held, held, held, void, void]);
        assert!(cycle.tick(dithered(55)).restarted, "the first sample after a void");
        assert!(!cycle.tick(dithered(56)).restarted, "the second sample after a void");
        // Within the hold time the estimator goes on.
        cycle.tick(Input::NOTHING);
        assert!(!cycle.tick(dithered(58)).restarted, "a sample after a held estimate");
    });
}

#[test]
fn other_settings_reset_the_estimator() {
    with_cycle(Settings::default(), Faults::empty(), |cycle, _| {
        for k in 0..50 {
            cycle.tick(dithered(k));
        }
        let other = Settings { window: 100, ..Settings::default() };
        cycle.apply(&ValidatedSettings::new(&other, &CALIBRATION, 1).expect("sound settings"));
        let report = cycle.tick(dithered(50));
        assert!(report.restarted && report.revision == 1, "{report:?}");
    });
}

#[test]
fn the_hold_time_is_limited_by_the_settings() {
    for (hold, accepted) in [(0, false), (1, true), (1_000, true), (1_001, false)] {
        let checked = Settings { hold, ..Settings::default() }.bank_config(&CALIBRATION);
        assert_eq!(checked.is_ok(), accepted, "{hold}: {checked:?}");
    }
}

#[test]
fn lost_ticks_count_as_ticks_of_an_unchanged_reading() {
    let [_, stuck_after] = CALIBRATION.stuck_after;
    assert_eq!(stuck_after, 500);
    with_cycle(Settings::default(), Faults::empty(), |cycle, _| {
        let unchanged = Input { elapsed: 100, ..words(0.01, 3.0) };
        let stuck: Vec<bool> = (0..6).map(|_| cycle.tick(unchanged).faults.contains(Faults::FORCE_STUCK)).collect();
        assert_eq!(stuck, [false, false, false, false, false, true]);
    });
}

#[test]
fn a_pull_beyond_the_calibrated_force_is_a_fault_as_a_push_is() {
    for (code, fault) in [(0x8000 - 31_900, false), (0x8000 - 32_500, true), (0x8000 + 32_500, true)] {
        with_cycle(Settings::default(), Faults::empty(), |cycle, _| {
            let force = ads8681::word(code, CALIBRATION.range);
            let report = cycle.tick(Input { force, ..words(0.0, 0.0) });
            assert_eq!(report.faults.contains(Faults::FORCE_RANGE), fault, "{code}");
        });
    }
}

#[test]
fn both_words_of_the_encoder_are_checked_for_parity() {
    let (angle, diagnostics) = (as5047p::with_parity(100), as5047p::with_parity(SOUND));
    assert_eq!(as5047p::angle(angle, diagnostics), Ok(100));
    assert_eq!(as5047p::angle(angle ^ 1 << 15, diagnostics), Err(Faults::POSITION_PARITY));
    assert_eq!(as5047p::angle(angle, diagnostics ^ 1 << 15), Err(Faults::POSITION_PARITY));
}

#[test]
fn the_effort_is_limited_on_both_sides() {
    let bounds = Bounds { effort: 10.0, ..Bounds::NO_EFFORT };
    let contact = Some(Impedance { stiffness: 300.0, damping: 5.0 });
    let sample = Some(Sample { position: 0.01, force: 3.0, elapsed: 1e-3 });
    for (wanted, got) in [(-1e3, -10.0), (-9.5, -9.5), (9.5, 9.5), (1e3, 10.0)] {
        assert_eq!(effort(contact, sample, &bounds, |_, _| wanted), got, "{wanted}");
    }
}

#[test]
fn a_force_at_its_calibrated_limit_is_no_fault() {
    let exact = Calibration { force_gain: 0.25, force_limit: 8.0, ..CALIBRATION };
    for (counts, fault) in [(32, false), (-32, false), (33, true), (-33, true)] {
        with_calibrated_cycle(exact, Settings::default(), Faults::empty(), |cycle, _| {
            let code = u16::try_from(0x8000 + counts).expect("a code");
            let report = cycle.tick(Input { force: ads8681::word(code, exact.range), ..words(0.0, 0.0) });
            assert_eq!(report.faults.contains(Faults::FORCE_RANGE), fault, "{counts}");
        });
    }
}

#[test]
fn a_tare_is_limited_by_its_distance_from_the_calibrated_zero() {
    // A zero of 20 N in counts, and 5 N that a tare may move it by.
    let shifted = Calibration { force_zero: 20_000.0, ..CALIBRATION };
    assert_eq!(shifted.tare_limit, 5.0);
    for (counts, taken) in [(20_100, true), (24_990, true), (25_010, false), (15_010, true), (14_990, false)] {
        with_calibrated_cycle(shifted, Settings::default(), Faults::empty(), |cycle, counters| {
            cycle.order(Order::Tare);
            for k in 0..200_u16 {
                // The readings move, so that none is stuck; their mean is `counts`.
                let code = 0x8000 + counts + if k % 2 == 0 { 1 } else { -1 };
                let force = ads8681::word(u16::try_from(code).expect("a code"), shifted.range);
                cycle.tick(Input { force, ..words(-0.01 + 1e-5 * f64::from(k % 7), 0.0) });
            }
            let zero = if taken { counts as f32 } else { 20_000.0 };
            assert_eq!((cycle.scale().zero, counters.others()[3]), (zero, u32::from(!taken)), "{counts}");
        });
    }
}

#[test]
fn a_word_that_was_not_read_is_not_judged() {
    with_cycle(Settings::default(), Faults::empty(), |cycle, _| {
        // The words of an input without an answer are zeros, which would be an alarm of the encoder.
        assert_eq!(cycle.tick(Input::NOTHING).faults, Faults::SAMPLE_LOST);
    });
    with_cycle(Settings::default(), Faults::empty(), |cycle, _| {
        let unanswered = Input { status: InputStatus::NO_POSITION, angle: 0, diagnostics: 0, ..dithered(0) };
        assert_eq!(cycle.tick(unanswered).faults, Faults::POSITION_TIMEOUT);
    });
}

#[test]
fn a_held_estimate_of_a_law_that_held_is_flagged_as_held() {
    with_cycle(Settings::default(), Faults::empty(), |cycle, _| {
        let first = cycle.tick(dithered(0));
        assert!(first.validity == Validity::Live && first.estimate.flags.contains(Flags::HELD), "{first:?}");
        let held = cycle.tick(Input::NOTHING);
        assert!(held.validity == Validity::Held && held.estimate.flags.contains(Flags::HELD), "{held:?}");
    });
}

#[test]
fn the_revision_of_the_settings_comes_back_with_every_report() {
    for revision in [0, 1, 7, u8::MAX] {
        with_cycle(Settings::default(), Faults::empty(), |cycle, _| {
            cycle.apply(&ValidatedSettings::new(&Settings::default(), &CALIBRATION, revision).expect("sound settings"));
            assert_eq!(cycle.tick(dithered(0)).revision, revision);
        });
    }
}
