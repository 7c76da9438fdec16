//! `palpate profile`: what each estimator costs on the device, counted twice.

mod counts;
mod cycles;
mod emulator;
mod image;
mod trial;

use std::path::PathBuf;

use clap::Args;

use crate::device;
use crate::tools::{self, Leave};

/// Count what each estimator costs on the device
#[derive(Debug, Clone, Args)]
pub struct ProfileArgs {
    /// Write the figures as JSON; `-`: to standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

/// Runs `palpate profile`.
///
/// # Errors
/// A tool is missing, the image fails, or the two counts disagree.
pub fn run(_args: &ProfileArgs) -> anyhow::Result<()> {
    let emulator = emulator::Emulator::prepare(tools::for_the_device(Leave::Install)?)?;
    let image = image::Image::read(&device::build("palpate", "profile")?)?;
    let cases = counts::combine(&emulator.with_plugin(&image)?, &emulator.with_clock(&image)?)?;
    for case in &cases {
        if std::env::var("DBG").is_ok_and(|d| d == format!("{}{}", case.name, case.window.unwrap_or(0))) {
            for (a, n) in &case.times {
                let i = &image.code[a];
                println!(
                    "{a:x} {:7.2} {} {} [{}]",
                    *n as f64 / case.passes.len() as f64,
                    i.mnemonic,
                    i.operands,
                    image.function_at(*a).map_or("", |f| &f.name)
                );
            }
        }
        let n = case.passes.len() as f64;
        let mean = case.passes.iter().map(|p| f64::from(p.instructions)).sum::<f64>() / n;
        let worst = case.passes.iter().enumerate().max_by_key(|p| p.1.instructions);
        let lo = case.passes.iter().map(|p| f64::from(p.cycles[0])).sum::<f64>() / n;
        let hi = case.passes.iter().map(|p| f64::from(p.cycles[1])).sum::<f64>() / n;
        let stack = case.passes.iter().map(|p| p.stack).max();
        println!(
            "{} {:?}: {mean:.1} {worst:?} {lo:.0}-{hi:.0} stack {stack:?} state {}",
            case.name, case.window, case.state
        );
    }
    Ok(())
}
