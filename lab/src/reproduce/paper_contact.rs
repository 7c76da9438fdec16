//! The paper's bench, simulated: its contacts as rig files, and trials of them.

use anyhow::{Context as _, Result};
use palpate::Sample;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use crate::rig::Rig;
use crate::simulate;

/// One of the paper's contacts, or the one of known steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PaperContact {
    /// A foam that stiffens with depth and relaxes.
    Soft,
    /// Bubble wrap that gives way.
    Varying,
    /// A pad of 3 kN/m.
    Medium,
    /// A linear one of 250, 900 and 250 N/m.
    Steps,
}

impl PaperContact {
    /// The paper's, in the order of its tables.
    pub const PAPER: [Self; 3] = [Self::Soft, Self::Varying, Self::Medium];

    /// For the reader.
    pub fn name(self) -> &'static str {
        match self {
            Self::Soft => "soft",
            Self::Varying => "time-varying",
            Self::Medium => "medium",
            Self::Steps => "steps of stiffness",
        }
    }

    /// The rig file, by name and text.
    pub fn file(self) -> (&'static str, &'static str) {
        match self {
            Self::Soft => ("paper_soft.toml", include_str!("../../rigs/paper_soft.toml")),
            Self::Varying => ("paper_varying.toml", include_str!("../../rigs/paper_varying.toml")),
            Self::Medium => ("paper_medium.toml", include_str!("../../rigs/paper_medium.toml")),
            Self::Steps => ("paper_steps.toml", include_str!("../../rigs/paper_steps.toml")),
        }
    }

    /// The rig.
    pub fn rig(self) -> Result<Rig> {
        let (name, text) = self.file();
        Ok(Rig::parse(text, name)?)
    }
}

/// One simulated trial. Position counts from the surface that the estimators are told.
#[derive(Debug, Clone)]
pub struct PaperTrial {
    /// Seconds.
    pub time: Vec<f64>,
    /// Commanded position, m.
    pub reference: Vec<f64>,
    /// Measured position, m.
    pub position: Vec<f64>,
    /// Measured force, N.
    pub force: Vec<f64>,
}

impl PaperTrial {
    /// One trial of `rig` with the noise of `seed`. With `misplaced`, the surface lies anywhere within one count of the encoder about
    /// where the estimators believe it.
    pub fn of(rig: &Rig, seed: u64, misplaced: bool) -> Result<Self> {
        let mut rig = rig.clone();
        let believed = rig.surface();
        if let (true, Some(contact), Some(count)) = (misplaced, &mut rig.contact, rig.sensors.position_resolution) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            rng.set_stream(2);
            contact.surface += count * (rng.random::<f64>() - 0.5);
        }
        let recording = simulate::simulate(&rig, seed, &rig.name)?.recording;
        let from = |column: Vec<f64>| column.into_iter().map(|value| value - believed).collect();
        Ok(Self {
            reference: from(recording.reference.context("a rig with a drive")?),
            position: from(recording.position),
            force: recording.force.context("a rig with a contact")?,
            time: recording.time,
        })
    }

    /// `count` trials of `rig`, seeds 1, 2, ...
    pub fn several(rig: &Rig, count: u64, misplaced: bool) -> Result<Vec<Self>> {
        (1..=count).into_par_iter().map(|seed| Self::of(rig, seed, misplaced)).collect()
    }

    /// Every `every`th row, as the estimators are fed.
    pub fn samples(&self, every: usize) -> Vec<Sample> {
        let period = (self.time[every] - self.time[0]) as f32;
        let rows = self.position.iter().zip(&self.force).step_by(every);
        rows.map(|(x, f)| Sample { position: *x as f32, force: *f as f32, elapsed: period }).collect()
    }
}
