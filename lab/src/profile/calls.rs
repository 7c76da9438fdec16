//! What a function calls, and what that needs: read from the code that the compiler wrote.

use std::collections::{BTreeMap, BTreeSet};

use super::image::{Function, Image, Instruction};

/// The call tree of an image.
pub struct Calls<'a> {
    image: &'a Image,
    /// The functions that each function calls, or goes on in.
    called: BTreeMap<u32, BTreeSet<u32>>,
    /// Functions that call through a register.
    indirect: BTreeSet<u32>,
}

impl<'a> Calls<'a> {
    /// Reads all calls of `image`.
    pub fn of(image: &'a Image) -> Self {
        let mut calls = Self { image, called: BTreeMap::new(), indirect: BTreeSet::new() };
        for (address, instruction) in &image.code {
            let Some(from) = image.function_at(*address) else { continue };
            let to = instruction.target.and_then(|target| image.function_at(target));
            if let Some(to) = to.filter(|to| to.start != from.start) {
                calls.called.entry(from.start).or_default().insert(to.start);
            }
            if is_indirect(instruction) {
                calls.indirect.insert(from.start);
            }
        }
        calls
    }

    /// Every function that can be reached from the one at `start`, itself among them; of a panic its door and no more, for
    /// nothing comes back from there.
    pub fn reached(&self, start: u32) -> Vec<&'a Function> {
        let (mut seen, mut open) = (BTreeSet::from([start]), vec![start]);
        while let Some(at) = open.pop() {
            open.extend(self.calls_of(at).filter(|to| seen.insert(**to)));
        }
        seen.iter().filter_map(|at| self.image.functions.get(at)).collect()
    }

    fn calls_of(&self, start: u32) -> impl Iterator<Item = &u32> {
        let returns = !self.image.functions.get(&start).is_some_and(is_panic);
        self.called.get(&start).into_iter().flatten().filter(move |_| returns)
    }

    /// The functions among those reached from `start` that call what no one can see from here.
    pub fn blind(&self, start: u32) -> Vec<&'a Function> {
        self.reached(start).into_iter().filter(|function| self.indirect.contains(&function.start)).collect()
    }

    /// Bytes of stack of the deepest way from `start`; `None` where a function calls itself. Each function is taken to push
    /// all that it pushes anywhere.
    pub fn stack(&self, start: u32) -> Option<u32> {
        self.deepest(start, &mut Vec::new())
    }

    /// Bytes of stack of all functions that are reached from `start`, one after the other: a bound where the deepest way cannot be
    /// told, because a function calls itself.
    pub fn frames(&self, start: u32) -> u32 {
        self.reached(start).iter().map(|function| self.frame(function.start)).sum()
    }

    fn deepest(&self, start: u32, above: &mut Vec<u32>) -> Option<u32> {
        if above.contains(&start) {
            return None;
        }
        above.push(start);
        let mut below = 0;
        for &to in self.calls_of(start) {
            below = below.max(self.deepest(to, above)?);
        }
        above.pop();
        Some(self.frame(start) + below)
    }

    fn frame(&self, start: u32) -> u32 {
        let Some(function) = self.image.functions.get(&start) else { return 0 };
        self.image.code.range(function.start..function.end).map(|(_, instruction)| pushed(instruction)).sum()
    }
}

/// A call or a jump through a register. A return is none, nor is the jump of a table, which stays in its function.
fn is_indirect(instruction: &Instruction) -> bool {
    let name = instruction.mnemonic.trim_end_matches(".w");
    name == "blx" || name.starts_with("bx") && instruction.operands != "lr"
}

/// Bytes by which an instruction lowers the stack pointer.
fn pushed(instruction: &Instruction) -> u32 {
    let name = instruction.mnemonic.split('.').next().unwrap_or_default();
    let operands = &instruction.operands;
    let registers = || operands.split(',').count() as u32;
    let number = |text: &str| -> u32 {
        let text = text.trim().trim_start_matches('#');
        text.strip_prefix("0x").map_or_else(|| text.parse().ok(), |hex| u32::from_str_radix(hex, 16).ok()).unwrap_or(0)
    };
    match name {
        "push" => 4 * registers(),
        "vpush" => registers() * if operands.contains('d') { 8 } else { 4 },
        "sub" | "subw" if operands.starts_with("sp, ") => operands.rsplit(',').next().map_or(0, number),
        "str" if operands.ends_with("]!") && operands.contains("[sp, #-") => {
            operands.rsplit("#-").next().map_or(0, |rest| number(rest.trim_end_matches("]!")))
        }
        _ => 0,
    }
}

/// Names that only a panic has.
const PANICS: [&str; 6] = ["panick", "panic_", "unwrap_failed", "expect_failed", "slice_index_fail", "begin_unwind"];

/// Whether a function belongs to a panic.
pub fn is_panic(function: &Function) -> bool {
    PANICS.iter().any(|word| function.name.contains(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(mnemonic: &str, operands: &str) -> Instruction {
        Instruction { size: 2, mnemonic: mnemonic.into(), operands: operands.into(), target: None }
    }

    #[test]
    fn what_lowers_the_stack_pointer_and_what_does_not() {
        for (mnemonic, operands, bytes) in [
            ("push.w", "{r4, r5, lr}", 12),
            ("vpush", "{d8, d9}", 16),
            ("sub", "sp, #0x30", 48),
            ("sub.w", "sp, sp, #0x408", 1032),
            ("str", "lr, [sp, #-4]!", 4),
            ("str", "r0, [sp, #4]", 0),
            ("sub", "r0, #0x30", 0),
        ] {
            assert_eq!(pushed(&of(mnemonic, operands)), bytes, "{mnemonic} {operands}");
        }
        assert!(is_indirect(&of("blx", "r4")) && is_indirect(&of("bx", "r3")) && !is_indirect(&of("bx", "lr")));
    }
}
