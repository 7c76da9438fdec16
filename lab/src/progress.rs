//! How far a long command is, on standard error: in place on a terminal, a line a step where it goes to a file.

use std::io::IsTerminal as _;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use crate::page::effect_name::effect_name;

/// The steps of a command.
pub struct Steps {
    bar: Option<ProgressBar>,
    command: &'static str,
}

impl Steps {
    /// Of `palpate COMMAND`.
    #[must_use]
    pub fn new(command: &'static str) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new_spinner();
            if let Ok(style) = ProgressStyle::with_template("{spinner} {elapsed} {msg}") {
                bar.set_style(style);
            }
            bar.enable_steady_tick(Duration::from_millis(120));
            bar
        });
        Self { bar, command }
    }

    /// Says which step begins; keys of effects become words.
    pub fn say(&self, step: &str) {
        let step = effect_name(step);
        match &self.bar {
            Some(bar) => bar.set_message(step),
            None => eprintln!("{}: {step}", self.command),
        }
    }
}

impl Drop for Steps {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
