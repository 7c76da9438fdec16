//! What the interrupt of the drive costs, and that it cannot panic.

use palpate_lab::profile::{drive_image, interrupt_costs, panics_reached_from};

use palpate_lab::tools::{self, Leave, MissingTools};

use super::rig;

/// Whether image, emulator and disassembler are there; else a word, and an end where they are required.
fn ready() -> bool {
    match tools::for_profiling(Leave::Look) {
        Ok(_) => rig::image().is_some(),
        Err(MissingTools(missing)) => {
            assert!(std::env::var_os("PALPATE_DEVICE").is_none(), "{missing:?}");
            eprintln!("left out: {missing:?}");
            false
        }
    }
}

#[test]
fn no_panic_can_be_reached_from_either_interrupt_of_the_drive() {
    if !ready() {
        return;
    }
    let image = drive_image().unwrap_or_else(|error| panic!("{error:#}"));
    for interrupt in ["SysTick", "USART1"] {
        let reached = panics_reached_from(&image, interrupt).unwrap_or_else(|error| panic!("{error:#}"));
        assert_eq!(reached, Vec::<String>::new(), "{interrupt} can come to these");
    }
    let idle = panics_reached_from(&image, "main").unwrap_or_else(|error| panic!("{error:#}"));
    assert!(!idle.is_empty(), "no panic is seen anywhere in the image");
}

/// Instructions of a tick at most, whatever it is fed and whatever is asked of it: a twentieth of the 125 000 that QEMU is given
/// for a millisecond, which leaves the rest to a current loop.
const MAX_INSTRUCTIONS: u32 = 6_000;

/// Instructions of the median tick that takes a sample, from its words to a report with estimate, intervals and flags.
const MAX_LIVE_INSTRUCTIONS: u32 = 1_300;

#[test]
fn the_longest_tick_is_counted_and_leaves_room_for_a_current_loop() {
    if !ready() {
        return;
    }
    for cost in interrupt_costs().unwrap_or_else(|error| panic!("{error:#}")) {
        eprintln!("{cost:?}");
        assert!(cost.ticks > 2_000 && cost.most < MAX_INSTRUCTIONS, "{cost:?}");
        if !cost.what.contains("faults") {
            assert!(cost.median_live.is_none_or(|median| median < MAX_LIVE_INSTRUCTIONS), "{cost:?}");
        }
    }
}

/// An exception's frame with the floating-point registers, ARMv7-M B1.5.7.
const FRAME: u32 = 104;
/// Bytes of memory.
const MEMORY: u64 = 128 * 1024;

#[test]
fn data_and_the_deepest_stack_of_all_that_may_interrupt_each_other_fit_the_memory() {
    use object::{Object as _, ObjectSection as _};
    if !ready() {
        return;
    }
    let image = drive_image().unwrap_or_else(|error| panic!("{error:#}"));
    let bytes = std::fs::read(&image).expect("an image");
    let file = object::File::parse(bytes.as_slice()).expect("an image");
    let size = |wanted: &[&str]| -> u64 {
        let found = file.sections().filter(|section| section.name().is_ok_and(|name| wanted.contains(&name)));
        found.map(|section| section.size()).sum()
    };
    let flash = size(&[".vector_table", ".text", ".rodata", ".data"]);
    let data = size(&[".data", ".bss", ".uninit"]);
    let [main, tick, line] = ["main", "SysTick", "USART1"]
        .map(|entry| palpate_lab::profile::stack_from(&image, entry).unwrap_or_else(|error| panic!("{error:#}")));
    eprintln!("flash {flash}, data {data}, stack of main {main}, of the tick {tick}, of the line {line}");
    let stack = u64::from(main + tick + line + 2 * FRAME);
    assert!(data + stack < MEMORY, "{data} bytes of data and {stack} of stack");
    assert!(flash < 896 * 1024, "{flash} bytes of flash");
}
