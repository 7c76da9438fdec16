//! `palpate effects`: what is known of every effect, for people and for machines.

mod machine;
mod text;

use std::io::{ErrorKind, Write as _};
use std::path::PathBuf;

use anyhow::Context as _;
use clap::Args;

use crate::effects::{self, Effect};
use crate::error::UsageError;
use crate::outfile::OutFile;
use crate::rig::nearest;

/// List the physics that it knows beyond spring and damper
#[derive(Debug, Clone, Args)]
pub struct EffectsArgs {
    /// Effects to list; all where none is named
    #[arg(value_name = "NAME")]
    pub names: Vec<String>,
    /// Write them as JSON instead; `-`: to standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

/// Columns of text on a terminal: its own width within these, and 80 where the output is redirected.
const MIN_COLUMNS: usize = 60;
const MAX_COLUMNS: usize = 110;

/// Runs `palpate effects`.
///
/// # Errors
/// A name that no effect has, or an output that cannot be written.
pub fn run(args: &EffectsArgs) -> anyhow::Result<()> {
    let chosen = chosen(&args.names)?;
    match &args.json {
        None => {
            let columns = textwrap::termwidth().clamp(MIN_COLUMNS, MAX_COLUMNS);
            let index = if args.names.is_empty() { text::index(&chosen, columns) } else { String::new() };
            print(&(index + &text::page(&chosen, columns)))
        }
        Some(path) if path.as_os_str() == "-" => print(&machine::document(&chosen)?),
        Some(path) => {
            let mut file = OutFile::create(path)?;
            file.write_all(machine::document(&chosen)?.as_bytes()).map_err(|error| file.fault(&error))?;
            Ok(file.commit()?)
        }
    }
}

fn chosen(names: &[String]) -> Result<Vec<&'static dyn Effect>, UsageError> {
    if names.is_empty() {
        return Ok(effects::ALL.to_vec());
    }
    names.iter().map(|name| effects::find(name).ok_or_else(|| unknown(name))).collect()
}

fn unknown(name: &str) -> UsageError {
    let all = effects::ALL.map(|effect| effect.spec().name);
    let expected = match nearest(name, &all) {
        Some(near) => format!("{near} perhaps; `palpate effects` lists them all"),
        None => format!("one of {}", all.join(", ")),
    };
    UsageError::new("NAME", format!("the unknown effect \"{name}\""), expected)
}

/// To standard output. A reader that has seen enough, `head` say, is no fault.
fn print(text: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error).context("standard output"),
        _ => Ok(()),
    }
}
