//! Which waves in time the motion of the tool keeps step with: those are not told from a law of place and direction.

use std::ops::Range;

use nalgebra::{Matrix2, Matrix4, RowVector4, Vector4};

use super::criteria::{LARGEST_SHARE_IN_STEP, LEAST_PART_OF_OWN_WAVE, OWN_LINE};
use super::data::Data;
use super::fit::Fit;
use super::trial::ContactTrial;
use crate::diagnose::ends::ends;

/// Depths that rows are grouped by, each way and at rest.
const DEPTHS: usize = 20;

/// Part of the speed in root mean square below which a tool is at rest.
const AT_REST: f64 = 0.1;

/// Ways of a tool: out, at rest, in.
const WAYS: usize = 3;

/// Whether a wave of `frequency`, Hz, in contact is one of place and direction along the trials of `data`, whose surface `fit` has: whether
/// of the wave's variance, of the phase at which it is most, more than [`LARGEST_SHARE_IN_STEP`] lies between groups of rows of one depth
/// and one way (the correlation ratio: K. Pearson 1905). Strokes that repeat with the wave's period show one phase at each of them, and
/// a law of the motion could be all of it; holds, sweeps and strokes of another period show all. A hold stays one where the wave itself moves the tool.
#[must_use]
pub fn is_in_step(data: &Data<'_>, fit: &Fit, frequency: f64) -> bool {
    let trials = data.trials.iter().enumerate();
    let shares = trials.filter_map(|(number, trial)| {
        let surface = (!fit.model.bilateral).then(|| fit.model.surface(&fit.values, number));
        let groups = groups(trial, surface, frequency);
        let rows = groups.iter().flatten().count();
        Some((rows as f64, largest_share(trial, &groups, frequency)?))
    });
    let (rows, share) = shares.fold((0.0, 0.0), |(rows, sum), (own, share)| (rows + own, sum + own * share));
    share > LARGEST_SHARE_IN_STEP * rows
}

/// Lines of the spectrum beside one that are looked at with it, past the window's own width of two.
const BESIDE: [f64; 4] = [-4.0, -3.0, 3.0, 4.0];

/// Whether `fit` has a surface that moves as a line of the tool's own motion does, by less than [`LEAST_PART_OF_OWN_WAVE`] of it: that is a law of the motion
/// which is wrong at that frequency.
#[must_use]
pub fn is_of_the_tool(data: &Data<'_>, fit: &Fit) -> bool {
    let terms = fit.model.terms.iter().enumerate().filter(|(_, term)| term.name() == "surface_motion");
    terms.into_iter().any(|(at, term)| {
        let Some(named) = term.parameters().iter().position(|parameter| parameter.name == "frequency") else {
            return false;
        };
        let all = &fit.values[fit.model.first_value_of(at)..];
        let (mut wave, mut own, mut beside) = (0.0, 0.0, 0.0);
        for (number, trial) in data.trials.iter().enumerate() {
            let values = term.in_trial(all, number);
            let duration = trial.duration_s().max(f64::MIN_POSITIVE);
            wave +=
                values.iter().enumerate().filter(|(nth, _)| *nth != named).map(|(_, value)| value * value).sum::<f64>();
            own += line_power(trial, values[named]);
            let others = BESIDE.iter().map(|lines| line_power(trial, values[named] + lines / duration));
            beside += others.sum::<f64>() / BESIDE.len() as f64;
        }
        let squared = |factor: f64| factor * factor;
        own > squared(OWN_LINE.value()) * beside && wave < squared(LEAST_PART_OF_OWN_WAVE.value()) * own
    })
}

/// Square of the size of the wave of `frequency`, Hz, in the position of `trial`, through a raised cosine.
fn line_power(trial: &ContactTrial, frequency: f64) -> f64 {
    let (rows, first, duration) =
        (trial.len().max(1) as f64, trial.time.first().copied().unwrap_or(0.0), trial.duration_s());
    let mean = trial.position.iter().sum::<f64>() / rows;
    let (mut sum, mut weights) = ([0.0; 2], 0.0);
    for (time, position) in trial.time.iter().zip(&trial.position) {
        let weight = 1.0 - (std::f64::consts::TAU * (time - first) / duration.max(f64::MIN_POSITIVE)).cos();
        let (sine, cosine) = (std::f64::consts::TAU * frequency * time).sin_cos();
        sum[0] += weight * (position - mean) * sine;
        sum[1] += weight * (position - mean) * cosine;
        weights += weight;
    }
    4.0 * (sum[0] * sum[0] + sum[1] * sum[1]) / (weights * weights).max(f64::MIN_POSITIVE)
}

/// The group of each row of `trial` beside a wave of `frequency`, Hz; `None` of a row before the `surface`.
fn groups(trial: &ContactTrial, surface: Option<f64>, frequency: f64) -> Vec<Option<usize>> {
    let is_inside = |place: f64| surface.is_none_or(|surface| place > surface);
    let inside = || (0..trial.len()).filter(|row| is_inside(trial.position[*row]));
    let [lowest, deepest] = ends(inside().map(|row| trial.position[row]));
    let square = inside().map(|row| trial.velocity[row].powi(2)).sum::<f64>() / inside().count().max(1) as f64;
    let rest = AT_REST * square.sqrt();
    let is_pushed = pushed(trial, &is_inside, (deepest - lowest) / DEPTHS as f64, frequency);
    let group = |row: usize| {
        let depth = (trial.position[row] - lowest) / (deepest - lowest).max(f64::MIN_POSITIVE);
        let way = match trial.velocity[row] {
            _ if is_pushed[row] => 1,
            speed if speed < -rest => 0,
            speed if speed > rest => 2,
            _ => 1,
        };
        WAYS * ((depth * DEPTHS as f64) as usize).min(DEPTHS - 1) + way
    };
    (0..trial.len()).map(|row| is_inside(trial.position[row]).then(|| group(row))).collect()
}

/// Periods of a stretch that is looked at as a whole.
const PERIODS: f64 = 2.0;

/// Fewest rows of it: a line and a wave have four values.
const FEWEST_ROWS: usize = 12;

/// Whether each row lies in a stretch of two periods of `frequency`, Hz, over which the tool stays `inside` and goes no farther than `nearest`, m or rad,
/// and in which it is less deep where the force is greater. A surface that rests pushes back the more the deeper the tool is, unless its spring falls; a
/// tool that is held softly gives way to one that moves.
fn pushed(trial: &ContactTrial, is_inside: &dyn Fn(f64) -> bool, nearest: f64, frequency: f64) -> Vec<bool> {
    let mut is_pushed = vec![false; trial.len()];
    let period = 1.0 / frequency;
    let (first, last) = (trial.time.first().copied().unwrap_or(0.0), trial.time.last().copied().unwrap_or(0.0));
    for nth in 0..((last - first) / period) as usize {
        let from = first + nth as f64 * period;
        let [start, end] = [from, from + PERIODS * period].map(|end| trial.time.partition_point(|time| *time < end));
        let own = &trial.position[start..end];
        let [low, high] = ends(own.iter().copied());
        let stays = own.len() >= FEWEST_ROWS && high - low <= nearest && is_inside(low);
        if stays && gives_way(trial, start..end, frequency) {
            is_pushed[start..end].fill(true);
        }
    }
    is_pushed
}

/// Whether of the waves of `frequency`, Hz, in position and force of `rows`, each beside a straight line, one is against the other.
fn gives_way(trial: &ContactTrial, rows: Range<usize>, frequency: f64) -> bool {
    let mut normal = Matrix4::zeros();
    let (mut of_position, mut of_force) = (Vector4::zeros(), Vector4::zeros());
    let origin = trial.time[rows.start];
    for row in rows {
        let time = trial.time[row] - origin;
        let (sine, cosine) = (std::f64::consts::TAU * frequency * time).sin_cos();
        let regressors = RowVector4::new(1.0, time * frequency, sine, cosine);
        normal += regressors.transpose() * regressors;
        of_position += regressors.transpose() * trial.position[row];
        of_force += regressors.transpose() * trial.force[row];
    }
    let Some(solve) = normal.cholesky() else { return false };
    let [position, force] = [solve.solve(&of_position), solve.solve(&of_force)];
    position[2] * force[2] + position[3] * force[3] < 0.0
}

/// Largest share of a wave's variance that lies between groups, over all its phases; `None` where there are no rows.
fn largest_share(trial: &ContactTrial, groups: &[Option<usize>], frequency: f64) -> Option<f64> {
    let mut sums = vec![(0.0, [0.0; 2]); WAYS * DEPTHS];
    let mut squares = Matrix2::zeros();
    for (time, group) in trial.time.iter().zip(groups) {
        let Some(group) = group else { continue };
        let (sine, cosine) = (std::f64::consts::TAU * frequency * time).sin_cos();
        sums[*group].0 += 1.0;
        sums[*group].1[0] += sine;
        sums[*group].1[1] += cosine;
        squares += Matrix2::new(sine * sine, sine * cosine, sine * cosine, cosine * cosine);
    }
    let of_mean = |(count, [sine, cosine]): &(f64, [f64; 2])| {
        Matrix2::new(sine * sine, sine * cosine, sine * cosine, cosine * cosine) / f64::max(*count, 1.0)
    };
    let all = sums
        .iter()
        .fold((0.0, [0.0; 2]), |(count, sum), (own, [sine, cosine])| (count + own, [sum[0] + sine, sum[1] + cosine]));
    let mean = of_mean(&all);
    let between = sums.iter().map(of_mean).sum::<Matrix2<f64>>() - mean;
    // The greater root of between - share (squares - mean).
    let ratio = (squares - mean).try_inverse()? * between;
    let (half, product) = (0.5 * ratio.trace(), ratio.determinant());
    let largest = half + (half * half - product).max(0.0).sqrt();
    largest.is_finite().then(|| largest.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::super::nominal::nominal_fit;
    use super::super::testing::TestContact;
    use super::*;

    /// Whether a wave of `frequency` is in step with the test's tool where it goes as `depth` says, on a spring whose surface is where `surface` says.
    fn is_in_step_on(surface: impl Fn(f64) -> f64, depth: impl Fn(f64) -> f64, frequency: f64) -> bool {
        let mut trial = TestContact::PLAIN.trial(1);
        for row in 0..trial.len() {
            let time = trial.time[row];
            trial.position[row] = depth(time);
            trial.velocity[row] = (depth(time + 1e-4) - depth(time - 1e-4)) / 2e-4;
            trial.force[row] = (TestContact::PLAIN.stiffness * (depth(time) - surface(time))).max(0.0);
        }
        let trials = [trial];
        let data = Data::new(&trials);
        is_in_step(&data, &nominal_fit(&data, &TestContact::nominal()), frequency)
    }

    fn is_in_step_with(depth: impl Fn(f64) -> f64, frequency: f64) -> bool {
        is_in_step_on(|_| 0.0, depth, frequency)
    }

    #[test]
    fn a_wave_is_in_step_with_strokes_of_its_period_and_not_with_holds_or_sweeps() {
        let wave = 0.6;
        let strokes = |every: f64| move |t: f64| 3e-3 * (1.0 - (std::f64::consts::TAU * t / every).cos());
        assert!(is_in_step_with(strokes(1.0 / wave), wave));
        assert!(is_in_step_with(strokes(2.0 / wave), wave), "two waves a stroke");
        assert!(!is_in_step_with(strokes(0.37), wave));
        let sweep = |t: f64| 3e-3 * (1.0 - (std::f64::consts::TAU * (0.3 + 0.1 * t) * t).cos());
        assert!(!is_in_step_with(sweep, wave));
        // Three depths, each held for four seconds: slow motion is loud at the wave's frequency, and tells it all the same.
        let steps = |t: f64| 2e-3 * (1.0 + [0.0, 2.0, 1.0][((t / 4.0) as usize).min(2)]);
        assert!(!is_in_step_with(steps, wave));
    }

    /// The size of a wave is that of the tool's, and what lies beside it is none of it.
    #[test]
    fn a_line_of_the_motion_has_its_size_and_leaves_what_is_beside_it() {
        let mut trial = TestContact::PLAIN.trial(1);
        let wave = |t: f64| 2e-3 * (std::f64::consts::TAU * 0.9 * t + 0.4).sin();
        trial.position = trial.time.iter().map(|t| 5e-3 + wave(*t)).collect();
        // `n` lines away a raised cosine leaves no more than 1 / (pi n (n^2 - 1)) of a wave: four away 1 / 188, and of that of the negative frequency, 20 away, 1 / 25 000.
        assert!((line_power(&trial, 0.9).sqrt() / 2e-3 - 1.0).abs() < 1e-3);
        assert!(line_power(&trial, 0.9 + 4.0 / trial.duration_s()).sqrt() < 2e-3 / 188.0);
    }

    /// A tool that goes by three waves: a surface that moves by a hundredth of one of them, and as one of them, is a spring that is wrong there; by half of it, or
    /// between them, it moves.
    #[test]
    fn a_surface_that_moves_as_the_tool_does_is_a_law_of_the_tool() {
        use super::super::super::term::Term;
        let trials = [1, 2].map(|seed| {
            let mut trial = TestContact::PLAIN.trial(seed);
            let wave = |hz: f64, t: f64| 2e-3 * (std::f64::consts::TAU * hz * t).sin();
            trial.position = trial.time.iter().map(|t| 6e-3 + wave(0.31, *t) + wave(0.9, *t) + wave(3.1, *t)).collect();
            trial
        });
        let data = Data::new(&trials);
        let nominal = nominal_fit(&data, &TestContact::nominal());
        let effect = crate::effects::find("surface_motion").unwrap();
        let is = |part: f64, frequency: f64| {
            let term = Term { effect, form: 0 };
            let own = term.spread(&[0.6 * part * 2e-3, 0.8 * part * 2e-3, frequency], trials.len());
            let values = nominal.values.iter().copied().chain(own).collect();
            is_of_the_tool(&data, &Fit { model: nominal.model.with(term), values, ..nominal.clone() })
        };
        assert!(is(0.01, 0.9) && is(0.2, 0.9) && is(0.01, 3.1));
        assert!(!is(0.5, 0.9) && !is(0.01, 1.7) && !is(f64::NAN, 0.9));
        assert!(!is_of_the_tool(&data, &nominal));
    }

    /// Four depths, each held for two and a half seconds by a tool that a pulse of 0.8 mm moves by a tenth of a millimetre: whichever way it goes tells the
    /// wave's phase. The same motion of a tool that goes so by itself is a law's.
    #[test]
    fn a_hold_that_the_wave_itself_moves_is_a_hold() {
        let pulse = |t: f64| (std::f64::consts::TAU * 1.25 * t).sin();
        let stairs = |t: f64| {
            let (hold, within) = (((t / 3.0) as usize).min(3), t % 3.0);
            let [from, to] = [hold, hold + 1].map(|hold| 2e-3 * [1.0, 3.0, 2.0, 4.0, 4.0][hold]);
            from + (to - from) * ((within - 2.5) / 0.5).max(0.0)
        };
        let held = |t: f64| stairs(t) + 1e-4 * pulse(t);
        assert!(!is_in_step_on(|t| 8e-4 * pulse(t), held, 1.25));
        assert!(is_in_step_with(held, 1.25));
    }
}
