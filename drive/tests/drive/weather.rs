//! Faults of all kinds at once, for millions of samples.

use palpate::Method;
use palpate_drive::{Faults, Input, InputStatus, Settings, Validity, ads8681, as5047p};

use super::link::{Random, fuzz_count};
use super::{CALIBRATION, assert_honest, dithered, with_cycle};

/// Upsets an input in one of many ways.
fn upset(random: &mut Random, input: Input) -> Input {
    let range = CALIBRATION.range;
    match random.below(14) {
        0 => Input { angle: input.angle ^ 1 << random.below(16), ..input },
        1 => Input { diagnostics: input.diagnostics ^ 1 << random.below(16), ..input },
        2 => Input { force: input.force ^ 1 << random.below(32), ..input },
        3 => Input { angle: random.draw() as u16, diagnostics: random.draw() as u16, ..input },
        4 => Input { force: random.draw(), ..input },
        5 => Input { angle: as5047p::with_parity(random.draw() as u16 & 0x3fff), ..input },
        6 => Input { force: ads8681::word(random.draw() as u16, range), ..input },
        7 => Input { elapsed: random.draw() as u8, ..input },
        8 => Input { status: InputStatus::from_bits_truncate(random.draw() as u8), ..input },
        9 => Input::NOTHING,
        10 => Input { angle: 0, diagnostics: 0, force: 0, ..input },
        11 => Input { angle: 0xffff, diagnostics: 0xffff, force: u32::MAX, ..input },
        12 => Input { status: InputStatus::all(), elapsed: 255, ..input },
        _ => <[u8; 10]>::from(input).map(|byte| if random.below(3) == 0 { random.draw() as u8 } else { byte }).into(),
    }
}

/// Four million ticks of storms and lulls for four methods; more with PALPATE_FUZZ.
#[test]
fn fuzz_in_any_weather_it_never_stops_never_lies_and_comes_back_within_a_window() {
    let ticks = u32::try_from(fuzz_count() * 5).expect("fewer than 2^32 ticks");
    for (seed, method) in [(1, Method::Ewrls), (2, Method::Bls), (3, Method::Blmf), (4, Method::CusumRls)] {
        let settings = Settings { method, ..Settings::default() };
        with_cycle(settings, Faults::empty(), |cycle, counters| {
            let mut random = Random::new(seed);
            let (mut calm, mut storm, mut lulls, mut rate) = (0_u32, 0_u32, 0_u32, 2);
            for k in 0..ticks {
                if storm == 0 && calm == 0 {
                    (storm, calm) = (1 + random.below(300) as u32, 100 + random.below(1_200) as u32);
                    rate = 1 + random.below(20);
                    lulls += 1;
                }
                let stormy = storm > 0;
                let input =
                    if stormy && random.below(rate) == 0 { upset(&mut random, dithered(k)) } else { dithered(k) };
                let report = cycle.tick(input);
                assert_honest(&report);
                assert!(report.faults.contains(input.faults()), "tick {k}: {report:?}");
                if stormy {
                    storm -= 1;
                    continue;
                }
                calm -= 1;
                // The lull's last tick, at least a hundred after the storm: no fault lingers, and the estimate lives.
                if calm == 0 {
                    assert!(report.faults.is_empty() && report.validity == Validity::Live, "tick {k}: {report:?}");
                }
            }
            let [counted, used, restarts, _] = counters.others();
            eprintln!(
                "{}: {ticks} ticks, {lulls} storms, {used} used, {restarts} restarts, {:?}",
                method.name(),
                counters.faults()
            );
            assert_eq!(counted, ticks);
            let told = counters.faults();
            let possible = Faults::all().difference(
                Faults::LATCHED | Faults::STANDING | Faults::REJECTED | Faults::FORCE_STUCK | Faults::POSITION_STUCK,
            );
            for fault in possible {
                assert!(told[fault.bits().trailing_zeros() as usize] > 0, "{} never happened", fault.name());
            }
        });
    }
}

/// Some of what a storm brings is a lie that no check can tell: another force, of the right parity and within its range. A law
/// on a window is rid of it after the window, one that forgets after some memories; `rls` forgets nothing (its interval says so),
/// and the gradient law is slow by design.
#[test]
fn after_the_worst_storm_the_stiffness_is_known_again() {
    for (method, patience) in [
        (Method::Bls, 400),
        (Method::Blms, 400),
        (Method::Blmf, 700),
        (Method::NewtonBlmf, 700),
        (Method::CusumRls, 3_000),
        (Method::Ewrls, 3_000),
        (Method::Sprls, 3_000),
        (Method::ResetRls, 3_000),
    ] {
        with_cycle(Settings { method, ..Settings::default() }, Faults::empty(), |cycle, _| {
            let mut random = Random::new(11);
            for k in 0..20_000 {
                cycle.tick(upset(&mut random, dithered(k)));
            }
            let report = (20_000..20_000 + patience).map(|k| cycle.tick(dithered(k))).last().expect("a report");
            let stiffness = report.estimate.impedance.stiffness;
            assert!((stiffness / 300.0 - 1.0).abs() < 0.05, "{}: K {stiffness}, {report:?}", method.name());
        });
    }
}
