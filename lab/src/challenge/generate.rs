//! Drawing all cases, before any is diagnosed.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use anyhow::Result;
use palpate_cases::python::Python;
use palpate_cases::{ExternalSimulator, SimulatorKind, draw, draw_in};

use super::case_list::ListedCase;
use super::commitment::{CommittedCase, Origin};
use super::work_folder::WorkFolder;

/// The cases of `entries` in `folder`, each in a folder of its own, in the order of `entries`, by as many threads as there are
/// cores; and those that could not be drawn, with why. What an interrupted run has drawn stays. `python` has the external
/// simulators, where there are any to be asked.
///
/// # Errors
/// The folder cannot be read.
pub fn generate_all(
    entries: &[ListedCase],
    seed: u64,
    folder: &WorkFolder,
    python: Option<&Python>,
    done: &(dyn Fn() + Sync),
) -> Result<(Vec<CommittedCase>, Vec<String>)> {
    let there = folder.drawn()?;
    let (next, results) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        let mut pool = SimulatorPool { python, simulators: HashMap::new() };
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(entry) = entries.get(place) else { break };
            let kept = there.get(&case_name(entry)).cloned();
            let drawn = kept.is_none().then(|| pool.generate(entry, seed, folder));
            let mut results = results.lock().unwrap_or_else(PoisonError::into_inner);
            // Noted under the lock: two lines of a file are not to be mixed.
            let case = match (kept, drawn) {
                (Some(case), _) => Ok(case),
                (None, Some(drawn)) => drawn.and_then(|case| folder.note_drawn(&case).map(|()| case)),
                (None, None) => continue,
            };
            results.push((place, case));
            done();
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.sort_by_key(|(place, _)| *place);
    let (mut drawn, mut failed) = (Vec::new(), Vec::new());
    for (place, result) in results {
        let entry = &entries[place];
        match result {
            Ok(case) => drawn.push(case),
            Err(error) => failed.push(format!("case {} ({}): {error:#}", entry.index, entry.source.name())),
        }
    }
    Ok((drawn, failed))
}

fn case_name(entry: &ListedCase) -> String {
    format!("case-{:04}", entry.index)
}

/// One thread's simulators with the cases each has played, started when they are first asked for.
struct SimulatorPool<'a> {
    python: Option<&'a Python>,
    simulators: HashMap<SimulatorKind, (ExternalSimulator, usize)>,
}

/// Cases after which a simulator is started anew: Exudyn keeps some 0.3 GB of each that it has played.
const CASES_PER_PROCESS: usize = 6;

impl SimulatorPool<'_> {
    fn generate(&mut self, entry: &ListedCase, seed: u64, home: &WorkFolder) -> Result<CommittedCase> {
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
        let name = case_name(entry);
        case.write(&home.path().join(&name))?;
        CommittedCase::new(home.path(), &name, Origin::Drawn, &case.truth)
    }
}
