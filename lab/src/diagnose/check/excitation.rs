//! What the motion leaves undecided: speeds, depths, ways back and holds that were never run.

use super::checked_trial::{CheckedTrial, bounds};
use super::ranked_finding::RankedFinding;
use super::wording::quantity;
use crate::diagnose::quantile::quantile;
use crate::diagnose::thresholds::check_excitation::{
    HOLD_SEGMENTS, MAX_HOLD_DEPTH_FRACTION, MAX_SINGLE_DEPTH_FRACTION, MAX_SINGLE_SPEED_RATIO, MIN_CONTACT_ROWS,
    MIN_DEPTH_ROWS, MIN_HOLD_SEGMENTS, MIN_MOVING_SPEED_FRACTION, MIN_RETURN_FRACTION,
};
use crate::rig::Rig;

/// Depths that are on the way to the one depth, over it, ...
const WAY: std::ops::Range<f64> = 0.1..0.8;

/// The rows that a channel speaks of: of each trial depth and speed.
struct Motion {
    stretches: Vec<Vec<f64>>,
    speeds: Vec<f64>,
    /// Recorded rows that a row here stands for.
    stride: f64,
}

/// What is lacking over all trials together: they are fitted together.
pub fn lacking(rig: &Rig, views: &[CheckedTrial<'_>]) -> Vec<RankedFinding> {
    let Some(first) = views.first() else { return Vec::new() };
    let in_contact = rig.contact.is_some() && views.iter().any(|view| view.force.is_some());
    let motion = Motion::of(rig, views, in_contact);
    if motion.speeds.len() < MIN_CONTACT_ROWS {
        return Vec::new();
    }
    let usual = quantile(motion.speeds.iter().map(|speed| speed.abs()).collect(), 0.95).unwrap_or(0.0);
    let noise = views.iter().map(|view| view.noise[1]).fold(0.0, f64::max);
    let threshold = (MIN_MOVING_SPEED_FRACTION * usual).max(4.0 * noise);
    let way = |sign: f64| -> Vec<f64> {
        motion.speeds.iter().map(|speed| sign * speed).filter(|speed| *speed > threshold).collect()
    };
    let (inward, outward) = (way(1.0), way(-1.0));
    let mut notes = Vec::new();
    notes.extend(one_speed(first.length, &inward, &outward, in_contact));
    if in_contact {
        notes.extend(motion.one_depth(first.length));
        notes.extend(one_way(&inward, &outward));
        notes.extend(motion.no_hold());
    }
    notes
}

impl Motion {
    fn of(rig: &Rig, views: &[CheckedTrial<'_>], in_contact: bool) -> Self {
        let (mut stretches, mut speeds) = (Vec::new(), Vec::new());
        for view in views {
            let inside = if in_contact { view.touching(rig) } else { vec![true; view.depth.len()] };
            let rows: Vec<usize> = (0..inside.len()).filter(|row| inside[*row]).collect();
            speeds.extend(rows.iter().map(|row| view.speed[*row]));
            let runs = rows.chunk_by(|a, b| a + 1 == *b);
            stretches.extend(runs.map(|run| run.iter().map(|row| view.depth[*row]).collect::<Vec<f64>>()));
        }
        let stride = views.iter().map(|view| view.step / view.raw.period).fold(1.0, f64::max);
        Self { stretches, speeds, stride }
    }

    fn depths(&self) -> Vec<f64> {
        self.stretches.iter().flatten().copied().collect()
    }

    /// Range of all but the outmost twentieths, and the upper end.
    fn spread(&self) -> Option<(f64, f64)> {
        let low = quantile(self.depths(), 0.05)?;
        let high = quantile(self.depths(), 0.95)?;
        Some((high - low, high.abs().max(low.abs())))
    }

    fn one_depth(&self, length: &str) -> Option<RankedFinding> {
        let (spread, deep) = self.spread()?;
        let text = format!(
            "Nine in ten rows of contact lie within {} at a depth of {}: whether stiffness or damping change with depth cannot be decided. Press to several \
             depths, the deepest three times the shallowest.",
            quantity(spread, length),
            quantity(deep, length),
        );
        let on_way = self.depths().iter().filter(|depth| WAY.contains(&(depth.abs() / deep))).count() as f64;
        (spread < MAX_SINGLE_DEPTH_FRACTION * deep && on_way * self.stride < MIN_DEPTH_ROWS)
            .then(|| RankedFinding::mild("one_depth", "motion", 0.0, text))
    }

    /// Whether the mean depth never stays: looked for in pieces, so that a small oscillation does not hide a hold.
    fn no_hold(&self) -> Option<RankedFinding> {
        let (spread, _) = self.spread()?;
        let longest = self.stretches.iter().map(Vec::len).max()?;
        let held = |stretch: &&Vec<f64>| {
            let size = stretch.len() / HOLD_SEGMENTS;
            // A fleeting touch beside long ones is no hold.
            if size == 0 || 4 * stretch.len() < longest {
                return false;
            }
            let means: Vec<f64> =
                stretch.chunks_exact(size).map(|piece| piece.iter().sum::<f64>() / size as f64).collect();
            means.windows(MIN_HOLD_SEGMENTS).any(|means| {
                let (low, high) = bounds(means);
                high - low < MAX_HOLD_DEPTH_FRACTION * spread
            })
        };
        let text = "The tool never stays at a depth: whether the force relaxes under a held contact cannot be distinguished from damping and hysteresis. Add a hold of \
                    some seconds, as long as the slowest change that matters.";
        (longest > HOLD_SEGMENTS && !self.stretches.iter().any(|stretch| held(&stretch)))
            .then(|| RankedFinding::mild("no_hold", "motion", 0.0, text))
    }
}

fn one_speed(length: &str, inward: &[f64], outward: &[f64], in_contact: bool) -> Option<RankedFinding> {
    let speed = |values: &[f64]| {
        let [low, mid, high] = [0.1, 0.5, 0.9].map(|at| quantile(values.to_vec(), at));
        Some((high? / low?, mid?))
    };
    let ways: Vec<(f64, f64)> =
        [inward, outward].into_iter().filter(|way| way.len() >= MIN_CONTACT_ROWS / 2).filter_map(speed).collect();
    if ways.is_empty() || ways.iter().any(|(ratio, _)| *ratio > MAX_SINGLE_SPEED_RATIO) {
        return None;
    }
    let unit = format!("{length}/s");
    let speeds: Vec<String> = ways.iter().map(|(_, speed)| quantity(*speed, &unit)).collect();
    let what = if in_contact {
        "damping cannot be distinguished from hysteresis"
    } else {
        "viscous cannot be distinguished from dry friction"
    };
    let text = format!(
        "The tool moves at one speed each way ({}): {what}. Run the same way at two more speeds, a factor of three apart.",
        speeds.join(" and "),
    );
    Some(RankedFinding::mild("one_speed", "motion", 0.0, text))
}

fn one_way(inward: &[f64], outward: &[f64]) -> Option<RankedFinding> {
    let all = (inward.len() + outward.len()) as f64;
    let lacks = |way: &[f64]| (way.len() as f64) < MIN_RETURN_FRACTION * all;
    let text = match (lacks(outward), lacks(inward)) {
        (true, _) => {
            "The tool goes in but never comes out: hysteresis, a lasting dent, adhesion and play cannot be seen. Record the way out as well."
        }
        (_, true) => {
            "The tool comes out but is not seen going in: hysteresis and a lasting dent cannot be seen. Record the way in as well."
        }
        _ => return None,
    };
    (all > MIN_CONTACT_ROWS as f64 / 2.0).then(|| RankedFinding::mild("one_way", "motion", 0.0, text))
}
