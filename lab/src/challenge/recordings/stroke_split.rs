//! A trial in two, at a turn: whole strokes on either side.

use crate::recording::Recording;

/// Share of the travel by which a motion has to come back to have turned: less is noise, or a pause.
const MIN_REVERSAL_FRACTION: f64 = 0.1;

/// Shares of the time between which a trial is parted; a turn beyond leaves one side with next to nothing.
const MIDDLE: (f64, f64) = (0.3, 0.7);

/// `trial` before and after the turn at the far end from the environment that is nearest its middle; none where it has no
/// such turn about its middle.
#[must_use]
pub fn split_at_turn(trial: &Recording) -> Option<[Recording; 2]> {
    let time = &trial.time;
    let (start, end) = (*time.first()?, *time.last()?);
    let share = |row: usize| (time[row] - start) / (end - start);
    let middle = turns(&trial.position).into_iter().filter(|row| (MIDDLE.0..MIDDLE.1).contains(&share(*row)));
    let at = middle.min_by(|a, b| (share(*a) - 0.5).abs().total_cmp(&(share(*b) - 0.5).abs()))?;
    Some([slice(trial, 0, at + 1), slice(trial, at, time.len())])
}

/// Rows at which the motion turns from going out to going in.
fn turns(position: &[f64]) -> Vec<usize> {
    let (low, high) =
        position.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    let back = MIN_REVERSAL_FRACTION * (high - low);
    let (mut found, mut lowest, mut highest, mut goes_out) = (Vec::new(), 0, 0, false);
    for (row, x) in position.iter().enumerate() {
        if goes_out {
            if *x < position[lowest] {
                lowest = row;
            } else if *x - position[lowest] > back {
                found.push(lowest);
                (goes_out, highest) = (false, row);
            }
        } else if *x > position[highest] {
            highest = row;
        } else if position[highest] - *x > back {
            (goes_out, lowest) = (true, row);
        }
    }
    found
}

/// Rows `from` to `to`, on a clock that begins with them.
fn slice(trial: &Recording, from: usize, to: usize) -> Recording {
    let rows = |values: &Vec<f64>| values[from..to].to_vec();
    let origin = trial.time[from];
    Recording {
        name: trial.name.clone(),
        time: trial.time[from..to].iter().map(|time| time - origin).collect(),
        position: rows(&trial.position),
        velocity: trial.velocity.as_ref().map(rows),
        force: trial.force.as_ref().map(rows),
        effort: trial.effort.as_ref().map(rows),
        reference: trial.reference.as_ref().map(rows),
        load: trial.load.as_ref().map(rows),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(position: impl Fn(f64) -> f64) -> Recording {
        let time: Vec<f64> = (0..1000).map(|row| f64::from(row) * 0.01).collect();
        let position: Vec<f64> = time.iter().map(|t| position(*t)).collect();
        Recording { force: Some(time.clone()), time, position, ..Recording::default() }
    }

    #[test]
    fn strokes_stay_whole_and_a_single_press_is_not_parted() {
        // Five strokes of two seconds that begin far out: it is out again at 2, 4, 6 and 8 s.
        let strokes = trial(|t| -(std::f64::consts::PI * t).cos() + 1e-3 * (977.0 * t).sin());
        let [first, second] = split_at_turn(&strokes).unwrap();
        let length = *first.time.last().unwrap();
        assert!((length - 4.0).abs() < 0.1 || (length - 6.0).abs() < 0.1, "{length}");
        assert_eq!(second.time[0], 0.0);
        assert_eq!(second.force.unwrap()[0], length);
        assert_eq!(first.time.len() + second.time.len(), 1001);
        assert!(split_at_turn(&trial(|t| 1.0 - (t - 5.0).abs())).is_none(), "one press");
        assert!(split_at_turn(&trial(|t| (t - 9.0).abs())).is_none(), "turns near its end");
    }

    #[test]
    fn a_turn_is_where_the_tool_is_farthest_out_between_two_strokes() {
        // Out is down: 4, in between at 9, and back by more than a tenth of the travel of ten.
        assert_eq!(turns(&[0.0, 10.0, 4.0, 3.0, 5.0, 9.0, 2.0, 10.0]), [3, 6]);
        // A tenth is no turn, either way; a little more is.
        assert_eq!(turns(&[0.0, 10.0, 9.0, 10.0]), [0; 0]);
        assert_eq!(turns(&[0.0, 10.0, 8.9, 9.9]), [0; 0]);
        assert_eq!(turns(&[0.0, 10.0, 8.9, 10.0]), [2]);
        // A travel of twenty: back by two is no turn.
        assert_eq!(turns(&[0.0, 5.0, 3.0, 6.0, 10.0, -10.0]), [0; 0]);
        // Of equal places the first, and a level that is not zero changes nothing.
        assert_eq!(turns(&[100.0, 110.0, 103.0, 103.0, 108.0]), [2]);
        assert_eq!(turns(&[100.0, 110.0, 110.0, 103.0, 108.0]), [3]);
        // The way in is counted from where it begins.
        assert_eq!(turns(&[0.0, 10.0, 5.0, 8.0, 7.5, 9.0, 6.0, 9.5]), [2, 6]);
    }

    #[test]
    fn the_turn_nearest_the_middle_parts_the_trial_on_a_clock_that_does_not_begin_at_zero() {
        // Turns at 3.5, 6 and 6.9 of 10 s, that begin at 100 s.
        let out = [3.5, 6.0, 6.9];
        let time: Vec<f64> = (0..=1000).map(|row| 100.0 + f64::from(row) * 0.01).collect();
        let near = |t: f64| out.iter().map(|turn| (t - 100.0 - turn).abs()).fold(f64::INFINITY, f64::min);
        let position = time.iter().map(|t| near(*t).min(0.4)).collect();
        let [first, second] = split_at_turn(&Recording { time, position, ..Recording::default() }).unwrap();
        assert_eq!((first.time.len(), second.time.len()), (601, 401));
        assert!((first.time[600] - 6.0).abs() < 1e-9 && first.time[0] == 0.0 && second.time[0] == 0.0);
    }

    #[test]
    fn a_turn_in_the_first_or_last_three_tenths_parts_nothing() {
        for (turn, parted) in [(2.9, false), (3.1, true), (6.9, true), (7.1, false)] {
            let found = split_at_turn(&trial(|t| (t - turn).abs().min(1.0)));
            assert_eq!(found.is_some(), parted, "{turn} of 10 s");
        }
    }
}
