//! A plugin of QEMU (interface version 1) that counts every instruction between two addresses of the image.
//!
//! Arguments: `begin` and `end`, the addresses of the region's first instruction and of the first behind it; `case`, an address
//! that is passed where another estimator begins; `excluded_begin` and `excluded_end`, the addresses of a function that may interrupt
//! the region and is not counted, where there is one; `costs`, a file of what each instruction costs; `out`, where
//! the counts go. For each pass through the region the plugin writes `pass INSTRUCTIONS LO HI`, for each estimator
//! `case`, and behind it `at ADDRESS TIMES` for each instruction that was executed.

mod costs;
mod counts;
mod qemu;

use std::ffi::{CStr, c_char, c_int, c_uint, c_void};
use std::path::PathBuf;
use std::sync::Mutex;

use costs::Costs;
use counts::Counts;

static COUNTS: Mutex<Option<Counts>> = Mutex::new(None);

/// The interface version that QEMU asks for.
// SAFETY: the name is that of QEMU's plugin interface, and nobody else in this library has it.
#[unsafe(no_mangle)]
pub static qemu_plugin_version: c_int = 1;

/// Called by QEMU when it loads the plugin; not zero where the arguments are no good.
///
/// # Safety
/// `argv` holds `argc` strings that end in zero, as QEMU passes them.
// SAFETY: the name is that of QEMU's plugin interface, and nobody else in this library has it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qemu_plugin_install(
    id: u64,
    _info: *const c_void,
    argc: c_int,
    argv: *const *const c_char,
) -> c_int {
    let count = usize::try_from(argc).unwrap_or(0);
    // SAFETY: QEMU passes `argc` pointers to strings that end in zero and live until this returns.
    let arguments = (0..count).map(|at| unsafe { CStr::from_ptr(*argv.add(at)) }.to_string_lossy().into_owned());
    match prepare(&arguments.collect::<Vec<_>>()) {
        Ok(counts) => {
            install(counts);
            // SAFETY: both functions have the signatures of the interface and live as long as the library.
            unsafe {
                qemu::qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
                qemu::qemu_plugin_register_atexit_cb(id, at_exit, std::ptr::null_mut());
            }
            0
        }
        Err(fault) => {
            eprintln!("counter: {fault}");
            1
        }
    }
}

fn install(counts: Counts) {
    if let Ok(mut place) = COUNTS.lock() {
        *place = Some(counts);
    }
}

fn prepare(arguments: &[String]) -> Result<Counts, String> {
    let value = |name: &str| {
        let found = arguments.iter().find_map(|argument| argument.strip_prefix(name)?.strip_prefix('='));
        found.ok_or_else(|| format!("the argument {name}=... is missing"))
    };
    let address = |name: &str| {
        let text = value(name)?;
        text.parse::<u64>().map_err(|_| format!("{name}={text}: expected an address in decimal"))
    };
    let costs = Costs::read(value("costs")?)?;
    let excluded = match value("excluded_begin") {
        Ok(_) => address("excluded_begin")?..address("excluded_end")?,
        Err(_) => 0..0,
    };
    let region = address("begin")?..address("end")?;
    Ok(Counts::new(region, address("case")?, excluded, costs, PathBuf::from(value("out")?)))
}

/// A block was translated: every instruction of it gets a callback at its execution. By address alone, for QEMU 7.2 gives
/// a wrong size to an instruction just before a page's end.
extern "C" fn translated(_id: u64, block: *mut qemu::Block) {
    // SAFETY: QEMU hands over a block that is valid during this call, and indices are below its count.
    unsafe {
        for at in 0..qemu::qemu_plugin_tb_n_insns(block) {
            let instruction = qemu::qemu_plugin_tb_get_insn(block, at);
            let address = qemu::qemu_plugin_insn_vaddr(instruction);
            let user_data = address as usize as *mut c_void;
            qemu::qemu_plugin_register_vcpu_insn_exec_cb(instruction, executed, qemu::NO_REGISTERS, user_data);
        }
    }
}

extern "C" fn executed(_core: c_uint, address: *mut c_void) {
    if let Ok(mut place) = COUNTS.lock()
        && let Some(counts) = place.as_mut()
    {
        counts.execute(address as usize as u64);
    }
}

extern "C" fn at_exit(_id: u64, _: *mut c_void) {
    if let Ok(mut place) = COUNTS.lock()
        && let Some(counts) = place.take()
        && let Err(fault) = counts.write()
    {
        eprintln!("counter: cannot write the counts: {fault}");
    }
}
