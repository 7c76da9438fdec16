//! Which case it shall be: the wish, with everything drawn that it leaves open.

use anyhow::{Result, bail, ensure};
use rand::RngExt;

use crate::chance::{Chance, log_uniform, pick};
use crate::effect::name::Known;
use crate::reference;
use crate::scale::Scale;
use crate::sensors::Grade;
use crate::truth::Kind;
use crate::wish::{What, Wish};
use crate::world::Offer;

/// All choices of a case but the numbers of its rig.
#[derive(Debug, Clone)]
pub struct Plan {
    /// What kind of case.
    pub kind: Kind,
    /// What it conceals, and how strong.
    pub effects: Vec<(&'static Known, f64)>,
    /// Of the sensors.
    pub grade: Grade,
    /// Of the trajectories.
    pub reference: reference::Kind,
    /// Whether the effort is recorded.
    pub effort: bool,
    /// Force both ways.
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

impl Plan {
    /// Draws what `wish` leaves open, from what is on `offer`.
    ///
    /// # Errors
    /// The wish names an effect that is not offered, or one that its other choices hide.
    pub fn draw(wish: &Wish, offer: Offer, chance: &mut Chance) -> Result<Self> {
        let what = match &wish.what {
            Some(what) => what.clone(),
            None => any(offer.effects, chance),
        };
        let asked = names(&what, offer)?;
        let needs_effort = asked.iter().any(|known| known.needs_effort);
        let one_sided = asked.iter().any(|known| !known.bilateral);
        ensure!(!(needs_effort && wish.effort == Some(false)), "{} shows in the effort alone", listed(&asked));
        ensure!(!(one_sided && wish.bilateral == Some(true)), "{} needs a surface that can be left", listed(&asked));
        let (often, seldom) = (chance.random_bool(0.8), chance.random_bool(0.12));
        let effort = wish.effort.unwrap_or(needs_effort || often);
        let enough = suited(offer.effects, &what, effort, true).len() >= wanted(&what).0;
        let bilateral = wish.bilateral.unwrap_or(seldom && !one_sided && enough);
        let grade = wish.sensors.unwrap_or(pick(chance, &[Grade::Coarse, Grade::Fine]));
        let rich = chance.random_bool(0.75);
        let reference = wish.reference.unwrap_or(if rich { reference::Kind::Rich } else { reference::Kind::Poor });
        let scale = scale(wish, chance);
        let half = chance.random_bool(0.5);
        let stated = (chance.random_bool(2.0 / 3.0), chance.random_bool(0.5));
        let control_stated = chance.random_bool(0.7);
        let suited = suited(offer.effects, &what, effort, bilateral);
        let effects = concealed(&what, asked, &suited, offer, chance)?;
        let kind = kind(&what);
        let exact = wish.exact.unwrap_or(half);
        Ok(Self { kind, effects, grade, reference, effort, bilateral, scale, exact, stated, control_stated })
    }
}

fn any(offered: &[Known], chance: &mut Chance) -> What {
    let outside = offered.iter().any(|known| !known.listed);
    match chance.random_range(0..20) {
        0..6 => What::Nothing,
        6..15 => What::Single { name: None, strength: None },
        15..18 => What::Pair { names: None, strength: None },
        _ if outside => What::Outside { name: None, strength: None },
        _ => What::Single { name: None, strength: None },
    }
}

/// How many effects `what` asks for, whether the list holds them, and their strength.
fn wanted(what: &What) -> (usize, bool, Option<f64>) {
    match what {
        What::Nothing => (0, true, None),
        What::Single { strength, .. } => (1, true, *strength),
        What::Pair { strength, .. } => (2, true, *strength),
        What::Outside { strength, .. } => (1, false, *strength),
    }
}

/// Which of those `offered` a recording of this kind can show.
fn suited(offered: &'static [Known], what: &What, effort: bool, bilateral: bool) -> Vec<&'static Known> {
    let (_, inside, _) = wanted(what);
    let suits =
        |known: &&Known| known.listed == inside && (effort || !known.needs_effort) && (!bilateral || known.bilateral);
    offered.iter().filter(suits).collect()
}

fn kind(what: &What) -> Kind {
    match what {
        What::Nothing => Kind::None,
        What::Single { .. } => Kind::Single,
        What::Pair { .. } => Kind::Pair,
        What::Outside { .. } => Kind::Outside,
    }
}

fn listed(asked: &[&Known]) -> String {
    asked.iter().map(|known| known.name).collect::<Vec<_>>().join(" with ")
}

fn names(what: &What, offer: Offer) -> Result<Vec<&'static Known>> {
    let (_, inside, _) = wanted(what);
    let asked: Vec<&String> = match what {
        What::Nothing => Vec::new(),
        What::Single { name, .. } | What::Outside { name, .. } => name.iter().collect(),
        What::Pair { names, .. } => names.iter().flatten().collect(),
    };
    let mut found = Vec::new();
    for name in asked {
        match offer.effects.iter().find(|known| known.name == name) {
            Some(known) if known.listed == inside => found.push(known),
            Some(_) if inside => bail!("{name} is outside of the list"),
            Some(_) => bail!("{name} is an effect of the list"),
            None => bail!("no effect is called {name} here"),
        }
    }
    if let [one, other] = found.as_slice() {
        ensure!(offer.fit(one, other), "{} and {} are not told apart by name", one.name, other.name);
    }
    Ok(found)
}

/// The effects with their strengths.
fn concealed(
    what: &What,
    mut asked: Vec<&'static Known>,
    suited: &[&'static Known],
    offer: Offer,
    chance: &mut Chance,
) -> Result<Vec<(&'static Known, f64)>> {
    let (count, _, strength) = wanted(what);
    let enough = |one: &Known| count < 2 || suited.iter().any(|other| offer.fit(one, other));
    ensure!(
        asked.len() == count || suited.iter().any(|one| enough(one)),
        "nothing that is offered suits such a recording"
    );
    while asked.len() < count {
        let one = pick(chance, suited);
        if asked.iter().all(|other| offer.fit(one, other)) && enough(one) {
            asked.push(one);
        }
    }
    if let Some(strength) = strength {
        ensure!(strength >= 0.0 && strength.is_finite(), "a strength of {strength}");
    }
    Ok(asked.into_iter().map(|known| (known, strength.unwrap_or_else(|| log_uniform(chance, 0.1, 10.0)))).collect())
}

fn scale(wish: &Wish, chance: &mut Chance) -> Scale {
    let (rotary, other) = (chance.random_bool(0.1), chance.random_bool(0.15));
    let (radians, lever) = (chance.random_range(15.0..60.0), log_uniform(chance, 0.05, 0.5));
    let (length, force) = pick(chance, &[(1e-3, 1e-5), (1e-3, 1e-3), (2.0, 300.0), (0.5, 1000.0)]);
    match (wish.rotary.unwrap_or(rotary), wish.bench.map_or(other, |bench| !bench)) {
        (true, _) => Scale { length: radians, force: lever, rotary: true },
        (false, true) => Scale { length, force, rotary: false },
        (false, false) => Scale::BENCH,
    }
}
