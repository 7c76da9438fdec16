//! What the two runs counted, put together and held against each other.

use std::collections::BTreeMap;

use anyhow::{Context, Result, ensure};

/// One pass of one update.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pass {
    /// Instructions, the call among them.
    pub instructions: u32,
    /// Modelled cycles, least and most.
    pub cycles: [u32; 2],
    /// Bytes of stack whose paint was gone.
    pub stack: u32,
}

/// One estimator.
#[derive(Debug, Clone)]
pub struct Case {
    /// Its name.
    pub name: String,
    /// Its window, where it has one.
    pub window: Option<u16>,
    /// Bytes of its state.
    pub state: u32,
    /// Bytes of the samples that it needs.
    pub ring: u32,
    /// All passes, in the order of the samples.
    pub passes: Vec<Pass>,
    /// How often each instruction was executed.
    pub times: BTreeMap<u32, u64>,
}

/// Ticks of the clock that one instruction takes: 64 ns at 168 MHz.
const TICKS_PER_INSTRUCTION: f64 = 10.752;

/// Reads both texts. The clock's counts must be the plugin's, pass by pass.
///
/// # Errors
/// A text is not what it should be, or the two disagree.
pub fn combine(counted: &str, clocked: &str) -> Result<Vec<Case>> {
    let mut cases = read_clock(clocked).context("the image's output")?;
    let plugin = read_plugin(counted).context("the plugin's counts")?;
    ensure!(cases.len() == plugin.len(), "the plugin saw {} estimators, the image ran {}", plugin.len(), cases.len());
    // The clock is read an instruction before the region and an instruction behind it, and once more for each read.
    let extra = extra(&cases, &plugin).context("nothing was measured")?;
    for (case, (counts, times)) in cases.iter_mut().zip(plugin) {
        ensure!(case.passes.len() == counts.len(), "{}: {} passes and {}", case.name, counts.len(), case.passes.len());
        for (k, (pass, count)) in case.passes.iter_mut().zip(counts).enumerate() {
            let clock =
                pass.instructions.checked_sub(extra).with_context(|| format!("{}: a pass of nothing", case.name))?;
            ensure!(
                clock == count.instructions,
                "{}, pass {k}: the clock says {clock} instructions, the plugin {}",
                case.name,
                count.instructions
            );
            *pass = Pass { stack: pass.stack, ..count };
        }
        case.times = times;
    }
    Ok(cases)
}

/// What the clock counts beyond the plugin: the same for every pass, so the first one, of nothing at all, tells.
fn extra(cases: &[Case], plugin: &[(Vec<Pass>, BTreeMap<u32, u64>)]) -> Option<u32> {
    let (clock, count) = (cases.first()?.passes.first()?, plugin.first()?.0.first()?);
    clock.instructions.checked_sub(count.instructions)
}

fn read_clock(text: &str) -> Result<Vec<Case>> {
    let mut cases: Vec<Case> = Vec::new();
    for line in text.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let found = || format!("found `{line}`");
        match words.as_slice() {
            ["case", name, window, state, ring] => cases.push(Case {
                name: (*name).to_owned(),
                window: Some(window.parse().with_context(found)?).filter(|window| *window > 0),
                state: state.parse().with_context(found)?,
                ring: ring.parse().with_context(found)?,
                passes: Vec::new(),
                times: BTreeMap::new(),
            }),
            [ticks, _, stack] => {
                let ticks: u32 = ticks.parse().with_context(found)?;
                let instructions = (f64::from(ticks) / TICKS_PER_INSTRUCTION).round() as u32;
                let pass = Pass { instructions, cycles: [0; 2], stack: stack.parse().with_context(found)? };
                cases.last_mut().with_context(found)?.passes.push(pass);
            }
            _ => anyhow::bail!(found()),
        }
    }
    Ok(cases)
}

pub(super) type Counted = (Vec<Pass>, BTreeMap<u32, u64>);

pub(super) fn read_plugin(text: &str) -> Result<Vec<Counted>> {
    let mut cases: Vec<Counted> = Vec::new();
    for line in text.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let found = || format!("found `{line}`");
        match words.as_slice() {
            ["case"] => cases.push(Counted::default()),
            ["pass", instructions, lo, hi] => {
                let number = |word: &str| word.parse().with_context(found);
                let pass = Pass { instructions: number(instructions)?, cycles: [number(lo)?, number(hi)?], stack: 0 };
                cases.last_mut().with_context(found)?.0.push(pass);
            }
            ["at", address, times] => {
                let (address, times) = (address.parse().with_context(found)?, times.parse().with_context(found)?);
                cases.last_mut().with_context(found)?.1.insert(address, times);
            }
            _ => anyhow::bail!(found()),
        }
    }
    Ok(cases)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLOCK: &str = "case nothing 0 0 0\n32 0 8\ncase bls 300 100 3600\n538 0 40\n";

    #[test]
    fn two_counts_that_agree_are_one_and_two_that_differ_are_none() {
        // 32 ticks are 3 instructions, the region 2 of them; 538 are 50.
        let agreed = combine("case\npass 2 2 6\ncase\npass 49 60 70\nat 134217728 1\n", CLOCK).expect("they agree");
        assert_eq!(agreed[1].passes, [Pass { instructions: 49, cycles: [60, 70], stack: 40 }]);
        assert_eq!((agreed[1].window, agreed[1].state, agreed[1].ring), (Some(300), 100, 3600));
        let error = combine("case\npass 2 2 6\ncase\npass 48 60 70\n", CLOCK).expect_err("one instruction is missing");
        assert!(error.to_string().contains("the clock says 49 instructions, the plugin 48"), "{error}");
        assert!(combine("case\npass 2 2 6\ncase\n", CLOCK).is_err(), "a pass is missing");
    }
}
