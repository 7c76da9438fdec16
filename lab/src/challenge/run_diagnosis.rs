//! One diagnosis: the command that a user runs, on plain files, in a folder that holds nothing else.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context as _, Result};

use super::diagnosis_json::{DiagnosisJson, SCHEMA};
use crate::interrupt;

/// Where the command leaves its answer.
const ANSWER_FILE: &str = "diagnosis.json";

/// Runs `tool diagnose` in `folder` on its rig file, with `arguments`: its answer, or why there is none, and the seconds from
/// its start to its end.
///
/// # Errors
/// The command cannot be started, or the answer of an interrupted run cannot be removed.
pub fn run_diagnosis(tool: &Path, folder: &Path, arguments: &[&str]) -> Result<(Result<DiagnosisJson, String>, f64)> {
    let mut command = Command::new(tool);
    command.args(["diagnose", "--rig", "rig.toml", "--json", ANSWER_FILE]).args(arguments).current_dir(folder);
    run_command(&mut command, &folder.join(ANSWER_FILE))
}

/// Runs `command`, which writes its answer to `answer`, in a process of its own: whatever becomes of that, this one goes on.
///
/// # Errors
/// The command cannot be started, or the answer of an earlier run cannot be removed.
pub fn run_command(command: &mut Command, answer: &Path) -> Result<(Result<DiagnosisJson, String>, f64)> {
    if answer.exists() {
        std::fs::remove_file(answer).with_context(|| format!("cannot remove {}", answer.display()))?;
    }
    let start = Instant::now();
    let output = interrupt::output(command.stdin(Stdio::null()))
        .with_context(|| format!("cannot run {}", command.get_program().display()))?;
    let seconds = start.elapsed().as_secs_f64();
    let diagnosis = if output.status.success() {
        read_answer(answer)
    } else {
        let errors = String::from_utf8_lossy(&output.stderr);
        Err(format!("{}: {}", output.status, errors.lines().last().unwrap_or("no message")))
    };
    Ok((diagnosis, seconds))
}

/// The answer that a diagnosis left at `path`, or why there is none.
///
/// # Errors
/// There is no such file, or it is none of [`SCHEMA`].
pub fn read_answer(path: &Path) -> Result<DiagnosisJson, String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("no answer was written: {error}"))?;
    let answer: DiagnosisJson =
        serde_json::from_str(&text).map_err(|error| format!("an answer that is none of {SCHEMA}: {error}"))?;
    if answer.schema == SCHEMA { Ok(answer) } else { Err(format!("an answer of {}, not of {SCHEMA}", answer.schema)) }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt as _;

    const ANSWER: &str = r#"{"schema": "palpate.diagnosis/1", "verdict": "explained", "rivals": [],
        "physics": [{"name": "adhesion", "parameters": []}],
        "fit": {"unit": "N", "noise_floor": 1.0, "refitted": 2.0, "improved": 1.0}}"#;

    /// What comes of a command that does `script` in its folder, where an earlier run has left `before`.
    fn run(script: &str, before: Option<&str>) -> Result<DiagnosisJson, String> {
        let folder = tempfile::tempdir().unwrap();
        let tool = folder.path().join("tool");
        std::fs::write(&tool, format!("#!/bin/sh\n{script}\n")).unwrap();
        std::fs::set_permissions(&tool, std::fs::Permissions::from_mode(0o755)).unwrap();
        if let Some(text) = before {
            std::fs::write(folder.path().join(ANSWER_FILE), text).unwrap();
        }
        let (answer, seconds) = run_diagnosis(&tool, folder.path(), &["trial-1.csv"]).unwrap();
        assert!(seconds > 0.0);
        answer
    }

    fn write(text: &str) -> String {
        format!("cat > diagnosis.json <<'END'\n{text}\nEND")
    }

    #[test]
    fn an_answer_is_read_where_the_command_succeeds() {
        let given = format!(
            "test \"$*\" = 'diagnose --rig rig.toml --json diagnosis.json trial-1.csv' || exit 3\n{}",
            write(ANSWER)
        );
        assert_eq!(run(&given, None).unwrap().names(), ["adhesion"]);
    }

    #[test]
    fn an_exit_status_other_than_zero_is_no_answer_whatever_was_written() {
        let error = run(&(write(ANSWER) + "\necho broken >&2\nexit 1"), None).unwrap_err();
        assert!(error.contains("exit status: 1") && error.contains("broken"), "{error}");
    }

    #[test]
    fn an_answer_of_an_earlier_run_is_not_read() {
        let error = run("exit 0", Some(ANSWER)).unwrap_err();
        assert!(error.contains("no answer was written"), "{error}");
    }

    #[test]
    fn another_schema_is_no_answer() {
        let error = run(&write(&ANSWER.replace("diagnosis/1", "diagnosis/2")), None).unwrap_err();
        assert!(error.contains("palpate.diagnosis/2"), "{error}");
        assert!(run(&write("{}"), None).is_err());
    }
}
