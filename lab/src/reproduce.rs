//! `palpate reproduce`: the paper's study on a simulated bench, beside the paper's own figures, and what does better.

pub mod claim;
pub mod comparison;
pub mod estimator;
mod figures;
pub mod force_control;
pub mod measure;
pub mod models;
mod output_files;
mod page;
pub mod paper;
pub mod paper_contact;
pub mod paper_tables;
mod plot;
pub mod rates;

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::{Context as _, Result};
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};

use claim::Claim;
use figures::Figure;
use paper_tables::{PaperVariant, Study};
use rates::{Rate, Source};

/// Reproduce the paper's study, and show what does better
#[derive(Debug, Clone, Args)]
pub struct ReproduceArgs {
    /// Folder for the page, the tables as CSV, the figures as SVG and the rig files; without it, the words go to standard output alone
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// How the paper's sampling is read in the tables and figures that are shown; its claims are judged under every reading
    #[arg(long, value_enum, default_value_t)]
    pub sampling: Sampling,
    /// Count the instructions of table IV in QEMU now, in the place of those that the sources hold
    #[arg(long)]
    pub count: bool,
}

/// How the paper's sampling is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Sampling {
    /// Every sample of the 1 kHz loop
    #[default]
    #[value(name = "1khz")]
    Full,
    /// Every tenth, as "down sampled by 10" says
    #[value(name = "100hz")]
    Tenth,
}

/// Everything that was computed.
pub struct Results {
    /// Tables I to III, by reading.
    pub studies: Vec<Study>,
    /// The one that is shown.
    pub shown: usize,
    /// What updates cost.
    pub rates: Source,
    /// Table IV.
    pub rate_table: Vec<Rate>,
    /// Every claim.
    pub claims: Vec<Claim>,
    /// What the paper says against itself.
    pub inconsistencies: Vec<String>,
    /// Where the truth is known.
    pub better: Vec<comparison::ComparisonRow>,
    /// Other contact laws.
    pub models: Vec<models::Case>,
    /// The force under control.
    pub force: Vec<force_control::ForceControlResult>,
    figures: Vec<Figure>,
    better_figures: Vec<Figure>,
    force_figures: Vec<Figure>,
    rigs: Vec<(&'static str, &'static str)>,
}

/// Runs the command.
///
/// # Errors
/// An output cannot be written, or, with `--count`, the image fails.
pub fn run(args: &ReproduceArgs) -> Result<()> {
    let files = args.out.as_deref().map(output_files::OutputFiles::open).transpose()?;
    let results = Results::compute(args)?;
    print(&results).context("standard output")?;
    if let (Some(files), Some(folder)) = (files, &args.out) {
        files.write(&results)?;
        println!("{}", folder.join("reproduce.html").display());
    }
    Ok(())
}

impl Results {
    /// Simulates and estimates everything.
    ///
    /// # Errors
    /// With `args.count`, the image fails; nothing for the rig files of this repository.
    pub fn compute(args: &ReproduceArgs) -> Result<Self> {
        let rates = Source::find(args.count)?;
        let bar = bar(3 * 7 + comparison::compared().len() + 5 + force_control::StiffnessSource::all().len() + 3);
        let done = || bar.inc(1);
        bar.set_message("simulating the paper's contacts");
        let trials = paper_tables::trials()?;
        done();
        bar.set_message("the paper's tables");
        let studies = PaperVariant::ALL.map(|reading| Study::of(reading, &trials, &done));
        let studies: Vec<Study> = studies.into_iter().collect::<Result<_>>()?;
        bar.set_message("what does better");
        let steps = comparison::trials()?;
        let better = comparison::study(&steps, &done)?;
        bar.set_message("other contact laws");
        let models = models::study(&done)?;
        bar.set_message("the force under control");
        let force = force_control::study(&done)?;
        bar.set_message("figures");
        let shown = usize::from(args.sampling == Sampling::Tenth);
        let rate_table = rates.table();
        let figures = figures::of_paper(&studies[shown].reading, &trials, &rate_table)?;
        done();
        let mut better_figures = figures::of_better(&steps[0], &force)?;
        let force_figures = better_figures.split_off(better_figures.len() - 1);
        bar.finish_and_clear();
        let claims = claim::of_tables(&studies).into_iter().chain(claim::of_rates(&rates)).collect();
        let (inconsistencies, rigs) = (claim::inconsistencies(), output_files::all_rigs().collect());
        Ok(Self {
            studies,
            shown,
            rates,
            rate_table,
            claims,
            inconsistencies,
            better,
            models,
            force,
            figures,
            better_figures,
            force_figures,
            rigs,
        })
    }
}

/// A bar on standard error where that is a terminal, and nothing else.
fn bar(steps: usize) -> ProgressBar {
    let bar = ProgressBar::new(steps as u64);
    if let Ok(style) = ProgressStyle::with_template("{msg:32} {wide_bar} {pos}/{len}, {elapsed}") {
        bar.set_style(style);
    }
    bar
}

fn print(results: &Results) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "The paper's claims, under each reading:")?;
    for claim in &results.claims {
        writeln!(out, "  {} ({}; paper: {})", claim.words, claim.place, claim.paper)?;
        for finding in &claim.findings {
            let verdict = if finding.holds { "holds" } else { "does not hold" };
            writeln!(out, "    {:<30} {verdict:<14} {}", finding.reading, finding.found)?;
        }
    }
    writeln!(out, "Where the paper disagrees with itself:")?;
    results.inconsistencies.iter().try_for_each(|words| writeln!(out, "  {words}"))?;
    writeln!(
        out,
        "\n{:<36}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}",
        "steps of K, means", "onset ms", "up ms", "down ms", "std K %", "bias B %", "K cov %", "B cov %"
    )?;
    for row in &results.better {
        writeln!(
            out,
            "{:<36}{:>10.0}{:>10.0}{:>10.0}{:>10.3}{:>10.2}{:>10.1}{:>10.1}",
            row.name(),
            row.onset.mean,
            row.up.mean,
            row.down.mean,
            row.deviation.mean,
            row.bias_damping.mean,
            row.covered_stiffness.mean,
            row.covered_damping.mean
        )?;
    }
    writeln!(out, "\n{:<36}{:>10}{:>10}{:>10}", "force control by K from", "up ms", "down ms", "rms %")?;
    for row in &results.force {
        writeln!(
            out,
            "{:<36}{:>10.0}{:>10.0}{:>10.1}",
            row.source.name(),
            row.settled_up.mean,
            row.settled_down.mean,
            row.rms.mean
        )?;
    }
    Ok(())
}
