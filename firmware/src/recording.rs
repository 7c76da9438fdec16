//! The recording, read by semihosting into memory once.

use palpate::{EstimatorBankConfig, Sample};
use palpate_drive::replay_format::{CONFIG_BYTES, SAMPLE_BYTES, decode_config, decode_sample};
use semihosting::fs::File;
use semihosting::io::Read;

/// Why the image gave up.
pub type Fault = &'static str;

/// Samples that fit into the memory beside everything else.
const CAPACITY: usize = 6_000;

/// Settings and samples.
pub struct Recording {
    /// Settings of the stream and of all laws.
    pub config: EstimatorBankConfig,
    /// The samples, in order.
    pub samples: &'static [Sample],
}

/// Reads `profile.in`: settings and samples as `palpate_drive::replay_format` has them.
pub fn read() -> Result<Recording, Fault> {
    let mut file = File::open(c"profile.in").map_err(|_| "cannot open profile.in in the folder it was run in")?;
    let mut length = [0; 4];
    file.read_exact(&mut length).map_err(|_| "profile.in is shorter than its header")?;
    let mut bytes = [0; CONFIG_BYTES];
    let length = usize::try_from(u32::from_le_bytes(length)).unwrap_or(usize::MAX);
    let bytes = bytes.get_mut(..length).ok_or("profile.in: the header is longer than any settings")?;
    file.read_exact(bytes).map_err(|_| "profile.in is shorter than its settings")?;
    let config = decode_config(bytes).ok_or("profile.in: the settings are not those of this image")?;
    Ok(Recording { config, samples: samples(&mut file)? })
}

fn samples(file: &mut File) -> Result<&'static [Sample], Fault> {
    const NOTHING: Sample = Sample { position: 0.0, force: 0.0, elapsed: 0.0 };
    let room = cortex_m::singleton!(: [Sample; CAPACITY] = [NOTHING; CAPACITY]).ok_or("the recording is read once")?;
    let mut count = 0;
    loop {
        let mut bytes = [0; SAMPLE_BYTES];
        match file.read(&mut bytes).map_err(|_| "cannot read profile.in")? {
            0 => return room.get(..count).ok_or("more samples than places"),
            SAMPLE_BYTES => {}
            _ => return Err("profile.in ends within a sample"),
        }
        *room.get_mut(count).ok_or("profile.in: more samples than this image has room for")? = decode_sample(&bytes);
        count += 1;
    }
}
