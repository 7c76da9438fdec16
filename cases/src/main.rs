//! `cases`: writes recordings with concealed physics, and the answers beside them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::{Parser, ValueEnum};
use palpate_cases::python;
use palpate_cases::reference::Kind as Reference;
use palpate_cases::rivals::Rival;
use palpate_cases::sensors::Grade;
use palpate_cases::world::{Own, Source, World};
use palpate_cases::{Simulator, What, Wish, draw_in};
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
    /// What each conceals; drawn where left out
    #[arg(long)]
    kind: Option<Kind>,
    /// The effect that each conceals; two, with a comma between them, make a pair
    #[arg(long, value_delimiter = ',')]
    effect: Vec<String>,
    /// Strength over the floor of the sensor; 0.1 to 10 at random where left out
    #[arg(long)]
    strength: Option<f64>,
    /// Sensors; drawn where left out
    #[arg(long)]
    sensors: Option<Sensors>,
    /// Trajectories; drawn where left out
    #[arg(long)]
    reference: Option<Trajectories>,
    /// Leave the effort out
    #[arg(long)]
    no_effort: bool,
    /// Only linear rigs at the size of a bench
    #[arg(long)]
    bench: bool,
    /// Whose simulation makes them
    #[arg(long, default_value = "own")]
    source: Maker,
    /// Folder in which Python packages are set up for the tools of others
    #[arg(long, default_value = "target/python")]
    python_home: PathBuf,
    /// Have PySINDy and SysIdentPy look at each case, and write what they find beside the answers
    #[arg(long)]
    rivals: bool,
    /// Folder to write to
    #[arg(long)]
    out: PathBuf,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Maker {
    Own,
    Mujoco,
    Drake,
    Exudyn,
}

impl Maker {
    fn source(self) -> Source {
        match self {
            Self::Own => Source::Own,
            Self::Mujoco => Source::Mujoco,
            Self::Drake => Source::Drake,
            Self::Exudyn => Source::Exudyn,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Kind {
    None,
    Single,
    Pair,
    Outside,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Sensors {
    Coarse,
    Fine,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Trajectories {
    Rich,
    Poor,
}

impl Cli {
    fn wish(&self) -> Wish {
        Wish {
            what: self.what(),
            sensors: self.sensors.map(|grade| match grade {
                Sensors::Coarse => Grade::Coarse,
                Sensors::Fine => Grade::Fine,
            }),
            reference: self.reference.map(|kind| match kind {
                Trajectories::Rich => Reference::Rich,
                Trajectories::Poor => Reference::Poor,
            }),
            effort: self.no_effort.then_some(false),
            rotary: self.bench.then_some(false),
            bench: self.bench.then_some(true),
            ..Wish::default()
        }
    }

    fn what(&self) -> Option<What> {
        let strength = self.strength;
        match (self.effect.as_slice(), self.kind) {
            ([one], _) => Some(What::single(one, strength)),
            ([one, other, ..], _) => Some(What::Pair { names: Some([one.clone(), other.clone()]), strength }),
            ([], Some(Kind::None)) => Some(What::Nothing),
            ([], Some(Kind::Single)) => Some(What::Single { name: None, strength }),
            ([], Some(Kind::Pair)) => Some(What::Pair { names: None, strength }),
            ([], Some(Kind::Outside)) => Some(What::Outside { name: None, strength }),
            ([], None) => strength.map(|_| What::Single { name: None, strength }),
        }
    }
}

fn main() -> Result<()> {
    let cli = Cli::parse();
    match cli.source.source() {
        Source::Own => write_all(&cli, &mut Own),
        source => {
            let python = python::set_up(&cli.python_home, &python::SIMULATORS)?;
            write_all(&cli, &mut Simulator::start(&python, source)?)
        }
    }
}

fn write_all<W: World>(cli: &Cli, world: &mut W) -> Result<()> {
    let wish = cli.wish();
    let rivals = cli.rivals.then(|| python::set_up(&cli.python_home, &python::RIVALS)).transpose()?;
    let (mut truths, mut findings) = (Vec::new(), Vec::new());
    for index in 0..cli.count {
        let case = draw_in(world, cli.seed, index, &wish)?;
        let folder = cli.out.join(format!("case-{index:04}"));
        case.write(&folder)?;
        truths.push(case.truth);
        if let Some(python) = &rivals {
            let found = Rival::ALL.into_iter().map(|rival| Ok((rival.name(), rival.look(python, &folder)?)));
            findings.push(found.collect::<Result<BTreeMap<_, _>>>()?);
        }
    }
    std::fs::create_dir_all(&cli.out).with_context(|| format!("cannot make {}", cli.out.display()))?;
    write_json(&cli.out.join("truth.json"), &truths)?;
    if rivals.is_some() {
        write_json(&cli.out.join("rivals.json"), &findings)?;
    }
    Ok(())
}

fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(value)?;
    std::fs::write(path, text + "\n").with_context(|| format!("cannot write {}", path.display()))
}
