//! An image as it stands in its file: symbols, code, and what each instruction is, as `llvm-objdump` has it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use object::{Object as _, ObjectSection as _, ObjectSymbol as _, SectionKind, SymbolKind};

use crate::tools::{self, Leave, MissingTools};

/// One instruction.
#[derive(Debug, Clone)]
pub struct Instruction {
    /// Bytes.
    pub size: u32,
    /// Mnemonic, with its condition and type.
    pub mnemonic: String,
    /// Operands.
    pub operands: String,
    /// Where it branches or calls to, as far as it says so itself.
    pub target: Option<u32>,
}

/// A function: its name, made readable, and where it stands.
#[derive(Debug, Clone)]
pub struct Function {
    /// Name.
    pub name: String,
    /// First address.
    pub start: u32,
    /// First address behind it.
    pub end: u32,
}

/// An image.
pub struct Image {
    /// The file.
    pub path: PathBuf,
    /// Every instruction by its address.
    pub code: BTreeMap<u32, Instruction>,
    /// Every function by its address.
    pub functions: BTreeMap<u32, Function>,
    labels: BTreeMap<String, u32>,
}

impl Image {
    /// Reads the image.
    ///
    /// # Errors
    /// It is no ELF file of this machine.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        let file = object::File::parse(bytes.as_slice()).with_context(|| format!("{} is no image", path.display()))?;
        let mut image =
            Self { path: path.to_owned(), code: BTreeMap::new(), functions: BTreeMap::new(), labels: BTreeMap::new() };
        image.name(&file);
        let text: Vec<(u32, &[u8])> = file
            .sections()
            .filter(|section| section.kind() == SectionKind::Text)
            .map(|section| Ok((u32::try_from(section.address())?, section.data()?)))
            .collect::<Result<_>>()?;
        image.code = disassembled(path, &text)?;
        Ok(image)
    }

    /// Takes the symbols; the lowest bit of a function's address only says that it is Thumb.
    fn name(&mut self, file: &object::File<'_>) {
        for symbol in file.symbols() {
            let (Ok(name), Ok(address)) = (symbol.name(), u32::try_from(symbol.address())) else { continue };
            let start = address & !1;
            if symbol.is_definition() && !name.starts_with('$') {
                self.labels.insert(name.to_owned(), start);
            }
            if symbol.kind() == SymbolKind::Text && symbol.size() > 0 {
                let end = start + u32::try_from(symbol.size()).unwrap_or(0);
                self.functions.insert(start, Function { name: readable(name), start, end });
            }
        }
        // A function of assembly has no size: it ends where the next one begins.
        for name in ["palpate_pass", "palpate_case"] {
            let Some(&start) = self.labels.get(name) else { continue };
            let next = self.labels.values().chain(self.functions.keys()).filter(|&&at| at > start + 2);
            let inner = ["palpate_begin", "palpate_end"].map(|label| self.labels.get(label).copied());
            let end = next.filter(|at| !inner.contains(&Some(**at))).min().copied().unwrap_or(start + 2);
            self.functions.entry(start).or_insert(Function { name: name.to_owned(), start, end });
        }
    }

    /// The address of a label.
    ///
    /// # Errors
    /// The image has none of that name.
    pub fn label(&self, name: &str) -> Result<u32> {
        self.labels.get(name).copied().with_context(|| format!("the image has no `{name}`"))
    }

    /// The function that `address` is in.
    pub fn function_at(&self, address: u32) -> Option<&Function> {
        self.functions.range(..=address).next_back().map(|(_, function)| function).filter(|f| address < f.end)
    }
}

/// Every instruction of the file by its address, `text` being its sections of code, each with its own. Constants among the
/// code are marked as such by the file's symbols, and left out.
fn disassembled(path: &Path, text: &[(u32, &[u8])]) -> Result<BTreeMap<u32, Instruction>> {
    let disassembler = tools::disassembler(Leave::Look).map_err(|missing| MissingTools(vec![missing]))?;
    let output = Command::new(&disassembler)
        .args(["--disassemble", "--no-show-raw-insn"])
        .arg(path)
        .output()
        .with_context(|| format!("cannot run {}", disassembler.display()))?;
    let errors = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "{} failed: {}", disassembler.display(), errors.trim());
    let listing = String::from_utf8(output.stdout).context("the disassembly is not UTF-8")?;
    let sized = |(at, found): (u32, Instruction)| Some((at, Instruction { size: size(text, at)?, ..found }));
    let code: BTreeMap<u32, Instruction> = listing.lines().filter_map(instruction).filter_map(sized).collect();
    ensure!(!code.is_empty(), "{} found no code in {}", disassembler.display(), path.display());
    Ok(code)
}

/// Bytes of the instruction at `address`: four where its first halfword begins with 11101, 11110 or 11111 (ARMv7-M,
/// A5.1), else two. `None` out of the code.
fn size(text: &[(u32, &[u8])], address: u32) -> Option<u32> {
    text.iter().find_map(|(start, bytes)| {
        let upper = bytes.get(address.checked_sub(*start)? as usize + 1)?;
        Some(if upper >> 3 >= 0b11101 { 4 } else { 2 })
    })
}

/// One line of the listing, ` ADDRESS:  <tab>MNEMONIC<tab>OPERANDS  @ comment`; it does not say the instruction's size.
fn instruction(line: &str) -> Option<(u32, Instruction)> {
    let (address, rest) = line.split_once(':')?;
    let address = u32::from_str_radix(address.trim(), 16).ok()?;
    let text = rest.split('@').next()?.trim();
    let (mnemonic, operands) = text.split_once('\t').unwrap_or((text, ""));
    let operands = operands.trim();
    // Constants: `.word` and its kin, behind their bytes or alone, and what is no instruction of this processor.
    let is_name = mnemonic.starts_with(|c: char| c.is_ascii_lowercase())
        && mnemonic.chars().all(|c| c.is_ascii_alphanumeric() || c == '.');
    if !is_name || operands.starts_with('.') {
        return None;
    }
    let branches = mnemonic.starts_with('b') && !mnemonic.starts_with("bic") && !mnemonic.starts_with("bf")
        || mnemonic.starts_with("cb");
    let last = operands.rsplit(", ").next().and_then(|last| last.split_whitespace().next()).unwrap_or_default();
    let target = last.strip_prefix("0x").filter(|_| branches).and_then(|hex| u32::from_str_radix(hex, 16).ok());
    Some((address, Instruction { size: 0, mnemonic: mnemonic.to_owned(), operands: operands.to_owned(), target }))
}

/// A Rust name without its hash and without the marks of its crates.
fn readable(name: &str) -> String {
    format!("{:#}", rustc_demangle::demangle(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instruction_is_as_long_as_its_first_halfword_says() {
        // movs r0, #0; bl; udf; ldrd: little-endian halfwords.
        let text: [(u32, &[u8]); 1] =
            [(0x100, &[0x00, 0x20, 0x12, 0xf0, 0xff, 0xfb, 0x00, 0xde, 0xd0, 0xe9, 0x00, 0x12])];
        assert_eq!(
            [0x100, 0x102, 0x106, 0x108, 0xfe, 0x10c].map(|at| size(&text, at)),
            [Some(2), Some(4), Some(2), Some(4), None, None]
        );
    }

    #[test]
    fn a_line_of_the_listing_is_an_instruction_a_constant_or_a_heading() {
        let read = |line: &str| instruction(line).map(|(at, i)| (at, i.mnemonic, i.operands, i.target));
        let of =
            |at, mnemonic: &str, operands: &str, target| Some((at, mnemonic.to_owned(), operands.to_owned(), target));
        assert_eq!(
            read(" 8000188:      \tbl\t0x801298a <__pre_init>  @ imm = #75774"),
            of(0x0800_0188, "bl", "0x801298a <__pre_init>", Some(0x0801_298a))
        );
        assert_eq!(
            read(" 80001f8:\tcbz\tr0, 0x8000212 <f+0x4> @ imm = #2"),
            of(0x0800_01f8, "cbz", "r0, 0x8000212 <f+0x4>", Some(0x0800_0212))
        );
        assert_eq!(read(" 800018c: \tldr\tr0, [pc, #56]  @ 0x80001c8"), of(0x0800_018c, "ldr", "r0, [pc, #56]", None));
        assert_eq!(read(" 80001c8:\tb4 c0 01 08\t.word\t0x0801c0b4"), None);
        assert_eq!(read(" 80001c8:\tb4\t.byte\t0xb4"), None);
        assert_eq!(read(" 80001c8:\t.word\t0x0801c0b4"), None);
        assert_eq!(read(" 80001c8:\t<unknown>"), None);
        assert_eq!(read("080001e0 <palpate_pass>:"), None);
    }
}
