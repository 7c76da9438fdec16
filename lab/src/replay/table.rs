//! The figures on standard output.

use std::io::Write as _;

use anyhow::Result;

use super::Replayed;
use crate::rig::Rig;
use crate::terminal::printable;

/// One line a trial and method.
pub fn print(rig: &Rig, replayed: &[Replayed]) -> Result<()> {
    let mut out = std::io::stdout().lock();
    let (k, b) = (rig.coordinate.stiffness_unit(), rig.coordinate.damping_unit());
    writeln!(
        out,
        "{:<28} {:<12} {:>24} {:>24} {:>8}",
        "trial",
        "method",
        format!("K [{k}]"),
        format!("B [{b}]"),
        "RMSE %"
    )?;
    for r in replayed {
        for (method, summary) in &r.summaries {
            let name = format!("{:<28} {:<12}", printable(&r.name), method.name());
            match summary {
                None => writeln!(out, "{name} never known: no contact, or no movement in it")?,
                Some(s) => {
                    let k = interval(s.stiffness, s.stiffness_half_width);
                    let b = interval(s.damping, s.damping_half_width);
                    writeln!(out, "{name} {k:>24} {b:>24} {:>8.2}", s.rmse_percent)?;
                }
            }
        }
    }
    Ok(())
}

/// A value with the half-width of its interval.
#[must_use]
pub fn interval(value: f64, half_width: f64) -> String {
    format!("{:.4} ± {:.2}", Short(value), Short(half_width))
}

/// A number in as many significant digits as the precision asks for, with an exponent where it is very small or large.
struct Short(f64);

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = f.precision().unwrap_or(4).max(1);
        let magnitude = if self.0 == 0.0 { 0 } else { self.0.abs().log10().floor() as i32 };
        if !self.0.is_finite() || !(-3..6).contains(&magnitude) {
            return write!(f, "{:.*e}", digits - 1, self.0);
        }
        let decimals = usize::try_from(digits as i32 - 1 - magnitude).unwrap_or(0);
        write!(f, "{:.*}", decimals, self.0)
    }
}
