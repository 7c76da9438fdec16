//! A rig of the cases' own generator, put to the three ways.

use std::path::Path;

use anyhow::Result;
use palpate_cases::excitation::Excitation;
use palpate_cases::truth::{CaseKind, Truth};
use palpate_cases::{CaseRequest, ConcealedRig};

use super::command::InvestigateChallengeArgs;
use super::comparison::{Comparison, Subject};
use super::row::{OWN, Row};
use crate::challenge::case_list::ListedCase;
use crate::experiment_design::Limits;
use crate::experiment_design::explanation::UNKNOWN;
use crate::investigate::concealed_bed::{ConcealedBed, recording};
use crate::investigate::record::write;
use crate::recording::Recording;
use crate::rig::Rig;

/// Limits of a rig over what its nominal model reaches along a rich reference.
const LIMIT_OVER_RICH: f64 = 1.5;

/// The same of its travel.
const TRAVEL_OVER_RICH: f64 = 1.3;

/// Draws the rig of `case` and investigates it in `folder`, which is there and empty.
///
/// # Errors
/// A file that cannot be written, or a rig of which no diagnosis can be made.
pub fn investigate(args: &InvestigateChallengeArgs, case: &ListedCase, folder: &Path) -> Result<Row> {
    // A rig that follows trajectories has a drive; its file says so where the effort is recorded.
    let request = CaseRequest { excitation: Some(Excitation::Poor), effort: Some(true), ..case.request.clone() };
    let concealed = || ConcealedRig::draw(args.seed, case.index, &request);
    let mut rig_of_case = concealed()?;
    let truth = names(&rig_of_case.case.truth);
    let strength = rig_of_case.case.truth.strength;
    let rig = Rig::parse(&rig_of_case.case.rig, "rig.toml")?;
    let given = [recording(&rig_of_case.case.trials[0], "trial-1.csv")];
    let limits = limits(&mut rig_of_case, &given[0]);
    write(&folder.join("rig.toml"), rig_of_case.case.rig.as_bytes())?;
    given[0].write(&folder.join("trial-1.csv"), &rig)?;
    let (mut bed, mut fixed_bed) = (ConcealedBed::new(rig_of_case), ConcealedBed::new(concealed()?));
    let subject = Subject { rig: &rig, origin: "rig.toml", given: &given, limits, folder, rounds: args.rounds };
    let comparison = Comparison::run(&subject, &mut bed, &mut fixed_bed)?;
    Ok(Row {
        source: OWN.to_owned(),
        index: case.index,
        case: None,
        truth,
        also: Vec::new(),
        strength: Some(strength),
        comparison,
    })
}

/// What `truth` conceals; "unknown" where that is outside of the list.
fn names(truth: &Truth) -> Vec<String> {
    match truth.kind {
        CaseKind::Outside => vec![UNKNOWN.to_owned()],
        _ => truth.effects.iter().map(|effect| effect.name.to_owned()).collect(),
    }
}

/// What the rig may do: more than a rich reference asks of its nominal model.
fn limits(rig: &mut ConcealedRig, given: &Recording) -> Limits {
    let reference = rig.rich_reference();
    let reached = rig.nominal_excursion(&reference);
    let low = given.position.iter().copied().fold(reached.position.0, f64::min);
    let high = given.position.iter().copied().fold(reached.position.1, f64::max);
    let around = 0.5 * (TRAVEL_OVER_RICH - 1.0) * (high - low);
    let peak = |values: &Option<Vec<f64>>| values.iter().flatten().fold(0.0, |most: f64, value| most.max(value.abs()));
    let speed = Limits::of_recordings(std::slice::from_ref(given)).map_or(0.0, |limits| limits.speed);
    Limits {
        position: [low - around, high + around],
        speed: LIMIT_OVER_RICH * reached.speed.max(speed),
        effort: Some(LIMIT_OVER_RICH * reached.effort.max(peak(&given.effort))),
        force: Some(LIMIT_OVER_RICH * reached.force.max(peak(&given.force))),
        duration_s: reached.duration_s,
        frequency_hz: 25.0,
    }
}
