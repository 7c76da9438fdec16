//! The answers, sealed before the first diagnosis.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};
use serde::Serialize;
use sha2::{Digest as _, Sha256};

/// A file of answers that has been committed to.
#[derive(Debug)]
pub struct Commitment {
    path: PathBuf,
    sha256: String,
}

impl Commitment {
    /// Writes `answers` to `path`, a line of JSON each, and commits to it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn commit(path: &Path, answers: impl Iterator<Item = impl Serialize>) -> Result<Self> {
        let text = lines(answers)?;
        fs::write(path, &text).with_context(|| format!("cannot write {}", path.display()))?;
        Ok(Self { path: path.to_owned(), sha256: hash(text.as_bytes()) })
    }

    /// The commitment: SHA-256 of the file, in hexadecimal.
    #[must_use]
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// Holds the file against the commitment, and `answers`, which are to be scored by, against the file.
    ///
    /// # Errors
    /// The file is gone or another, or the answers are not those that were sealed.
    pub fn verify(&self, answers: impl Iterator<Item = impl Serialize>) -> Result<()> {
        let found = fs::read(&self.path).with_context(|| format!("cannot read {}", self.path.display()))?;
        let broken =
            || format!("{}: found another file than was sealed by SHA-256 {}", self.path.display(), self.sha256);
        ensure!(hash(&found) == self.sha256, broken());
        ensure!(found == lines(answers)?.as_bytes(), "the answers to be scored by are not those that were sealed");
        Ok(())
    }
}

fn lines(answers: impl Iterator<Item = impl Serialize>) -> Result<String> {
    let mut text = String::new();
    for answer in answers {
        text += &serde_json::to_string(&answer).context("an answer cannot be written as JSON")?;
        text.push('\n');
    }
    Ok(text)
}

fn hash(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use palpate_cases::{CaseRequest, EffectSelection, Truth, draw};

    #[test]
    fn a_seal_holds_what_was_sealed_and_nothing_else() {
        let request = CaseRequest { selection: Some(EffectSelection::Nothing), ..CaseRequest::default() };
        let truths: Vec<Truth> = (0..2).map(|index| draw(9, index, &request).unwrap().truth).collect();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("answers.jsonl");
        let commitment = Commitment::commit(&path, truths.iter()).unwrap();
        // The empty message has a hash that everybody knows: the function is the one that it is called.
        assert_eq!(hash(b""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
        assert_eq!(commitment.sha256().len(), 64);
        commitment.verify(truths.iter()).unwrap();
        assert!(commitment.verify(truths.iter().rev()).is_err(), "other answers");
        fs::write(&path, fs::read_to_string(&path).unwrap().replacen("none", "pair", 1)).unwrap();
        assert!(commitment.verify(truths.iter()).is_err(), "another file");
    }
}
