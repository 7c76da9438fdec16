//! A trial in two, at a turn: whole strokes on either side.

use crate::recording::Recording;

/// Share of the travel by which a motion has to come back to have turned: less is noise, or a pause.
const BACK: f64 = 0.1;

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
    let back = BACK * (high - low);
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
}
