//! `cases`: writes recordings with concealed physics, and the answers beside them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::{Parser, ValueEnum};
use palpate_cases::baselines::Baseline;
use palpate_cases::excitation::Excitation;
use palpate_cases::python;
use palpate_cases::sensors::SensorGrade;
use palpate_cases::simulator::{OwnSimulator, Simulator, SimulatorKind};
use palpate_cases::{CaseRequest, EffectSelection, ExternalSimulator, draw_in};
use serde::Serialize;

/// Recordings of simulated rigs with concealed physics
#[derive(Debug, Parser)]
#[command(name = "cases", version)]
struct Cli {
    /// Seed of all cases
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Number of cases
    #[arg(long, default_value_t = 10)]
    count: u64,
    /// Number of concealed effects; drawn where left out
    #[arg(long)]
    kind: Option<KindChoice>,
    /// The effect that each conceals; two, with a comma between them, make a pair
    #[arg(long, value_delimiter = ',')]
    effect: Vec<String>,
    /// RMS residual of the refitted nominal model over the RMS sensor error; 0.1 to 10 at random where left out
    #[arg(long)]
    strength: Option<f64>,
    /// SensorChoice; drawn where left out
    #[arg(long)]
    sensors: Option<SensorChoice>,
    /// ExcitationChoice; drawn where left out
    #[arg(long)]
    reference: Option<ExcitationChoice>,
    /// Leave the effort out
    #[arg(long)]
    no_effort: bool,
    /// Only linear rigs at the size of a bench
    #[arg(long)]
    bench: bool,
    /// Simulator that makes the cases
    #[arg(long, default_value = "own")]
    source: SimulatorChoice,
    /// Folder in which Python packages are set up for simulators and baselines
    #[arg(long, default_value = "target/python")]
    python_home: PathBuf,
    /// Run PySINDy and SysIdentPy on each case, and write their results beside the answers
    #[arg(long)]
    baselines: bool,
    /// Folder to write to
    #[arg(long)]
    out: PathBuf,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum SimulatorChoice {
    Own,
    Mujoco,
    Drake,
    Exudyn,
}

impl SimulatorChoice {
    fn source(self) -> SimulatorKind {
        match self {
            Self::Own => SimulatorKind::Own,
            Self::Mujoco => SimulatorKind::Mujoco,
            Self::Drake => SimulatorKind::Drake,
            Self::Exudyn => SimulatorKind::Exudyn,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum KindChoice {
    None,
    Single,
    Pair,
    Outside,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum SensorChoice {
    Coarse,
    Fine,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum ExcitationChoice {
    Rich,
    Poor,
}

impl Cli {
    fn request(&self) -> CaseRequest {
        CaseRequest {
            selection: self.selection(),
            sensors: self.sensors.map(|grade| match grade {
                SensorChoice::Coarse => SensorGrade::Coarse,
                SensorChoice::Fine => SensorGrade::Fine,
            }),
            excitation: self.reference.map(|kind| match kind {
                ExcitationChoice::Rich => Excitation::Rich,
                ExcitationChoice::Poor => Excitation::Poor,
            }),
            effort: self.no_effort.then_some(false),
            rotary: self.bench.then_some(false),
            bench: self.bench.then_some(true),
            ..CaseRequest::default()
        }
    }

    fn selection(&self) -> Option<EffectSelection> {
        let strength = self.strength;
        match (self.effect.as_slice(), self.kind) {
            ([one], _) => Some(EffectSelection::single(one, strength)),
            ([one, other, ..], _) => {
                Some(EffectSelection::Pair { names: Some([one.clone(), other.clone()]), strength })
            }
            ([], Some(KindChoice::None)) => Some(EffectSelection::Nothing),
            ([], Some(KindChoice::Single)) => Some(EffectSelection::Single { name: None, strength }),
            ([], Some(KindChoice::Pair)) => Some(EffectSelection::Pair { names: None, strength }),
            ([], Some(KindChoice::Outside)) => Some(EffectSelection::Outside { name: None, strength }),
            ([], None) => strength.map(|_| EffectSelection::Single { name: None, strength }),
        }
    }
}

fn main() -> Result<()> {
    let cli = Cli::parse();
    match cli.source.source() {
        SimulatorKind::Own => write_all(&cli, &mut OwnSimulator),
        source => {
            let python = python::set_up(&cli.python_home, &python::SIMULATORS)?;
            write_all(&cli, &mut ExternalSimulator::start(&python, source)?)
        }
    }
}

fn write_all<W: Simulator>(cli: &Cli, simulator: &mut W) -> Result<()> {
    let request = cli.request();
    let baselines = cli.baselines.then(|| python::set_up(&cli.python_home, &python::BASELINES)).transpose()?;
    let (mut truths, mut results) = (Vec::new(), Vec::new());
    for index in 0..cli.count {
        let case = draw_in(simulator, cli.seed, index, &request)?;
        let folder = cli.out.join(format!("case-{index:04}"));
        case.write(&folder)?;
        truths.push(case.truth);
        if let Some(python) = &baselines {
            let found = Baseline::ALL.into_iter().map(|rival| Ok((rival.name(), rival.run(python, &folder)?)));
            results.push(found.collect::<Result<BTreeMap<_, _>>>()?);
        }
    }
    std::fs::create_dir_all(&cli.out).with_context(|| format!("cannot make {}", cli.out.display()))?;
    write_json(&cli.out.join("truth.json"), &truths)?;
    if baselines.is_some() {
        write_json(&cli.out.join("baselines.json"), &results)?;
    }
    Ok(())
}

fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(value)?;
    std::fs::write(path, text + "\n").with_context(|| format!("cannot write {}", path.display()))
}
