//! The link: whatever the bytes.

use palpate_drive::framing::{LINE_BYTES, LinkCounters, Receiver, encode};
use palpate_drive::link::{
    Command, EstimateMessage, FEED, Message, Request, RequestOutcome, SampleMessage, Source, Streams,
};
use palpate_drive::replay_format::estimate_words;
use palpate_drive::{DecodedRequest, Faults, INPUT_BYTES, Input, Order, POINTS, RequestDecoder, Settings};

use super::{dithered, with_cycle};

/// A small generator of its own, so that a failure comes back.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// xorshift64*.
    pub fn draw(&mut self) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 32) as u32
    }

    pub fn below(&mut self, limit: usize) -> usize {
        self.draw() as usize % limit.max(1)
    }

    /// `whole`, upset in one of many ways; sometimes not at all, sometimes nothing is left of it.
    pub fn damaged(&mut self, whole: &[u8]) -> Vec<u8> {
        let mut bytes = whole.to_vec();
        match self.below(8) {
            0 => {}
            1 => bytes = (0..self.below(300)).map(|_| self.draw() as u8).collect(),
            2 => bytes.truncate(self.below(whole.len() + 1)),
            3 => bytes.extend((0..self.below(40)).map(|_| 0xff)),
            4 => {
                let at = self.below(bytes.len());
                bytes.insert(at, self.draw() as u8);
            }
            5 => {
                let at = self.below(bytes.len());
                bytes.remove(at);
            }
            _ => {
                for _ in 0..=self.below(4) {
                    let at = self.below(bytes.len());
                    bytes[at] = self.draw() as u8;
                }
            }
        }
        bytes
    }
}

/// How many inputs a fuzz takes: 200 000, or what PALPATE_FUZZ says.
pub fn fuzz_count() -> u64 {
    std::env::var("PALPATE_FUZZ").ok().and_then(|text| text.parse().ok()).unwrap_or(200_000)
}

fn line<T: serde::Serialize>(message: &T) -> Vec<u8> {
    let mut buffer = [0; LINE_BYTES];
    encode(message, &mut buffer).expect("it fits").to_vec()
}

fn requests() -> Vec<Vec<u8>> {
    let inputs: Vec<u8> = (0..FEED as u32).flat_map(|k| <[u8; INPUT_BYTES]>::from(dithered(k))).collect();
    let commands = [
        Command::Alive,
        Command::Identify,
        Command::Counters,
        Command::Choose(Settings::default()),
        Command::Order(Order::Tare),
        Command::Stream(Streams { estimates: 10, samples: true }),
        Command::Source(Source::Link),
        Command::Feed(&inputs),
        Command::Feed(&inputs[..INPUT_BYTES]),
    ];
    commands
        .into_iter()
        .enumerate()
        .map(|(number, command)| line(&Request { number: number as u16, command }))
        .collect()
}

fn hear(decoder: &mut RequestDecoder, bytes: &[u8]) -> Vec<(u16, DecodedRequest)> {
    bytes.iter().filter_map(|&byte| decoder.push(byte)).collect()
}

#[test]
fn every_request_arrives_and_nothing_is_counted_as_lost() {
    let mut decoder = RequestDecoder::new();
    let all = requests();
    let wishes = hear(&mut decoder, &all.concat());
    assert_eq!(wishes.len(), all.len());
    assert!(wishes.iter().enumerate().all(|(k, (number, _))| usize::from(*number) == k));
    let DecodedRequest::Feed(inputs, used) = wishes[7].1 else { panic!("{:?}", wishes[7]) };
    assert_eq!((inputs[3], used), (dithered(3), FEED));
    assert_eq!((decoder.link_counters().frames as usize, decoder.link_counters().lost()), (all.len(), 0));
}

#[test]
fn who_begins_in_the_middle_is_in_step_from_the_next_frame_on() {
    let all = requests().concat();
    for start in 0..all.len() {
        let mut decoder = RequestDecoder::new();
        let heard = hear(&mut decoder, &all[start..]);
        let whole = all[start..].iter().filter(|&&byte| byte == 0).count();
        assert!(heard.len() >= whole - 1, "from byte {start}: {} of {whole}", heard.len());
    }
}

#[test]
fn what_is_damaged_oversized_of_another_version_or_cannot_be_is_refused_and_counted() {
    let good = line(&Request { number: 1, command: Command::Identify });
    let mut decoder = RequestDecoder::new();
    let mut after = |bytes: &[u8]| {
        assert_eq!(hear(&mut decoder, bytes), [], "{bytes:x?}");
        assert_eq!(hear(&mut decoder, &good).len(), 1, "and the next one is heard");
        decoder.link_counters()
    };
    assert_eq!(after(&[vec![7; 4_000], vec![0]].concat()).oversized, 1);
    assert_eq!(after(&[200, 1, 0]).malformed, 1);
    assert_eq!(after(&[2, 2, 0]).malformed, 2, "shorter than its CRC");
    let mut upset = good.clone();
    upset[2] ^= 4;
    assert_eq!(after(&upset).checksum, 1);
    // Messages that no version has: a number beyond the commands, and one with something behind it.
    assert_eq!(after(&line(&(1_u16, 200_u8))).refused, 1);
    assert_eq!(after(&line(&(1_u16, 1_u8, 0_u8))).refused, 2);
    // Inputs that are none, too many, or cut.
    for length in [0, INPUT_BYTES - 1, INPUT_BYTES + 1, INPUT_BYTES * (FEED + 1)] {
        let bytes = vec![1; length];
        let before = desk_refusals(&mut after, &good);
        let link_counters = after(&line(&Request { number: 1, command: Command::Feed(&bytes) }));
        assert_eq!(link_counters.refused, before + 1, "{length} bytes");
    }
}

fn desk_refusals(after: &mut impl FnMut(&[u8]) -> palpate_drive::framing::LinkCounters, _: &[u8]) -> u32 {
    after(&[0]).refused
}

#[test]
fn another_version_is_counted_as_such() {
    let good = line(&Request { number: 1, command: Command::Identify });
    let mut frame = good[..good.len() - 1].to_vec();
    let length = cobs_decode(&mut frame);
    frame.truncate(length - 4);
    frame[0] = 9;
    let check = crc32(&frame);
    frame.extend(check.to_le_bytes());
    let mut stuffed = cobs_encode(&frame);
    stuffed.push(0);
    let mut decoder = RequestDecoder::new();
    assert_eq!(hear(&mut decoder, &stuffed), []);
    assert_eq!((decoder.link_counters().version, decoder.link_counters().lost()), (1, 1));
}

/// Consistent overhead byte stuffing as its authors wrote it down (Cheshire and Baker, 1999), not as the library does it.
fn cobs_encode(bytes: &[u8]) -> Vec<u8> {
    let runs = bytes.split(|&byte| byte == 0);
    runs.flat_map(|run| [&[run.len() as u8 + 1][..], run].concat()).collect()
}

fn cobs_decode(bytes: &mut Vec<u8>) -> usize {
    let (mut out, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        let code = usize::from(bytes[at]);
        out.extend_from_slice(&bytes[at + 1..at + code]);
        at += code;
        if at < bytes.len() {
            out.push(0);
        }
    }
    *bytes = out;
    bytes.len()
}

/// CRC-32 bit by bit, as IEEE 802.3 has it.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 })
    })
}

#[test]
fn the_frame_is_what_its_documentation_says() {
    let message = Message::Answer { number: 300, outcome: RequestOutcome::NoRoom };
    // Version 1; variant 0, 300 as a varint, variant 2.
    let body = [1, 0, 0xac, 0x02, 2];
    let mut expected = cobs_encode(&[&body[..], &crc32(&body).to_le_bytes()].concat());
    expected.push(0);
    assert_eq!(line(&message), expected);
}

#[test]
fn reports_survive_the_journey_to_the_bit() {
    with_cycle(Settings::default(), Faults::empty(), |cycle, _| {
        let mut receiver = Receiver::new();
        for k in 0..1_000 {
            let input = if k % 97 == 0 { Input::NOTHING } else { dithered(k) };
            let report = cycle.tick(input);
            for byte in [
                line(&Message::Estimate(EstimateMessage::of(&report))),
                line(&Message::Sample(SampleMessage::of(&report))),
            ]
            .concat()
            {
                if !receiver.push(byte) {
                    continue;
                }
                match receiver.message() {
                    Some(Message::Estimate(told)) => {
                        assert_eq!(estimate_words(&told.estimate()), estimate_words(&report.estimate));
                        assert_eq!((told.faults(), told.validity), (report.faults, report.validity));
                    }
                    Some(Message::Sample(seen)) => assert_eq!(seen, SampleMessage::of(&report)),
                    other => panic!("{other:?}"),
                }
            }
        }
        assert_eq!((receiver.link_counters().frames, receiver.link_counters().lost()), (2_000, 0));
    });
}

/// The frame of `whole`'s body, upset, with the CRC that it then has.
fn resealed(whole: &[u8], random: &mut Random) -> Vec<u8> {
    let mut frame = whole[..whole.len() - 1].to_vec();
    let length = cobs_decode(&mut frame);
    let mut body = random.damaged(&frame[..length - 4]);
    body.truncate(240);
    let check = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&body);
    body.extend(check.to_le_bytes());
    let mut line = vec![0; body.len() + 4];
    let used = cobs::encode(&body, &mut line);
    line.truncate(used);
    line.push(0);
    line
}

/// `PALPATE_FUZZ=10000000 cargo test -p palpate --test host -- fuzz --nocapture` for ten million.
#[test]
fn fuzz_whatever_comes_over_the_line_the_desk_goes_on() {
    let (mut random, all) = (Random::new(3), requests());
    let mut decoder = RequestDecoder::new();
    let (mut granted, count) = (0_u64, fuzz_count());
    for k in 0..count {
        let whole = &all[random.below(all.len())];
        // Every other time the damage is done before the CRC is taken, so that it reaches the messages.
        let bytes = if k % 2 == 0 { random.damaged(whole) } else { resealed(whole, &mut random) };
        granted += hear(&mut decoder, &bytes).len() as u64;
    }
    let link_counters = decoder.link_counters();
    eprintln!("{count} inputs, {granted} wishes, {link_counters:?}");
    for (what, times) in [
        ("wishes", granted),
        ("oversized", link_counters.oversized.into()),
        ("malformed", link_counters.malformed.into()),
        ("checksum", link_counters.checksum.into()),
        ("version", link_counters.version.into()),
        ("refused", link_counters.refused.into()),
    ] {
        assert!(times > count / 100, "{what} {times}: {link_counters:?}");
    }
    // And it still hears; the first zero ends whatever was left.
    hear(&mut decoder, &[0]);
    assert_eq!(hear(&mut decoder, &all[1]), [(1, DecodedRequest::Identity)]);
}

fn decode(decoder: &mut RequestDecoder, command: Command<'_>) -> Option<DecodedRequest> {
    let mut decoded = None;
    for byte in line(&Request { number: 3, command }) {
        decoded = decoded.or(decoder.push(byte));
    }
    decoded.map(|(_, request)| request)
}

#[test]
fn references_are_whole_numbers_of_floats_and_no_more_than_fit() {
    let mut decoder = RequestDecoder::new();
    let bytes: Vec<u8> = (0..=POINTS).flat_map(|k| (k as f32 + 0.5).to_le_bytes()).collect();
    for count in [1, 2, POINTS] {
        let Some(DecodedRequest::Points(points, used)) = decode(&mut decoder, Command::Points(&bytes[..4 * count]))
        else {
            panic!("{count} references are refused");
        };
        assert_eq!(used, count);
        assert!(points[..count].iter().enumerate().all(|(k, point)| *point == k as f32 + 0.5), "{points:?}");
        assert!(points[count..].iter().all(|point| *point == 0.0), "{points:?}");
    }
    assert_eq!(decoder.link_counters().refused, 0);
    for (refused, length) in [(1, 0), (2, 5), (3, 4 * POINTS + 4)] {
        assert!(decode(&mut decoder, Command::Points(&bytes[..length])).is_none(), "{length} bytes");
        assert_eq!(decoder.link_counters().refused, refused, "{length} bytes");
    }
    decoder.refuse();
    assert_eq!((decoder.link_counters().refused, decoder.link_counters().frames), (4, 6));
}

#[test]
fn a_line_at_rest_counts_as_nothing() {
    let mut receiver = Receiver::new();
    assert!((0..5).all(|_| !receiver.push(0)));
    assert_eq!(receiver.link_counters(), LinkCounters::default());
}
