//! Where a case happens: in our own simulation, or in somebody else's.

use anyhow::Result;
use serde::{Deserialize, Serialize};

use crate::chance::Chance;
use crate::effect::name::{ALL, Known};
use crate::effect::{self, Acting, Scene, Shape};
use crate::nominal::Nominal;
use crate::physics::Physics;
use crate::simulate::{self, PERIOD, Setup, Track};

/// Whose simulation made a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// Ours.
    Own,
    /// MuJoCo.
    Mujoco,
    /// Drake.
    Drake,
    /// Exudyn.
    Exudyn,
}

impl Source {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Own, Self::Mujoco, Self::Drake, Self::Exudyn];

    /// As the answers and the command line write it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Mujoco => "mujoco",
            Self::Drake => "drake",
            Self::Exudyn => "exudyn",
        }
    }
}

/// The effects that a simulation has.
#[derive(Debug, Clone, Copy)]
pub struct Offer {
    /// One by one.
    pub effects: &'static [Known],
    /// Pairs that it cannot play, or of which one holds the other, or that are two views of one part.
    pub apart: &'static [[&'static str; 2]],
}

impl Offer {
    /// Of our own simulation.
    pub const OWN: Self = Self {
        effects: &ALL,
        apart: &[["coulomb_friction", "stribeck_friction"], ["backlash", "transmission_compliance"]],
    };

    /// Whether a case can hold both.
    #[must_use]
    pub fn fit(&self, one: &Known, other: &Known) -> bool {
        one != other && !self.apart.iter().any(|pair| pair.contains(&one.name) && pair.contains(&other.name))
    }
}

/// What plays the physics of a case. All else, from the rig to the noise, is the same for all.
pub trait World {
    /// An effect with all of its shape drawn but its size.
    type Effect: Shape + ?Sized;

    /// Whose simulation this is.
    fn source(&self) -> Source;

    /// The effects that it has.
    fn offer(&self) -> Offer;

    /// The nominal physics of a rig that conceals `effects`: `drawn`, unless one of them takes the place of a part.
    fn nominal(&self, drawn: Nominal, effects: &[&Known]) -> Nominal {
        let _ = effects;
        drawn
    }

    /// The effect `name` with a shape at random; none where it is not offered.
    fn shape(&self, name: &str, scene: &Scene, chance: &Chance) -> Option<Box<Self::Effect>>;

    /// Runs a trial along each of `references`, m, one value a period; an effect of size zero is not there.
    ///
    /// # Errors
    /// The simulation cannot be had, or gave up.
    fn run(&mut self, setup: &Setup, references: &[Vec<f64>], effects: &[(&Self::Effect, f64)]) -> Result<Vec<Track>>;
}

/// Our own simulation.
#[derive(Debug, Clone, Copy)]
pub struct Own;

impl World for Own {
    type Effect = dyn Acting;

    fn source(&self) -> Source {
        Source::Own
    }

    fn offer(&self) -> Offer {
        Offer::OWN
    }

    fn shape(&self, name: &str, scene: &Scene, chance: &Chance) -> Option<Box<Self::Effect>> {
        effect::draw(name, scene, chance)
    }

    fn run(&mut self, setup: &Setup, references: &[Vec<f64>], effects: &[(&Self::Effect, f64)]) -> Result<Vec<Track>> {
        let trial = |(trial, reference): (usize, &Vec<f64>)| {
            let mut physics = Physics::new(setup.nominal, trial, PERIOD / setup.steps as f64);
            for (shape, size) in effects.iter().filter(|(_, size)| *size > 0.0) {
                shape.put(*size, &mut physics);
            }
            simulate::run(setup, physics, reference)
        };
        Ok(references.iter().enumerate().map(trial).collect())
    }
}
