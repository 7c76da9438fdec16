//! One diagnosis from that of the contact and that of the drive.

use super::diagnosis::{Diagnosis, PlotData, Verdict};
use super::summary;
use crate::rig::Coordinate;

/// A diagnosis with what the page draws.
pub type Report = (Diagnosis, PlotData);

/// Both channels in one diagnosis; physics in order of evidence, the channel with the larger mismatch first.
#[must_use]
pub fn merged(contact: Report, drive: Report, coordinate: Coordinate) -> Report {
    let (mut first, mut second) = (contact, drive);
    if excess(&second.0) > excess(&first.0) {
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
    use super::*;

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
}
