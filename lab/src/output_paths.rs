//! Where a command writes: never over its own input, and never twice to one place.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};

use crate::error::{InputError, UsageError};

/// Refuses `outputs`, options with their paths, where one is among `inputs` or two are the same file. `-`, standard output, is no file.
///
/// # Errors
/// A slip on the command line that would cost a user a recording, or one of two results.
pub fn check(inputs: &[&Path], outputs: &[(&str, &Path)]) -> Result<()> {
    let places: Vec<_> = outputs.iter().filter_map(|(option, path)| Some((*option, *path, place(path)?))).collect();
    for (at, (option, path, output)) in places.iter().enumerate() {
        if inputs.iter().any(|input| place(input).is_some_and(|input| input == *output)) {
            bail!(InputError::new(path.display(), "an input of this very run", "another file to write to"));
        }
        if let Some((other, ..)) = places[..at].iter().find(|(.., earlier)| earlier == output) {
            let found = format!("{}, which {other} writes", path.display());
            bail!(UsageError::new(option, found, "a file of its own"));
        }
    }
    Ok(())
}

/// The file that `path` names, with links followed; `None` for a device or a pipe, which may be written to twice, and standard output.
fn place(path: &Path) -> Option<PathBuf> {
    if path.as_os_str() == "-" {
        return None;
    }
    match std::fs::canonicalize(path) {
        Ok(there) => there.is_file().then_some(there),
        Err(_) => {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            let folder = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
            Some(folder.join(path.file_name()?))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_input_and_a_place_that_is_taken_are_refused_however_they_are_spelt() {
        let folder = tempfile::tempdir().unwrap();
        let (input, fresh) = (folder.path().join("trial.csv"), folder.path().join("new.json"));
        std::fs::write(&input, "t_s").unwrap();
        std::fs::create_dir(folder.path().join("sub")).unwrap();
        let beside = folder.path().join("sub").join("..").join("new.json");
        let over = folder.path().join("sub").join("..").join("trial.csv");
        let [one, other] = ["--json", "--report"];
        assert!(check(&[&input], &[(one, &fresh)]).is_ok());
        let error = check(&[&input], &[(one, &over)]).unwrap_err();
        assert!(error.is::<InputError>() && error.to_string().contains("an input of this very run"), "{error}");
        let error = check(&[&input], &[(one, &fresh), (other, &beside)]).unwrap_err();
        assert!(error.is::<UsageError>() && error.to_string().contains("--json writes"), "{error}");
        let standard = Path::new("-");
        assert!(check(&[], &[(one, standard), (other, standard)]).is_ok());
    }
}
