//! An image as it stands in its file: symbols, code, and what each instruction is.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use capstone::arch::BuildsCapstone as _;
use capstone::prelude::*;
use object::{Object as _, ObjectSection as _, ObjectSymbol as _, SectionKind, SymbolKind};

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
        for section in file.sections().filter(|section| section.kind() == SectionKind::Text) {
            image.disassemble(section.data()?, u32::try_from(section.address())?)?;
        }
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

    fn disassemble(&mut self, code: &[u8], start: u32) -> Result<()> {
        let decoder = Capstone::new()
            .arm()
            .mode(arch::arm::ArchMode::Thumb)
            .extra_mode([arch::arm::ArchExtraMode::MClass].into_iter())
            .build();
        let decoder = decoder.map_err(|error| anyhow::anyhow!("no disassembler: {error}"))?;
        let functions: Vec<Function> = self.functions.values().cloned().collect();
        for function in functions {
            let (Some(from), Some(to)) = (function.start.checked_sub(start), function.end.checked_sub(start)) else {
                continue;
            };
            let mut at = from as usize;
            while let Some(rest) = code.get(at..to as usize).filter(|rest| rest.len() >= 2) {
                let address = start + u32::try_from(at)?;
                let found = decoder.disasm_count(rest, address.into(), 1).ok();
                let Some(found) = found.as_ref().and_then(|all| all.first()) else {
                    // A word among the code.
                    at += 2;
                    continue;
                };
                at += found.len();
                self.code.insert(address, instruction(found));
            }
        }
        Ok(())
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

fn instruction(found: &capstone::Insn<'_>) -> Instruction {
    let mnemonic = found.mnemonic().unwrap_or_default().to_owned();
    let operands = found.op_str().unwrap_or_default().to_owned();
    let last = operands.rsplit(", ").next().unwrap_or_default();
    let branches = mnemonic.starts_with('b') && !mnemonic.starts_with("bic") && !mnemonic.starts_with("bf")
        || mnemonic.starts_with("cb");
    let target = last.strip_prefix("#0x").filter(|_| branches).and_then(|hex| u32::from_str_radix(hex, 16).ok());
    Instruction { size: u32::try_from(found.len()).unwrap_or(2), mnemonic, operands, target }
}

/// A Rust name without its hash and without the marks of its crates.
fn readable(name: &str) -> String {
    format!("{:#}", rustc_demangle::demangle(name))
}
