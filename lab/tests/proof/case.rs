//! One case: drawn, written, read back as a user's files, diagnosed, and last held against its truth.

use std::path::Path;
use std::time::Instant;

use palpate_cases::truth::Kind;
use palpate_cases::{Truth, Wish, draw};
use palpate_lab::diagnose::answer::Answer;
use palpate_lab::diagnose::diagnose;
use palpate_lab::recording::Recording;
use palpate_lab::rig::Rig;

use crate::row::Row;
use crate::values;

/// Draws case `index` of `seed`, diagnoses it with twins of `twins`, and scores.
pub fn prove(seed: u64, index: u64, wish: &Wish, twins: u64) -> Row {
    let case = draw(seed, index, wish).expect("a wish that can be drawn");
    let folder = tempfile::tempdir().expect("a folder for the recordings");
    case.write(folder.path()).expect("recordings that can be written");
    let start = Instant::now();
    let answer = diagnosed(folder.path(), case.trials.len(), twins);
    let seconds = start.elapsed().as_secs_f64();
    score(&case.truth, answer, seconds)
}

/// The same path as `palpate diagnose --rig rig.toml trial-1.csv trial-2.csv`.
fn diagnosed(folder: &Path, trials: usize, twins: u64) -> Result<Answer, String> {
    let rig = folder.join("rig.toml");
    let origin = rig.display().to_string();
    let rig = Rig::read(&rig).map_err(|error| error.to_string())?;
    let read = |number| Recording::read(&folder.join(format!("trial-{number}.csv")), &rig);
    let trials = (1..=trials).map(read).collect::<Result<Vec<_>, _>>().map_err(|error| error.to_string())?;
    let found = diagnose(&rig, &origin, &trials, &[], twins, &|_| ()).map_err(|error| format!("{error:#}"))?;
    Ok(found.answer)
}

fn score(truth: &Truth, answer: Result<Answer, String>, seconds: f64) -> Row {
    let mut row = Row {
        seed: truth.seed,
        index: truth.index,
        kind: truth.kind,
        truth: truth.effects.iter().map(|effect| effect.name.to_owned()).collect(),
        asked: truth.effects.iter().map(|effect| effect.strength_asked).fold(0.0, f64::max),
        strength: truth.strength,
        grade: truth.grade,
        reference: truth.reference,
        effort: truth.channels.iter().any(|channel| channel.starts_with("effort")),
        named: Vec::new(),
        rivals: Vec::new(),
        verdict: None,
        before: None,
        after: None,
        values: Vec::new(),
        seconds,
        failure: None,
    };
    match answer {
        Err(failure) => row.failure = Some(failure),
        Ok(answer) => {
            row.named = answer.physics.iter().map(|physics| physics.name.clone()).collect();
            row.rivals = answer.rivals.iter().map(|rival| rival.physics.clone()).collect();
            row.verdict = Some(answer.verdict);
            let over = |rms: f64| (answer.fit.noise_floor > 0.0).then(|| rms / answer.fit.noise_floor);
            row.before = over(answer.fit.refitted);
            row.after = over(answer.fit.improved);
            if truth.kind == Kind::Single && row.is_right() {
                row.values = values::compare(truth, &answer.physics);
            }
        }
    }
    row
}
