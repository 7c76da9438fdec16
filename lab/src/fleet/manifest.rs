//! A fleet as a manifest: a list of rigs in TOML or CSV. Paths are relative to the manifest's folder.

use std::path::Path;

use serde::Deserialize;

use super::source::FleetRig;
use crate::error::InputError;

/// What a manifest in TOML looks like.
const TOML_LAYOUT: &str = "[[rig]] tables with name, rig (the rig file) and recordings (a list of files)";
/// What a manifest in CSV looks like.
const CSV_LAYOUT: &str = "the columns name, rig (the rig file) and recording, one line a recording";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Manifest {
    #[serde(default)]
    rig: Vec<Entry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: String,
    rig: String,
    recordings: Vec<String>,
}

#[derive(Deserialize)]
struct Line {
    name: String,
    rig: String,
    recording: String,
}

/// The rigs that the manifest at `path` lists, in its order.
///
/// # Errors
/// It cannot be read, is neither TOML nor CSV, or a name cannot be that of a folder.
pub fn read(path: &Path) -> Result<Vec<FleetRig>, InputError> {
    let expected = "a folder of rigs, or a manifest in TOML or CSV";
    let text = std::fs::read_to_string(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => InputError::new(path.display(), "no such file or folder", expected),
        _ => InputError::new(path.display(), format!("it cannot be read: {error}"), expected),
    })?;
    let ending = path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
    let rigs = match ending.as_deref() {
        Some("toml") => toml_entries(path, &text)?,
        Some("csv") => csv_entries(path, &text)?,
        _ => return Err(InputError::new(path.display(), "a file that ends otherwise", expected)),
    };
    match rigs.iter().find(|rig| !is_folder_name(&rig.name)) {
        Some(rig) => {
            let expected = "a name that a folder can have: no / or \\, no control character, no dot first";
            Err(InputError::new(path.display(), format!("a rig of the name {:?}", rig.name), expected))
        }
        None => Ok(rigs),
    }
}

fn toml_entries(path: &Path, text: &str) -> Result<Vec<FleetRig>, InputError> {
    let manifest: Manifest = toml::from_str(text).map_err(|error| {
        let line = error.span().map_or(1, |span| text[..span.start].matches('\n').count() + 1);
        InputError::new(format!("{}:{line}", path.display()), error.message(), TOML_LAYOUT)
    })?;
    let of = |entry: Entry| FleetRig {
        name: entry.name,
        rig: beside(path, &entry.rig),
        recordings: entry.recordings.iter().map(|recording| beside(path, recording)).collect(),
    };
    Ok(manifest.rig.into_iter().map(of).collect())
}

/// Lines of one name are the trials of one rig, wherever they stand.
fn csv_entries(path: &Path, text: &str) -> Result<Vec<FleetRig>, InputError> {
    let mut rigs: Vec<FleetRig> = Vec::new();
    let mut reader =
        csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.trim_start_matches('\u{feff}').as_bytes());
    for (at, line) in reader.deserialize::<Line>().enumerate() {
        let line = line.map_err(|error| {
            let number = error.position().map_or(at as u64 + 2, csv::Position::line);
            InputError::new(format!("{}:{number}", path.display()), error, CSV_LAYOUT)
        })?;
        let (rig, recording) = (beside(path, &line.rig), beside(path, &line.recording));
        match rigs.iter_mut().find(|rig| rig.name == line.name) {
            Some(found) if found.rig == rig => found.recordings.push(recording),
            Some(found) => {
                let expected = format!("one rig file for {}, {}", found.name, found.rig.display());
                return Err(InputError::new(format!("{}: {}", path.display(), line.name), rig.display(), expected));
            }
            None => rigs.push(FleetRig { name: line.name, rig, recordings: vec![recording] }),
        }
    }
    Ok(rigs)
}

fn beside(manifest: &Path, file: &str) -> std::path::PathBuf {
    manifest.parent().unwrap_or(Path::new("")).join(file)
}

fn is_folder_name(name: &str) -> bool {
    !name.is_empty()
        && !name.starts_with('.')
        && !name.chars().any(|letter| letter.is_control() || "/\\".contains(letter))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(name: &str, text: &str) -> Result<Vec<FleetRig>, String> {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join(name);
        std::fs::write(&path, text).unwrap();
        let below = |file: &Path| file.strip_prefix(home.path()).unwrap().to_owned();
        let of = |rig: FleetRig| FleetRig {
            rig: below(&rig.rig),
            recordings: rig.recordings.iter().map(|file| below(file)).collect(),
            ..rig
        };
        Ok(read(&path).map_err(|error| error.to_string())?.into_iter().map(of).collect())
    }

    fn rig(name: &str, rig: &str, recordings: &[&str]) -> FleetRig {
        let recordings = recordings.iter().map(Into::into).collect();
        FleetRig { name: name.to_owned(), rig: rig.into(), recordings }
    }

    #[test]
    fn both_forms_list_the_same_rigs() {
        let toml = "[[rig]]\nname = \"press 3\"\nrig = \"press.toml\"\nrecordings = [\"3/a.csv\", \"3/b.mcap\"]\n\
                    [[rig]]\nname = \"press 4\"\nrig = \"press.toml\"\nrecordings = []\n";
        assert_eq!(
            parse("fleet.toml", toml).unwrap(),
            [rig("press 3", "press.toml", &["3/a.csv", "3/b.mcap"]), rig("press 4", "press.toml", &[])]
        );
        let csv = "\u{feff}name, rig, recording, hall\npress 3,press.toml,3/a.csv,B\npress 4,press.toml,4/a.csv,B\npress 3,press.toml,3/b.mcap,B\n";
        assert_eq!(
            parse("fleet.csv", csv).unwrap(),
            [rig("press 3", "press.toml", &["3/a.csv", "3/b.mcap"]), rig("press 4", "press.toml", &["4/a.csv"])]
        );
    }

    #[test]
    fn a_manifest_at_fault_is_told_by_its_line() {
        let refused = |name: &str, text: &str, words: &[&str]| {
            let error = parse(name, text).unwrap_err();
            assert!(words.iter().all(|word| error.contains(word)), "{error}");
        };
        refused("fleet.toml", "[[rig]]\nname = \"a\"\nrig = 3\n", &["fleet.toml:3", "[[rig]] tables"]);
        refused("fleet.toml", "[[rig]]\nname = \"a\"\nrig = \"r\"\n", &["fleet.toml:1", "recordings"]);
        refused("fleet.toml", "[[rigs]]\n", &["fleet.toml:1", "rigs"]);
        refused("fleet.csv", "name,rig\na,b\n", &["fleet.csv:2", "recording"]);
        refused("fleet.csv", "name,rig,recording\na,b,c\na,d,e\n", &["fleet.csv: a", "one rig file"]);
        refused("fleet.yaml", "", &["in TOML or CSV"]);
        for name in ["", "..", "a/b", "a\\\\b", ".hidden"] {
            refused(
                "f.toml",
                &format!("[[rig]]\nname = \"{name}\"\nrig = \"r\"\nrecordings = []\n"),
                &["a folder can have"],
            );
        }
    }
}
