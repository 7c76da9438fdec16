//! The answer in words that a mechanic understands.

use super::diagnosis::{Diagnosis, FitQuality, Location, Verdict};
use crate::diagnose::phase;
use crate::page::effect_name::effect_name;
use crate::page::quantity;
use crate::rig::Coordinate;

/// Residual over the sensors' own that is still called theirs: their noise is known to some 15 %.
pub(super) const MOST_OVER_NOISE: f64 = 1.15;

/// The same from which the two figures differ to the eye.
const ABOUT_NOISE: f64 = 1.03;

/// Code of the finding that the force reading holds effort of the drive.
pub(super) const EFFORT_IN_FORCE: &str = "effort_in_force";

/// Code of the finding that the force reading holds a force of free motion.
pub(super) const PARASITIC_FORCE: &str = "parasitic_force";

/// Share of a mismatch from which a place holds most of it.
pub const MAJORITY_SHARE: f64 = 0.5;

/// Whether what the answer leaves is what the sensors leave.
#[must_use]
pub fn is_noise(fit: &FitQuality) -> bool {
    fit.improved < MOST_OVER_NOISE * fit.noise_floor
}

/// Whether what is not named is effort that the force reading holds.
pub(super) fn holds_effort(answer: &Diagnosis) -> bool {
    answer.findings.iter().any(|finding| finding.code == EFFORT_IN_FORCE)
}

/// Whether what is not named is a force of free motion.
pub(super) fn holds_parasitic_force(answer: &Diagnosis) -> bool {
    answer.findings.iter().any(|finding| finding.code == PARASITIC_FORCE)
}

/// The channel that holds what is not named.
pub(super) fn unexplained(answer: &Diagnosis) -> &FitQuality {
    let unknown = answer.physics.iter().find(|physics| physics.name == "unknown");
    let channel = unknown.and_then(|unknown| answer.channels.iter().find(|fit| fit.channel == unknown.channel));
    channel.unwrap_or(&answer.fit)
}

/// What a channel lacks, in words.
fn lacks_in(channel: &str, coordinate: Coordinate) -> &'static str {
    match (channel, coordinate) {
        ("effort", _) => "effort",
        (_, Coordinate::Rotary) => "torque",
        _ => "force",
    }
}

/// What a partly explained `answer` leaves beside its names.
fn beside_names(answer: &Diagnosis, coordinate: Coordinate) -> String {
    let left = unexplained(answer);
    let shown = |value: f64| quantity::rounded(value, left.unit, 3);
    let sensors = format!("the sensors alone would leave {}", shown(left.noise_floor));
    if holds_effort(answer) {
        format!(" The force reading holds effort of the drive besides, which is no effect of the list: {sensors}.")
    } else if holds_parasitic_force(answer) && left.channel == answer.fit.channel {
        format!(" That is with a force that acts in free motion, too, which is no effect of the list: {sensors}.")
    } else if left.channel == answer.fit.channel {
        format!(" Something is left beside that: {sensors}.")
    } else {
        let (lacks, improved) = (lacks_in(left.channel, coordinate), shown(left.improved));
        format!(
            " In the {lacks} something is missing that no effect of the list explains: {improved} are left, where {sensors}."
        )
    }
}

/// Whether refitted values leave more than those of the rig file on rows that no fit saw, in the three digits that a reader sees.
pub(super) fn refit_is_worse(fit: &FitQuality) -> bool {
    let shown = |value: f64| quantity::rounded(value, fit.unit, 3);
    fit.as_given < fit.refitted && shown(fit.as_given) != shown(fit.refitted)
}

/// One sentence or two.
#[must_use]
pub fn summary(answer: &Diagnosis, coordinate: Coordinate) -> String {
    let fit = &answer.fit;
    let unit = fit.unit;
    let before = quantity::rounded(fit.refitted, unit, 3);
    let expected_noise = quantity::rounded(fit.noise_floor, unit, 3);
    let lacks = lacks_in(fit.channel, coordinate);
    match answer.verdict {
        Verdict::NoMismatch => {
            format!(
                "The simulation leaves no more than the sensors do ({expected_noise}): nothing is missing that these recordings could show."
            )
        }
        Verdict::Parameters => {
            let given = quantity::rounded(fit.as_given, unit, 3);
            format!(
                "No physics is missing, only values are off: refitted, the residual {lacks} falls from {given} to {before}, where the sensors leave {expected_noise}."
            )
        }
        Verdict::Unknown => {
            let place = answer.locations.first().filter(|place| place.share >= MAJORITY_SHARE).map_or(
                String::new(),
                |location| {
                    format!(
                        " {} of it lies in one stretch{}.",
                        quantity::percent(100.0 * location.share),
                        during(location)
                    )
                },
            );
            if holds_parasitic_force(answer) {
                let course = course(fit, lacks, "it");
                return format!(
                    "The force reading holds a force that acts in free motion, too, which is no effect of the list: {course}. The sensors alone would leave {expected_noise}."
                );
            }
            let what = if holds_effort(answer) {
                "The force reading holds effort of the drive, which is no effect of the list"
            } else {
                "Something is missing that no effect of the list explains"
            };
            format!("{what}: {before} are left where the sensors leave {expected_noise}.{place}")
        }
        Verdict::Explained | Verdict::PartlyExplained => {
            let names: Vec<String> =
                answer.physics.iter().filter(|p| p.name != "unknown").map(|p| effect_name(&p.name)).collect();
            let rest = if answer.verdict == Verdict::PartlyExplained {
                beside_names(answer, coordinate)
            } else if is_noise(fit) {
                let about = if fit.improved > ABOUT_NOISE * fit.noise_floor { "about " } else { "" };
                format!(" That is {about}what the sensors leave ({expected_noise}).")
            } else {
                format!(" The sensors alone would leave {expected_noise}.")
            };
            let rivals = if answer.alternatives.is_empty() {
                String::new()
            } else {
                let all: Vec<String> = answer
                    .alternatives
                    .iter()
                    .map(|rival| listed(&rival.physics.iter().map(|name| effect_name(name)).collect::<Vec<_>>()))
                    .collect();
                format!(" These data do not rule out {}.", all.join(" or "))
            };
            let pronoun = if names.len() == 1 { "it" } else { "them" };
            format!("The simulation leaves out {}: {}.{rest}{rivals}", listed(&names), course(fit, lacks, pronoun))
        }
    }
}

/// What becomes of the residual `lacks` on unseen rows with the named physics, the `pronoun`. A name stands by its likelihood: behind a coarse encoder
/// the residual can stay what it is.
fn course(fit: &FitQuality, lacks: &str, pronoun: &str) -> String {
    let shown = |value: f64| quantity::rounded(value, fit.unit, 3);
    let (before, after) = (shown(fit.refitted), shown(fit.improved));
    if fit.improved >= fit.refitted || before == after {
        return format!(
            "with {pronoun} the recordings are likelier, but on data that no fit saw the residual {lacks} does not fall, {before} without {pronoun} and {after} with {pronoun}"
        );
    }
    // What is missing was fitted into the values, which then do worse elsewhere than those of the file.
    let given = if refit_is_worse(fit) {
        format!(" (refitted values without {pronoun}; those of the rig file leave {})", shown(fit.as_given))
    } else {
        String::new()
    };
    format!("with {pronoun} the residual {lacks} falls from {before}{given} to {after} on data that no fit saw")
}

/// The phase of contact, where there is one: an axis that moves freely has none.
fn during(location: &Location) -> String {
    match location.phase {
        phase::Phase::Free if location.channel == "effort" => String::new(),
        phase => format!(" during {}", phase::word(phase)),
    }
}

fn listed(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_residual_falls_only_where_a_reader_sees_that_it_does() {
        let said = |refitted: f64, improved: f64| {
            let fit = FitQuality {
                channel: "effort",
                unit: "N",
                noise_floor: 0.0135,
                as_given: 0.0245,
                refitted,
                improved,
                held_out: true,
                explained_share: 0.0,
                band_hz: 13.6,
                learned: None,
            };
            course(&fit, "effort", "it")
        };
        let shown = |value: f64| quantity::rounded(value, "N", 3);
        let falls = format!("falls from {} to {}", shown(0.0237), shown(0.0145));
        assert!(said(0.0237, 0.0145).contains(&falls), "{}", said(0.0237, 0.0145));
        let stays = format!("does not fall, {} without it and {} with it", shown(0.0237), shown(0.0238));
        assert!(said(0.0237, 0.0238).contains(&stays), "{}", said(0.0237, 0.0238));
        // Less in the fourth digit, of which three are shown.
        assert!(said(0.023_702, 0.023_698).contains("does not fall"));
    }
}
