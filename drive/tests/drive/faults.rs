//! One fault after the other: what was fed, what the estimate says, how it comes back.

use palpate::Flags;
use palpate_drive::{Faults, Input, InputStatus, Order, Settings, Validity, ads8681, as5047p};

use super::{CALIBRATION, assert_honest, dithered, with_cycle, words};

/// A fault, what makes it of a sound input, and what is expected of the tick.
struct Case {
    fault: Faults,
    fed: &'static str,
    upset: fn(Input) -> Input,
    /// The estimate of the tick rests on it all the same.
    live: bool,
}

fn cases() -> Vec<Case> {
    let case = |fault, fed, upset, live| Case { fault, fed, upset, live };
    vec![
        case(Faults::POSITION_TIMEOUT, "no answer", |i| Input { status: InputStatus::NO_POSITION, ..i }, false),
        case(Faults::POSITION_PARITY, "bit 3 of the angle upset", |i| Input { angle: i.angle ^ 8, ..i }, false),
        case(
            Faults::POSITION_ALARM,
            "magnet too far",
            |i| Input { diagnostics: as5047p::with_parity(0x0980), ..i },
            false,
        ),
        case(Faults::POSITION_RANGE, "31 mm out of the surface, of 30", |_| words(-0.031, 0.0), false),
        case(Faults::POSITION_JUMP, "5 mm in a millisecond", |_| words(0.005, 1.5), false),
        case(Faults::FORCE_TIMEOUT, "no answer", |i| Input { status: InputStatus::NO_FORCE, ..i }, false),
        case(Faults::FORCE_PARITY, "bit 20 of the word upset", |i| Input { force: i.force ^ 1 << 20, ..i }, false),
        case(Faults::FORCE_ALARM, "supply alarm", |i| Input { force: i.force ^ 1 << 7 ^ 1 << 2, ..i }, false),
        case(
            Faults::FORCE_SATURATED,
            "code 0xFFFF",
            |i| Input { force: ads8681::word(0xffff, CALIBRATION.range), ..i },
            false,
        ),
        case(
            Faults::FORCE_RANGE,
            "32.5 N of 32",
            |i| Input { force: ads8681::word(0x8000 + 32_500, CALIBRATION.range), ..i },
            false,
        ),
        case(Faults::SAMPLE_LOST, "nothing", |_| Input::NOTHING, false),
        case(Faults::SAMPLE_LOST, "the third tick after the last", |i| Input { elapsed: 3, ..i }, true),
        case(Faults::BROWN_OUT, "supply low", |i| Input { status: InputStatus::BROWN_OUT, ..i }, false),
        case(Faults::OVERRUN, "the tick before was late", |i| Input { status: InputStatus::OVERRUN, ..i }, true),
        case(Faults::LINK_GONE, "nothing heard", |i| Input { status: InputStatus::LINK_GONE, ..i }, true),
    ]
}

/// Ticks of fault that are tried: a glitch, one within the hold time, one beyond it.
const LENGTHS: [u32; 3] = [1, 30, 200];

#[test]
fn each_fault_is_told_held_counted_and_forgotten_in_time() {
    eprintln!(
        "{:<18} {:<34} {:>5}  {:<6} {:>7} {:>9} {:>6}",
        "fault", "fed", "ticks", "says", "count", "live in", "quiet"
    );
    for case in cases() {
        for length in LENGTHS {
            with_cycle(Settings::default(), Faults::empty(), |cycle, counters| {
                let mut k = 0;
                let mut last = None;
                while k < 1_000 {
                    last = Some(cycle.tick(dithered(k)));
                    k += 1;
                }
                let sound = last.expect("a report");
                assert!(sound.faults.is_empty() && sound.validity == Validity::Live, "{sound:?}");
                let mut end = sound.validity;
                for _ in 0..length {
                    let report = cycle.tick((case.upset)(dithered(k)));
                    assert_honest(&report);
                    assert!(
                        report.faults.contains(case.fault) || length > 1 && case.fault == Faults::POSITION_JUMP,
                        "{}: {report:?}",
                        case.fed
                    );
                    end = report.validity;
                    k += 1;
                }
                let beyond = length > u32::from(Settings::default().hold);
                let wanted = match (case.live, beyond) {
                    (true, _) => Validity::Live,
                    (false, false) => Validity::Held,
                    (false, true) => Validity::Void,
                };
                // A new place is believed at the second look.
                let wanted = if case.fault == Faults::POSITION_JUMP && length > 1 { Validity::Live } else { wanted };
                assert_eq!(end, wanted, "{} for {length} ticks", case.fed);
                let (mut live, mut quiet) = (None, None);
                for after in 1..=40 {
                    let report = cycle.tick(dithered(k));
                    assert_honest(&report);
                    k += 1;
                    live = live.or((report.validity == Validity::Live).then_some(after));
                    quiet = quiet.or(report.faults.is_empty().then_some(after));
                }
                let bit = case.fault.bits().trailing_zeros() as usize;
                let count = counters.faults()[bit];
                eprintln!(
                    "{:<18} {:<34} {length:>5}  {:<6} {count:>7} {:>9} {:>6}",
                    case.fault.name(),
                    case.fed,
                    format!("{end:?}"),
                    live.unwrap_or(99),
                    quiet.unwrap_or(99)
                );
                assert!(live.is_some_and(|after| after <= 2), "{}: live again after {live:?}", case.fed);
                let fleeting = !Faults::CONDITIONS.contains(case.fault);
                let least = if fleeting { u32::from(Faults::LINGER) } else { 1 };
                assert!(quiet.is_some_and(|after| after >= least), "{}: quiet after {quiet:?}", case.fed);
                let linger = 2 * u32::from(Faults::LINGER) + 2;
                assert!(quiet.is_some_and(|after| after <= linger), "{}: quiet after {quiet:?}", case.fed);
                assert!(count >= 1 && count <= length + 1, "{}: counted {count} times", case.fed);
                // The contact is known again within a window.
                for _ in 0..350 {
                    last = Some(cycle.tick(dithered(k)));
                    k += 1;
                }
                let stiffness = last.expect("a report").estimate.impedance.stiffness;
                assert!((stiffness / 300.0 - 1.0).abs() < 0.02, "{} for {length}: K {stiffness}", case.fed);
            });
        }
    }
}

#[test]
fn a_glitch_of_one_sample_costs_one_sample() {
    with_cycle(Settings::default(), Faults::empty(), |cycle, counters| {
        for k in 0..2_000 {
            let input = dithered(k);
            let upset = Input { angle: input.angle ^ 1, ..input };
            cycle.tick(if k % 100 == 99 { upset } else { input });
        }
        let [ticks, used, restarts, _] = counters.others();
        assert_eq!((ticks, used, restarts), (2_000, 1_980, 1));
    });
}

#[test]
fn a_sensor_that_says_the_same_for_ever_is_stuck_and_one_that_moves_again_is_not() {
    let [position, force] = CALIBRATION.stuck_after;
    for (fault, after, hold) in [
        (
            Faults::POSITION_STUCK,
            position,
            (|still, k| Input { force: dithered(k).force, ..still }) as fn(Input, u32) -> Input,
        ),
        (Faults::FORCE_STUCK, force, |still, k| Input { force: still.force, ..dithered(k) }),
    ] {
        with_cycle(Settings::default(), Faults::empty(), |cycle, _| {
            let still = dithered(0);
            let first = (0..4_000).find(|&k| cycle.tick(hold(still, k)).faults.contains(fault));
            assert_eq!(first, Some(u32::from(after)), "{}", fault.name());
            let clear = (4_000..4_100).find(|&k| cycle.tick(dithered(k)).faults.is_empty());
            // The jump back from where it stuck is a fault of its own, and lingers.
            assert!(clear.is_some_and(|k| k < 4_030), "{}: {clear:?}", fault.name());
        });
    }
}

#[test]
fn what_was_found_at_the_start_stays_until_it_is_acknowledged_or_for_good() {
    let found = Faults::WATCHDOG | Faults::CRASH | Faults::CALIBRATION | Faults::CLOCK;
    with_cycle(Settings::default(), found, |cycle, _| {
        let run = |cycle: &mut palpate_drive::Cycle<'_>, from: u32| {
            (from..from + 500).map(|k| cycle.tick(dithered(k))).last().expect("a report")
        };
        let report = run(cycle, 0);
        assert_eq!((report.faults, report.validity), (found, Validity::Live), "it works, and says so");
        cycle.order(Order::Acknowledge);
        assert_eq!(run(cycle, 500).faults, Faults::CALIBRATION | Faults::CLOCK);
    });
}

#[test]
fn a_tare_moves_the_zero_by_the_mean_of_good_samples_and_no_further_than_it_may() {
    with_cycle(Settings::default(), Faults::empty(), |cycle, counters| {
        cycle.order(Order::Tare);
        for k in 0..400 {
            // 0.25 N with a ripple, and every third sample a fault that must not count.
            let ripple = if k % 2 == 0 { 0.01 } else { -0.01 };
            let input = words(-0.01 + 1e-5 * f64::from(k % 7), 0.25 + ripple);
            let upset = Input { force: input.force ^ 1 << 30, ..input };
            cycle.tick(if k % 3 == 2 { upset } else { input });
        }
        assert!((cycle.scale().zero - 250.0).abs() < 1.0, "{:?}", cycle.scale());
        cycle.order(Order::Tare);
        for k in 0..400 {
            cycle.tick(words(-0.01 + 1e-5 * f64::from(k % 7), 8.0 + 1e-3 * f64::from(k % 5)));
        }
        assert!((cycle.scale().zero - 250.0).abs() < 1.0, "8 N is more than a zero can be off");
        assert_eq!(counters.others()[3], 1);
    });
}

#[test]
fn a_tare_in_contact_is_refused_and_the_zero_stays() {
    with_cycle(Settings::default(), Faults::empty(), |cycle, counters| {
        // 300 N/m, to and fro within the surface: the force is up to some newtons, less than a tare may move the zero by.
        (0..1_000).for_each(|k| assert_honest(&cycle.tick(dithered(k))));
        cycle.order(Order::Tare);
        let report = (1_000..1_400).map(|k| cycle.tick(dithered(k))).last().expect("a report");
        assert_eq!((cycle.scale().zero, counters.others()[3]), (0.0, 1));
        assert!(!report.estimate.flags.contains(Flags::NO_CONTACT), "the contact is still told: {report:?}");
    });
}

#[test]
fn a_tare_that_was_ordered_while_the_sensors_were_silent_is_refused_in_contact() {
    with_cycle(Settings::default(), Faults::empty(), |cycle, counters| {
        (0..1_000).for_each(|k| assert_honest(&cycle.tick(dithered(k))));
        (0..500).for_each(|_| assert!(cycle.tick(Input::NOTHING).sample.is_none()));
        cycle.order(Order::Tare);
        (0..500).for_each(|_| assert!(cycle.tick(Input::NOTHING).sample.is_none()));
        (1_000..1_400).for_each(|k| _ = cycle.tick(dithered(k)));
        assert_eq!((cycle.scale().zero, counters.others()[3]), (0.0, 1));
    });
}

#[test]
fn a_reset_forgets_the_contact() {
    with_cycle(Settings::default(), Faults::empty(), |cycle, _| {
        (0..1_000).for_each(|k| assert_honest(&cycle.tick(dithered(k))));
        cycle.order(Order::Restart);
        let report = cycle.tick(dithered(1_000));
        assert!(report.restarted && report.estimate.fill == 0.0, "{report:?}");
        let again = (1_001..1_400).map(|k| cycle.tick(dithered(k))).last().expect("a report");
        assert!((again.estimate.impedance.stiffness / 300.0 - 1.0).abs() < 0.01, "{again:?}");
    });
}

#[test]
fn after_a_jump_the_contact_before_is_not_the_contact_after() {
    with_cycle(Settings::default(), Faults::empty(), |cycle, _| {
        (0..1_000).for_each(|k| assert_honest(&cycle.tick(dithered(k))));
        // The encoder slips by 8 mm on its shaft, and the tool goes on as before.
        let slipped = |k| {
            let depth = CALIBRATION.depth_of(dithered(k).angle & 0x3fff);
            let angle = as5047p::with_parity(CALIBRATION.angle_of(depth - 1_638));
            Input { angle, ..dithered(k) }
        };
        let slip = cycle.tick(slipped(1_000));
        assert_eq!((slip.faults, slip.validity), (Faults::POSITION_JUMP, Validity::Held));
        let next = cycle.tick(slipped(1_001));
        assert!(next.restarted && next.validity == Validity::Live && next.estimate.fill == 0.0, "{next:?}");
    });
}

#[test]
fn what_moved_while_nothing_was_read_has_not_jumped() {
    with_cycle(Settings::default(), Faults::empty(), |cycle, _| {
        // 0.5 m/s of the 2 that it can, for 30 ms unseen: 15 mm.
        let place = |k: u32| words(-0.02 + 0.5e-3 * f64::from(k), 1e-3 * f64::from(k % 5));
        (0..10).for_each(|k| assert_honest(&cycle.tick(place(k))));
        (10..40).for_each(|_| assert_honest(&cycle.tick(Input::NOTHING)));
        let report = cycle.tick(place(40));
        assert!(!report.faults.contains(Faults::POSITION_JUMP) && report.validity == Validity::Live, "{report:?}");
        assert_eq!(report.sample.map(|sample| sample.elapsed), Some(0.031), "and its time covers the gap");
    });
}
