//! A rig of another author, as far as an investigation may know it: rig file, first recordings, limits, rich references, and the bed.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};

use super::source_bed::SourceBed;
use crate::challenge::external_cases::{tables, trials};
use crate::error::InputError;
use crate::experiment_design::Limits;
use crate::investigate::session::reference_column;
use crate::recording::Recording;
use crate::recording::data_file::{Content, DataFile};
use crate::rig::Rig;

/// What stands in the folder of a rig, less what is concealed.
#[derive(Debug, Clone)]
pub struct SourceRig {
    /// `rig.toml`: what the simulation knows.
    pub rig: Rig,
    /// `trial-1.csv` and so on: what an investigation begins with.
    pub given: Vec<Recording>,
    /// `limits.toml`.
    pub limits: Limits,
    /// `rich-1.csv` and so on: positions of the fixed rich trials, m or rad.
    pub rich: Vec<Vec<f64>>,
    /// `bed`, which runs the concealed rig; an absolute path.
    pub bed: PathBuf,
}

impl SourceRig {
    /// Reads `folder`.
    ///
    /// # Errors
    /// A file is absent or at fault, a reference has another clock than the recordings or is longer than a trial may last, or `bed` cannot
    /// be run.
    pub fn read(folder: &Path) -> Result<Self> {
        let rig = Rig::read(&folder.join("rig.toml"))?;
        let given = trials(folder)?.into_iter().map(|name| Recording::read(&folder.join(name), &rig));
        let given = given.collect::<Result<Vec<_>, _>>()?;
        let first = given.first().with_context(|| InputError::new(folder.display(), "no trial", "trial-1.csv, ..."))?;
        let limits = Limits::read(&folder.join("limits.toml"), &rig)?;
        let mut names = tables(folder, "rich-")?;
        // The tenth comes after the ninth.
        names.sort_by_key(String::len);
        ensure!(!names.is_empty(), InputError::new(folder.display(), "no rich reference", "rich-1.csv, ..."));
        let rich = names.iter().map(|name| reference(&folder.join(name), &rig, first.rate(), limits.duration_s));
        let rich = rich.collect::<Result<_, _>>()?;
        let bed = executable(&folder.join("bed"))?;
        Ok(Self { rig, given, limits, rich, bed })
    }

    /// A bed of this rig, before any trial.
    ///
    /// # Errors
    /// Its path is no text.
    pub fn bed(&self) -> Result<SourceBed> {
        SourceBed::new(&self.bed, &self.rig, self.rich.clone())
    }
}

/// The positions that `path` commands, one a row at `rate_hz`, for at most `most_s` seconds.
fn reference(path: &Path, rig: &Rig, rate_hz: f64, most_s: f64) -> Result<Vec<f64>, InputError> {
    let channels = DataFile::read(path)?.channels;
    let column = |name: &str| {
        let numbers = channels.iter().find_map(|channel| match &channel.content {
            Content::Numbers(values) if channel.name == name => Some(values),
            _ => None,
        });
        let values = numbers
            .ok_or_else(|| InputError::new(path.display(), format!("no column {name}"), "t_s and what is commanded"))?;
        match values.iter().position(|value| !value.is_finite()) {
            None => Ok(values),
            Some(row) => Err(InputError::new(
                format!("{}: {name}, row {}", path.display(), row + 1),
                values[row],
                "a finite number",
            )),
        }
    };
    let (time, positions) = (column("t_s")?, column(reference_column(rig))?);
    let off = |row: usize| (time[row] - time[0] - row as f64 / rate_hz).abs() * rate_hz > 0.5;
    if let Some(row) = (0..time.len()).find(|row| off(*row)) {
        let place = format!("{}: t_s, row {}", path.display(), row + 1);
        return Err(InputError::new(place, time[row], format!("{rate_hz:.1} rows a second, as the recordings have")));
    }
    let length = time.len() as f64 / rate_hz;
    // The last row may be that of the last instant.
    if positions.len() < 2 || length > most_s + 1.5 / rate_hz {
        let expected = format!("a motion of no more than {most_s} s, as [limits] duration_s says");
        return Err(InputError::new(path.display(), format!("{length:.3} s"), expected));
    }
    Ok(positions.clone())
}

/// The absolute path of `bed`, which can be run.
fn executable(bed: &Path) -> Result<PathBuf> {
    let wrong =
        |found: &str| InputError::new(bed.display(), found, "an executable, called as bed REFERENCE.csv RECORDING.csv");
    let found = std::fs::metadata(bed).map_err(|_| wrong("no such file"))?;
    ensure!(found.is_file(), wrong("no file"));
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        ensure!(found.permissions().mode() & 0o111 != 0, wrong("a file that is not executable"));
    }
    // Not resolved: where `bed` is a link, what it leads to may look beside itself for the rig.
    std::path::absolute(bed).with_context(|| format!("no absolute path of {}", bed.display()))
}

#[cfg(all(test, unix))]
pub(crate) mod tests {
    use std::os::unix::fs::PermissionsExt as _;

    use tempfile::TempDir;

    use super::*;

    const RECORDED: &str = "t_s,position_m,effort_N\n0.000,0.001,1.0\n0.001,0.002,1.0\n0.002,0.002,1.0\n";
    const LIMITS: &str = "[limits]\nposition_min_m = -0.02\nposition_max_m = 0.02\nspeed_m_s = 0.3\nduration_s = 5.0\n";

    /// A reference of `rows` rows, `period_s` apart.
    fn motion(rows: usize, period_s: f64) -> String {
        let rows = (0..rows).map(|row| format!("{},{}\n", row as f64 * period_s, 1e-3 * row as f64));
        rows.fold("t_s,reference_m\n".to_owned(), |text, row| text + &row)
    }

    /// The folder of a rig, at `folder`.
    pub(crate) fn write(folder: &Path) {
        std::fs::create_dir_all(folder).unwrap();
        let rig = "[rig]\nname = \"arm\"\n[drive]\nmass_kg = 1.0\nviscous_n_s_m = 2.0\n";
        for (name, text) in
            [("rig.toml", rig), ("trial-1.csv", RECORDED), ("limits.toml", LIMITS), ("bed", "#!/bin/sh\n")]
        {
            std::fs::write(folder.join(name), text).unwrap();
        }
        std::fs::write(folder.join("rich-1.csv"), motion(3, 1e-3)).unwrap();
        std::fs::set_permissions(folder.join("bed"), std::fs::Permissions::from_mode(0o755)).unwrap();
    }

    #[test]
    fn the_tenth_reference_comes_after_the_ninth_and_what_is_concealed_is_not_read() {
        let folder = TempDir::new().unwrap();
        write(folder.path());
        for nth in 2..=10 {
            std::fs::write(folder.path().join(format!("rich-{nth}.csv")), motion(nth + 2, 1e-3)).unwrap();
        }
        let rig = SourceRig::read(folder.path()).unwrap();
        let lengths: Vec<usize> = rig.rich.iter().map(Vec::len).collect();
        assert_eq!(lengths, [3, 4, 5, 6, 7, 8, 9, 10, 11, 12]);
        assert_eq!((rig.rich[0].as_slice(), rig.given.len()), ([0.0, 1e-3, 2e-3].as_slice(), 1));
        assert!(rig.bed.is_absolute() && rig.limits.duration_s == 5.0);
    }

    #[test]
    fn a_rig_that_cannot_be_used_is_refused_by_file_finding_and_expectation() {
        let refused = |spoil: &dyn Fn(&Path), expected: [&str; 2]| {
            let folder = TempDir::new().unwrap();
            let rig = folder.path().join("031");
            write(&rig);
            spoil(&rig);
            let error = format!("{:#}", SourceRig::read(&rig).unwrap_err());
            assert!(error.contains("031") && expected.iter().all(|part| error.contains(part)), "{expected:?}: {error}");
        };
        let without = |name: &'static str| move |rig: &Path| std::fs::remove_file(rig.join(name)).unwrap();
        let rich = |text: String| move |rig: &Path| std::fs::write(rig.join("rich-1.csv"), &text).unwrap();
        refused(&without("rig.toml"), ["rig.toml", "expected"]);
        refused(&without("trial-1.csv"), ["no trial", "trial-1.csv"]);
        refused(&without("limits.toml"), ["limits.toml", "[limits]"]);
        refused(&without("rich-1.csv"), ["no rich reference", "rich-1.csv"]);
        refused(&without("bed"), ["bed: found no such file", "REFERENCE.csv RECORDING.csv"]);
        let locked = |rig: &Path| {
            std::fs::set_permissions(rig.join("bed"), std::fs::Permissions::from_mode(0o644)).unwrap();
        };
        refused(&locked, ["not executable", "REFERENCE.csv RECORDING.csv"]);
        refused(&rich(motion(3, 2e-3)), ["rich-1.csv: t_s, row 2", "1000.0 rows a second"]);
        refused(&rich(motion(5002, 1e-3)), ["5.002 s", "no more than 5 s"]);
        refused(&rich("t_s,position_m\n0,0\n0.001,0\n".to_owned()), ["no column reference_m", "t_s"]);
        refused(&rich("t_s,reference_m\n0,0\n0.001,\n".to_owned()), ["reference_m, row 2", "a finite number"]);
    }
}
