//! Hardware in the loop: the sensors' words over the link, and the host's bits back.

use palpate::Method;
use palpate_drive::framing::LinkCounters;
use palpate_drive::link::{Command, EstimateMessage, Source};
use palpate_drive::replay_format::estimate_words;
use palpate_drive::{Calibration, Faults, Input, InputStatus, Settings, Validity, as5047p};
use palpate_lab::listen::Taken;
use palpate_lab::replay::{Options, Plan, Runner};
use palpate_lab::rig::Rig;

use super::rig::{Heard, drive, feed, host, image, words};

/// Everything that came back is what the host makes of it: every sample, estimate, fault and flag, in order, none lost.
fn assert_same(what: &str, settings: Settings, revision: u8, fed: &[Input], heard: &Heard) {
    let host = host(settings, revision, heard.seen[0].tick, fed);
    assert_eq!((heard.seen.len(), heard.told.len()), (host.len(), host.len()), "{what}");
    for (k, ((seen, told), (host_seen, host_told))) in heard.seen.iter().zip(&heard.told).zip(host).enumerate() {
        assert_eq!(*seen, host_seen, "{what}, sample {k}");
        let words = |told: &EstimateMessage| (estimate_words(&told.estimate()), told.effort.to_bits());
        assert_eq!(words(told), words(&host_told), "{what}, sample {k}: {told:?}, {host_told:?}");
        let rest = |told: &EstimateMessage| (told.tick, told.faults(), told.validity, told.revision);
        assert_eq!(rest(told), rest(&host_told), "{what}, sample {k}");
    }
}

#[test]
fn every_estimate_of_what_is_fed_has_the_bits_of_the_host() {
    let Some(image) = image() else { return };
    let words = words(8.0);
    for method in [Method::CusumRls, Method::Bls, Method::Sprls, Method::NewtonBlmf] {
        let (_drive, mut client) = drive(image, None);
        // A call that came while the line was being set up may have been heard in part.
        let before = client.counters().expect("counters").link_counters;
        let settings = Settings { method, window: 200, ..Settings::default() };
        client.demand(Command::Choose(settings), "the settings").unwrap_or_else(|error| panic!("{error:#}"));
        let heard = feed(&mut client, &words);
        assert_same(method.name(), settings, 1, &words, &heard);
        let touched = heard.told.iter().filter(|told| told.impedance.stiffness > 100.0).count();
        assert!(touched > 3_000, "{}: {touched} samples of contact", method.name());
        let count = client.counters().expect("counters");
        // What was refused for want of room was sent again.
        let broken = |link_counters: LinkCounters| link_counters.lost() - link_counters.refused;
        let lost = broken(count.link_counters) - broken(before);
        assert_eq!((count.dropped, count.rx_overruns, lost), (0, 0, 0), "nothing was lost on the way");
        let overruns = count.faults[Faults::OVERRUN.bits().trailing_zeros() as usize];
        assert_eq!(overruns, 0, "every update ends within its millisecond");
    }
}

#[test]
fn faults_that_are_fed_have_the_bits_of_the_host_too() {
    let Some(image) = image() else { return };
    let (_drive, mut client) = drive(image, None);
    let mut random = 1_u32;
    let mut draw = move || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        random >> 8
    };
    let sound = words(6.0);
    let upset = |k: usize, input: Input, draw: &mut dyn FnMut() -> u32| {
        // A calm beginning, then a storm, then calm.
        if !(1_500..4_500).contains(&k) || !draw().is_multiple_of(8) {
            return input;
        }
        match draw() % 8 {
            0 => Input { angle: input.angle ^ 1 << (draw() % 16), ..input },
            1 => Input { force: input.force ^ 1 << (draw() % 32), ..input },
            2 => Input { status: InputStatus::from_bits_truncate(draw() as u8), ..input },
            3 => Input { elapsed: draw() as u8, ..input },
            4 => Input { angle: as5047p::with_parity(draw() as u16 & 0x3fff), ..input },
            5 => Input::NOTHING,
            6 => Input { diagnostics: draw() as u16, ..input },
            _ => Input { force: draw() << 8, ..input },
        }
    };
    let fed: Vec<Input> = sound.iter().enumerate().map(|(k, &input)| upset(k, input, &mut draw)).collect();
    let heard = feed(&mut client, &fed);
    assert_same("storm", Settings::default(), 0, &fed, &heard);
    let validity = |wanted| heard.told.iter().filter(|told| told.validity == wanted).count();
    assert!(validity(Validity::Held) > 100, "{} held", validity(Validity::Held));
    let last = heard.told.last().expect("an estimate");
    assert_eq!((last.faults(), last.validity), (Faults::CALIBRATION, Validity::Live), "and it has come back");
}

#[test]
fn a_recording_made_through_the_link_replays_to_the_same_estimates() {
    let Some(image) = image() else { return };
    let (_drive, mut client) = drive(image, None);
    // Two samples are lost and one is upset on the way: the recording has a gap there, and a replay knows it.
    let mut fed = words(8.0);
    fed[4_000].angle ^= 1;
    fed[5_000].status = InputStatus::NO_SAMPLE;
    fed[5_001].status = InputStatus::NO_SAMPLE;
    let heard = feed(&mut client, &fed);
    client.demand(Command::Source(Source::Sensors), "the sensors").unwrap_or_else(|error| panic!("{error:#}"));
    let mut taken = Taken::default();
    heard.seen.iter().for_each(|seen| taken.take(seen));
    assert_eq!(taken.notices(), Vec::<String>::new());
    let folder = tempfile::tempdir().expect("a folder");
    let [csv, toml] = ["trial.csv", "trial.toml"].map(|name| folder.path().join(name));
    let create = |path| palpate_lab::outfile::OutFile::create(path).expect("a file");
    taken
        .write(create(&csv), create(&toml), &Calibration::DEFAULT, &Settings::default())
        .unwrap_or_else(|error| panic!("{error:#}"));

    let rig = Rig::read(&toml).unwrap_or_else(|error| panic!("{error}"));
    let recording = palpate_lab::recording::Recording::read(&csv, &rig).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(recording.time.len(), fed.len() - 3);
    let options = Options { methods: vec![Settings::default().method], ..Options::default() };
    let plan = Plan::new(&rig, &toml, &recording, &options).unwrap_or_else(|error| panic!("{error:#}"));
    let mut estimates = Vec::new();
    let pass = Runner::Host.start(&plan, &recording, |_| ()).and_then(|run| {
        run.pass(
            |_| (),
            |step| {
                estimates.extend_from_slice(step.estimates);
                Ok(())
            },
        )
    });
    pass.unwrap_or_else(|error| panic!("{error:#}"));
    let live: Vec<_> = heard.told.iter().filter(|told| told.validity == Validity::Live).collect();
    assert_eq!(live.len(), estimates.len());
    for (k, (told, estimate)) in live.iter().zip(&estimates).enumerate() {
        let device = estimate_words(&told.estimate());
        assert_eq!(device, estimate_words(estimate), "row {k}: {told:?}, {estimate:?}");
    }
}
