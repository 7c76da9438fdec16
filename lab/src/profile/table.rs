//! The figures as a table to read.

use std::fmt::Write as _;

use super::cycles::RULES;
use super::figures::Figures;

/// What stands before every figure.
pub const NO_BOARD: &str =
    "No board was measured: instructions are counted in QEMU, cycles are modelled from its trace.";

/// The table, and what its figures are.
pub fn text(all: &[Figures], passes: usize) -> String {
    let mut text = format!(
        "{NO_BOARD}\nTwo counts, by a plugin of QEMU and by its clock, agree on all {passes} passes.\n\n\
         {:<18}{:>7}{:>9}{:>8}{:>8}{:>13}{:>13}{:>7}{:>7}{:>11}{:>8}{:>9}{:>11}\n",
        "update",
        "window",
        "instr",
        "worst",
        "sample",
        "cycles",
        "worst",
        "lines",
        "cold",
        "stack",
        "state",
        "% of ms",
        "updates/s"
    );
    for f in all {
        let window = f.window.map_or_else(|| "-".to_owned(), |window| window.to_string());
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "{:<18}{window:>7}{:>9.1}{:>8}{:>8}{:>13}{:>13}{:>7}{:>7}{:>11}{:>8}{:>9.2}{:>11.0}",
            f.name,
            f.instructions_mean,
            f.instructions_worst,
            f.worst_sample,
            format!("{}-{}", f.cycles_lo, f.cycles_hi),
            format!("{}-{}", f.worst_cycles_lo, f.worst_cycles_hi),
            f.flash_lines,
            f.cold_cycles,
            format!("{}/{}", f.stack_painted_bytes, f.stack_bytes),
            f.state_bytes,
            f.share_of_1ms_percent,
            f.updates_per_s
        );
    }
    text.push_str(
        "\ninstr: instructions of an update on the mean, and of the worst, at that sample of the recording; cycles: the band of \
         the mean and of the worst; lines: 16-byte lines of flash that the code fills, cold: the cycles that they add at 5 wait \
         states where none is at hand; stack: bytes seen in use / along the deepest call; state: bytes with the window's \
         samples; % of ms, updates/s: of the worst at most, at 168 MHz.\n\ncycles of a Cortex-M4F (ARM DDI 0439, tables 3-1 and 7-1):\n",
    );
    for (what, cycles) in RULES {
        let _ = writeln!(text, "  {what}: {cycles}");
    }
    text
}
