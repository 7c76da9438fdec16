//! Beyond K and B: contacts that no spring and damper is, by the regressors of two and three parameters.

use anyhow::{Result, anyhow};
use palpate::{ChangeConfig, ContactModel, ModelStream, ParameterRls, ParameterRlsConfig, contact_plane};
use rayon::prelude::*;

use super::measure::MeanAndDeviation;
use super::paper_contact::{PaperContact, PaperTrial};
use crate::effects::{find, to_table};
use crate::rig::{Coordinate, Rig};

/// Trials of each.
pub const SEEDS: u64 = 5;

/// A parameter as it was found.
#[derive(Debug, Clone)]
pub struct Parameter {
    /// Symbol and unit.
    pub symbol: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// What the rig holds.
    pub truth: f64,
    /// What was found, mean and spread over trials.
    pub found: MeanAndDeviation,
    /// Half-width of the 95 % interval, mean over trials.
    pub half_width: f64,
}

/// One contact, seen by its own law and by spring and damper alone.
#[derive(Debug, Clone)]
pub struct Case {
    /// What is different about it.
    pub name: &'static str,
    /// The law in symbols.
    pub equation: &'static str,
    /// The regressor of the library.
    pub regressor: &'static str,
    /// By the right law.
    pub parameters: Vec<Parameter>,
    /// K and B by spring and damper alone.
    pub plain: [MeanAndDeviation; 2],
    /// RMSE% by the right law and by spring and damper alone.
    pub rmse: [MeanAndDeviation; 2],
}

struct Plan {
    name: &'static str,
    equation: &'static str,
    model: ContactModel,
    truth: [f64; 3],
    symbols: [(&'static str, &'static str); 3],
    spreads: [f32; 3],
    rig: Rig,
}

const K: (&str, &str) = ("K", "N/m");
const B: (&str, &str) = ("B", "N s/m");

fn plans() -> Result<Vec<Plan>> {
    let base = |stiffness: f64, damping: f64, effect: Option<(&str, usize, &[f64])>| -> Result<Rig> {
        let mut rig = PaperContact::Steps.rig()?;
        rig.effects.retain(|effect| effect.name == "coulomb_friction");
        if let Some(contact) = &mut rig.contact {
            (contact.stiffness, contact.damping) = (stiffness, damping);
        }
        if let Some((name, form, values)) = effect {
            let effect = find(name).ok_or_else(|| anyhow!("no effect {name}"))?;
            rig.effects.push(to_table(effect, form, Coordinate::Linear, values, None));
        }
        rig.simulation.duration_s = 7.0;
        Ok(rig)
    };
    let mut deep = base(300.0, 5.0, None)?;
    if let Some(contact) = &mut deep.contact {
        contact.surface = 0.8e-3;
    }
    Ok(vec![
        Plan {
            name: "damping that grows with depth (Hunt-Crossley, exponent 1)",
            equation: "F = K x + B x v",
            model: ContactModel::HuntCrossley { exponent: 1.0 },
            truth: [300.0, 400.0, 0.0],
            symbols: [K, ("B", "N s/m^2"), ("", "")],
            spreads: [1e3, 1e4, 1.0],
            rig: base(300.0, 0.0, Some(("hunt_crossley_damping", 0, &[400.0])))?,
        },
        Plan {
            name: "damping at the surface and more below it",
            equation: "F = K x + B v + alpha x v",
            model: ContactModel::GrowingDamping,
            truth: [300.0, 2.0, 400.0],
            symbols: [K, B, ("alpha", "N s/m^2")],
            spreads: [1e3, 30.0, 1e4],
            rig: base(300.0, 2.0, Some(("hunt_crossley_damping", 0, &[400.0])))?,
        },
        Plan {
            name: "a force sensor whose zero is off",
            equation: "F = K x + B v + c",
            model: ContactModel::BiasedKelvinVoigt,
            truth: [300.0, 5.0, 0.4],
            symbols: [K, B, ("c", "N")],
            spreads: [1e3, 30.0, 10.0],
            rig: base(300.0, 5.0, Some(("force_bias", 0, &[0.4])))?,
        },
        Plan {
            name: "a surface 0.8 mm deeper than it was said to lie",
            equation: "F = K (x - plane) + B v",
            model: ContactModel::BiasedKelvinVoigt,
            truth: [300.0, 5.0, 0.8e-3],
            symbols: [K, B, ("plane", "m")],
            spreads: [1e3, 30.0, 10.0],
            rig: deep,
        },
        Plan {
            name: "a tool of 0.15 kg beyond the force sensor",
            equation: "F = K x + B v + m a",
            model: ContactModel::ToolMass,
            truth: [300.0, 5.0, 0.15],
            symbols: [K, B, ("m", "kg")],
            spreads: [1e3, 30.0, 1.0],
            rig: base(300.0, 5.0, Some(("tool_inertia", 0, &[0.15])))?,
        },
    ])
}

/// All of them.
///
/// # Errors
/// None for the rig file of this repository.
pub fn study(done: &(dyn Fn() + Sync)) -> Result<Vec<Case>> {
    plans()?
        .into_par_iter()
        .map(|plan| {
            let case = case(&plan);
            done();
            case
        })
        .collect()
}

fn case(plan: &Plan) -> Result<Case> {
    let mut rig = plan.rig.clone();
    // The estimators believe the surface at zero, wherever it is.
    let surface = rig.surface();
    rig.name = plan.name.into();
    let mut trials = PaperTrial::several(&rig, SEEDS, false)?;
    for trial in &mut trials {
        trial.position.iter_mut().for_each(|x| *x += surface);
    }
    let is_plane = plan.symbols[2].0 == "plane";
    let own: Vec<Found> = match plan.model.parameters() {
        2 => identify::<2>(plan.model, [plan.spreads[0], plan.spreads[1]], &trials),
        _ => identify::<3>(plan.model, plan.spreads, &trials),
    }?;
    let plain = identify::<2>(ContactModel::KelvinVoigt, [1e3, 30.0], &trials)?;
    let parameters = (0..plan.model.parameters())
        .map(|j| {
            let value = |found: &Found| match (is_plane, j) {
                (true, 2) => f64::from(contact_plane(found.parameters)),
                _ => f64::from(found.parameters[j]),
            };
            let width = |found: &Found| match (is_plane, j) {
                (true, 2) => f64::from(found.half_widths[2] / found.parameters[0]),
                _ => f64::from(found.half_widths[j]),
            };
            let (symbol, unit) = plan.symbols[j];
            Parameter {
                symbol,
                unit,
                truth: plan.truth[j],
                found: MeanAndDeviation::of(own.iter().map(value)),
                half_width: MeanAndDeviation::of(own.iter().map(width)).mean,
            }
        })
        .collect();
    Ok(Case {
        name: plan.name,
        equation: plan.equation,
        regressor: plan.model.name(),
        parameters,
        plain: [0, 1].map(|j| MeanAndDeviation::of(plain.iter().map(|found| f64::from(found.parameters[j])))),
        rmse: [&own, &plain].map(|all| MeanAndDeviation::of(all.iter().map(|found| found.rmse))),
    })
}

struct Found {
    parameters: [f32; 3],
    half_widths: [f32; 3],
    rmse: f64,
}

fn identify<const P: usize>(model: ContactModel, spreads: [f32; P], trials: &[PaperTrial]) -> Result<Vec<Found>> {
    let front_end = palpate::FrontEndConfig::BENCH;
    let identified = trials.iter().map(|trial| {
        let mut stream = ModelStream::new(front_end, model).map_err(|error| anyhow!("{error}"))?;
        let config = ParameterRlsConfig {
            forgetting_factor: 0.998,
            noise: 0.1,
            spreads,
            change: Some(ChangeConfig::default()),
            correlated_samples: stream.correlated_samples(),
        };
        let law = ParameterRls::new(config).map_err(|error| anyhow!("{error}"))?;
        let mut state = law.initial_state();
        let (mut errors, mut forces) = (0.0, 0.0);
        for sample in trial.samples(1) {
            let row = stream.update(sample).map_err(|why| anyhow!("a sample was rejected: {why:?}"))?;
            if row.contact && !row.restarted {
                let step = law.update(&mut state, row.first(), row.force);
                errors += f64::from(step.innovation).powi(2);
                forces += f64::from(row.force).powi(2);
            }
        }
        let pad = |values: [f32; P]| std::array::from_fn(|j| values.get(j).copied().unwrap_or_default());
        Ok(Found {
            parameters: pad(state.parameters),
            half_widths: pad(law.half_widths(&state)),
            rmse: 100.0 * f64::sqrt(errors / forces),
        })
    });
    identified.collect()
}
