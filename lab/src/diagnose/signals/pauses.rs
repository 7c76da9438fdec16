//! Long pauses: what lies before and behind one is a trial of its own.
//!
//! Checks and filters work on an even clock, whose rows a pause would fill: an hour without a row, or a clock that is set between two rows,
//! holds more of them than any memory.

use crate::diagnose::check::Finding;
use crate::diagnose::thresholds::pauses::MAX_GAP_RATIO;
use crate::diagnose::thresholds::prepare::MIN_TRIAL_ROWS;
use crate::diagnose::thresholds::uniform_trial::GAP_PERIODS;
use crate::page::quantity;
use crate::recording::Recording;

/// Trials without long pauses.
#[derive(Debug)]
pub struct Divided {
    /// The parts, in order; a trial without a long pause is one part and keeps its name.
    pub trials: Vec<Recording>,
    /// The same parts of the simulations that were handed over.
    pub simulation: Vec<Recording>,
    /// What was divided and left out; `None` where nothing was.
    pub finding: Option<Finding>,
}

/// Divides each of `trials`, and the simulation of it, at its longest gaps until gaps hold no more than [`MAX_GAP_RATIO`] of the time that
/// rows do. Parts too short to tell anything of are left out where a longer one is left.
#[must_use]
pub fn divided(trials: &[Recording], simulation: &[Recording]) -> Divided {
    let mut divided = Divided { trials: Vec::new(), simulation: Vec::new(), finding: None };
    let (mut pauses, mut left_out, mut longest) = (0, 0, None::<(f64, f64, &str)>);
    for (number, trial) in trials.iter().enumerate() {
        let found = pauses_of(&trial.time);
        for &row in &found {
            let (start, length) = (trial.time[row], trial.time[row + 1] - trial.time[row]);
            if longest.is_none_or(|(_, most, _)| length > most) {
                longest = Some((start, length, &trial.name));
            }
        }
        pauses += found.len();
        let mut ranges = parts(&found, trial.time.len());
        if ranges.iter().any(|(first, end)| end - first >= MIN_TRIAL_ROWS) {
            left_out +=
                ranges.iter().map(|(first, end)| end - first).filter(|rows| *rows < MIN_TRIAL_ROWS).sum::<usize>();
            ranges.retain(|(first, end)| end - first >= MIN_TRIAL_ROWS);
        }
        for (first, end) in ranges {
            let name = if found.is_empty() {
                trial.name.clone()
            } else {
                format!("{} (rows {} to {end})", trial.name, first + 1)
            };
            if let Some(run) = simulation.get(number) {
                divided.simulation.push(during(run, trial, first, end));
            }
            divided.trials.push(Recording { name, ..rows(trial, first, end) });
        }
    }
    divided.finding = longest.map(|(start, length, name)| finding(pauses, left_out, start, length, name));
    divided
}

/// Last rows before the pauses.
fn pauses_of(time: &[f64]) -> Vec<usize> {
    let steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut sorted = steps.clone();
    sorted.sort_unstable_by(f64::total_cmp);
    let Some(period) = sorted.get(sorted.len() / 2) else { return Vec::new() };
    let is_gap = |step: f64| step > GAP_PERIODS * *period;
    let recorded: f64 = steps.iter().filter(|step| !is_gap(**step)).sum();
    let mut gaps: Vec<usize> = (0..steps.len()).filter(|at| is_gap(steps[*at])).collect();
    gaps.sort_by(|a, b| steps[*b].total_cmp(&steps[*a]));
    // Summed from the shortest: one that is longer than all numbers together hides nothing.
    let mut lost = 0.0;
    let kept = gaps.iter().rev().take_while(|at| {
        lost += steps[**at];
        lost <= MAX_GAP_RATIO * recorded
    });
    let kept = kept.count();
    gaps.truncate(gaps.len() - kept);
    gaps.sort_unstable();
    gaps
}

/// First row and one beyond the last of each part of `rows` rows.
fn parts(pauses: &[usize], rows: usize) -> Vec<(usize, usize)> {
    let starts = std::iter::once(0).chain(pauses.iter().map(|row| row + 1));
    let ends = pauses.iter().map(|row| row + 1).chain([rows]);
    starts.zip(ends).collect()
}

/// Rows `first` to before `end` of `recording`.
fn rows(recording: &Recording, first: usize, end: usize) -> Recording {
    let column = |values: &Option<Vec<f64>>| values.as_ref().map(|values| values[first..end].to_vec());
    Recording {
        name: recording.name.clone(),
        time: recording.time[first..end].to_vec(),
        position: recording.position[first..end].to_vec(),
        velocity: column(&recording.velocity),
        force: column(&recording.force),
        effort: column(&recording.effort),
        reference: column(&recording.reference),
        load: column(&recording.load),
    }
}

/// What `run` gave while rows `first` to before `end` of `trial` were recorded; both begin at the same moment of their own clocks.
fn during(run: &Recording, trial: &Recording, first: usize, end: usize) -> Recording {
    let since = |row: usize| trial.time[row] - trial.time[0];
    let start = run.time.first().copied().unwrap_or(0.0);
    // A row more on either side: what is compared is read between rows.
    let from = run.time.partition_point(|time| time - start < since(first)).saturating_sub(1);
    let to = run.time.partition_point(|time| time - start <= since(end - 1)) + 1;
    rows(run, from.min(run.time.len()), to.min(run.time.len()))
}

fn finding(pauses: usize, left_out: usize, start: f64, length: f64, name: &str) -> Finding {
    let many = if pauses == 1 { "A pause".to_owned() } else { format!("{pauses} pauses, the longest") };
    let seconds = |value| quantity::rounded(value, "s", 3);
    let rest = match left_out {
        0 => String::new(),
        1 => " One row that stands alone is left out.".to_owned(),
        rows => format!(" {rows} rows in parts too short to tell anything are left out."),
    };
    Finding {
        code: "pauses",
        grave: false,
        place: format!("{name}, time"),
        text: format!(
            "{many} of {} at {}: what lies before and behind is taken as trials of their own.{rest} If the clock was set there, subtract the step; \
             else record each part as a file.",
            seconds(length),
            seconds(start),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(time: Vec<f64>) -> Recording {
        let column: Vec<f64> = (0..time.len()).map(|row| row as f64).collect();
        Recording {
            name: "trial.csv".to_owned(),
            position: column.clone(),
            force: Some(column),
            time,
            ..Recording::default()
        }
    }

    fn even(rows: usize, start: f64) -> impl Iterator<Item = f64> {
        (0..rows).map(move |row| start + 0.01 * row as f64)
    }

    #[test]
    fn an_hour_divides_a_trial_and_a_second_does_not() {
        let gap = trial(even(100, 0.0).chain(even(100, 2.0)).collect());
        let kept = divided(std::slice::from_ref(&gap), &[]);
        assert_eq!((kept.trials, kept.finding.is_some()), (vec![gap], false));
        let pause = trial(even(100, 0.0).chain(even(200, 3600.0)).collect());
        let parts = divided(&[pause], &[]);
        let names: Vec<_> = parts.trials.iter().map(|part| (part.name.as_str(), part.position[0])).collect();
        assert_eq!(names, [("trial.csv (rows 1 to 100)", 0.0), ("trial.csv (rows 101 to 300)", 100.0)]);
        let text = parts.finding.expect("a finding").text;
        assert!(text.contains("3600") || text.contains("3599"), "{text}");
    }

    #[test]
    fn a_clock_that_is_set_after_its_first_row_leaves_that_row_out() {
        for leap in [1.7e9, 1e300] {
            let parts = divided(&[trial(std::iter::once(-leap).chain(even(100, 0.0)).collect())], &[]);
            assert_eq!(parts.trials.len(), 1);
            assert_eq!(parts.trials[0].time.len(), 100);
            assert!(parts.finding.expect("a finding").text.contains("One row"));
        }
        // Between the two ends there is no finite length.
        let parts = divided(&[trial([-f64::MAX].into_iter().chain(even(100, 0.0)).chain([f64::MAX]).collect())], &[]);
        assert_eq!(parts.trials[0].time.len(), 100);
    }

    #[test]
    fn a_simulation_is_divided_where_its_trial_is_whatever_its_clock() {
        let recorded = trial(even(100, 5.0).chain(even(100, 4000.0)).collect());
        let run = trial((0..40_000).map(|row| 0.1 * f64::from(row)).collect());
        let parts = divided(&[recorded], &[run]);
        assert_eq!(parts.simulation.len(), 2);
        for (part, since) in parts.simulation.iter().zip([0.0, 3995.0]) {
            let (first, last) = (part.time[0], part.time[part.time.len() - 1]);
            assert!(first <= since && since - first < 0.21, "{first} {since}");
            assert!(last >= since + 0.99 && last < since + 1.3, "{last} {since}");
        }
    }

    #[test]
    fn where_every_part_is_too_short_they_stay_to_be_refused_by_name() {
        let bursts = trial((0..20).flat_map(|burst| even(5, 1e4 * f64::from(burst))).collect());
        assert!(divided(&[bursts], &[]).trials.iter().all(|part| part.time.len() == 5));
    }
}
