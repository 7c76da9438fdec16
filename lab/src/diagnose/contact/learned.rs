//! What no law of the list explains, learned as a curve over depth and direction, and told in words.

use super::criteria::{LEAST_HELD_OUT_SHARE, NOTABLE_POWER};
use super::fit::{Data, Fit, Rest};
use super::held_out::{Folds, rms};
use super::model::index;
use super::spline::{Part, Spline};
use super::trial::ContactTrial;
use crate::diagnose::interval::NORMAL_97_5;
use crate::diagnose::linalg::energy;
use crate::diagnose::term::Term;
use crate::effects::{LEARNED, LEARNED_FORM, LEARNED_KNOTS, geometric};

/// A law with a learned element behind its other terms.
#[derive(Debug, Clone)]
pub struct LearnedCurve {
    /// The law, the element last.
    pub fit: Fit,
    /// What it leaves of rows that taught nothing, N or N m, a column a trial.
    pub residual: Vec<Vec<f64>>,
    /// Share of the power above the noise that it takes there of what the law without it leaves.
    pub held_out_share: f64,
    /// Deviation of the force at each knot: of the mean at all of them, and of the loop.
    pub deviations: Vec<f64>,
    /// Paths in and out by the law with it, from shallow to deep: depth, force on the way in, force on the way out.
    pub paths: Vec<[f64; 3]>,
}

impl LearnedCurve {
    /// 95 % interval of each value of the fit, where `law` are those of the law's.
    #[must_use]
    pub fn intervals(&self, law: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let values = &self.fit.values;
        let forces = values.len() - self.deviations.len();
        let mut ends: Vec<[f64; 2]> = law.to_vec();
        ends.extend(values[law.len()..forces].iter().map(|value| [*value; 2]));
        let of_force = |(value, deviation): (&f64, &f64)| {
            let half = NORMAL_97_5 * deviation;
            [value - half, value + half]
        };
        ends.extend(values[forces..].iter().zip(&self.deviations).map(of_force));
        ends
    }

    /// Half-width of the 95 % interval of the force midway between the paths, N or N m: the median over the knots, and the greatest.
    #[must_use]
    pub fn half_widths(&self) -> [f64; 2] {
        let mut mean: Vec<f64> = self.deviations[..LEARNED_KNOTS].to_vec();
        mean.sort_by(f64::total_cmp);
        [LEARNED_KNOTS / 2, LEARNED_KNOTS - 1].map(|at| NORMAL_97_5 * mean[at])
    }
}

/// Share of what is left on unseen rows from which a curve is worth having: that of a named effect.
const LEAST_SHARE: f64 = LEAST_HELD_OUT_SHARE;

/// Part of the depth before the surface over which the curve reaches: what pulls or pushes before the touch.
const BEFORE_SURFACE: f64 = 0.25;

/// Travels of a turn that are tried, of the way.
const TURNS: [f64; 2] = [0.003, 0.3];

/// Stretches of the way that the force's mean is taken over.
const BINS: usize = 300;

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
    let [low, high] = model.scales.positions.map(|position| position - surface);
    let from = if model.bilateral { low } else { low.max(-BEFORE_SURFACE * high.max(0.0)) };
    let way = high - from;
    if !way.is_finite() || way <= 0.0 {
        return None;
    }
    let places = places(data.trials, surface, [from, high]);
    let turns = geometric(TURNS[0] * way, TURNS[1] * way, 5);
    let splines = turns.iter().map(|turn| Spline::of(data, law, &model, *turn, &places, &folds));
    let (spline, penalty, _) = splines
        .filter_map(|spline| spline.best_penalty().map(|(penalty, left)| (spline, penalty, left)))
        .min_by(|a, b| a.2.total_cmp(&b.2))?;
    let taught = [spline.values(penalty, Part::FirstHalf)?, spline.values(penalty, Part::SecondHalf)?];
    let values = spline.values(penalty, Part::All)?;
    let (left, unseen) = (folds.held_out(data, law), folds.judged(data, &model, taught));
    // Where next to nothing is above the noise, a share of that says nothing: what would not be notable counts as the least.
    let expected = data.expected();
    let above = (left.energy - expected).max((NOTABLE_POWER - 1.0) * expected);
    let held_out_share = (left.energy - unseen.energy) / above;
    // By weight, and as it is told: in newtons.
    if held_out_share < LEAST_SHARE || rms(data, &unseen.residual) >= rms(data, &left.residual) {
        return None;
    }
    let energy = energy(&data.weighted_residual(&model, &values));
    let fit = Fit { model, values, energy };
    let paths = paths(&fit, &data.trials[0], [surface + from, surface + high]);
    let deviations = spline.deviations(penalty, &Rest::of(data, &fit))?;
    Some(LearnedCurve { fit, residual: unseen.residual, held_out_share: held_out_share.min(1.0), paths, deviations })
}

/// Where the knots lie between `ends`, from `surface` inwards: half of them as the way, half as the force goes, so that a stop that is
/// steep has as many as a spring that is long.
fn places(trials: &[ContactTrial], surface: f64, ends: [f64; 2]) -> Vec<f64> {
    let bin = (ends[1] - ends[0]) / BINS as f64;
    let mut sums = vec![(0.0, 0usize); BINS];
    for trial in trials {
        for (position, force) in trial.position.iter().zip(&trial.force) {
            let at = (position - surface - ends[0]) / bin;
            if at >= 0.0 {
                let (sum, count) = &mut sums[(at as usize).min(BINS - 1)];
                (*sum, *count) = (*sum + force, *count + 1);
            }
        }
    }
    let mut force = 0.0;
    let mut changes: Vec<f64> = Vec::with_capacity(BINS);
    for (at, (sum, count)) in sums.into_iter().enumerate() {
        let mean = if count > 0 { sum / count as f64 } else { force };
        changes.push(if at == 0 { 0.0 } else { (mean - force).abs() });
        force = mean;
    }
    let total = changes.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let mut places = vec![ends[0]];
    let mut done = 0.0;
    for (at, change) in changes.iter().enumerate() {
        done += 0.5 * (change / total + 1.0 / BINS as f64);
        if places.len() < LEARNED_KNOTS - 1 && done * (LEARNED_KNOTS - 1) as f64 >= places.len() as f64 {
            places.push(ends[0] + (at as f64 + 1.0) * bin);
        }
    }
    // A force that leaps within one bin would leave knots over: they share the last stretch.
    let last = places[places.len() - 1];
    let left = LEARNED_KNOTS - places.len();
    places.extend((1..=left).map(|nth| last + (ends[1] - last) * nth as f64 / left as f64));
    places
}

/// In from `ends[0]` to `ends[1]` and out again, so slowly that nothing asks for the speed.
fn paths(fit: &Fit, like: &ContactTrial, ends: [f64; 2]) -> Vec<[f64; 3]> {
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
    let surface = fit.values[index::SURFACE];
    way_in.iter().enumerate().map(|(at, place)| [place - surface, force[at], force[rows - 1 - at]]).collect()
}

/// What the paths look like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Where the force falls while the tool goes on in: from, to, and by how much; `None` where it nowhere does.
    pub softening: Option<[f64; 3]>,
    /// By how much the way out lies below the way in, mean over the depth, and root mean square about that mean.
    pub loop_force: [f64; 2],
    /// Range of the force on the way in.
    pub range: f64,
}

/// The shape of `paths`.
#[must_use]
pub fn shape(paths: &[[f64; 3]]) -> Shape {
    let count = paths.len().max(1) as f64;
    let mean = paths.iter().map(|[_, into, out]| into - out).sum::<f64>() / count;
    let spread = (paths.iter().map(|[_, into, out]| (into - out - mean).powi(2)).sum::<f64>() / count).sqrt();
    let (low, high) =
        paths.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), row| (low.min(row[1]), high.max(row[1])));
    // The largest fall from any force before.
    let (mut top, mut softening): (Option<[f64; 3]>, Option<[f64; 3]>) = (None, None);
    for row in paths {
        if top.is_none_or(|top| row[1] >= top[1]) {
            top = Some(*row);
        }
        if let Some(top) = top {
            let fall = top[1] - row[1];
            if fall > softening.map_or(0.0, |most| most[2]) {
                softening = Some([top[0], row[0], fall]);
            }
        }
    }
    Shape { softening, loop_force: [mean, spread], range: high - low }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{FORCE_NOISE, TestContact};
    use super::*;
    use crate::diagnose::contact::nominal::nominal_fit;

    #[test]
    fn a_pocket_and_another_way_back_are_read_from_the_paths() {
        let paths: Vec<[f64; 3]> = (0..=100)
            .map(|at| {
                let depth = f64::from(at) / 100.0;
                let into = if depth < 0.4 { depth } else { 0.8 - depth };
                [depth, if depth < 0.6 { into } else { depth - 0.4 }, depth - 0.7]
            })
            .collect();
        let Shape { softening: Some([from, to, fall]), loop_force: [mean, _], range } = shape(&paths) else { panic!() };
        // From 0.4 at 0.4 to 0.2 at 0.6, and a hundredth of a step either way.
        assert!(
            (from - 0.4).abs() < 0.015 && (to - 0.6).abs() < 0.015 && (fall - 0.2).abs() < 0.025,
            "{from} {to} {fall}"
        );
        assert!(mean > 0.3 && range > 0.55);
    }

    #[test]
    fn a_line_neither_softens_nor_returns_elsewhere() {
        let paths: Vec<[f64; 3]> =
            (0..50).map(|at| [f64::from(at), 2.0 * f64::from(at), 2.0 * f64::from(at)]).collect();
        let shape = shape(&paths);
        assert_eq!((shape.softening, shape.loop_force), (None, [0.0, 0.0]));
    }

    /// A pocket that no law of the list has: the curve takes what a spring leaves, on the trial that taught nothing.
    #[test]
    fn a_pocket_is_learned_from_one_trial_and_found_in_the_other() {
        let trials: Vec<ContactTrial> = [1, 2]
            .map(|seed| {
                let mut trial = TestContact::PLAIN.trial(seed);
                let pocket = |x: f64| if x > 0.0 { -0.5 * (-((x - 4e-3) / 1e-3).powi(2)).exp() } else { 0.0 };
                let added: Vec<f64> = trial.position.iter().map(|x| pocket(*x)).collect();
                trial.force.iter_mut().zip(added).for_each(|(force, pocket)| *force += pocket);
                trial
            })
            .to_vec();
        let data = Data::new(&trials);
        let law = nominal_fit(&data, &TestContact::nominal());
        let curve = learned(&data, &law).unwrap();
        // Straight lines between knots half a millimetre apart follow a pocket of a millimetre to a fortieth of its height: 12 mN of 0.5 N.
        assert!(curve.held_out_share > 0.9, "{}", curve.held_out_share);
        let rest = rms(&data, &curve.residual);
        assert!(rest < 1.2 * FORCE_NOISE, "{rest}");
        let ends = curve.intervals(&vec![[0.0; 2]; law.values.len()]);
        let forces = curve.fit.values.len() - 2 * LEARNED_KNOTS;
        let [usual, most] = curve.half_widths();
        // 6000 rows over some twenty knots in 8 mm: 0.02 N / sqrt(300), twice.
        assert!((1e-3..6e-3).contains(&usual) && usual < most, "{usual} {most}");
        let [low, high] = ends[forces + LEARNED_KNOTS / 2];
        assert!(
            low < curve.fit.values[forces + LEARNED_KNOTS / 2] && curve.fit.values[forces + LEARNED_KNOTS / 2] < high
        );
        let [from, to, fall] = shape(&curve.paths).softening.unwrap();
        assert!((2e-3..4.5e-3).contains(&from) && (3e-3..6e-3).contains(&to) && fall > 0.02, "{from} {to} {fall}");
    }

    #[test]
    fn where_nothing_is_left_nothing_is_learned() {
        let trials = [1, 2].map(|seed| TestContact::PLAIN.trial(seed)).to_vec();
        let data = Data::new(&trials);
        let law = nominal_fit(&data, &TestContact::nominal());
        assert!(learned(&data, &law).is_none(), "noise does not pay on unseen rows");
    }
}
