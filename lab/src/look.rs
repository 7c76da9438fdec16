//! `palpate look`: what a recording holds, and a rig file to begin with.

mod channel_summary;
mod rig_template;

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::Result;
use clap::Args;

use crate::recording::data_file::DataFile;
use crate::terminal::printable;
use channel_summary::ChannelSummary;

/// List what a recording holds: columns or topics, rates, ranges and gaps
#[derive(Debug, Clone, Args)]
pub struct LookArgs {
    /// A recording: CSV, NPZ, MAT version 5, Parquet or MCAP
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Write a rig file to begin with instead
    #[arg(long)]
    pub rig_template: bool,
}

/// Runs `palpate look`.
///
/// # Errors
/// The file cannot be read or is damaged, or standard output is closed.
pub fn run(args: &LookArgs) -> Result<()> {
    let file = DataFile::read(&args.file)?;
    let text = if args.rig_template { rig_template::text(&file, &args.file) } else { listing(&file) };
    Ok(std::io::stdout().write_all(printable(&text).as_bytes())?)
}

/// A line a channel.
fn listing(file: &DataFile) -> String {
    let time = rig_template::time_column(file);
    let summaries: Vec<ChannelSummary> =
        file.channels.iter().map(|channel| ChannelSummary::of(channel, time)).collect();
    let width = summaries.iter().map(|summary| summary.name.chars().count()).max().unwrap_or(0).max("channel".len());
    let mut text = format!("{} file, {} channels", file.format.name(), file.channels.len());
    text += &match time {
        Some((name, _)) => format!(", time in {name}\n\n"),
        None if file.channels.iter().any(|channel| channel.clock.is_some()) => {
            ", each with a clock of its own\n\n".to_owned()
        }
        None => ", none of them looks like time (a column that increases, named t_s, time, ...)\n\n".to_owned(),
    };
    text += &format!(
        "{:width$}  {:>9}  {:>10}  {:>12}  {:>12}  notes\n",
        "channel", "values", "rate, Hz", "least", "greatest"
    );
    for summary in &summaries {
        text += &summary.line(width);
    }
    text
}
