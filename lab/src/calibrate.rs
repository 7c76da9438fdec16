//! `palpate calibrate`: from a file that a person writes to the block that a drive reads.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use clap::Args;
use palpate_drive::{CALIBRATION_BYTES, Calibration, PositionSensor, TICK_HZ};

use crate::error::InputError;
use crate::outfile::OutFile;
use crate::output_paths;

/// Make the calibration block that a drive reads from its flash
#[derive(Debug, Clone, Args)]
pub struct CalibrateArgs {
    /// The calibration, an example that was edited (docs/drive.md has the steps)
    #[arg(value_name = "CALIBRATION.toml", required_unless_present = "example")]
    pub calibration: Option<PathBuf>,
    /// The block to write, for the flash at 0x080E0000
    #[arg(long, value_name = "CALIBRATION.bin", required_unless_present = "example", requires = "calibration")]
    pub out: Option<PathBuf>,
    /// Print an example to copy, each key with its meaning and unit
    #[arg(long)]
    pub example: bool,
}

/// Runs `palpate calibrate`.
///
/// # Errors
/// The file is at fault, or the block cannot be written.
pub fn run(args: &CalibrateArgs) -> Result<()> {
    let (Some(path), Some(out)) = (&args.calibration, &args.out) else {
        print!("{}", example()?);
        return Ok(());
    };
    output_paths::check(&[path], &[("--out", out)])?;
    let fault = |found: String, expected: &str| InputError::new(path.display(), found, expected);
    let text = std::fs::read_to_string(path).map_err(|error| fault(error.to_string(), "a calibration"))?;
    let calibration: Calibration = toml::from_str(&text).map_err(|error| {
        fault(error.to_string().trim_end().to_owned(), "a calibration as `palpate calibrate --example` prints it")
    })?;
    refuse_unknown_keys(path, &text)?;
    calibration.check().map_err(|error| fault(format!("{} out of range", error.parameter), error.expected))?;
    plausible(&calibration).map_err(|(key, expected)| fault(format!("{key} out of range"), &expected))?;
    let mut buffer = [0; CALIBRATION_BYTES];
    let block = calibration.write(&mut buffer).context("the calibration does not fit its block")?;
    let mut file = OutFile::create(out)?;
    file.write_all(block).map_err(|error| file.fault(&error))?;
    file.commit()?;
    Ok(())
}

/// The meaning of each key, for the reader of the example.
const KEYS: [(&str, &str); 15] = [
    ("date", "when it was made, as 20261121; 0: not said"),
    ("position_sensor", "\"As5047p\" (absolute, one turn) or \"Quadrature\""),
    ("counts_per_turn", "of the encoder: 16384, or four times the lines of a quadrature encoder"),
    ("travel_per_turn", "m of the tool in a turn of the encoder; negative where they run against each other"),
    ("centre", "reading of the absolute encoder in the middle of the travel"),
    ("surface", "counts from `centre` at which contact begins"),
    ("travel", "m from the surface: first and last position that can be"),
    ("max_speed", "m/s, the fastest that the tool can go"),
    ("force_gain", "N a count of the converter; negative where a push lowers the count"),
    ("force_zero", "counts without any force"),
    ("force_limit", "N, the largest force that the sensor is calibrated for"),
    ("force_noise", "N, standard deviation with nothing touching, rounding included"),
    ("tare_limit", "N, how far a tare may move the zero"),
    (
        "range",
        "of the converter's input: \"Volts2\" (2.56 V either way), \"Volts5\", \"Volts6\", \"Volts10\" or \"Volts12\"",
    ),
    ("stuck_after", "ms of one and the same reading after which position and force are stuck; 0: never"),
];

/// The default calibration, each key with its meaning.
fn example() -> Result<String> {
    let plain = toml::to_string(&Calibration::DEFAULT).context("the default calibration is no TOML")?;
    let width = plain.lines().map(str::len).max().unwrap_or(0);
    let meaning = |line: &str| KEYS.into_iter().find(|(key, _)| line.split(' ').next() == Some(*key));
    let line = |line| match meaning(line) {
        Some((_, meaning)) => format!("{line:<width$}  # {meaning}\n"),
        None => format!("{line}\n"),
    };
    let head = "# On a rotary joint read rad for m and N m for N.\n".to_owned();
    Ok(plain.lines().map(line).fold(head, |text, line| text + &line))
}

/// A key that nobody reads is a slip of the pen: what it was to say would silently be the default or the line above.
fn refuse_unknown_keys(path: &Path, text: &str) -> Result<()> {
    let table: toml::Table = text.parse().context("a calibration is TOML")?;
    let known = toml::Table::try_from(Calibration::DEFAULT).context("the default calibration is no TOML")?;
    let Some(key) = table.keys().find(|key| !known.contains_key(*key)) else { return Ok(()) };
    let nearest = known.keys().max_by(|a, b| strsim::jaro(a, key).total_cmp(&strsim::jaro(b, key)));
    let expected = format!("one of the keys of the example; the nearest is {}", nearest.map_or("", String::as_str));
    bail!(InputError::new(path.display(), format!("the key {key}"), expected))
}

/// Whether limits are ones that the sensors can see: the drive takes any, and a limit that is never reached protects nothing.
fn plausible(calibration: &Calibration) -> Result<(), (&'static str, String)> {
    let full_scale = calibration.force_gain.abs() * 65_536.0;
    let forces = [
        ("force_limit", calibration.force_limit, full_scale),
        ("force_noise", calibration.force_noise, calibration.force_limit),
        ("tare_limit", calibration.tare_limit, calibration.force_limit),
    ];
    if let Some((key, _, most)) = forces.into_iter().find(|(_, value, most)| value > most) {
        let reason = if key == "force_limit" { "the converter's 65536 counts" } else { "the force_limit" };
        return Err((key, format!("at most {most} N, {reason}")));
    }
    let fastest = 0.5 * calibration.travel_per_turn.abs() * f32::from(TICK_HZ);
    if calibration.max_speed > fastest {
        return Err(("max_speed", format!("at most {fastest} m/s, half a turn of the encoder in a tick")));
    }
    if calibration.position_sensor == PositionSensor::As5047p {
        let half = 0.5 * calibration.travel_per_turn.abs();
        let shift = calibration.surface as f32 * calibration.position_per_count();
        let [low, high] = [-half - shift, half - shift];
        // Rounding of the units alone.
        let slack = 1e-3 * half;
        if calibration.travel[0] < low - slack || calibration.travel[1] > high + slack {
            return Err(("travel", format!("within {low} to {high} m, the one turn of the encoder around `centre`")));
        }
    }
    let dates = 20_000_101..=99_991_231;
    if calibration.date != 0 && !dates.contains(&calibration.date) {
        return Err(("date", "a day as 20261121, or 0".to_owned()));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_that_no_sensor_can_reach_are_refused_by_their_keys() {
        let default = Calibration::DEFAULT;
        assert_eq!(plausible(&default), Ok(()));
        for (key, calibration) in [
            ("force_limit", Calibration { force_limit: 1e30, ..default }),
            ("force_noise", Calibration { force_noise: 1e30, ..default }),
            ("tare_limit", Calibration { tare_limit: 1e30, ..default }),
            ("max_speed", Calibration { max_speed: 1e30, ..default }),
            ("travel", Calibration { travel: [-1e9, 1e9], ..default }),
            ("travel", Calibration { surface: 4_000, ..default }),
            ("date", Calibration { date: u32::MAX, ..default }),
        ] {
            assert_eq!(plausible(&calibration).unwrap_err().0, key);
        }
    }

    #[test]
    fn the_example_tells_every_key_and_reads_back_as_the_default() {
        let text = example().unwrap();
        assert_eq!(toml::from_str::<Calibration>(&text).unwrap(), Calibration::DEFAULT);
        let keys: Vec<String> = toml::Table::try_from(Calibration::DEFAULT).unwrap().keys().cloned().collect();
        assert_eq!(keys.len(), KEYS.len());
        for key in keys {
            let line = text.lines().find(|line| line.starts_with(&format!("{key} "))).unwrap();
            assert!(line.contains("  # "), "{line}");
        }
    }

    #[test]
    fn a_key_that_nobody_reads_is_refused_with_the_nearest() {
        let text = toml::to_string(&Calibration::DEFAULT).unwrap();
        let path = Path::new("calibration.toml");
        assert!(refuse_unknown_keys(path, &text).is_ok());
        let error = refuse_unknown_keys(path, &format!("force_limits = 3.0\n{text}")).unwrap_err().to_string();
        assert!(error.contains("force_limits") && error.contains("nearest is force_limit"), "{error}");
    }
}
