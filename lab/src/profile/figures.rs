//! The cost figures of each estimator.

use std::collections::BTreeSet;

use anyhow::{Context, Result, ensure};
use schemars::JsonSchema;
use serde::Serialize;

use super::calls::Calls;
use super::counts::Case;
use super::image::Image;

/// Core clock of the board, cycles a second.
const CLOCK_HZ: f64 = 168e6;

/// What the counting itself takes: the call, a branch, and the return of a function that does nothing.
const EMPTY_CASE: &str = "nothing";

/// Bytes that the flash of an STM32F405 hands over at once, and the cycles that the core waits where they are not at hand.
const FLASH_LINE_BYTES: u32 = 16;
const FLASH_WAIT_CYCLES: u32 = 5;

/// The figures of one estimator.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Figures {
    /// Its name.
    pub name: String,
    /// Its window.
    pub window: Option<u16>,
    /// Instructions of an update, on the mean, without the call.
    pub instructions_mean: f64,
    /// The most of any update.
    pub instructions_worst: u32,
    /// The sample of the recording that took the most.
    pub worst_sample: usize,
    /// Modelled cycles of the mean update, at least.
    pub cycles_lo: u32,
    /// The same, at most.
    pub cycles_hi: u32,
    /// Modelled cycles of the worst update, at least.
    pub worst_cycles_lo: u32,
    /// The same, at most.
    pub worst_cycles_hi: u32,
    /// Lines of flash that its code fills.
    pub flash_lines: usize,
    /// Cycles that they add where none is at hand.
    pub cold_cycles: u32,
    /// Bytes of stack along the deepest call.
    pub stack_bytes: u32,
    /// Bytes of stack that were seen in use.
    pub stack_painted_bytes: u32,
    /// Bytes of state and of the samples in its window.
    pub state_bytes: u32,
    /// Share of a period of 1 ms, in per cent, of the worst update at most.
    pub share_of_1ms_percent: f64,
    /// Updates a second at 168 MHz, of the worst update at most.
    pub updates_per_s: f64,
}

impl Figures {
    /// Those that the sources hold.
    #[must_use]
    pub fn cost(&self) -> super::Cost {
        super::Cost::of(self)
    }
}

/// Where the code of a case begins.
pub fn entry(image: &Image, case: &Case) -> Option<u32> {
    let called = |at: &u32| image.function_at(*at).filter(|function| function.name.contains("measurement::call"));
    case.times.keys().find_map(|at| called(at).map(|function| function.start))
}

/// The figures of all cases but the first, the empty call, whose cost is subtracted from the others.
///
/// # Errors
/// There is no such case, one has no pass, or its stack is not bounded.
pub fn of(image: &Image, cases: &[Case], updates: &[usize]) -> Result<Vec<Figures>> {
    let nothing = cases.first().filter(|case| case.name == EMPTY_CASE).and_then(|case| case.passes.first());
    let nothing = nothing.context("the image did not measure nothing first")?;
    let calls = Calls::of(image);
    let relieved = |value: u32, by: u32| value.saturating_sub(by);
    cases[1..]
        .iter()
        .map(|case| {
            let worst = case.passes.iter().enumerate().rev().max_by_key(|(_, pass)| pass.instructions);
            let (at, worst) = worst.with_context(|| format!("{}: no update", case.name))?;
            let mean = |of: &dyn Fn(usize) -> u32| {
                (0..case.passes.len()).map(|k| f64::from(of(k))).sum::<f64>() / case.passes.len() as f64
            };
            let band = |k: usize, end: usize| relieved(case.passes[k].cycles[end], nothing.cycles[end]);
            let entry = entry(image, case).with_context(|| format!("{}: nothing was called", case.name))?;
            let blind = calls.blind(entry);
            ensure!(blind.is_empty(), "{}: a call through a register in {}", case.name, blind[0].name);
            let lines: BTreeSet<u32> = case.times.keys().map(|address| address / FLASH_LINE_BYTES).collect();
            let hi = relieved(worst.cycles[1], nothing.cycles[1]);
            Ok(Figures {
                name: case.name.clone(),
                window: case.window,
                instructions_mean: mean(&|k| relieved(case.passes[k].instructions, nothing.instructions)),
                instructions_worst: relieved(worst.instructions, nothing.instructions),
                worst_sample: if case.passes.len() == updates.len() { updates[at] } else { at },
                cycles_lo: mean(&|k| band(k, 0)).floor() as u32,
                cycles_hi: mean(&|k| band(k, 1)).ceil() as u32,
                worst_cycles_lo: relieved(worst.cycles[0], nothing.cycles[0]),
                worst_cycles_hi: hi,
                flash_lines: lines.len(),
                cold_cycles: FLASH_WAIT_CYCLES * u32::try_from(lines.len())?,
                stack_bytes: calls.stack(entry).with_context(|| format!("{}: a function calls itself", case.name))?,
                stack_painted_bytes: case.passes.iter().map(|pass| pass.stack).max().unwrap_or(0),
                state_bytes: case.state + case.ring,
                share_of_1ms_percent: 100.0 * f64::from(hi) / (CLOCK_HZ * 1e-3),
                updates_per_s: CLOCK_HZ / f64::from(hi.max(1)),
            })
        })
        .collect()
}
