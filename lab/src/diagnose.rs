//! `palpate diagnose`: where simulation and recording differ, and why.
//!
//! The recordings are checked ([`check`]). The contact is identified by a model of its force along the recorded motion ([`contact`]), the
//! drive by a model of its motion under the recorded effort ([`drive`]); each tells which effects are missing, what else would do, and
//! what is left. [`report`] writes it down; [`experiment`] says which experiment would separate alternatives.

pub mod acting_force;
pub mod check;
pub mod command;
pub mod contact;
pub mod drive;
pub mod evidence;
pub mod experiment;
pub mod interval;
pub mod linalg;
pub mod model_comparison;
pub mod phase;
pub mod report;
pub mod signals;
pub mod term;
pub mod thresholds;
pub mod verdict;

use anyhow::{Result, bail};

pub use command::{DiagnoseArgs, run};
use signals::pauses;
pub use signals::prepare::sensed;

use crate::effects::{self, Place};
use crate::error::InputError;
use crate::recording::Recording;
use crate::rig::Rig;
use crate::sensors::Figures;
use drive::named::NamedEffect;
use drive::outcome::Outcome;
pub use report::diagnosis::Diagnosis;
use report::diagnosis::PlotData;
use report::merge::{self, Report};
use report::{contact_report, drive_report};

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
    let known = effects::resolve_all(rig, origin)?;
    let is_touching = contact::prepare::is_recorded(rig, trials);
    // Held at one depth a memory fades and a loop does not.
    let is_one_speed = ["one_speed", "no_hold"].iter().all(|code| findings.iter().any(|finding| finding.code == *code));
    let by_force = |rig: &Rig| touched(rig, origin, trials, &figures, is_one_speed, say);
    let mut contact = if is_touching { by_force(&contact_rig(rig, &[]))? } else { None };
    let drive = drive::prepare::is_recorded(rig, trials).then(|| {
        let acted = contact.as_ref().map(|contact| acting_force::as_it_acted(contact, trials));
        identified(rig, acted.as_deref().unwrap_or(trials), known, seed, say)
    });
    let mut drive = drive.flatten();
    let found = drive.as_ref().map(drive_report::found).unwrap_or_default();
    let sensors: Vec<NamedEffect> =
        found.into_iter().filter(|found| acting_force::CARRIED_BY_THE_DRIVE.contains(&found.name())).collect();
    if is_touching && !sensors.is_empty() {
        contact = by_force(&contact_rig(rig, &sensors))?;
    }
    if let Some(contact) = &mut contact {
        contact.compare_with(simulation);
    }
    if let (Some(contact), Some(drive)) = (&contact, &mut drive) {
        drive.leave_to_the_contact(|name| is_told(contact, name));
    }
    let Some(((mut answer, pictures), improved)) = together(rig, contact.as_ref(), drive.as_ref()) else {
        bail!(InputError::new(origin, "recordings in which nothing moves, or of too few rows", NEEDED));
    };
    answer.findings.splice(0..0, findings.into_iter().chain(divided.finding));
    let alternatives = contact.as_ref().map(|contact| contact_report::alternative_rigs(&improved, contact));
    Ok(Found { answer, pictures, improved, alternatives: alternatives.unwrap_or_default() })
}

/// What a diagnosis needs.
const NEEDED: &str = "a force in contact, or some hundred rows of an effort that moves the drive";

/// What the recordings say of the drive; effects that the rig already holds are nominal.
fn identified(
    rig: &Rig,
    trials: &[Recording],
    known: Vec<effects::Resolved>,
    seed: u64,
    say: &dyn Fn(&str),
) -> Option<Outcome> {
    let nominal = drive::prepare::nominal(rig, trials, known)?;
    drive::outcome::identify(drive::prepare::trials(rig, trials), &nominal, seed, say)
}

/// The rig without its drive, which has a model of its own; `sensors` is what that found of the force sensor, and known to the contact.
fn contact_rig(rig: &Rig, sensors: &[NamedEffect]) -> Rig {
    let mut contact = rig.clone();
    contact.drive = None;
    contact.effects.retain(|table| effects::find(&table.name).is_none_or(|e| e.spec().place != Place::Drive));
    contact.effects.extend(sensors.iter().map(|effect| drive_report::table(effect, rig.coordinate)));
    contact
}

/// Whether the contact names `name`, or what a slow sensor and a late one have in common.
fn is_told(contact: &contact::outcome::Outcome, name: &str) -> bool {
    let terms = &contact.chosen.model.terms;
    let names = |name: &str| contact.named.iter().any(|named| terms[named.at].name() == name);
    names(name) || (name == "channel_delay" && names("force_lag"))
}

/// One report and one rig from those of the contact and of the drive.
fn together(rig: &Rig, contact: Option<&contact::outcome::Outcome>, drive: Option<&Outcome>) -> Option<(Report, Rig)> {
    let of_contact =
        contact.map(|outcome| (contact_report::contact_report(outcome, rig), contact_report::refined(rig, outcome)));
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

/// What the recordings say of the contact, by their force and position alone.
///
/// # Errors
/// Effects in the rig file that cannot be.
fn touched(
    rig: &Rig,
    origin: &str,
    trials: &[Recording],
    figures: &[Figures],
    is_one_speed: bool,
    say: &dyn Fn(&str),
) -> Result<Option<contact::outcome::Outcome>> {
    let known = effects::resolve_all(rig, origin)?;
    let Some(nominal) = contact::prepare::nominal(rig, known) else { return Ok(None) };
    let [fine, coarse] = contact::prepare::trials(trials, figures);
    Ok(contact::outcome::identify(fine, &coarse, &nominal, is_one_speed, say))
}
