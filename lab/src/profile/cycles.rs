//! What an instruction costs on a Cortex-M4F, as a band.
//!
//! From ARM's technical reference manual of the Cortex-M4 (ARM DDI 0439, tables 3-1 and 7-1). Where the manual gives a
//! range, or says that an instruction may be folded or pipelined, the band holds both ends. Not in the band: waits of the
//! flash beyond the first (see the cold lines), and of the bus.

use super::image::Instruction;

/// The rules of the cycle model, for the reader.
pub const RULES: [(&str, &str); 10] = [
    ("data processing, VADD, VSUB, VMUL, VCMP, VCVT, VABS, VNEG, VMOV", "1"),
    ("VMLA, VMLS, VFMA, VFMS and their kin", "3"),
    ("VDIV, VSQRT", "14"),
    ("a floating-point result that the next instruction reads", "+1"),
    ("LDR, VLDR of one word", "2; 1 at best behind another access"),
    ("STR, VSTR of one word", "1 (write buffer) to 2"),
    ("LDM, STM, PUSH, POP, VLDM, VSTM, VPUSH, VPOP, LDRD, STRD of n words", "1 + n; n at best behind another access"),
    ("a taken branch, a call, a return", "+1 to +3 (P, the refill of the pipeline)"),
    ("UDIV, SDIV; UMULL, UMLAL and their kin", "2 to 12; 1"),
    ("IT", "0 (folded) to 1"),
];

/// The cost of one instruction by itself, and what it has to do with its neighbours.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Cost {
    /// Least and most cycles.
    pub band: [u32; 2],
    /// Cycles saved at best behind another access to memory.
    pub paired: u32,
    /// It reaches memory.
    pub memory: bool,
    /// Floating-point registers read.
    pub reads: u64,
    /// Floating-point registers that a result comes late to.
    pub writes: u64,
}

/// The cost of `instruction`.
pub fn cost(instruction: &Instruction) -> Cost {
    let name = instruction.mnemonic.split('.').next().unwrap_or_default();
    let words = words(&instruction.operands);
    let (reads, writes) = registers(name, &instruction.operands);
    let plain = |band: [u32; 2]| Cost { band, reads, writes, ..Cost::default() };
    let memory = |band: [u32; 2], paired: u32| Cost { band, paired, memory: true, reads, writes: 0 };
    let starts = |any: &[&str]| any.iter().any(|prefix| name.starts_with(prefix));
    if starts(&["ldm", "stm", "push", "pop", "vldm", "vstm", "vpush", "vpop"]) {
        memory([1 + words; 2], 1)
    } else if starts(&["ldrd", "strd"]) || starts(&["vldr", "vstr"]) && instruction.operands.starts_with('d') {
        memory([3; 2], 1)
    } else if starts(&["ldr", "vldr"]) {
        memory([2; 2], 1)
    } else if starts(&["str", "vstr"]) {
        memory([1, 2], 0)
    } else if starts(&["vdiv", "vsqrt"]) {
        plain([14; 2])
    } else if starts(&["vmla", "vmls", "vfma", "vfms", "vnmla", "vnmls", "vfnma", "vfnms"]) {
        plain([3; 2])
    } else if starts(&["udiv", "sdiv"]) {
        plain([2, 12])
    } else if name.starts_with("it") {
        plain([0, 1])
    } else if name.starts_with("vmov") && core_registers(&instruction.operands) == 2 {
        plain([2; 2])
    } else {
        plain([1; 2])
    }
}

/// How many registers a list names; `d` registers are two words.
fn words(operands: &str) -> u32 {
    let list = operands.split_once('{').and_then(|(_, rest)| rest.split_once('}')).map_or("", |(list, _)| list);
    let each = |name: &str| -> u32 {
        let width = if name.trim().starts_with('d') { 2 } else { 1 };
        match name.split_once('-') {
            Some((first, last)) => number(last).saturating_sub(number(first)).saturating_add(1) * width,
            None => width,
        }
    };
    list.split(',').filter(|name| !name.trim().is_empty()).map(each).sum()
}

fn number(register: &str) -> u32 {
    register.trim().trim_start_matches(|c: char| c.is_alphabetic()).parse().unwrap_or(0)
}

fn core_registers(operands: &str) -> usize {
    operands
        .split(", ")
        .filter(|name| ["r", "lr", "sp", "ip", "sl", "fp", "sb"].iter().any(|core| name.starts_with(core)))
        .count()
}

/// Single-precision registers of `operands`, as bits: read, and written late.
fn registers(name: &str, operands: &str) -> (u64, u64) {
    let bit = |register: &str| -> u64 {
        let register = register.trim();
        if register.starts_with('s') && register[1..].starts_with(|c: char| c.is_ascii_digit()) {
            1 << number(register).min(63)
        } else if register.starts_with('d') {
            0b11 << (2 * number(register)).min(62)
        } else {
            0
        }
    };
    let all: Vec<u64> = operands.trim_matches(['{', '}']).split(", ").map(bit).collect();
    let (first, rest) = all.split_first().map_or((0, 0), |(first, rest)| (*first, rest.iter().fold(0, |a, b| a | b)));
    let arithmetic =
        ["vadd", "vsub", "vmul", "vnmul", "vdiv", "vsqrt", "vmla", "vmls", "vfma", "vfms", "vfnm", "vnml", "vcvt"];
    let accumulates = ["vmla", "vmls", "vfma", "vfms", "vfnm", "vnml"].iter().any(|prefix| name.starts_with(prefix));
    if arithmetic.iter().any(|prefix| name.starts_with(prefix)) {
        (if accumulates { first | rest } else { rest }, first)
    } else if name.starts_with("vcmp") || name.starts_with("vst") || name.starts_with("vpush") {
        (first | rest, 0)
    } else {
        (rest, 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(mnemonic: &str, operands: &str) -> Cost {
        cost(&Instruction { size: 4, mnemonic: mnemonic.into(), operands: operands.into(), target: None })
    }

    #[test]
    fn the_manual_s_own_examples() {
        assert_eq!(of("vadd.f32", "s0, s1, s2").band, [1, 1]);
        assert_eq!(of("vfma.f32", "s0, s1, s2").band, [3, 3]);
        assert_eq!(of("vdiv.f32", "s0, s1, s2").band, [14, 14]);
        assert_eq!(of("ldr", "r0, [r1, #4]").band, [2, 2]);
        assert_eq!(of("push", "{r4, r5, r6, lr}").band, [5, 5]);
        assert_eq!(of("vpush", "{d8, d9}").band, [5, 5]);
        assert_eq!(of("vldmia", "r0, {s0, s1, s2}").band, [4, 4]);
    }

    #[test]
    fn a_result_is_late_for_who_reads_it_and_for_nobody_else() {
        let sum = of("vadd.f32", "s5, s1, s2");
        assert_ne!(sum.writes & of("vmul.f32", "s3, s5, s4").reads, 0);
        assert_eq!(sum.writes & of("vmul.f32", "s5, s3, s4").reads, 0);
        assert_ne!(sum.writes & of("vstr", "s5, [r0]").reads, 0);
        assert_ne!(sum.writes & of("vmla.f32", "s5, s3, s4").reads, 0);
        assert_eq!(of("vldr", "s5, [r0]").writes, 0);
    }
}
