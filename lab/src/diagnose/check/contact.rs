//! Whether the tool touched, whether it was ever free, and whether the force has the right sign.

use super::checked_trial::{CheckedTrial, bounds, correlation, middle, range};
use super::ranked_finding::RankedFinding;
use super::wording::{digits, quantity};
use crate::diagnose::quantile::quantile;
use crate::diagnose::thresholds::check_contact::{DEPTH_SLICES, FORCE_RISE_SIGMAS, MIN_CORRELATION, MIN_STATE_ROWS};
use crate::rig::{Contact, Rig};

/// Force that falls as the tool goes in.
pub fn wrong_sign(rig: &Rig, view: &CheckedTrial<'_>) -> Option<RankedFinding> {
    rig.contact?;
    let force = view.force.as_ref()?;
    let inside = view.touching(rig);
    let pick = |values: &[f64]| -> Vec<f64> {
        values.iter().zip(&inside).filter(|(_, touch)| **touch).map(|(value, _)| *value).collect()
    };
    let (depth, force) = (pick(&view.depth), pick(force));
    let link = correlation(&depth, &force);
    let stands_out =
        range(&force) > FORCE_RISE_SIGMAS * view.noise[2] && range(&depth) > FORCE_RISE_SIGMAS * view.noise[0];
    let text = format!(
        "In contact the force falls as the tool goes in (correlation {}): one of the two has the wrong sign. If the force reads negative when the tool \
         pushes, multiply the force column by -1; if the position counts away from the surface, multiply that one by -1 and give the surface anew.",
        digits(link),
    );
    (depth.len() > 10 && stands_out && link < -MIN_CORRELATION)
        .then(|| RankedFinding::grave("force_sign", format!("{}, force", view.name()), -link, text))
}

/// Whether the surface was reached and left, over all trials.
pub fn reached(rig: &Rig, views: &[CheckedTrial<'_>]) -> Option<RankedFinding> {
    let contact = rig.contact?;
    let views: Vec<&CheckedTrial<'_>> = views.iter().filter(|view| view.force.is_some()).collect();
    let first = *views.first()?;
    let rows = |view: &CheckedTrial<'_>, count: usize| count as f64 * view.step / view.raw.period;
    let beyond = |view: &CheckedTrial<'_>| view.depth.iter().filter(|depth| **depth > view.noise[0]).count();
    let touched = views.iter().any(|view| contact.bilateral || rows(view, beyond(view)) >= MIN_STATE_ROWS);
    let risen: Vec<&CheckedTrial<'_>> = views.iter().copied().filter(|view| has_risen(view)).collect();
    match (touched, risen.first()) {
        (false, None) => Some(never(contact, first)),
        (false, Some(view)) => Some(elsewhere(contact, view)),
        (true, None) => Some(silent(contact, &views)),
        (true, Some(_)) => {
            let free = |view: &CheckedTrial<'_>| view.depth.iter().filter(|depth| **depth <= view.noise[0]).count();
            let was_free = contact.bilateral || views.iter().any(|view| rows(view, free(view)) >= MIN_STATE_ROWS);
            (!was_free).then(|| {
                let text = "The tool is in contact from the first row to the last: what the force sensor reads when nothing touches, and where the surface \
                            lies, cannot be distinguished. Start and end each trial clear of the surface.";
                RankedFinding::mild("never_free", "", 0.0, text)
            })
        }
    }
}

/// Whether the force does more than its noise.
fn has_risen(view: &CheckedTrial<'_>) -> bool {
    let step = view.raw.figures.force.map_or(0.0, |channel| channel.resolution);
    view.force.as_ref().is_some_and(|force| range(force) > (FORCE_RISE_SIGMAS * view.noise[2]).max(2.0 * step))
}

fn never(contact: Contact, view: &CheckedTrial<'_>) -> RankedFinding {
    let deepest = view.depth.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let text = format!(
        "The tool never touched: it stays {} short of the surface at {}, and the force never rises above its noise. Nothing can be said of the contact; \
         press further in.",
        quantity(deepest.abs(), view.length),
        quantity(contact.surface, view.length),
    );
    RankedFinding::grave("contact", "", 0.0, text)
}

fn elsewhere(contact: Contact, view: &CheckedTrial<'_>) -> RankedFinding {
    let force = view.force.as_deref().unwrap_or_default();
    let link = correlation(&view.depth, force);
    let surface = quantity(contact.surface, view.length);
    let text = if link < -0.5 * MIN_CORRELATION {
        format!(
            "The position never passes the surface at {surface}, and the force rises as the position falls: the position counts away from the surface. \
             Multiply the position column by -1 and give the surface anew."
        )
    } else {
        let rise = onset(&view.depth, force, view.noise[2]).map_or_else(String::new, |depth| {
            format!(": the force rises at a position of {}", quantity(contact.surface + depth, view.length))
        });
        format!(
            "The position never passes the surface at {surface}, yet the force rises. The surface value may be wrong{rise}. Set it to where the contact begins."
        )
    };
    RankedFinding::grave("contact", format!("{}, position", view.name()), 0.0, text)
}

fn silent(contact: Contact, views: &[&CheckedTrial<'_>]) -> RankedFinding {
    let deepest = views.iter().flat_map(|view| view.depth.iter().copied()).fold(f64::NEG_INFINITY, f64::max);
    let (length, push) = views.first().map_or(("m", "N"), |view| (view.length, view.push));
    let text = format!(
        "The position goes {} beyond the surface at {}, where the rig's stiffness gives {}, yet the force never rises above its noise. Either the surface \
         lies deeper and was never touched, or the force sensor is not connected.",
        quantity(deepest, length),
        quantity(contact.surface, length),
        quantity(contact.stiffness * deepest, push),
    );
    RankedFinding::grave("contact", "force", 0.0, text)
}

/// Depth from which the force stays above what it reads furthest out.
fn onset(depth: &[f64], force: &[f64], noise: f64) -> Option<f64> {
    let (low, high) = bounds(depth);
    let slice = |value: f64| (((value - low) / (high - low) * DEPTH_SLICES as f64) as usize).min(DEPTH_SLICES - 1);
    let mut slices = vec![Vec::new(); DEPTH_SLICES];
    for (depth, force) in depth.iter().zip(force) {
        slices[slice(*depth)].push(*force);
    }
    let outmost = quantile(depth.to_vec(), 0.1)?;
    let rest =
        middle(depth.iter().zip(force).filter(|(depth, _)| **depth <= outmost).map(|(_, force)| *force).collect())?;
    let least = rest + (0.5 * FORCE_RISE_SIGMAS * noise).max(0.05 * range(force)).value();
    let levels: Vec<Option<f64>> = slices.into_iter().map(middle).collect();
    let last_idle = levels.iter().rposition(|level| level.is_some_and(|level| level < least))?;
    Some(low + (last_idle + 1) as f64 / DEPTH_SLICES as f64 * (high - low))
}
