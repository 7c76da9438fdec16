//! The counts of one run.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::ops::Range;
use std::path::PathBuf;

use crate::costs::{Cost, Costs};

/// Cycles that a taken branch waits for the pipeline at least and at most (ARM DDI 0439, table 3-1: P is 1 to 3).
const PIPELINE_REFILL_CYCLES: [u32; 2] = [1, 3];

/// One pass through the region.
#[derive(Debug, Clone, Copy, Default)]
struct Pass {
    instructions: u32,
    lo: u32,
    hi: u32,
}

/// One estimator.
#[derive(Default)]
struct Case {
    passes: Vec<Pass>,
    times: BTreeMap<u64, u64>,
}

/// All counts, and where in the image it is.
pub struct Counts {
    begin: u64,
    end: u64,
    case: u64,
    excluded: Range<u64>,
    costs: Costs,
    out: PathBuf,
    cases: Vec<Case>,
    present: Option<Pass>,
    before: Option<(u64, Cost)>,
}

impl Counts {
    /// Nothing counted yet. Instructions in `excluded` are never counted.
    pub fn new(region: Range<u64>, case: u64, excluded: Range<u64>, costs: Costs, out: PathBuf) -> Self {
        let Range { start: begin, end } = region;
        Self { begin, end, case, excluded, costs, out, cases: Vec::new(), present: None, before: None }
    }

    /// The instruction at `address` is about to be executed.
    pub fn execute(&mut self, address: u64) {
        if self.excluded.contains(&address) {
            return;
        }
        if address == self.case {
            self.cases.push(Case::default());
        } else if address == self.begin {
            (self.present, self.before) = (Some(Pass::default()), None);
        } else if address == self.end {
            self.branch(address);
            if let (Some(pass), Some(case)) = (self.present.take(), self.cases.last_mut()) {
                case.passes.push(pass);
            }
        }
        if self.present.is_some() {
            self.count(address);
        }
    }

    /// What the way to `address` cost beyond the instruction before.
    fn branch(&mut self, address: u64) {
        if let (Some(pass), Some((from, cost))) = (self.present.as_mut(), self.before)
            && address != from + cost.size
        {
            pass.lo += PIPELINE_REFILL_CYCLES[0];
            pass.hi += PIPELINE_REFILL_CYCLES[1];
        }
    }

    fn count(&mut self, address: u64) {
        self.branch(address);
        let cost = self.costs.at(address);
        if let (Some(pass), Some(case)) = (self.present.as_mut(), self.cases.last_mut()) {
            pass.instructions += 1;
            pass.lo += cost.lo;
            pass.hi += cost.hi;
            if let Some((_, before)) = self.before {
                // A result of the floating-point unit is a cycle late for the instruction behind it.
                let late = u32::from(before.writes & cost.reads != 0);
                pass.lo += late;
                pass.hi += late;
                if before.memory {
                    pass.lo -= cost.paired.min(cost.lo);
                }
            }
            *case.times.entry(address).or_default() += 1;
        }
        self.before = Some((address, cost));
    }

    /// Writes all counts to the file.
    pub fn write(&self) -> io::Result<()> {
        let mut out = BufWriter::new(File::create(&self.out)?);
        for case in &self.cases {
            writeln!(out, "case")?;
            for pass in &case.passes {
                writeln!(out, "pass {} {} {}", pass.instructions, pass.lo, pass.hi)?;
            }
            for (address, times) in &case.times {
                writeln!(out, "at {address} {times}")?;
            }
        }
        out.flush()
    }
}
