//! The format of the two files by which host and replay image exchange samples and estimates, through semihosting.
//!
//! In: the length of the settings (u32), the settings ([`EstimatorBankConfig`] by postcard), then 12 bytes a sample. Out: a record
//! a sample (a status word, then 32 bytes for each method that runs), then [`ReplayCounters`]. All words little-endian, floats
//! as their bits, so nothing is lost on the way.

use palpate::Estimate;
use palpate::Flags;
use palpate::{BankEstimates, EstimatorBankConfig, Method, Methods};
use palpate::{Field, Rejection};
use palpate::{Impedance, Sample};

/// The file that the image reads, in the folder it is run in.
pub const INPUT_FILE: &core::ffi::CStr = c"replay.in";
/// The file that the image writes.
pub const OUTPUT_FILE: &core::ffi::CStr = c"replay.out";

/// Room for the settings, encoded.
pub const CONFIG_BYTES: usize = 512;
/// Bytes of one sample.
pub const SAMPLE_BYTES: usize = 12;
/// Bytes of one record where every method runs.
pub const RECORD_BYTES: usize = WORD + Method::ALL.len() * ESTIMATE_BYTES;
/// Bytes of the counters at the end.
pub const COUNTER_BYTES: usize = 4 * WORD;

const WORD: usize = 4;
const ESTIMATE_BYTES: usize = 8 * WORD;

/// The result of one update.
pub type UpdateResult = Result<BankEstimates, Rejection>;

/// Counters of the interrupt of the replay image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ReplayCounters {
    /// Samples taken.
    pub samples: u32,
    /// Ticks of the 1 kHz timer.
    pub ticks: u32,
    /// Ticks that came while the one before was still at work.
    pub overruns: u32,
    /// Ticks that found no sample, or no room for the record.
    pub starved: u32,
}

/// Encodes the settings, with their length before them, into `buffer`; the bytes used.
pub fn encode_config<'a>(config: &EstimatorBankConfig, buffer: &'a mut [u8; CONFIG_BYTES + WORD]) -> Option<&'a [u8]> {
    let (length, body) = buffer.split_first_chunk_mut::<WORD>()?;
    let used = postcard::to_slice(config, body).ok()?.len();
    *length = u32::try_from(used).ok()?.to_le_bytes();
    buffer.get(..WORD + used)
}

/// Decodes the settings from their bytes, without the length.
pub fn decode_config(bytes: &[u8]) -> Option<EstimatorBankConfig> {
    postcard::from_bytes(bytes).ok()
}

/// One sample to its bytes.
pub fn encode_sample(sample: &Sample) -> [u8; SAMPLE_BYTES] {
    let mut bytes = [0; SAMPLE_BYTES];
    let words = [sample.position, sample.force, sample.elapsed];
    for (to, word) in bytes.chunks_exact_mut(WORD).zip(words) {
        to.copy_from_slice(&word.to_le_bytes());
    }
    bytes
}

/// One sample from its bytes.
pub fn decode_sample(bytes: &[u8; SAMPLE_BYTES]) -> Sample {
    let [p0, p1, p2, p3, f0, f1, f2, f3, e0, e1, e2, e3] = *bytes;
    Sample {
        position: f32::from_le_bytes([p0, p1, p2, p3]),
        force: f32::from_le_bytes([f0, f1, f2, f3]),
        elapsed: f32::from_le_bytes([e0, e1, e2, e3]),
    }
}

/// Bytes of one record of `methods`.
pub fn record_bytes(methods: Methods) -> usize {
    WORD + methods.count() * ESTIMATE_BYTES
}

/// One outcome to its record; `record` is [`record_bytes`] long.
pub fn encode_record(outcome: &UpdateResult, methods: Methods, record: &mut [u8]) {
    let Some((status, rest)) = record.split_first_chunk_mut::<WORD>() else { return };
    *status = status_word(outcome).to_le_bytes();
    let Ok(estimates) = outcome else {
        rest.fill(0);
        return;
    };
    let running = Method::ALL.iter().zip(estimates).filter(|(method, _)| methods.contains(**method));
    for (to, (_, estimate)) in rest.chunks_exact_mut(ESTIMATE_BYTES).zip(running) {
        for (to, word) in to.chunks_exact_mut(WORD).zip(estimate_words(estimate)) {
            to.copy_from_slice(&word.to_le_bytes());
        }
    }
}

/// One outcome from its record; `None` where the bytes are none.
pub fn decode_record(bytes: &[u8], methods: Methods) -> Option<UpdateResult> {
    let (status, rest) = bytes.split_first_chunk::<WORD>()?;
    if let Some(rejection) = rejection_of(u32::from_le_bytes(*status))? {
        return Some(Err(rejection));
    }
    let mut estimates = [Estimate::NO_CONTACT; Method::ALL.len()];
    let running = Method::ALL.iter().zip(&mut estimates).filter(|(method, _)| methods.contains(**method));
    let mut chunks = rest.chunks_exact(ESTIMATE_BYTES);
    for (_, estimate) in running {
        *estimate = estimate_of(chunks.next()?)?;
    }
    Some(Ok(estimates))
}

/// The counters to their bytes.
pub fn encode_counters(c: &ReplayCounters) -> [u8; COUNTER_BYTES] {
    let mut bytes = [0; COUNTER_BYTES];
    for (to, word) in bytes.chunks_exact_mut(WORD).zip([c.samples, c.ticks, c.overruns, c.starved]) {
        to.copy_from_slice(&word.to_le_bytes());
    }
    bytes
}

/// The counters from their bytes.
pub fn decode_counters(bytes: &[u8; COUNTER_BYTES]) -> Option<ReplayCounters> {
    let [samples, ticks, overruns, starved] = words::<4>(bytes)?;
    Some(ReplayCounters { samples, ticks, overruns, starved })
}

fn words<const N: usize>(bytes: &[u8]) -> Option<[u32; N]> {
    let mut words = [0; N];
    let mut chunks = bytes.chunks_exact(WORD);
    for word in &mut words {
        *word = u32::from_le_bytes(chunks.next()?.try_into().ok()?);
    }
    Some(words)
}

/// An estimate as the words of its record: equal words are equal to the bit.
pub fn estimate_words(e: &Estimate) -> [u32; 8] {
    [
        e.impedance.stiffness.to_bits(),
        e.impedance.damping.to_bits(),
        e.half_width.stiffness.to_bits(),
        e.half_width.damping.to_bits(),
        e.innovation.to_bits(),
        e.fill.to_bits(),
        e.excitation.to_bits(),
        u32::from(e.flags.bits()),
    ]
}

fn estimate_of(bytes: &[u8]) -> Option<Estimate> {
    let words = words::<8>(bytes)?;
    let [k, b, k_half, b_half, innovation, fill, excitation, flags] = words;
    let pair = |k, b| Impedance { stiffness: f32::from_bits(k), damping: f32::from_bits(b) };
    Some(Estimate {
        impedance: pair(k, b),
        half_width: pair(k_half, b_half),
        innovation: f32::from_bits(innovation),
        fill: f32::from_bits(fill),
        excitation: f32::from_bits(excitation),
        flags: Flags::from_bits(u16::try_from(flags).ok()?)?,
    })
}

const FIELDS: [Field; 3] = [Field::Position, Field::Force, Field::Elapsed];

/// 0 for an estimate, 1 to 3 for a field that is not finite, 4 to 6 for one out of range.
fn status_word(outcome: &UpdateResult) -> u32 {
    match outcome {
        Ok(_) => 0,
        Err(Rejection::NotFinite(field)) => 1 + *field as u32,
        Err(Rejection::OutOfRange(field)) => 4 + *field as u32,
    }
}

/// `None` where the word is no status, `Some(None)` for an estimate.
fn rejection_of(status: u32) -> Option<Option<Rejection>> {
    match status {
        0 => Some(None),
        1..=3 => Some(FIELDS.get(status as usize - 1).map(|&field| Rejection::NotFinite(field))),
        4..=6 => Some(FIELDS.get(status as usize - 4).map(|&field| Rejection::OutOfRange(field))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    extern crate std;

    #[test]
    fn every_outcome_survives_the_journey_to_the_bit() {
        let methods = Methods::default().with(Method::Sprls).with(Method::NewtonBlmf);
        let mut estimates = [Estimate::NO_CONTACT; Method::ALL.len()];
        estimates[Method::Sprls as usize] = Estimate {
            impedance: Impedance { stiffness: 300.25, damping: -0.0 },
            half_width: Impedance { stiffness: f32::INFINITY, damping: 1e-42 },
            innovation: -3.5,
            fill: 0.25,
            excitation: 1.0,
            flags: Flags::RESET | Flags::FILLING,
        };
        let mut outcomes = std::vec![Ok(estimates)];
        for field in FIELDS {
            outcomes.extend([Err(Rejection::NotFinite(field)), Err(Rejection::OutOfRange(field))]);
        }
        for outcome in outcomes {
            let mut bytes = std::vec![0xaa; record_bytes(methods)];
            encode_record(&outcome, methods, &mut bytes);
            assert_eq!(decode_record(&bytes, methods), Some(outcome));
        }
        assert_eq!(decode_record(&[7, 0, 0, 0], methods), None, "a status that does not exist");
        assert_eq!(decode_record(&[0; 40], methods), None, "cut short");
    }

    #[test]
    fn settings_samples_and_counters_stand_where_the_format_says() {
        let config = crate::Settings::default().bank_config(&crate::Calibration::DEFAULT).unwrap();
        let mut buffer = [0xaa; CONFIG_BYTES + 4];
        let bytes = encode_config(&config, &mut buffer).unwrap();
        let (length, body) = bytes.split_first_chunk::<4>().unwrap();
        assert_eq!(usize::try_from(u32::from_le_bytes(*length)), Ok(body.len()));
        assert_eq!(decode_config(body), Some(config));
        assert_eq!(decode_config(&body[..body.len() - 1]), None, "cut short");

        let sample = Sample { position: -0.25, force: 3.5, elapsed: 1e-3 };
        let bytes = encode_sample(&sample);
        let words = [-0.25_f32, 3.5, 1e-3].map(f32::to_le_bytes);
        assert_eq!(bytes.as_slice(), words.as_flattened());
        assert_eq!(decode_sample(&bytes), sample);

        let counters = ReplayCounters { samples: 1, ticks: 2 << 8, overruns: 3 << 16, starved: 4 << 24 };
        let bytes = encode_counters(&counters);
        assert_eq!(bytes, [1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4]);
        assert_eq!(decode_counters(&bytes), Some(counters));
    }

    #[test]
    fn a_record_is_a_word_and_eight_words_for_each_method() {
        let two = Methods::default().with(Method::Sprls).with(Method::NewtonBlmf);
        assert_eq!([Methods::default(), two].map(record_bytes), [4, 4 + 2 * 32]);
    }
}
