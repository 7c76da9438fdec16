//! What a person sees.

use std::fmt::Write as _;
use std::io::IsTerminal as _;

use indicatif::{ProgressBar, ProgressStyle};
use palpate::Flags;
use palpate_drive::link::{CountersMessage, EstimateMessage};
use palpate_drive::{Calibration, Faults, TICK_HZ, Validity};

use super::DriveInfo;

/// One line that is written over on a terminal, and a line an estimate elsewhere.
pub struct Screen {
    line: ProgressBar,
    terminal: bool,
}

impl Screen {
    /// An empty one.
    #[must_use]
    pub fn new() -> Self {
        let line = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{wide_msg}") {
            line.set_style(style);
        }
        Self { line, terminal: std::io::stderr().is_terminal() }
    }

    /// Shows an estimate.
    pub fn show(&self, message: &EstimateMessage, _: &Calibration) {
        let text = estimate(message);
        if self.terminal {
            self.line.set_message(text);
            self.line.tick();
        } else {
            println!("{text}");
        }
    }

    /// Leaves the terminal as it was.
    pub fn clear(&self) {
        self.line.finish_and_clear();
    }
}

impl Default for Screen {
    fn default() -> Self {
        Self::new()
    }
}

/// An estimate in a line.
#[must_use]
pub fn estimate(message: &EstimateMessage) -> String {
    let seconds = f64::from(message.tick) / f64::from(TICK_HZ);
    let (k, b) = (message.impedance, message.half_width);
    let what = match message.validity {
        Validity::Void => "no estimate".to_owned(),
        _ if message.flags & Flags::NO_CONTACT.bits() != 0 => "no contact".to_owned(),
        _ if !b.stiffness.is_finite() => "in contact, nothing known yet".to_owned(),
        _ => format!("K {} N/m, B {} N s/m", interval(k.stiffness, b.stiffness), interval(k.damping, b.damping)),
    };
    let held = if message.validity == Validity::Held { ", held" } else { "" };
    let faults = message.faults();
    let faults = if faults.is_empty() { String::new() } else { format!("  FAULT {}", names(faults)) };
    format!("{seconds:9.2} s  {what}{held}{faults}")
}

fn interval(value: f32, half_width: f32) -> String {
    crate::replay::interval(value.into(), half_width.into())
}

/// Faults by name.
#[must_use]
pub fn names(faults: Faults) -> String {
    faults.iter_names().map(|(name, _)| name.to_lowercase().replace('_', " ")).collect::<Vec<_>>().join(", ")
}

/// What a drive is, in a few lines.
#[must_use]
pub fn identity(about: &DriveInfo) -> String {
    let [a, b, c] = about.chip;
    let place = if about.emulator { "QEMU".to_owned() } else { format!("chip {a:08x}{b:08x}{c:08x}") };
    let reasons = ["", "brown-out", "pin", "power-on", "software", "watchdog", "window watchdog", "low power"];
    let reset: Vec<_> = (1..8).filter(|bit| about.reset >> bit & 1 != 0).map(|bit| reasons[bit]).collect();
    let reset = if reset.is_empty() { "unknown".to_owned() } else { reset.join(", ") };
    let found = if about.found.is_empty() { "nothing".to_owned() } else { names(about.found) };
    let (calibration, settings) = (&about.calibration, &about.settings);
    format!(
        "drive {} on {place}, image {:08x}; last reset: {reset}; found at its start: {found}\n\
         calibration of {}: {:.3e} m and {:.3e} N a count; {}, window {} samples, cut-off {} Hz",
        about.version,
        about.image,
        calibration.date,
        about.scale.position,
        about.scale.force,
        settings.method.name(),
        settings.window,
        settings.cutoff
    )
}

/// The counters as a table.
#[must_use]
pub fn counters(count: &CountersMessage) -> String {
    let mut text = String::new();
    let [ticks, used, restarts, tares] = count.others;
    let [least, most] = count.latency;
    let link_counters = count.link_counters;
    let mut row = |name: &str, value: u32| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name:<28}{value:>12}");
    };
    for (name, value) in [
        ("ticks", ticks),
        ("samples used", used),
        ("estimator begun anew", restarts),
        ("tares refused", tares),
        ("reports dropped", count.dropped),
        ("bytes lost on the way in", count.rx_overruns),
        ("ticks without a fed input", count.starved),
        ("least latency, cycles", least),
        ("most latency, cycles", most),
        ("longest interrupt, cycles", count.longest),
        ("frames heard", link_counters.frames),
        ("frames oversized", link_counters.oversized),
        ("frames malformed", link_counters.malformed),
        ("frames of a wrong CRC", link_counters.checksum),
        ("frames of another version", link_counters.version),
        ("requests refused", link_counters.refused),
    ] {
        row(name, value);
    }
    for (bit, value) in count.faults.into_iter().enumerate() {
        row(&names(Faults::from_bits_retain(1 << bit)), value);
    }
    text
}
