//! A case request with every open choice drawn.

use anyhow::{Result, bail, ensure};
use rand::RngExt;

use crate::case_request::{CaseRequest, EffectSelection};
use crate::effect::registry::EffectInfo;
use crate::excitation::Excitation;
use crate::rng::{CaseRng, log_uniform, pick};
use crate::scale::Scale;
use crate::sensors::SensorGrade;
use crate::simulator::SupportedEffects;
use crate::truth::CaseKind;

/// Every choice of a case except the numbers of its rig.
#[derive(Debug, Clone)]
pub struct CaseSpec {
    /// Number of effects, and of which list.
    pub kind: CaseKind,
    /// Concealed effects, each with its requested strength.
    pub effects: Vec<(&'static EffectInfo, f64)>,
    /// Grade of the sensors.
    pub grade: SensorGrade,
    /// Excitation of the trajectories.
    pub excitation: Excitation,
    /// Whether the effort is recorded.
    pub effort: bool,
    /// Whether the contact force acts both ways.
    pub bilateral: bool,
    /// Size and coordinate.
    pub scale: Scale,
    /// Whether the rig file's values are right.
    pub exact: bool,
    /// Whether the rig file states the sensors' steps, and their noise.
    pub stated: (bool, bool),
    /// Whether it states the controller.
    pub control_stated: bool,
}

impl CaseSpec {
    /// Draws what `request` leaves open, from the effects that are `supported`.
    ///
    /// # Errors
    /// The request names an effect that the simulator does not have, or one that its other choices make unobservable.
    pub fn draw(request: &CaseRequest, supported: SupportedEffects, rng: &mut CaseRng) -> Result<Self> {
        let selection = match &request.selection {
            Some(selection) => selection.clone(),
            None => draw_selection(supported.effects, rng),
        };
        let requested = requested_effects(&selection, supported)?;
        let needs_effort = requested.iter().any(|info| info.needs_effort);
        let one_sided = requested.iter().any(|info| !info.bilateral);
        ensure!(
            !(needs_effort && request.effort == Some(false)),
            "{} shows in the effort alone",
            joined_names(&requested)
        );
        ensure!(
            !(one_sided && request.bilateral == Some(true)),
            "{} needs a surface that can be left",
            joined_names(&requested)
        );
        let (often, seldom) = (rng.random_bool(0.8), rng.random_bool(0.12));
        let effort = request.effort.unwrap_or(needs_effort || often);
        let enough =
            observable(supported.effects, &selection, effort, true).len() >= count_listed_strength(&selection).0;
        let bilateral = request.bilateral.unwrap_or(seldom && !one_sided && enough);
        let grade = request.sensors.unwrap_or(pick(rng, &[SensorGrade::Coarse, SensorGrade::Fine]));
        let rich = rng.random_bool(0.75);
        let excitation = request.excitation.unwrap_or(if rich { Excitation::Rich } else { Excitation::Poor });
        let scale = scale(request, rng);
        let half = rng.random_bool(0.5);
        let stated = (rng.random_bool(2.0 / 3.0), rng.random_bool(0.5));
        let control_stated = rng.random_bool(0.7);
        let observable = observable(supported.effects, &selection, effort, bilateral);
        let effects = draw_effects(&selection, requested, &observable, supported, rng)?;
        let kind = kind(&selection);
        let exact = request.exact.unwrap_or(half);
        Ok(Self { kind, effects, grade, excitation, effort, bilateral, scale, exact, stated, control_stated })
    }
}

fn draw_selection(supported: &[EffectInfo], rng: &mut CaseRng) -> EffectSelection {
    let outside = supported.iter().any(|info| !info.listed);
    match rng.random_range(0..20) {
        0..6 => EffectSelection::Nothing,
        6..15 => EffectSelection::Single { name: None, strength: None },
        15..18 => EffectSelection::Pair { names: None, strength: None },
        _ if outside => EffectSelection::Outside { name: None, strength: None },
        _ => EffectSelection::Single { name: None, strength: None },
    }
}

/// How many effects `selection` asks for, whether the list holds them, and their strength.
fn count_listed_strength(selection: &EffectSelection) -> (usize, bool, Option<f64>) {
    match selection {
        EffectSelection::Nothing => (0, true, None),
        EffectSelection::Single { strength, .. } => (1, true, *strength),
        EffectSelection::Pair { strength, .. } => (2, true, *strength),
        EffectSelection::Outside { strength, .. } => (1, false, *strength),
    }
}

/// Which of those `supported` a recording of this kind can show.
fn observable(
    supported: &'static [EffectInfo],
    selection: &EffectSelection,
    effort: bool,
    bilateral: bool,
) -> Vec<&'static EffectInfo> {
    let (_, inside, _) = count_listed_strength(selection);
    let suits =
        |info: &&EffectInfo| info.listed == inside && (effort || !info.needs_effort) && (!bilateral || info.bilateral);
    supported.iter().filter(suits).collect()
}

fn kind(selection: &EffectSelection) -> CaseKind {
    match selection {
        EffectSelection::Nothing => CaseKind::None,
        EffectSelection::Single { .. } => CaseKind::Single,
        EffectSelection::Pair { .. } => CaseKind::Pair,
        EffectSelection::Outside { .. } => CaseKind::Outside,
    }
}

fn joined_names(requested: &[&EffectInfo]) -> String {
    requested.iter().map(|info| info.name).collect::<Vec<_>>().join(" with ")
}

fn requested_effects(selection: &EffectSelection, supported: SupportedEffects) -> Result<Vec<&'static EffectInfo>> {
    let (_, inside, _) = count_listed_strength(selection);
    let requested: Vec<&String> = match selection {
        EffectSelection::Nothing => Vec::new(),
        EffectSelection::Single { name, .. } | EffectSelection::Outside { name, .. } => name.iter().collect(),
        EffectSelection::Pair { names, .. } => names.iter().flatten().collect(),
    };
    let mut found = Vec::new();
    for name in requested {
        match supported.effects.iter().find(|info| info.name == name) {
            Some(info) if info.listed == inside => found.push(info),
            Some(_) if inside => bail!("{name} is outside of the list"),
            Some(_) => bail!("{name} is an effect of the list"),
            None => bail!("no effect is called {name} here"),
        }
    }
    if let [one, other] = found.as_slice() {
        ensure!(
            supported.are_compatible(one, other),
            "{} and {} cannot be distinguished by name",
            one.name,
            other.name
        );
    }
    Ok(found)
}

/// The effects with their strengths.
fn draw_effects(
    selection: &EffectSelection,
    mut requested: Vec<&'static EffectInfo>,
    observable: &[&'static EffectInfo],
    supported: SupportedEffects,
    rng: &mut CaseRng,
) -> Result<Vec<(&'static EffectInfo, f64)>> {
    let (count, _, strength) = count_listed_strength(selection);
    let enough = |one: &EffectInfo| count < 2 || observable.iter().any(|other| supported.are_compatible(one, other));
    ensure!(
        requested.len() == count || observable.iter().any(|one| enough(one)),
        "nothing that is supported suits such a recording"
    );
    while requested.len() < count {
        let one = pick(rng, observable);
        if requested.iter().all(|other| supported.are_compatible(one, other)) && enough(one) {
            requested.push(one);
        }
    }
    if let Some(strength) = strength {
        ensure!(strength >= 0.0 && strength.is_finite(), "a strength of {strength}");
    }
    Ok(requested.into_iter().map(|info| (info, strength.unwrap_or_else(|| log_uniform(rng, 0.1, 10.0)))).collect())
}

fn scale(request: &CaseRequest, rng: &mut CaseRng) -> Scale {
    let (rotary, other) = (rng.random_bool(0.1), rng.random_bool(0.15));
    let (radians, lever) = (rng.random_range(15.0..60.0), log_uniform(rng, 0.05, 0.5));
    let (length, force) = pick(rng, &[(1e-3, 1e-5), (1e-3, 1e-3), (2.0, 300.0), (0.5, 1000.0)]);
    match (request.rotary.unwrap_or(rotary), request.bench.map_or(other, |bench| !bench)) {
        (true, _) => Scale { length: radians, force: lever, rotary: true },
        (false, true) => Scale { length, force, rotary: false },
        (false, false) => Scale::BENCH,
    }
}
