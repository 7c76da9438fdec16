//! What no law of the list explains, learned as a curve over depth and direction, and told in words.

use nalgebra::{DMatrix, DVector};

use super::broken_line::DepthProfile;
use super::criteria::{LEAST_HELD_OUT_SHARE, NOTABLE_POWER};
use super::data::Data;
use super::fit::Fit;
use super::free_curve::way_below;
use super::held_out::{Folds, HeldOut, rms};
use super::learned_damping::DampingCurve;
use super::model::index;
use super::rest::Rest;
use super::spline::{Part, Spline};
use super::trial::ContactTrial;
use crate::diagnose::interval::NORMAL_97_5;
use crate::diagnose::linalg::energy;
use crate::diagnose::term::Term;
use crate::effects::{LEARNED, LEARNED_FORM, LEARNED_KNOTS, geometric};

/// What is learned.
#[derive(Debug, Clone)]
pub enum Learned {
    /// A curve over depth and direction.
    OverDepth(LearnedCurve),
    /// A curve over the speed in contact.
    OverSpeed(DampingCurve),
}

impl Learned {
    /// The law with it.
    #[must_use]
    pub fn fit(&self) -> &Fit {
        match self {
            Self::OverDepth(curve) => &curve.fit,
            Self::OverSpeed(curve) => &curve.fit,
        }
    }

    /// What that leaves of rows that taught nothing, N or N m, a column a trial.
    #[must_use]
    pub fn residual(&self) -> &Vec<Vec<f64>> {
        match self {
            Self::OverDepth(curve) => &curve.residual,
            Self::OverSpeed(curve) => &curve.residual,
        }
    }

    /// The same, to change.
    pub fn residual_mut(&mut self) -> &mut Vec<Vec<f64>> {
        match self {
            Self::OverDepth(curve) => &mut curve.residual,
            Self::OverSpeed(curve) => &mut curve.residual,
        }
    }

    /// 95 % interval of each value of the fit, where `law` are those of the law's.
    #[must_use]
    pub fn intervals(&self, law: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let covariance = match self {
            Self::OverDepth(curve) => &curve.covariance,
            Self::OverSpeed(curve) => &curve.covariance,
        };
        let values = &self.fit().values;
        let deviations = covariance.diagonal().map(|variance| variance.max(0.0).sqrt());
        let forces = values.len() - deviations.len();
        let mut ends: Vec<[f64; 2]> = law.to_vec();
        ends.extend(values[law.len()..forces].iter().map(|value| [*value; 2]));
        let of_force = |(value, deviation): (&f64, &f64)| {
            // A force that is held by convention has no interval.
            let half = if *deviation > 0.0 { NORMAL_97_5 * deviation } else { f64::INFINITY };
            [value - half, value + half]
        };
        ends.extend(values[forces..].iter().zip(&deviations).map(of_force));
        ends
    }
}

/// A law with a learned element behind its other terms.
#[derive(Debug, Clone)]
pub struct LearnedCurve {
    /// The law, the element last.
    pub fit: Fit,
    /// What it leaves of rows that taught nothing, N or N m, a column a trial.
    pub residual: Vec<Vec<f64>>,
    /// Share of the power above the noise that it takes there of what the law without it leaves.
    pub held_out_share: f64,
    /// Covariance of the forces at the knots: of the mean at all of them, and of the loop.
    pub covariance: DMatrix<f64>,
    /// In and out by the law with it, from shallow to deep.
    pub paths: Vec<PathPoint>,
}

/// A depth on the ways in and out.
#[derive(Debug, Clone, Default)]
pub struct PathPoint {
    /// m or rad below the surface.
    pub depth: f64,
    /// Force on the way in and on the way out, N or N m.
    pub force: [f64; 2],
    /// Their derivatives by the forces at the knots.
    pub by_knots: [DVector<f64>; 2],
}

impl LearnedCurve {
    /// Half-width of the 95 % interval of the force on the way in, N or N m: the median over the depth, and the greatest.
    #[must_use]
    pub fn half_widths(&self) -> [f64; 2] {
        let mut widths: Vec<f64> = self.paths.iter().map(|point| self.half_width(&point.by_knots[0])).collect();
        widths.sort_by(f64::total_cmp);
        [widths[widths.len() / 2], widths[widths.len() - 1]]
    }

    /// Half-width of the 95 % interval of what changes with the forces at the knots by `slope`.
    fn half_width(&self, slope: &DVector<f64>) -> f64 {
        NORMAL_97_5 * (&self.covariance * slope).dot(slope).max(0.0).sqrt()
    }

    /// What the paths look like, of which the recordings tell the sign.
    #[must_use]
    pub fn shape(&self) -> Shape {
        let shape = shape(&self.paths);
        let slope = |[way_in, way_out]: &[DVector<f64>; 2]| way_in - way_out;
        let fall = |softening: &Softening| {
            let [top, bottom] = softening.at.map(|at| &self.paths[at].by_knots[0]);
            self.half_width(&(top - bottom))
        };
        let loops = self.paths.iter().map(|point| slope(&point.by_knots));
        let mean = loops.sum::<DVector<f64>>() / self.paths.len() as f64;
        Shape {
            softening: shape.softening.filter(|softening| softening.fall > fall(softening)),
            loop_force: shape.loop_force.filter(|force| force.abs() > self.half_width(&mean)),
            ..shape
        }
    }
}

/// Part of the depth before the surface over which the curve reaches: what pulls or pushes before the touch.
const BEFORE_SURFACE: f64 = 0.25;

/// Travels of a turn that are tried, of the way.
const TURNS: [f64; 2] = [0.003, 0.3];

/// Blocks of a single trial, every other of which teaches: some of them between two knots.
const BLOCKS: usize = 10 * LEARNED_KNOTS;

/// Points of a path.
const POINTS: usize = 120;

/// The element that takes most of what `law` leaves; `None` where unseen rows do not pay for it.
///
/// The forces at the knots are a penalised spline (P. H. C. Eilers, B. D. Marx, *Stat. Sci.* 11, 1996): second differences from knot to knot
/// are small, by the penalty, and with the travel of a turn, that leave least on unseen rows. Of a single trial the halves lie closer
/// together than for named laws: a curve has no more to say of a depth than was seen of it.
#[must_use]
pub fn learned(data: &Data<'_>, law: &Fit) -> Option<LearnedCurve> {
    let folds = Folds::with_blocks(data, BLOCKS);
    let model = law.model.with(Term { effect: LEARNED, form: LEARNED_FORM });
    let surface = law.values[index::SURFACE];
    let [from, high] = way_below(law, BEFORE_SURFACE)?;
    let way = high - from;
    let rest: Vec<Vec<f64>> =
        (0..data.trials.len()).map(|trial| data.residual(&law.model, &law.values, trial)).collect();
    let profile = DepthProfile::of(data.trials, &rest, [from, high].map(|place| surface + place));
    let places: Vec<f64> = profile.corners(LEARNED_KNOTS).into_iter().map(|place| place - surface).collect();
    let turns = geometric(TURNS[0] * way, TURNS[1] * way, 5);
    let splines = turns.iter().map(|turn| Spline::of(data, law, &model, *turn, &places, &folds));
    let (spline, penalty, _) = splines
        .filter_map(|spline| spline.best_penalty().map(|(penalty, left)| (spline, penalty, left)))
        .min_by(|a, b| a.2.total_cmp(&b.2))?;
    let first = spline.values(penalty, Part::All)?;
    let fit = Fit { model: model.clone(), values: first, energy: 0.0 };
    let spline = spline.where_left(&Rest::of(data, &fit));
    let (penalty, _) = spline.best_penalty()?;
    let taught = [spline.values(penalty, Part::FirstHalf)?, spline.values(penalty, Part::SecondHalf)?];
    let values = spline.values(penalty, Part::All)?;
    let unseen = folds.judged(data, &model, taught);
    let held_out_share = share_that_pays(data, &folds.held_out(data, law), &unseen)?;
    let energy = energy(&data.weighted_residual(&model, &values));
    let fit = Fit { model, values, energy };
    let paths = paths(&fit, &data.trials[0], [surface + from, surface + high]);
    let covariance = spline.covariance(penalty, &Rest::of(data, &fit))?;
    Some(LearnedCurve { fit, residual: unseen.residual, held_out_share, covariance, paths })
}

/// Share of the power above the noise that an element takes of unseen rows, where it leaves `unseen` and the law without it `left`; `None` where they do not pay for it.
pub(super) fn share_that_pays(data: &Data<'_>, left: &HeldOut, unseen: &HeldOut) -> Option<f64> {
    // Where next to nothing is above the noise, a share of that says nothing: what would not be notable counts as the least.
    let expected = data.expected();
    let above = (left.energy - expected).max(((NOTABLE_POWER - 1.0) * expected).value());
    let share = (left.energy - unseen.energy) / above;
    // By weight, and as it is told: in newtons.
    let pays = share >= LEAST_HELD_OUT_SHARE && rms(data, &unseen.residual) < rms(data, &left.residual);
    pays.then_some(share.min(1.0))
}

/// In from `ends[0]` to `ends[1]` and out again, so slowly that nothing asks for the speed.
fn paths(fit: &Fit, like: &ContactTrial, ends: [f64; 2]) -> Vec<PathPoint> {
    let way_in: Vec<f64> =
        (0..POINTS).map(|at| ends[0] + (ends[1] - ends[0]) * at as f64 / (POINTS - 1) as f64).collect();
    let position: Vec<f64> = way_in.iter().chain(way_in.iter().rev()).copied().collect();
    let rows = position.len();
    let zeros = vec![0.0; rows];
    // The time that the recording takes: what a memory makes of it is part of the path.
    let step = like.duration_s() / rows as f64;
    let trial = ContactTrial {
        time: (0..rows).map(|row| row as f64 * step).collect(),
        step_s: step,
        position,
        velocity: zeros.clone(),
        acceleration: zeros.clone(),
        force: zeros,
        ..like.clone()
    };
    let force = fit.model.predicted(&fit.values, &trial, 0);
    let knots = fit.values.len() - 2 * LEARNED_KNOTS;
    // The force is linear in them: any step does.
    let step = 1e-2 * fit.model.scales.force;
    let moved: Vec<Vec<f64>> = (knots..fit.values.len())
        .map(|at| {
            let mut values = fit.values.clone();
            values[at] += step;
            fit.model.predicted(&values, &trial, 0)
        })
        .collect();
    let by_knots = |row: usize| DVector::from_fn(moved.len(), |at, _| (moved[at][row] - force[row]) / step);
    let surface = fit.values[index::SURFACE];
    let point = |(at, place): (usize, &f64)| {
        let rows = [at, rows - 1 - at];
        PathPoint { depth: place - surface, force: rows.map(|row| force[row]), by_knots: rows.map(by_knots) }
    };
    way_in.iter().enumerate().map(point).collect()
}

/// What the paths look like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Where the force falls most while the tool goes on in; `None` where it nowhere does.
    pub softening: Option<Softening>,
    /// By how much the way out lies below the way in, mean over the depth; `None` where it does not.
    pub loop_force: Option<f64>,
    /// Range of the force on the way in.
    pub range: f64,
}

/// A force that falls while the tool goes on in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Softening {
    /// Points of the path between which it does.
    pub at: [usize; 2],
    /// Their depths.
    pub between: [f64; 2],
    /// By how much, N or N m.
    pub fall: f64,
}

/// The shape of `paths`.
fn shape(paths: &[PathPoint]) -> Shape {
    let count = paths.len().max(1) as f64;
    let mean = paths.iter().map(|PathPoint { force: [into, out], .. }| into - out).sum::<f64>() / count;
    let way_in = || paths.iter().map(|point| point.force[0]);
    let (low, high) =
        way_in().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), force| (low.min(force), high.max(force)));
    // The largest fall from any force before.
    let mut top = 0;
    let mut softening: Option<Softening> = None;
    for (at, force) in way_in().enumerate() {
        if force >= paths[top].force[0] {
            top = at;
        }
        let fall = paths[top].force[0] - force;
        if fall > softening.map_or(0.0, |most| most.fall) {
            softening = Some(Softening { at: [top, at], between: [top, at].map(|at| paths[at].depth), fall });
        }
    }
    Shape { softening, loop_force: (mean != 0.0).then_some(mean), range: high - low }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{FORCE_NOISE, TestContact};
    use super::*;
    use crate::diagnose::contact::nominal::nominal_fit;
    use crate::recording::Recording;

    #[test]
    fn a_pocket_and_another_way_back_are_read_from_the_paths() {
        let paths: Vec<PathPoint> = (0..=100)
            .map(|at| {
                let depth = f64::from(at) / 100.0;
                let into = if depth < 0.4 { depth } else { 0.8 - depth };
                PathPoint {
                    depth,
                    force: [if depth < 0.6 { into } else { depth - 0.4 }, depth - 0.7],
                    ..PathPoint::default()
                }
            })
            .collect();
        let Shape { softening: Some(Softening { between: [from, to], fall, .. }), loop_force: Some(mean), range } =
            shape(&paths)
        else {
            panic!()
        };
        // From 0.4 at 0.4 to 0.2 at 0.6, and a hundredth of a step either way.
        assert!(
            (from - 0.4).abs() < 0.015 && (to - 0.6).abs() < 0.015 && (fall - 0.2).abs() < 0.025,
            "{from} {to} {fall}"
        );
        assert!(mean > 0.3 && range > 0.55);
    }

    #[test]
    fn a_line_neither_softens_nor_returns_elsewhere() {
        let point = |depth: f64| PathPoint { depth, force: [2.0 * depth; 2], ..PathPoint::default() };
        let paths: Vec<PathPoint> = (0..50).map(|at| point(f64::from(at))).collect();
        let shape = shape(&paths);
        assert_eq!((shape.softening, shape.loop_force), (None, None));
    }

    /// Recordings of a spring with a pocket that no law of the list has, in as far as each goes on.
    fn with_a_pocket(seeds: [u64; 2], goes_on: impl Fn(&Recording) -> usize) -> Vec<ContactTrial> {
        let pocket = |x: f64| if x > 0.0 { -0.5 * (-((x - 4e-3) / 1e-3).powi(2)).exp() } else { 0.0 };
        let trial = |seed: u64| {
            let mut recording = TestContact::PLAIN.recording(seed);
            let rows = goes_on(&recording);
            let Recording { time, position, force, .. } = &mut recording;
            [time, position, force.as_mut().unwrap()].into_iter().for_each(|column| column.truncate(rows));
            let mut trial = TestContact::seen(&recording);
            let added: Vec<f64> = trial.position.iter().map(|x| pocket(*x)).collect();
            trial.force.iter_mut().zip(added).for_each(|(force, pocket)| *force += pocket);
            trial
        };
        seeds.map(trial).to_vec()
    }

    /// A pocket that no law of the list has: the curve takes what a spring leaves, on the trial that taught nothing.
    #[test]
    fn a_pocket_is_learned_from_one_trial_and_found_in_the_other() {
        let trials = with_a_pocket([1, 2], |recording| recording.time.len());
        let data = Data::new(&trials);
        let law = nominal_fit(&data, &TestContact::nominal());
        let curve = learned(&data, &law).unwrap();
        // Straight lines between knots half a millimetre apart follow a pocket of a millimetre to a fortieth of its height: 12 mN of 0.5 N.
        assert!(curve.held_out_share > 0.9, "{}", curve.held_out_share);
        let rest = rms(&data, &curve.residual);
        assert!(rest < 1.2 * FORCE_NOISE, "{rest}");
        let ends = Learned::OverDepth(curve.clone()).intervals(&vec![[0.0; 2]; law.values.len()]);
        let forces = curve.fit.values.len() - 2 * LEARNED_KNOTS;
        let [usual, most] = curve.half_widths();
        // 6000 rows over some twenty knots in 8 mm: 0.02 N / sqrt(300), twice.
        assert!((1e-3..6e-3).contains(&usual) && usual < most, "{usual} {most}");
        let [low, high] = ends[forces + LEARNED_KNOTS / 2];
        assert!(
            low < curve.fit.values[forces + LEARNED_KNOTS / 2] && curve.fit.values[forces + LEARNED_KNOTS / 2] < high
        );
        let Softening { between: [from, to], fall, .. } = curve.shape().softening.unwrap();
        assert!((2e-3..4.5e-3).contains(&from) && (3e-3..6e-3).contains(&to) && fall > 0.02, "{from} {to} {fall}");
    }

    /// Of a tool that goes in and never comes out the way back is not known, and nothing is told of it.
    #[test]
    fn without_a_way_out_there_is_no_loop() {
        let deepest = |recording: &Recording| recording.position.iter().take_while(|x| **x < 7e-3).count();
        let trials = with_a_pocket([1, 2], deepest);
        let data = Data::new(&trials);
        let law = nominal_fit(&data, &TestContact::nominal());
        let curve = learned(&data, &law).unwrap();
        let shape = curve.shape();
        assert_eq!(shape.loop_force, None);
        let fall = shape.softening.unwrap().fall;
        // From 0.72 N at 2.8 mm to 0.65 N at 3.7 mm; either end by the lines between knots, as above.
        assert!((fall - 0.07).abs() < 0.025, "{fall}");
        let half = &curve.fit.values[curve.fit.values.len() - LEARNED_KNOTS..];
        let largest = half.iter().fold(0.0f64, |most, force| most.max(force.abs()));
        assert!(largest < curve.fit.model.scales.force, "{half:?}");
    }

    #[test]
    fn where_nothing_is_left_nothing_is_learned() {
        let trials = [1, 2].map(|seed| TestContact::PLAIN.trial(seed)).to_vec();
        let data = Data::new(&trials);
        let law = nominal_fit(&data, &TestContact::nominal());
        assert!(learned(&data, &law).is_none(), "noise does not pay on unseen rows");
    }
}
