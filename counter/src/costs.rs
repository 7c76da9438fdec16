//! What each instruction costs, as the host worked it out from the image.

use std::collections::HashMap;
use std::fs;

/// The cost of one instruction in cycles, and what it has to do with its neighbours.
#[derive(Debug, Clone, Copy, Default)]
pub struct Cost {
    /// Bytes.
    pub size: u64,
    /// Least cycles.
    pub lo: u32,
    /// Most cycles.
    pub hi: u32,
    /// Cycles saved at best where the instruction before reaches memory, too.
    pub paired: u32,
    /// It reaches memory.
    pub memory: bool,
    /// Floating-point registers that it reads, a bit each.
    pub reads: u64,
    /// Floating-point registers that a result comes late to.
    pub writes: u64,
}

/// The cost of every instruction of the image, by its address.
pub struct Costs(HashMap<u64, Cost>);

impl Costs {
    /// Reads a file of lines `ADDRESS SIZE LO HI PAIRED MEMORY READS WRITES`, all decimal.
    pub fn read(path: &str) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
        text.lines()
            .enumerate()
            .map(|(at, line)| parse(line).ok_or(format!("{path}, line {}: `{line}`", at + 1)))
            .collect::<Result<_, _>>()
            .map(Self)
    }

    /// The cost of the instruction at `address`; zero where the host knew none.
    pub fn at(&self, address: u64) -> Cost {
        self.0.get(&address).copied().unwrap_or_default()
    }
}

fn parse(line: &str) -> Option<(u64, Cost)> {
    let numbers: Vec<u64> = line.split(' ').map(|word| word.parse().ok()).collect::<Option<_>>()?;
    let &[address, size, lo, hi, paired, memory, reads, writes] = numbers.as_slice() else { return None };
    let small = |number: u64| u32::try_from(number).ok();
    let (lo, hi, paired) = (small(lo)?, small(hi)?, small(paired)?);
    Some((address, Cost { size, lo, hi, paired, memory: memory != 0, reads, writes }))
}
