//! Cases in the simulations of others: MuJoCo, Drake and Exudyn, each a script in `cases/simulators` that runs as a
//! child process. Plan, rig, sensors, strength, search and recording are those of all cases; the integrator, the
//! contacts, the joints, the friction and the force sensor are theirs.

use anyhow::{Result, bail};

use crate::chance::Chance;
use crate::effect::name::Known;
use crate::effect::{Scene, Shape};
use crate::nominal::Nominal;
use crate::simulate::{Setup, Track};
use crate::world::{Offer, Source, World};

mod child;
pub mod offer;
pub mod shape;

use crate::python::Python;
use child::{Answer, Child};
use shape::Named;

/// A simulator that waits for trials.
#[derive(Debug)]
pub struct Simulator {
    source: Source,
    child: Child,
}

impl Simulator {
    /// Starts the script of `source` under `python`, and waits until the simulator has been loaded.
    ///
    /// # Errors
    /// `source` is our own, or the script does not come up.
    pub fn start(python: &Python, source: Source) -> Result<Self> {
        if source == Source::Own {
            bail!("our own simulation needs no script");
        }
        Ok(Self { source, child: Child::start(python, source.name())? })
    }
}

impl World for Simulator {
    type Effect = Named;

    fn source(&self) -> Source {
        self.source
    }

    fn offer(&self) -> Offer {
        offer::of(self.source)
    }

    fn nominal(&self, drawn: Nominal, effects: &[&Known]) -> Nominal {
        // Drake has either contact, and its Hunt-Crossley contact has no linear damper beside it.
        let replaced =
            self.source == Source::Drake && effects.iter().any(|known| known.name == "hunt_crossley_damping");
        if replaced { Nominal { damping: 0.0, ..drawn } } else { drawn }
    }

    fn shape(&self, name: &str, scene: &Scene, chance: &Chance) -> Option<Box<Self::Effect>> {
        let known = self.offer().effects.iter().find(|known| known.name == name)?;
        shape::draw(known.name, scene, chance).map(Box::new)
    }

    fn run(&mut self, setup: &Setup, references: &[Vec<f64>], effects: &[(&Self::Effect, f64)]) -> Result<Vec<Track>> {
        let there = || effects.iter().filter(|(_, size)| *size > 0.0);
        let values = there().map(|(effect, size)| (effect.name, effect.parameters(*size))).collect::<Vec<_>>();
        match self.child.ask(setup, references, &values)? {
            Answer::Tracks(tracks) => Ok(tracks),
            // A size that the simulator cannot bring to an end is no possible size: the search looks below it.
            Answer::GaveUp(_) if !values.is_empty() => Ok(references.iter().map(|_| nowhere()).collect()),
            Answer::GaveUp(why) => bail!("{} gave up on a trial without any effect: {why}", self.source.name()),
        }
    }
}

/// A trial that went to nowhere, which [`Track::is_sane`] refuses.
fn nowhere() -> Track {
    Track { position: vec![f64::NAN], ..Track::default() }
}
