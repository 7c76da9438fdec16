//! The motions among which an experiment is chosen.

use super::path::{MotionLimits, Path};

/// Share of a trial that a hold takes.
const HOLD_FRACTION: f64 = 1.0 / 16.0;

/// Share of it in which sines of one frequency go on.
const SINE_FRACTION: f64 = 1.0 / 10.0;

/// A motion and what it is.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// One plain clause that goes on after "a" or stands by itself: "holds at two depths".
    pub what: String,
    /// The way it goes.
    pub path: Path,
}

/// Every motion that has a place in `limits`.
#[must_use]
pub fn motions(limits: MotionLimits) -> Vec<Candidate> {
    let mut motions = Vec::new();
    if limits.surface.is_some() {
        motions.extend([
            holds(limits),
            slow_holds(limits),
            sines(limits),
            sines_at_two_depths(limits),
            small_reversals(limits),
        ]);
        if limits.free {
            motions.extend([taps(limits), two_depths(limits), repeat(limits)]);
        }
    }
    if limits.free {
        motions.extend([slow_reversals(limits), rest(limits), dashes(limits)]);
    }
    motions
}

fn motion(what: impl Into<String>, path: Path) -> Candidate {
    Candidate { what: what.into(), path }
}

fn begin(limits: MotionLimits) -> Path {
    Path::new(limits).rest(0.25 * HOLD_FRACTION * limits.seconds)
}

fn end(path: Path, limits: MotionLimits) -> Path {
    path.home(0.5).rest(0.25 * HOLD_FRACTION * limits.seconds)
}

fn holds(limits: MotionLimits) -> Candidate {
    let hold = HOLD_FRACTION * limits.seconds;
    let path = begin(limits).to(limits.depth(0.95), 1.0).rest(2.0 * hold).to(limits.depth(0.4), 1.0).rest(2.0 * hold);
    motion("quick approaches with long holds at two depths", end(path, limits))
}

fn slow_holds(limits: MotionLimits) -> Candidate {
    let hold = HOLD_FRACTION * limits.seconds;
    let path = begin(limits).to(limits.depth(0.4), 0.1).rest(hold).to(limits.depth(0.95), 0.1).rest(hold);
    motion("a slow ramp with holds at two depths", end(path, limits))
}

fn taps(limits: MotionLimits) -> Candidate {
    let rest = 0.3 * HOLD_FRACTION * limits.seconds;
    let tap = |path: Path, part: f64| {
        path.to(limits.away(0.5), 1.0).rest(rest).to(limits.depth(0.9), part).to(limits.away(0.5), part).rest(rest)
    };
    let path = [1.0, 0.3, 1.0, 0.3].into_iter().fold(begin(limits), tap);
    motion("taps at two speeds", end(path, limits))
}

fn two_depths(limits: MotionLimits) -> Candidate {
    let rest = 0.3 * HOLD_FRACTION * limits.seconds;
    let tap = |path: Path, depth: f64| {
        path.to(limits.away(0.5), 1.0).rest(rest).to(limits.depth(depth), 1.0).to(limits.away(0.5), 1.0).rest(rest)
    };
    let path = [0.35, 0.95, 0.35, 0.95, 0.35].into_iter().fold(begin(limits), tap);
    motion("quick taps to two depths, shallow ones before and after deep ones", end(path, limits))
}

/// Swings about where `path` is for a while.
fn swing(path: Path, limits: MotionLimits, amplitude: f64, frequency: f64) -> Path {
    path.sine(amplitude, frequency, (frequency * SINE_FRACTION * limits.seconds).clamp(3.0, 200.0).round())
}

fn sines(limits: MotionLimits) -> Candidate {
    let amplitude = 0.2 * (limits.high - limits.depth(0.0));
    let quick = limits.quickest(amplitude);
    // Above it the limits take the amplitude down.
    let top = (2.5 * quick).min(limits.band.max(quick));
    let path = [0.15, 0.5, 1.0]
        .iter()
        .fold(begin(limits).to(limits.depth(0.6), 0.5), |path, part| swing(path, limits, amplitude, part * top));
    let what =
        format!("sines of three frequencies at one depth ({}, {} and {})", hz(0.15 * top), hz(0.5 * top), hz(top));
    motion(what, end(path, limits))
}

fn sines_at_two_depths(limits: MotionLimits) -> Candidate {
    let amplitude = 0.2 * (limits.high - limits.depth(0.0));
    let quick = limits.quickest(amplitude);
    let path = [0.3, 0.75].iter().fold(begin(limits), |path, depth| {
        let there = swing(path.to(limits.depth(*depth), 0.5), limits, amplitude, 0.3 * quick);
        swing(there, limits, amplitude, quick)
    });
    motion(format!("sines of {} and {} at two depths", hz(0.3 * quick), hz(quick)), end(path, limits))
}

fn small_reversals(limits: MotionLimits) -> Candidate {
    let path = [0.3, 0.15, 0.05].iter().fold(begin(limits).to(limits.depth(0.6), 0.3), |path, size| {
        let (in_, out) = (limits.depth(0.6 + size), limits.depth(0.6 - size));
        path.to(in_, 0.2).to(out, 0.2).to(in_, 0.2).to(out, 0.2)
    });
    motion("slow reversals in contact, large ones and small ones", end(path, limits))
}

fn repeat(limits: MotionLimits) -> Candidate {
    let hold = HOLD_FRACTION * limits.seconds;
    let contact = |path: Path| {
        let in_ = path.to(limits.away(0.5), 1.0).to(limits.depth(0.6), 0.6).rest(0.5 * hold);
        in_.to(limits.away(0.5), 0.6).rest(0.5 * hold)
    };
    let deep = contact(begin(limits)).to(limits.depth(0.95), 0.6).rest(0.5 * hold).to(limits.away(0.5), 0.6);
    motion(
        "one contact, a deeper one, a long rest, and the first contact again",
        end(contact(deep.rest(3.0 * hold)), limits),
    )
}

fn slow_reversals(limits: MotionLimits) -> Candidate {
    let path = [0.02f64, 0.1, 0.4, 1.0].iter().fold(begin(limits), |path, part| {
        // The slower, the shorter the way: no leg takes the whole of the time.
        let way = 0.4 * part.sqrt();
        let (near, far) = (limits.away(0.5 + way), limits.away(0.5 - way));
        path.to(near, *part).to(far, *part).to(near, *part)
    });
    motion("reversals in free space, from very slow to quick", end(path, limits))
}

fn rest(limits: MotionLimits) -> Candidate {
    let hold = HOLD_FRACTION * limits.seconds;
    motion(
        "long rests in free space, at two places",
        end(
            begin(limits).to(limits.away(0.2), 0.5).rest(2.0 * hold).to(limits.away(0.8), 0.5).rest(2.0 * hold),
            limits,
        ),
    )
}

fn dashes(limits: MotionLimits) -> Candidate {
    let amplitude = 0.2 * (limits.away(1.0) - limits.low);
    let quick = limits.quickest(amplitude);
    let dash = begin(limits).to(limits.away(0.1), 1.0).to(limits.away(0.9), 1.0).to(limits.away(0.5), 1.0);
    let path =
        swing(swing(dash, limits, amplitude, quick), limits, amplitude, (2.0 * quick).min(limits.band.max(quick)));
    motion("quick accelerations in free space", end(path, limits))
}

fn hz(frequency: f64) -> String {
    crate::page::quantity::rounded(frequency, "Hz", 2)
}
