//! What the image does where things are missing or damaged.

use palpate::Method;
use palpate_drive::link::{Command, Message, RequestOutcome, Source, Streams};
use palpate_drive::{CALIBRATION_BYTES, Calibration, Faults, Input, Order, Settings, Validity};

use super::rig::{drive, image, words};

fn index(fault: Faults) -> usize {
    fault.bits().trailing_zeros() as usize
}

#[test]
fn without_sensors_it_comes_up_tells_of_them_and_keeps_its_kilohertz() {
    let Some(image) = image() else { return };
    let (mut drive, mut client) = drive(image, None);
    let about = client.about().unwrap_or_else(|error| panic!("{error:#}"));
    assert!(about.emulator && about.image != 0 && about.found == Faults::CALIBRATION, "{about:?}");
    client.demand(Command::Stream(Streams { estimates: 100, samples: false }), "streams").expect("streams");
    let mut told = Vec::new();
    while told.len() < 50 {
        client
            .poll(|message| told.extend(matches!(message, Message::Estimate(_)).then(|| as_message(&message))))
            .expect("a line");
    }
    for estimate in &told {
        // A line that hangs low: the encoder is not ready, the converter's range is wrong.
        let wanted = Faults::POSITION_ALARM | Faults::FORCE_PARITY | Faults::CALIBRATION;
        assert_eq!((estimate.faults(), estimate.validity), (wanted, Validity::Void), "{estimate:?}");
        assert_eq!(
            (estimate.impedance.stiffness, estimate.half_width.stiffness, estimate.effort),
            (0.0, f32::INFINITY, 0.0)
        );
    }
    client.quiet().expect("silence");
    let count = client.counters().expect("counters");
    let [ticks, used, ..] = count.others;
    assert!(ticks > 4_000 && used == 0, "{count:?}");
    for (fault, times) in [(Faults::POSITION_ALARM, ticks), (Faults::FORCE_PARITY, ticks), (Faults::OVERRUN, 0)] {
        assert!(count.faults[index(fault)].abs_diff(times) <= 1, "{}: {count:?}", fault.name());
    }
    // The interrupt looks at its timer within a few instructions of the zero: QEMU has no flash to wait for.
    assert!(count.latency[1] < 2_000, "{count:?}");
    assert!(drive.runs().expect("a process"));
}

fn as_message(message: &Message<'_>) -> palpate_drive::link::EstimateMessage {
    match message {
        Message::Estimate(told) => *told,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_sound_calibration_in_flash_is_used_and_a_damaged_one_is_refused_and_told() {
    let Some(image) = image() else { return };
    let own = Calibration { date: 20_260_101, travel_per_turn: -0.02, surface: 1_234, ..Calibration::DEFAULT };
    let mut buffer = [0; CALIBRATION_BYTES];
    let block = own.write(&mut buffer).expect("room").to_vec();
    {
        let (_drive, mut client) = drive(image, Some(&block));
        let about = client.about().unwrap_or_else(|error| panic!("{error:#}"));
        assert_eq!((about.calibration, about.found), (own, Faults::empty()));
        assert_eq!(about.scale, own.scale());
    }
    let mut damaged = block;
    damaged[20] ^= 0x10;
    let (_drive, mut client) = drive(image, Some(&damaged));
    let about = client.about().unwrap_or_else(|error| panic!("{error:#}"));
    assert_eq!((about.calibration, about.found), (Calibration::DEFAULT, Faults::CALIBRATION));
}

#[test]
fn whatever_is_sent_it_goes_on_and_counts_what_it_refuses() {
    let Some(image) = image() else { return };
    let (mut drive, mut client) = drive(image, None);
    let mut random = 9_u32;
    let mut draw = move || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (random >> 24) as u8
    };
    for _ in 0..40 {
        let noise: Vec<u8> = (0..500).map(|_| draw()).collect();
        client.write(&noise).expect("a line");
        // The zero ends whatever the noise began.
        client.write(&[0]).expect("a line");
        client.about().unwrap_or_else(|error| panic!("{error:#}"));
    }
    let before = client.counters().expect("counters").link_counters;
    assert!(before.malformed + before.checksum + before.oversized > 40, "{before:?}");
    let refused = |client: &mut palpate_lab::listen::Client, command, outcome| {
        assert_eq!(client.request(command, |_| ()).expect("an answer"), outcome, "{command:?}");
    };
    let d = Settings::default();
    for wrong in [
        Settings { window: 0, ..d },
        Settings { window: 3_000, ..d },
        Settings { cutoff: 500.0, ..d },
        Settings { cutoff: f32::NAN, ..d },
        Settings { method: Method::Ewrls, forgetting: 1.5, ..d },
        Settings { initial_covariance: -1.0, ..d },
        Settings { hold: 0, ..d },
    ] {
        refused(&mut client, Command::Choose(wrong), RequestOutcome::OutOfRange);
    }
    let word: [u8; 10] = Input::NOTHING.into();
    refused(&mut client, Command::Feed(&word), RequestOutcome::NotNow);
    let after = client.counters().expect("counters");
    assert_eq!(after.link_counters.refused - before.refused, 8);
    assert_eq!(client.about().expect("settings").settings, d, "and nothing was changed");
    assert_eq!(after.faults[index(Faults::OVERRUN)], 0);
    assert!(drive.runs().expect("a process"));
}

#[test]
fn other_settings_take_over_between_two_ticks_and_the_number_of_them_comes_back() {
    let Some(image) = image() else { return };
    let (_drive, mut client) = drive(image, None);
    for (k, method) in Method::ALL.into_iter().cycle().take(30).enumerate() {
        let settings = Settings { method, window: 10 + 60 * k as u16, ..Settings::default() };
        client.demand(Command::Choose(settings), "the settings").unwrap_or_else(|error| panic!("{k}: {error:#}"));
        let about = client.about().expect("settings");
        assert_eq!((about.settings, usize::from(about.revision)), (settings, k + 1));
    }
    assert_eq!(client.counters().expect("counters").faults[index(Faults::OVERRUN)], 0);
}

#[test]
fn a_tare_and_a_silent_host_are_seen_by_the_drive() {
    let Some(image) = image() else { return };
    let (_drive, mut client) = drive(image, None);
    client
        .demand(Command::Choose(Settings { link_timeout: 500, ..Settings::default() }), "settings")
        .expect("settings");
    client.demand(Command::Source(Source::Link), "the test mode").expect("test mode");
    client.demand(Command::Order(Order::Tare), "the tare").expect("a tare");
    // Free of the surface, with 0.7 N of offset.
    let offset: Vec<Input> = words(1.0)
        .iter()
        .enumerate()
        .map(|(k, word)| {
            let code = 0x8000 + 700 + (k % 3) as u16;
            Input { force: palpate_drive::ads8681::word(code, Calibration::DEFAULT.range), ..*word }
        })
        .collect();
    let heard = super::rig::feed(&mut client, &offset);
    let zero = client.about().expect("a scale").scale.zero;
    assert!((zero - 701.0).abs() < 1.0, "{zero}");
    let force = heard.seen.last().and_then(|seen| seen.taken).map(|[_, force]| force);
    assert!(force.is_some_and(|force| force.abs() < 0.01), "{force:?}");
    client.quiet().expect("silence");
    // Half a second of the emulator's time without a word. How long that is of ours depends on the host: the silence is doubled
    // until the drive's own ticks show that it was long enough.
    client.demand(Command::Source(Source::Sensors), "the sensors").expect("sensors");
    let mut silence = std::time::Duration::from_millis(10);
    loop {
        let before = client.counters().expect("counters");
        std::thread::sleep(silence);
        let after = client.counters().expect("counters");
        if after.others[0] - before.others[0] > 2 * 500 {
            assert!(after.faults[index(Faults::LINK_GONE)] > before.faults[index(Faults::LINK_GONE)], "{after:?}");
            break;
        }
        silence *= 2;
    }
}
