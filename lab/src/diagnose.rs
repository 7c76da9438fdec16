//! `palpate diagnose`: where simulation and recording differ, and why.
//!
//! The recordings are checked ([`check`]). The contact is identified by a model of its force along the recorded motion ([`contact`]), the
//! drive by a model of its motion under the recorded effort ([`drive`]); each tells which effects are missing, what else would do, and
//! what is left. [`report`] writes it down; [`experiment`] says which experiment would separate alternatives.

pub mod acting_force;
pub mod channels;
pub mod check;
pub mod clipped_force;
pub mod command;
pub mod contact;
pub mod drive;
pub mod ends;
pub mod evidence;
pub mod experiment;
pub mod interval;
pub mod jackknife;
pub mod linalg;
pub mod local_level;
pub mod median;
pub mod model_comparison;
pub mod periodogram;
pub mod phase;
pub mod quantile;
pub mod report;
pub mod signals;
pub mod so_far;
pub mod term;
pub mod thresholds;
pub mod tool_position;
pub mod verdict;

use anyhow::{Result, bail};

use channels::{Channels, Recorded};
pub use command::{DiagnoseArgs, run};
use contact::circumstances::Circumstances;
use signals::pauses;
pub use signals::prepare::sensed;

use crate::error::InputError;
use crate::motion;
use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;
use crate::threshold::Threshold;
use drive::outcome::Outcome;
pub use report::diagnosis::Diagnosis;
use report::diagnosis::PlotData;
use report::merge::{self, Report};
use report::{contact_report, contact_rig, drive_report};

/// Every threshold of the diagnosis that is a number on a scale.
pub fn thresholds() -> impl Iterator<Item = Threshold> {
    let channels = contact::criteria::ALL.iter().chain(drive::criteria::ALL).chain(motion::THRESHOLDS);
    channels.copied().chain(thresholds::all())
}

/// What `diagnose` found.
pub struct Found {
    /// As JSON.
    pub answer: Diagnosis,
    /// For the page.
    pub pictures: PlotData,
    /// The improved rig.
    pub improved: Rig,
    /// The improved rig with each law of the contact that the recordings do not tell from the answer's.
    pub alternatives: Vec<Rig>,
}

/// Diagnoses `trials` against `rig`; `origin` names the rig file in errors, `say` receives messages of progress.
///
/// The same input and seed give the same answer to the bit.
///
/// # Errors
/// No channel that the rig predicts and every trial holds, trials too short to tell anything, or effects in the rig file
/// that cannot be.
pub fn diagnose(
    rig: &Rig,
    origin: &str,
    trials: &[Recording],
    simulation: &[Recording],
    seed: u64,
    say: &dyn Fn(&str),
) -> Result<Found> {
    say("reading the sensors");
    let divided = pauses::divided(trials, simulation);
    let (trials, simulation) = (divided.trials.as_slice(), divided.simulation.as_slice());
    let uniform_trials = sensed(rig, origin, trials)?;
    let figures: Vec<Figures> = uniform_trials.iter().map(|trial| trial.figures).collect();
    let findings = check::check(rig, trials, &uniform_trials);
    let circumstances = Circumstances::of(|code| findings.iter().any(|finding| finding.code == code));
    let recorded = Recorded { rig, origin, trials, figures: &figures, circumstances, seed, say };
    let (mut channels, at_the_tool) = tool_position::told_at_the_tool(&recorded, recorded.identified()?)?;
    channels.tell_what_is_beyond_the_sensor();
    let felt = channels.finding();
    let Channels { mut contact, drive, .. } = channels;
    if let Some(contact) = &mut contact {
        contact.compare_with(simulation);
    }
    let Some(((mut answer, pictures), improved)) = together(rig, contact.as_ref(), drive.as_ref()) else {
        bail!(InputError::new(origin, "recordings in which nothing moves, or of too few rows", NEEDED));
    };
    answer.findings.splice(0..0, findings.into_iter().chain(divided.finding).chain(felt).chain(at_the_tool));
    let alternatives = contact.as_ref().map(|contact| contact_rig::alternative_rigs(&improved, contact));
    Ok(Found { answer, pictures, improved, alternatives: alternatives.unwrap_or_default() })
}

/// What a diagnosis needs.
const NEEDED: &str = "a force in contact, or some hundred rows of an effort that moves the drive";

/// One report and one rig from those of the contact and of the drive.
fn together(rig: &Rig, contact: Option<&contact::outcome::Outcome>, drive: Option<&Outcome>) -> Option<(Report, Rig)> {
    let of_contact =
        contact.map(|outcome| (contact_report::contact_report(outcome, rig), contact_rig::refined(rig, outcome)));
    let touched = contact.map(drive_report::Touched::of);
    let of_drive = drive.map(|outcome| (drive_report::drive_report(outcome, rig, touched.as_ref()), outcome));
    match (of_contact, of_drive) {
        (None, None) => None,
        (Some((report, improved)), None) => Some((report, improved)),
        (None, Some((report, outcome))) => Some((report, drive_report::refined(rig, rig, outcome))),
        (Some((contact, improved)), Some((drive, outcome))) => {
            let improved = drive_report::refined(rig, &improved, outcome);
            Some((merge::merged(contact, drive, rig.coordinate), improved))
        }
    }
}
