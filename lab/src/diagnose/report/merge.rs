//! One diagnosis from that of the contact and that of the drive.

use super::diagnosis::{Diagnosis, PlotData, Verdict};
use super::summary;
use crate::rig::Coordinate;

/// A diagnosis with what the page draws.
pub type Report = (Diagnosis, PlotData);

/// Both channels in one diagnosis; physics in order of evidence, the channel that shows the named physics first, of two or of none that with the larger mismatch.
#[must_use]
pub fn merged(contact: Report, drive: Report, coordinate: Coordinate) -> Report {
    let (mut first, mut second) = (contact, drive);
    if leads(&second.0, &first.0) {
        std::mem::swap(&mut first, &mut second);
    }
    let ((mut diagnosis, mut plots), (other, other_plots)) = (first, second);
    diagnosis.verdict = verdict(diagnosis.verdict, other.verdict);
    let (mut named, unknown): (Vec<_>, Vec<_>) =
        diagnosis.physics.into_iter().chain(other.physics).partition(|physics| physics.name != "unknown");
    named.sort_by(|a, b| b.evidence.held_out_gain.total_cmp(&a.evidence.held_out_gain));
    diagnosis.physics = named;
    diagnosis.physics.extend(unknown.into_iter().take(1));
    diagnosis.alternatives.extend(other.alternatives);
    diagnosis.locations.extend(other.locations);
    diagnosis.channels.extend(other.channels);
    diagnosis.nominal.extend(other.nominal);
    diagnosis.correlations.extend(other.correlations);
    for name in other.checked {
        if !diagnosis.checked.contains(&name) {
            diagnosis.checked.push(name);
        }
    }
    diagnosis.findings.extend(other.findings);
    plots.evidence.extend(other_plots.evidence);
    plots.traces.extend(other_plots.traces);
    plots.maps.extend(other_plots.maps);
    plots.experiment = plots.experiment.or(other_plots.experiment);
    diagnosis.summary = summary::summary(&diagnosis, coordinate);
    (diagnosis, plots)
}

/// Whether the answer is told by the channel of `one` rather than by that of `other`: what is said of named physics has to be said of the channel that shows them.
fn leads(one: &Diagnosis, other: &Diagnosis) -> bool {
    let names = |diagnosis: &Diagnosis| diagnosis.physics.iter().any(|physics| physics.name != "unknown");
    match (names(one), names(other)) {
        (true, false) => true,
        (false, true) => false,
        _ => excess(one) > excess(other),
    }
}

/// What the channel's refitted law leaves, over its expected noise; of a channel that has nothing to tell, nothing.
fn excess(diagnosis: &Diagnosis) -> f64 {
    let tells = f64::from(!diagnosis.physics.is_empty());
    tells * (diagnosis.fit.refitted / diagnosis.fit.noise_floor.max(f64::MIN_POSITIVE))
}

/// What both say together.
fn verdict(one: Verdict, other: Verdict) -> Verdict {
    use Verdict::{Explained, NoMismatch, Parameters, PartlyExplained, Unknown};
    match (one, other) {
        (NoMismatch, NoMismatch) => NoMismatch,
        (NoMismatch | Parameters, NoMismatch | Parameters) => Parameters,
        (Unknown, NoMismatch | Parameters | Unknown) | (NoMismatch | Parameters, Unknown) => Unknown,
        (PartlyExplained | Unknown, _) | (_, PartlyExplained | Unknown) => PartlyExplained,
        (Explained, _) | (_, Explained) => Explained,
    }
}

#[cfg(test)]
mod tests {
    use super::super::diagnosis::{Evidence, Finding, FitQuality, Physics};
    use super::*;
    use crate::page::quantity;

    #[test]
    fn every_pair_of_verdicts_is_told_alike_whichever_comes_first() {
        use Verdict::{Explained, NoMismatch, Parameters, PartlyExplained, Unknown};
        let all = [NoMismatch, Parameters, Explained, PartlyExplained, Unknown];
        let wanted = [
            [NoMismatch, Parameters, Explained, PartlyExplained, Unknown],
            [Parameters, Parameters, Explained, PartlyExplained, Unknown],
            [Explained, Explained, Explained, PartlyExplained, PartlyExplained],
            [PartlyExplained, PartlyExplained, PartlyExplained, PartlyExplained, PartlyExplained],
            [Unknown, Unknown, PartlyExplained, PartlyExplained, Unknown],
        ];
        for (row, one) in all.iter().enumerate() {
            for (column, other) in all.iter().enumerate() {
                assert_eq!(verdict(*one, *other), wanted[row][column], "{one:?} {other:?}");
            }
        }
    }
    /// Of one channel that leaves `refitted` over its noise of 10 mN, and half of that with the names of `physics`.
    fn report(channel: &'static str, verdict: Verdict, physics: &str, refitted: f64) -> Report {
        let improved = if physics == "unknown" { refitted } else { 0.5 * refitted };
        let fit = FitQuality {
            channel,
            unit: "N",
            noise_floor: 0.01,
            as_given: refitted,
            refitted,
            improved,
            held_out: true,
            explained_share: 0.5,
            band_hz: 100.0,
            learned: None,
        };
        let physics = Physics {
            name: physics.to_owned(),
            acts_in: channel,
            channel,
            statement: String::new(),
            equation: String::new(),
            evidence: Evidence { held_out_gain: 0.5, p_value: 0.0 },
            parameters: Vec::new(),
            on_drive: None,
        };
        let diagnosis = Diagnosis {
            schema: "",
            verdict,
            summary: String::new(),
            physics: vec![physics],
            alternatives: Vec::new(),
            locations: Vec::new(),
            channels: vec![fit.clone()],
            fit,
            nominal: Vec::new(),
            correlations: Vec::new(),
            checked: Vec::new(),
            findings: Vec::new(),
        };
        (diagnosis, PlotData::default())
    }

    /// Friction of the drive beside a contact of which nothing is known, with the larger mismatch: what is said of the friction is said of the effort.
    #[test]
    fn what_is_said_of_a_name_is_said_of_the_channel_that_shows_it() {
        let contact = || report("force", Verdict::Unknown, "unknown", 0.3);
        let drive = || report("effort", Verdict::Explained, "stribeck_friction", 0.02);
        let (told, _) = merged(contact(), drive(), Coordinate::Linear);
        assert_eq!((told.fit.channel, told.channels.len()), ("effort", 2));
        let shown = |value: f64| quantity::rounded(value, "N", 3);
        let falls = format!("the residual effort falls from {} to {}", shown(0.02), shown(0.01));
        assert!(told.summary.contains(&falls), "{}", told.summary);
        let left = format!("In the force something is missing that no effect of the list explains: {}", shown(0.3));
        assert!(told.summary.contains(&left), "{}", told.summary);
        // A force of free motion is the contact's, and not what is left of the effort.
        let mut parasitic = contact();
        let code = summary::PARASITIC_FORCE;
        parasitic.0.findings.push(Finding { code, grave: false, place: String::new(), text: String::new() });
        let (told, _) = merged(parasitic, drive(), Coordinate::Linear);
        assert!(told.summary.contains(&left), "{}", told.summary);
        // Where both name something, the larger mismatch comes first.
        let named = report("force", Verdict::Explained, "adhesion", 0.3);
        let (both, _) = merged(named, drive(), Coordinate::Linear);
        assert_eq!(both.fit.channel, "force");
    }
}
