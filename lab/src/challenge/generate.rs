//! Drawing all cases, before any is diagnosed.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::Result;
use palpate_cases::python::Python;
use palpate_cases::{ExternalSimulator, SimulatorKind, Truth, draw, draw_in};

use super::case_list::ListedCase;

/// A case whose recordings lie in a folder of their own.
#[derive(Debug)]
pub struct GeneratedCase {
    /// Holds `rig.toml`, `trial-1.csv` and `trial-2.csv`, and nothing else.
    pub folder: PathBuf,
    /// What they conceal.
    pub truth: Truth,
}

/// The cases of `entries` under `home`, each in a folder of its own, in their order, by as many threads as there are cores;
/// and those that could not be drawn, with why. `python` has the simulators of others, where there are any to be asked.
///
/// # Errors
/// Nothing can be written to `home`.
pub fn generate_all(
    entries: &[ListedCase],
    seed: u64,
    home: &Path,
    python: Option<&Python>,
    done: &(dyn Fn() + Sync),
) -> Result<(Vec<GeneratedCase>, Vec<String>)> {
    let (next, results) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        let mut pool = SimulatorPool { python, simulators: HashMap::new() };
        while let Some(entry) = entries.get(next.fetch_add(1, Ordering::Relaxed)) {
            let drawn = pool.generate(entry, seed, home);
            results.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((entry, drawn));
            done();
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    let mut results = results.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    let place = |entry: &ListedCase| entries.iter().position(|other| other.index == entry.index);
    results.sort_by_key(|(entry, _)| place(entry));
    let (mut drawn, mut failed) = (Vec::new(), Vec::new());
    for (entry, result) in results {
        match result {
            Ok(case) => drawn.push(case),
            Err(error) => failed.push(format!("case {} ({}): {error:#}", entry.index, entry.source.name())),
        }
    }
    Ok((drawn, failed))
}

/// One thread's simulators with the cases each has played, started when they are first asked for.
struct SimulatorPool<'a> {
    python: Option<&'a Python>,
    simulators: HashMap<SimulatorKind, (ExternalSimulator, usize)>,
}

/// Cases after which a simulator is started anew: Exudyn keeps some 0.3 GB of each that it has played.
const CASES_PER_PROCESS: usize = 6;

impl SimulatorPool<'_> {
    fn generate(&mut self, entry: &ListedCase, seed: u64, home: &Path) -> Result<GeneratedCase> {
        let case = match (entry.source, self.python) {
            (SimulatorKind::Own, _) => draw(seed, entry.index, &entry.request)?,
            (source, Some(python)) => {
                if self.simulators.get(&source).is_some_and(|(_, played)| *played >= CASES_PER_PROCESS) {
                    self.simulators.remove(&source);
                }
                let (simulator, played) = match self.simulators.entry(source) {
                    Entry::Occupied(running) => running.into_mut(),
                    Entry::Vacant(place) => place.insert((ExternalSimulator::start(python, source)?, 0)),
                };
                *played += 1;
                draw_in(simulator, seed, entry.index, &entry.request)?
            }
            (source, None) => anyhow::bail!("{} is not installed", source.name()),
        };
        let folder = home.join(format!("case-{:04}", entry.index));
        case.write(&folder)?;
        Ok(GeneratedCase { folder, truth: case.truth })
    }
}
