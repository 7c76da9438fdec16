//! The part of QEMU's plugin interface that is used, declared by hand (`qemu-plugin.h` of QEMU 7.2, version 1).

use std::ffi::{c_int, c_uint, c_void};

/// A translated block; QEMU alone knows what is in it.
#[repr(C)]
pub struct Block {
    _opaque: [u8; 0],
}

/// An instruction of a block.
#[repr(C)]
pub struct Instruction {
    _opaque: [u8; 0],
}

/// The callback reads no registers.
pub const NO_REGISTERS: c_int = 0;

// SAFETY: names and signatures are those of the interface, which QEMU exports to its plugins.
unsafe extern "C" {
    pub fn qemu_plugin_register_vcpu_tb_trans_cb(id: u64, callback: extern "C" fn(u64, *mut Block));
    pub fn qemu_plugin_register_atexit_cb(id: u64, callback: extern "C" fn(u64, *mut c_void), user_data: *mut c_void);
    pub fn qemu_plugin_tb_n_insns(block: *const Block) -> usize;
    pub fn qemu_plugin_tb_get_insn(block: *const Block, at: usize) -> *mut Instruction;
    pub fn qemu_plugin_insn_vaddr(instruction: *const Instruction) -> u64;
    pub fn qemu_plugin_register_vcpu_insn_exec_cb(
        instruction: *mut Instruction,
        callback: extern "C" fn(c_uint, *mut c_void),
        flags: c_int,
        user_data: *mut c_void,
    );
}
