//! The real recordings in Markdown.

use super::specimen_score::{RecordingScores, SpecimenScore, spaced};

/// Names offered beside the answer that a table has room for.
const MAX_ALTERNATIVES: usize = 3;

/// One line: how many came out how.
#[must_use]
pub fn line(recorded: &RecordingScores) -> String {
    let RecordingScores {
        n,
        named,
        rest_owned,
        owned,
        undecidable,
        wrong,
        missed,
        held_back,
        left_median,
        better,
        halved,
        ..
    } = recorded;
    let mut text = format!(
        "Real recordings, {n} specimens: known physics named and nothing else {named} (in {rest_owned} the rest reported as unknown), \
         reported as unknown {owned}, undecidable and said so {undecidable}, wrong {wrong}, missed {missed}."
    );
    if *held_back > 0 {
        let halved = halved.map_or(String::new(), |halved| format!(" less than half of it in {halved},"));
        text += &format!(
            " On held-out trials or stretches ({held_back} specimens), what belongs to a trial placed, the improved model leaves less \
             than the refitted law in {better},{halved} {:.0} % of it in the median.",
            100.0 * left_median
        );
    }
    text
}

/// A row each.
#[must_use]
pub fn table(recorded: &RecordingScores) -> String {
    let mut text =
        "| recording | known | verdict: names | not ruled out | residual | judgement |\n|---|---|---|---|---|---|\n"
            .to_owned();
    recorded.rows.iter().for_each(|row| text += &of(row));
    text + "\nResiduals are root mean squares, refitted nominal law to improved model (expected noise): of the held-out trials, or, marked *, of \
            stretches of the same trial, where it cannot be parted.\n"
}

fn of(row: &SpecimenScore) -> String {
    let said = match (&row.failure, &row.verdict) {
        (Some(why), None) => format!("no answer: {}", why.replace('|', "/")),
        (_, verdict) => format!("{}: {}", verdict.clone().unwrap_or_default().replace('_', " "), spaced(&row.named)),
    };
    format!(
        "| {} | {} | {said} | {} | {} | {} |\n",
        row.recording,
        row.description,
        rivals(row),
        residual(row),
        row.words()
    )
}

/// The first of the alternatives, and how many more there are.
#[must_use]
pub fn rivals(row: &SpecimenScore) -> String {
    let first = &row.alternatives[..row.alternatives.len().min(MAX_ALTERNATIVES)];
    match row.alternatives.len().saturating_sub(MAX_ALTERNATIVES) {
        _ if first.is_empty() => "-".to_owned(),
        0 => spaced(first),
        more => format!("{} and {more} more", spaced(first)),
    }
}

/// That of the trials kept back, or of stretches, marked.
#[must_use]
pub fn residual(row: &SpecimenScore) -> String {
    match row.held_out {
        Some(unseen) => unseen.text(row.noise_rms, &row.unit),
        None if row.cross_validated.before.is_some() => {
            format!("{} *", row.cross_validated.text(row.noise_rms, &row.unit))
        }
        None => "-".to_owned(),
    }
}
