//! The table, as the README has it.

use anyhow::Result;
use palpate_lab::profile::{Figures, Profile, observations};
use palpate_lab::tools::Leave;

use crate::accuracy;

/// Prints it.
///
/// # Errors
/// A tool is missing, or an image fails.
pub fn print() -> Result<()> {
    let rows = observations()?;
    let ours = Profile::take(Leave::Install)?;
    let rivals = Profile::of(Leave::Install, "palpate-rivals", "rivals")?;
    println!("| update | window | instructions, mean / worst | cycles, modelled | bytes | rms error of K |");
    println!("|---|---|---|---|---|---|");
    let wanted = |f: &&Figures| {
        let windowed = matches!(f.window, Some(50 | 300)) || f.window.is_none();
        windowed && !f.name.starts_with("identify") && !f.name.starts_with("front")
    };
    let compared = ours.figures.iter().filter(wanted).map(|figures| ("palpate", figures));
    for (by, f) in rivals.figures.iter().map(|figures| ("", figures)).chain(compared) {
        let Some(error) = accuracy::of(&f.name, f.window, &rows) else { continue };
        let window = f.window.map_or_else(String::new, |window| window.to_string());
        println!(
            "| {} | {window} | {:.0} / {} | {} to {} | {} | {error:.1e} |",
            [by, f.name.as_str()].join(" ").trim(),
            f.instructions_mean,
            f.instructions_worst,
            f.cycles_lo,
            f.cycles_hi,
            f.state_bytes
        );
    }
    println!("\nCounted twice alike on {} passes. No board was measured.", ours.passes() + rivals.passes());
    Ok(())
}
