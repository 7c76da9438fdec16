//! Table IV: updates per second on the device.

use std::fmt::Write as _;

use anyhow::Result;

use super::paper::RATES;
use crate::profile::{self, Cost};
use crate::tools::Leave;

/// Where the counts are from.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// One sentence for the reader.
    pub words: String,
    /// What each update costs.
    pub costs: Vec<Cost>,
}

/// One line of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Rate {
    /// Method, as the paper writes it.
    pub method: String,
    /// Window.
    pub window: Option<u16>,
    /// Instructions of the mean and of the worst update.
    pub instructions: [f64; 2],
    /// Modelled cycles of the worst update, at least and at most.
    pub cycles: [u32; 2],
    /// Updates per second at 168 MHz of the worst update, at least and at most.
    pub per_second: [f64; 2],
    /// The paper's.
    pub paper: Option<f64>,
}

/// Core clock of the board, Hz.
pub const CLOCK_HZ: f64 = 168e6;

impl Source {
    /// Counts now where `count` is set and the tools are there, else what the sources hold.
    ///
    /// # Errors
    /// The image fails, or its two counts disagree.
    pub fn find(count: bool) -> Result<Self> {
        let kept = profile::kept_costs()?;
        if !count {
            let words = "Counted in QEMU by palpate profile when the code was last changed, and held to that within 2 % by a test \
                         (lab/budget.csv); reproduce --count counts anew.";
            return Ok(Self { words: words.into(), costs: kept });
        }
        match crate::tools::for_the_device(Leave::Look) {
            Ok(_) => {
                let costs =
                    profile::Profile::take(Leave::Look, &|_| ())?.figures.iter().map(profile::Figures::cost).collect();
                Ok(Self { words: "Counted just now in QEMU.".into(), costs })
            }
            Err(missing) => {
                let mut words =
                    String::from("Not counted now, for something is missing here; taken from lab/budget.csv. ");
                // Writing to a string does not fail.
                let _ = write!(words, "{missing}");
                Ok(Self { words, costs: kept })
            }
        }
    }

    /// The cost of an update.
    pub fn cost(&self, update: &str, window: Option<u16>) -> Option<&Cost> {
        self.costs.iter().find(|cost| cost.update == update && cost.window == window)
    }

    /// The paper's methods at windows of 10, 50 and 300.
    pub fn table(&self) -> Vec<Rate> {
        let windows = [Some(10), Some(50), Some(300)];
        let recursive = [("EWRLS", "ewrls", None), ("SPRLS", "sprls", None)];
        let block = [("BLS", "bls"), ("BLMF", "blmf")];
        let block = block.into_iter().flat_map(|(method, update)| windows.map(|window| (method, update, window)));
        let lines = recursive.into_iter().chain(block);
        lines.filter_map(|(method, update, window)| self.rate(method, update, window)).collect()
    }

    fn rate(&self, method: &str, update: &str, window: Option<u16>) -> Option<Rate> {
        let cost = self.cost(update, window)?;
        let paper = RATES.iter().find(|(name, of, _)| *name == method && *of == window).map(|(.., rate)| *rate);
        Some(Rate {
            method: method.into(),
            window,
            instructions: [cost.instructions_mean, f64::from(cost.instructions_worst)],
            cycles: [cost.worst_cycles_lo, cost.worst_cycles_hi],
            per_second: [cost.worst_cycles_hi, cost.worst_cycles_lo].map(|cycles| CLOCK_HZ / f64::from(cycles.max(1))),
            paper,
        })
    }
}
