//! `palpate profile`: what each estimator costs on the device, counted twice. Beside what running an image takes it needs
//! `llvm-objdump`, which rustup has as `llvm-tools`.

mod budget;
mod calls;
mod counts;
mod cycles;
mod emulator;
mod figures;
mod image;
mod interrupt;
mod listing;
mod table;
mod trial;

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use clap::Args;
use serde::Serialize;

pub use budget::{Cost, kept as kept_costs};
pub use figures::Figures;
pub use interrupt::{InterruptCost, interrupt_costs};

use crate::outfile::OutFile;
use crate::output_paths;
use crate::progress::Steps;
use crate::qemu_bench;
use crate::tools::{self, Leave, TARGET};
use calls::Calls;
use counts::Case;
use image::Image;

/// Count what each estimator costs on the device
#[derive(Debug, Clone, Args)]
pub struct ProfileArgs {
    /// Write the figures as JSON; `-`: to standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write a page that shows where the instructions go (disassembled by llvm-objdump, of rustup's llvm-tools)
    #[arg(long, value_name = "FILE.html")]
    pub listing: Option<PathBuf>,
    /// Write the figures into the sources as the budget that the tests hold them against
    #[arg(long)]
    pub renew_budget: bool,
}

#[derive(Serialize, schemars::JsonSchema)]
struct Document<'a> {
    schema: &'static str,
    target: &'static str,
    machine: &'static str,
    note: &'static str,
    counts_agree_on: usize,
    methods: &'a [Figures],
}

/// The JSON schema of the figures, made from the type that writes them.
#[must_use]
pub fn schema() -> schemars::Schema {
    schemars::schema_for!(Document<'static>)
}

/// A profile: the image, what was counted, and the figures.
pub struct Profile {
    image: Image,
    cases: Vec<Case>,
    /// The figures of each update.
    pub figures: Vec<Figures>,
}

impl Profile {
    /// Builds the image and its counter, and runs it twice; `say` receives the step that begins.
    ///
    /// # Errors
    /// A tool is missing, the image fails, or the two counts disagree.
    pub fn take(leave: Leave, say: &dyn Fn(&str)) -> Result<Self> {
        Self::of(leave, "palpate-firmware", "--bin", "profile", say)
    }

    /// The same of another image that measures by the same gauge: the one `name` of `package`, `kind` being `--bin` or `--example`.
    ///
    /// # Errors
    /// As [`Self::take`].
    pub fn of(leave: Leave, package: &str, kind: &str, name: &str, say: &dyn Fn(&str)) -> Result<Self> {
        say("looking for the cross target, QEMU and the disassembler");
        let qemu = tools::for_profiling(leave)?;
        say("building the plugin that counts");
        let emulator = emulator::Emulator::prepare(qemu)?;
        say("building and reading the image");
        let image = Image::read(&qemu_bench::build(package, kind, name)?)?;
        say("first count, by the plugin");
        let by_plugin = emulator.with_plugin(&image)?;
        say("second count, by the emulator's clock");
        let cases = counts::combine(&by_plugin, &emulator.with_clock(&image)?)?;
        say("following calls and stack");
        let figures = figures::of(&image, &cases, &trial::updates(&trial::samples()?)?)?;
        Ok(Self { image, cases, figures })
    }

    /// How many passes were counted.
    #[must_use]
    pub fn passes(&self) -> usize {
        self.cases.iter().map(|case| case.passes.len()).sum()
    }

    /// Every panic that an update can come to, after the name of the update.
    #[must_use]
    pub fn panics(&self) -> Vec<String> {
        let calls = Calls::of(&self.image);
        let of_case = |case: &Case| -> Vec<String> {
            let Some(start) = figures::entry(&self.image, case) else { return vec![format!("{}: no code", case.name)] };
            let panics = calls.reached(start).into_iter().filter(|function| calls::is_panic(function));
            panics.map(|function| format!("{}: {}", case.name, function.name)).collect()
        };
        self.cases.iter().skip(1).flat_map(of_case).collect()
    }

    /// Every figure that is not within the budget of the sources, in words; empty where all are.
    ///
    /// # Errors
    /// The budget is not there.
    pub fn beyond_budget(&self) -> Result<String> {
        budget::differences(&self.figures, &budget::path(&qemu_bench::project()?))
    }
}

/// The observations in contact of the recording that is measured, in internal units.
///
/// # Errors
/// None for the settings of the recording.
pub fn observations() -> Result<Vec<palpate::Observation>> {
    trial::observations(&trial::samples()?)
}

/// Names of panics that can be reached from the function `entry` of an image, and of functions that call what cannot be seen.
///
/// # Errors
/// The image cannot be read, or has no such function.
pub fn panics_reached_from(image: &Path, entry: &str) -> Result<Vec<String>> {
    let image = Image::read(image)?;
    let start = image.label(entry)?;
    let calls = Calls::of(&image);
    let panics = calls.reached(start).into_iter().filter(|function| calls::is_panic(function));
    Ok(panics.chain(calls.blind(start)).map(|function| function.name.clone()).collect())
}

/// Bytes of stack of the deepest way from the function `entry` of an image, or of all its functions where that cannot be determined.
///
/// # Errors
/// The image cannot be read, or has no such function.
pub fn stack_from(image: &Path, entry: &str) -> Result<u32> {
    let image = Image::read(image)?;
    let (calls, start) = (Calls::of(&image), image.label(entry)?);
    Ok(calls.stack(start).unwrap_or_else(|| calls.frames(start)))
}

/// The image that runs the estimators from the interrupt, built.
///
/// # Errors
/// It does not build.
pub fn interrupt_image() -> Result<PathBuf> {
    qemu_bench::build("palpate-firmware", "--bin", "replay")
}

/// The image of a drive, built.
///
/// # Errors
/// It does not build.
pub fn drive_image() -> Result<PathBuf> {
    qemu_bench::build("palpate-firmware", "--bin", "drive")
}

/// Runs `palpate profile`.
///
/// # Errors
/// A tool is missing, the image fails, the two counts disagree, or an output cannot be written.
pub fn run(args: &ProfileArgs) -> Result<()> {
    let outputs = [("--json", &args.json), ("--listing", &args.listing)];
    let outputs: Vec<_> = outputs.iter().filter_map(|(option, path)| Some((*option, path.as_deref()?))).collect();
    output_paths::check(&[], &outputs)?;
    let listing = args.listing.as_deref().map(OutFile::create).transpose()?;
    let json = args.json.as_deref().filter(|path| path.as_os_str() != "-").map(OutFile::create).transpose()?;
    let steps = Steps::new("profile");
    let profile = Profile::take(Leave::Install, &|step| steps.say(step))?;
    drop(steps);
    let text = table::text(&profile.figures, profile.passes());
    let document = Document {
        schema: "palpate.profile/1",
        target: TARGET,
        machine: "netduinoplus2",
        note: table::NO_BOARD,
        counts_agree_on: profile.passes(),
        methods: &profile.figures,
    };
    let document = serde_json::to_string_pretty(&document)? + "\n";
    let to_stdout = args.json.as_deref().is_some_and(|path| path.as_os_str() == "-");
    if to_stdout {
        eprint!("{text}");
        std::io::stdout().write_all(document.as_bytes()).context("standard output")?;
    } else {
        std::io::stdout().write_all(text.as_bytes()).context("standard output")?;
    }
    for (file, content) in
        [(json, document), (listing, listing::page(&profile.image, &profile.cases, &profile.figures))]
    {
        let Some(mut file) = file else { continue };
        file.write_all(content.as_bytes()).map_err(|error| file.fault(&error))?;
        file.commit()?;
    }
    if args.renew_budget {
        let path = budget::path(&qemu_bench::project()?);
        let mut file = OutFile::create(&path)?;
        file.write_all(budget::text(&profile.figures)?.as_bytes()).map_err(|error| file.fault(&error))?;
        file.commit()?;
        eprintln!("wrote {}", path.display());
        return Ok(());
    }
    let beyond = profile.beyond_budget()?;
    if beyond.is_empty() {
        return Ok(());
    }
    bail!("beyond the budget ({}; --renew-budget takes them over):\n{}", budget::BUDGET_FILE, beyond.trim_end())
}
