//! The motions among which an experiment is chosen.

use super::motion_limits::MotionLimits;
use super::trajectory::Trajectory;
use crate::diagnose::thresholds::experiment_test_motions::{HOLD_FRACTION, SINE_FRACTION};

/// A motion and what it is.
#[derive(Debug, Clone)]
pub struct TestMotion {
    /// One plain clause that goes on after "a" or stands by itself: "holds at two depths".
    pub what: String,
    /// The way it goes.
    pub course: Trajectory,
}

impl TestMotion {
    /// This one and then `other`.
    #[must_use]
    pub fn then(&self, other: &Self) -> Self {
        motion(format!("{}; then {}", self.what, other.what), self.course.clone().then(&other.course))
    }

    /// This one `count` times.
    #[must_use]
    pub fn times(self, count: usize) -> Self {
        motion(format!("{}, {count} times over", self.what), self.course.times(count))
    }
}

/// Every motion that has a place in `room`.
#[must_use]
pub fn motions(room: MotionLimits) -> Vec<TestMotion> {
    let mut motions = Vec::new();
    if room.surface.is_some() {
        motions.extend([holds(room), slow_holds(room), sines(room), sines_at_two_depths(room), small_reversals(room)]);
        if room.free {
            motions.extend([taps(room), two_depths(room), repeat(room)]);
        }
    }
    if room.free {
        motions.extend([slow_reversals(room), rest(room), dashes(room)]);
    }
    motions
}

fn motion(what: impl Into<String>, course: Trajectory) -> TestMotion {
    TestMotion { what: what.into(), course }
}

fn begin(room: MotionLimits) -> Trajectory {
    Trajectory::new(room).rest(0.25 * HOLD_FRACTION * room.seconds)
}

fn end(course: Trajectory, room: MotionLimits) -> Trajectory {
    course.home(0.5).rest(0.25 * HOLD_FRACTION * room.seconds)
}

fn holds(room: MotionLimits) -> TestMotion {
    let hold = HOLD_FRACTION * room.seconds;
    let course = begin(room).to(room.depth(0.95), 1.0).rest(2.0 * hold).to(room.depth(0.4), 1.0).rest(2.0 * hold);
    motion("quick approaches with long holds at two depths", end(course, room))
}

fn slow_holds(room: MotionLimits) -> TestMotion {
    let hold = HOLD_FRACTION * room.seconds;
    let course = begin(room).to(room.depth(0.4), 0.1).rest(hold).to(room.depth(0.95), 0.1).rest(hold);
    motion("a slow ramp with holds at two depths", end(course, room))
}

fn taps(room: MotionLimits) -> TestMotion {
    let rest = 0.3 * HOLD_FRACTION * room.seconds;
    let tap = |course: Trajectory, part: f64| {
        course.to(room.away(0.5), 1.0).rest(rest).to(room.depth(0.9), part).to(room.away(0.5), part).rest(rest)
    };
    let course = [1.0, 0.3, 1.0, 0.3].into_iter().fold(begin(room), tap);
    motion("taps at two speeds", end(course, room))
}

fn two_depths(room: MotionLimits) -> TestMotion {
    let rest = 0.3 * HOLD_FRACTION * room.seconds;
    let tap = |course: Trajectory, depth: f64| {
        course.to(room.away(0.5), 1.0).rest(rest).to(room.depth(depth), 1.0).to(room.away(0.5), 1.0).rest(rest)
    };
    let course = [0.35, 0.95, 0.35, 0.95, 0.35].into_iter().fold(begin(room), tap);
    motion("quick taps to two depths, shallow ones before and after deep ones", end(course, room))
}

/// Swings about where `course` is for a while.
fn swing(course: Trajectory, room: MotionLimits, amplitude: f64, frequency: f64) -> Trajectory {
    course.wave(amplitude, frequency, (frequency * SINE_FRACTION * room.seconds).clamp(3.0, 200.0).round())
}

fn sines(room: MotionLimits) -> TestMotion {
    let amplitude = 0.2 * (room.high - room.depth(0.0));
    let quick = room.quickest(amplitude);
    // Above it the limits take the amplitude down.
    let top = (2.5 * quick).min(room.band.max(quick));
    let course = [0.15, 0.5, 1.0]
        .iter()
        .fold(begin(room).to(room.depth(0.6), 0.5), |course, part| swing(course, room, amplitude, part * top));
    let what =
        format!("sines of three frequencies at one depth ({}, {} and {})", hz(0.15 * top), hz(0.5 * top), hz(top));
    motion(what, end(course, room))
}

fn sines_at_two_depths(room: MotionLimits) -> TestMotion {
    let amplitude = 0.2 * (room.high - room.depth(0.0));
    let quick = room.quickest(amplitude);
    let course = [0.3, 0.75].iter().fold(begin(room), |course, depth| {
        let there = swing(course.to(room.depth(*depth), 0.5), room, amplitude, 0.3 * quick);
        swing(there, room, amplitude, quick)
    });
    motion(format!("sines of {} and {} at two depths", hz(0.3 * quick), hz(quick)), end(course, room))
}

fn small_reversals(room: MotionLimits) -> TestMotion {
    let course = [0.3, 0.15, 0.05].iter().fold(begin(room).to(room.depth(0.6), 0.3), |course, size| {
        let (in_, out) = (room.depth(0.6 + size), room.depth(0.6 - size));
        course.to(in_, 0.2).to(out, 0.2).to(in_, 0.2).to(out, 0.2)
    });
    motion("slow reversals in contact, large ones and small ones", end(course, room))
}

fn repeat(room: MotionLimits) -> TestMotion {
    let hold = HOLD_FRACTION * room.seconds;
    let contact = |course: Trajectory| {
        let in_ = course.to(room.away(0.5), 1.0).to(room.depth(0.6), 0.6).rest(0.5 * hold);
        in_.to(room.away(0.5), 0.6).rest(0.5 * hold)
    };
    let deep = contact(begin(room)).to(room.depth(0.95), 0.6).rest(0.5 * hold).to(room.away(0.5), 0.6);
    motion(
        "one contact, a deeper one, a long rest, and the first contact again",
        end(contact(deep.rest(3.0 * hold)), room),
    )
}

fn slow_reversals(room: MotionLimits) -> TestMotion {
    let course = [0.02f64, 0.1, 0.4, 1.0].iter().fold(begin(room), |course, part| {
        // The slower, the shorter the way: no leg takes the whole of the time.
        let way = 0.4 * part.sqrt();
        let (near, far) = (room.away(0.5 + way), room.away(0.5 - way));
        course.to(near, *part).to(far, *part).to(near, *part)
    });
    motion("reversals in free space, from very slow to quick", end(course, room))
}

fn rest(room: MotionLimits) -> TestMotion {
    let hold = HOLD_FRACTION * room.seconds;
    motion(
        "long rests in free space, at two places",
        end(begin(room).to(room.away(0.2), 0.5).rest(2.0 * hold).to(room.away(0.8), 0.5).rest(2.0 * hold), room),
    )
}

fn dashes(room: MotionLimits) -> TestMotion {
    let amplitude = 0.2 * (room.away(1.0) - room.low);
    let quick = room.quickest(amplitude);
    let dash = begin(room).to(room.away(0.1), 1.0).to(room.away(0.9), 1.0).to(room.away(0.5), 1.0);
    let course = swing(swing(dash, room, amplitude, quick), room, amplitude, (2.0 * quick).min(room.band.max(quick)));
    motion("quick accelerations in free space", end(course, room))
}

fn hz(frequency: f64) -> String {
    crate::page::quantity::rounded(frequency, "Hz", 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_motion_is_smooth_keeps_within_its_room_and_comes_home() {
        let room = MotionLimits {
            start: -4e-3,
            low: -5e-3,
            high: 10e-3,
            surface: Some(0.0),
            free: true,
            speed: 0.15,
            acceleration: 8.0,
            seconds: 20.0,
            band: 30.0,
        };
        let mut all = motions(room);
        all.extend([all[0].then(&all[3]), all[5].clone().times(2)]);
        for TestMotion { what, course } in all {
            let step = 1e-4;
            let rows = course.rows(step);
            for row in &rows {
                assert!(row[0] >= room.low - 1e-12 && row[0] <= room.high + 1e-12, "{what}: {row:?}");
                assert!(
                    row[1].abs() <= 1.001 * room.speed && row[2].abs() <= 1.001 * room.acceleration,
                    "{what}: {row:?}"
                );
            }
            for trio in rows.windows(3) {
                // What differences say; at 0.1 ms the third derivative, some 3000 m/s^3, is worth 5e-6 m/s and 0.3 m/s^2.
                let slope = (trio[2][0] - trio[0][0]) / (2.0 * step);
                let bend = (trio[2][1] - trio[0][1]) / (2.0 * step);
                assert!((slope - trio[1][1]).abs() < 1e-5, "{what}: {slope} for {}", trio[1][1]);
                assert!((bend - trio[1][2]).abs() < 0.3, "{what}: {bend} for {}", trio[1][2]);
            }
            let last = rows[rows.len() - 1];
            assert_eq!((rows[0], last), ([room.start, 0.0, 0.0], [room.start, 0.0, 0.0]), "{what}");
            assert!(course.seconds() < 1.2 * room.seconds, "{what}: {} s", course.seconds());
        }
    }
}
