//! Two bodies along a trial, corrected at each encoder row: an extended Kalman filter whose transition is that of the free or of the
//! coupled pair.

use super::innovations::Innovations;
use super::input::Inputs;
use super::law::{Acting, DriveLaw, Link, Side};
use super::matrix::{Matrix, exponential, identity, product, propagated, transposed_product};
use super::noise::Noise;
use super::presliding::Slips;
use super::trial::DriveTrial;

/// Number of states of two bodies: motor position and velocity, load position and velocity.
const STATES: usize = 4;

/// A period of the pair's own swing has at least this many substeps.
const SUBSTEPS_PER_RADIAN: f64 = 1.0 / 0.35;

/// Most substeps of a row.
const MOST_SUBSTEPS: f64 = 64.0;

/// Step lengths whose pair is kept at hand.
const REMEMBERED_PAIRS: usize = 8;

/// Share of the disturbance's density that acts on the load: without any the filter would trust its load for ever.
const LOAD_DENSITY_SHARE: f64 = 1e-4;

/// The pair over one step length: a transition and a driving noise apart, and coupled.
struct Pair {
    step: f64,
    substeps: usize,
    /// See [`curving`]; s^2.
    curving: f64,
    transition: [Matrix<STATES>; 2],
    driving: [Matrix<STATES>; 2],
    /// State after the step for a constant force of one on the motor.
    response: [[f64; STATES]; 2],
    coupled: Coupled,
}

/// The coupled pair over a whole step, exactly: state after it for each state before it, and for a constant force of one on the motor and on
/// the load.
struct Coupled {
    transition: Matrix<STATES>,
    on_motor: [f64; STATES],
    on_load: [f64; STATES],
}

impl Coupled {
    fn new(law: &DriveLaw, link: &Link, step: f64) -> Self {
        let (motor, load) = masses(law, link);
        let rates = pair_rates(law, link, [link.stiffness, link.damping]);
        // Forces as two states that do not change.
        let mut all = [[0.0; STATES + 2]; STATES + 2];
        for (row, rates) in all.iter_mut().zip(rates) {
            row[..STATES].copy_from_slice(&rates);
        }
        (all[1][STATES], all[3][STATES + 1]) = (1.0 / motor, 1.0 / load);
        let after = exponential(&all, step);
        let of = |column: usize| std::array::from_fn(|row| after[row][column]);
        let transition = std::array::from_fn(|row| std::array::from_fn(|column| after[row][column]));
        Self { transition, on_motor: of(STATES), on_load: of(STATES + 1) }
    }

    fn after(&self, state: &[f64; STATES], [on_motor, on_load]: [f64; 2]) -> [f64; STATES] {
        std::array::from_fn(|row| {
            let free: f64 = self.transition[row].iter().zip(state).map(|(a, x)| a * x).sum();
            free + self.on_motor[row] * on_motor + self.on_load[row] * on_load
        })
    }
}

impl Pair {
    fn new(law: &DriveLaw, link: &Link, [on_motor, on_load]: [f64; 2], step: f64) -> Self {
        let (motor, load) = masses(law, link);
        let swing = (link.stiffness * (1.0 / motor + 1.0 / load)).sqrt();
        let substeps = (swing * step * SUBSTEPS_PER_RADIAN).ceil().clamp(1.0, MOST_SUBSTEPS) as usize;
        let short = step / substeps as f64;
        let regimes = [(0.0, 0.0), (link.stiffness, link.damping)];
        let both = regimes.map(|(stiffness, damping)| {
            let rates = pair_rates(law, link, [stiffness, damping]);
            let once = exponential(&rates, short);
            let mut white = [[0.0; STATES]; STATES];
            white[1][1] = on_motor / (motor * motor);
            white[3][3] = on_load / (load * load);
            // The integral of the driving noise over a substep by the trapezoid rule.
            let half = white.map(|row| row.map(|x| 0.5 * short * x));
            let driving = propagated(&once, &half, &half);
            // The same rule for a constant force: half of the velocity that it gives before the substep, half after.
            let push = |state: [f64; STATES]| -> [f64; STATES] {
                let start = [state[0], state[1] + 0.5 * short / motor, state[2], state[3]];
                let mut after: [f64; STATES] = once.map(|row| row.iter().zip(&start).map(|(a, x)| a * x).sum());
                after[1] += 0.5 * short / motor;
                after
            };
            let (mut all, mut sum, mut response) = (once, driving, push([0.0; STATES]));
            for _ in 1..substeps {
                sum = propagated(&once, &sum, &driving);
                all = product(&once, &all);
                response = push(response);
            }
            (all, sum, response)
        });
        let [apart, coupled] = both;
        Self {
            step,
            substeps,
            curving: curving(swing, short),
            transition: [apart.0, coupled.0],
            driving: [apart.1, coupled.1],
            response: [apart.2, coupled.2],
            coupled: Coupled::new(law, link, step),
        }
    }
}

/// Rates of the pair's states by each of them, through a link of `stiffness` and `damping`.
fn pair_rates(law: &DriveLaw, link: &Link, [stiffness, damping]: [f64; 2]) -> Matrix<STATES> {
    let (motor, load) = masses(law, link);
    [
        [0.0, 1.0, 0.0, 0.0],
        [-stiffness / motor, -(damping + law.viscous) / motor, stiffness / motor, damping / motor],
        [0.0, 0.0, 0.0, 1.0],
        [stiffness / load, damping / load, -stiffness / load, -(damping + link.load_viscous) / load],
    ]
}

/// What the stretch of a link has to be taken further by, over its own acceleration, s^2, for the mean of its force over a substep: with
/// the stretch in the middle alone a pair that swings by `swing` would do so too fast, sin(angle / 2) = swing step / 2 (L. Verlet, *Phys. Rev.* 159,
/// 1967, 98). With it the swing is exact, and so is a link's stretch at rest (W. Gautschi, *Numer. Math.* 3, 1961, 381).
fn curving(swing: f64, step: f64) -> f64 {
    let half = 0.5 * swing * step;
    let exact = half.sin() / half;
    (1.0 - exact * exact) / (swing * swing)
}

fn masses(law: &DriveLaw, link: &Link) -> (f64, f64) {
    let load = link.load_share * law.inertia;
    (law.inertia - load, load)
}

/// The pair after a row over which it stays coupled and its motor goes one way, exactly but for loads and friction, which are those in the middle;
/// `None` where it does not.
fn after_coupled_row(
    law: &DriveLaw,
    link: &Link,
    state: &[f64; STATES],
    [effort, force]: [f64; 2],
    pair: &Pair,
) -> Option<[f64; STATES]> {
    let side = |state: &[f64; STATES]| {
        let ahead = state[0] - state[2];
        if link.play == 0.0 || ahead.abs() >= 0.5 * link.play { ahead.signum() } else { 0.0 }
    };
    let (flank, direction) = (side(state), state[1].signum());
    if flank == 0.0 || (law.friction.acts() && state[1] == 0.0) {
        return None;
    }
    let from_play = flank * 0.5 * link.play * link.stiffness;
    let under = |position: f64, speed: f64| {
        let against = if law.friction.acts() { direction * law.friction.level(speed.abs(), force) } else { 0.0 };
        pair.coupled.after(state, [effort - law.load(position) - against + from_play, -force - from_play])
    };
    let goes_on = |after: &[f64; STATES]| {
        (!law.friction.acts() || after[1] * direction > 0.0) && (link.play == 0.0 || side(after) == flank)
    };
    let first = under(state[0] + 0.5 * pair.step * state[1], state[1]);
    if !goes_on(&first) {
        return None;
    }
    let after = under(0.5 * (state[0] + first[0]), 0.5 * (state[1] + first[1]));
    goes_on(&after).then_some(after)
}

/// The pair over a row under constant effort and force; tells whether the sides were coupled for most of it.
fn advance_pair(
    law: &DriveLaw,
    link: &Link,
    state: &mut [f64; STATES],
    slips: &mut Slips,
    input: [f64; 2],
    pair: &Pair,
) -> bool {
    if pair.substeps > 1
        && law.friction.presliding == 0.0
        && let Some(after) = after_coupled_row(law, link, state, input, pair)
    {
        *state = after;
        return true;
    }
    let (motor, load) = masses(law, link);
    let short = pair.step / pair.substeps as f64;
    let [effort, force] = input;
    let mut coupled = 0;
    for _ in 0..pair.substeps {
        let [x, v, load_x, load_v] = *state;
        let now = link.transmitted(x - load_x, v - load_v);
        // Midpoint rule; a motor that dry friction may hold is predicted to keep its velocity.
        let pushed = if law.friction.acts() { 0.0 } else { (effort - now - law.viscous * v) / motor };
        let (middle_v, middle_load_v) =
            (v + 0.5 * short * pushed, load_v + 0.5 * short * (now - force - link.load_viscous * load_v) / load);
        let ahead = x + 0.5 * short * v - load_x - 0.5 * short * load_v;
        let mid = link.transmitted(ahead, middle_v - middle_load_v);
        let is_held = law.friction.acts() && v == 0.0;
        let motor_rate = if is_held { 0.0 } else { (effort - mid - law.viscous * middle_v) / motor };
        let braked = force + link.load_viscous * middle_load_v;
        let stretch_rate = motor_rate - (mid - braked) / load;
        let passed = link.transmitted(ahead + pair.curving * stretch_rate, middle_v - middle_load_v);
        coupled += usize::from(ahead.abs() >= 0.5 * link.play);
        let acting = Acting { push: effort - passed, force, friction_factor: 1.0 };
        let [x, v] = law.advance([x, v], slips, &acting, motor, short);
        let after = load_v + short * (passed - braked) / load;
        *state = [x, v, load_x + 0.5 * short * (load_v + after), after];
    }
    2 * coupled >= pair.substeps
}

/// What is not known of the pair along a trial.
#[derive(Clone, Copy, Default)]
struct Uncertainty {
    covariance: Matrix<STATES>,
    gain: [f64; STATES],
    variance: f64,
    /// Pair and regime of the latest row.
    latest: (usize, usize),
    /// Rows since then over which the gain stood.
    steady_rows: usize,
}

/// Rows over which the gain of one pair in one regime has to stand before it is taken as steady, and its relative change. Derivatives
/// are differences over 1e-4 of a value: the gain has to be a hundred millionth of that exact.
const STEADY_ROWS: usize = 10;
const STEADY_CHANGE: f64 = 1e-12;

impl Uncertainty {
    /// Over the row of `pair`, the `at`-th, in `regime`, and its encoder row.
    fn update(&mut self, at: usize, pair: &Pair, regime: usize, measured: usize, encoder: f64) {
        if self.latest != (at, regime) {
            (self.latest, self.steady_rows) = ((at, regime), 0);
        }
        if self.steady_rows >= STEADY_ROWS {
            return;
        }
        self.covariance = propagated(&pair.transition[regime], &self.covariance, &pair.driving[regime]);
        let line = self.covariance[measured];
        self.variance = line[measured] + encoder;
        let gain = line.map(|covariance| covariance / self.variance);
        let stands = gain.iter().zip(self.gain).all(|(new, old)| (new - old).abs() <= STEADY_CHANGE * new.abs());
        self.steady_rows = if stands { self.steady_rows + 1 } else { 0 };
        for (row, gain) in self.covariance.iter_mut().zip(gain) {
            row.iter_mut().zip(line).for_each(|(value, known)| *value -= gain * known);
        }
        self.gain = gain;
    }
}

/// A row of the pair's filter, as the smoother needs it.
struct PairRow {
    gain: [f64; STATES],
    coupled: bool,
    pair: usize,
    /// The motor's lead over the load after the row, and its covariance with each state.
    stretch: f64,
    spread: [f64; STATES],
}

/// Covariance of the motor's lead over the load with each state.
fn of_stretch(covariance: &Matrix<STATES>) -> [f64; STATES] {
    std::array::from_fn(|column| covariance[0][column] - covariance[2][column])
}

/// Two bodies on `link` under `inputs`; with `smooth` the disturbance is smoothed, too.
#[must_use]
pub fn two_bodies(
    trial: &DriveTrial,
    inputs: &Inputs,
    law: &DriveLaw,
    link: Link,
    noise: &Noise,
    smooth: bool,
) -> Innovations {
    let rows = trial.len();
    let encoder = noise.encoder();
    let measured = if link.encoder == Side::Load { 2 } else { 0 };
    let mut out = Innovations {
        innovation: vec![0.0; rows],
        variance: vec![encoder; rows],
        velocity: vec![0.0; rows],
        ..Innovations::default()
    };
    let densities = [noise.disturbance(), LOAD_DENSITY_SHARE * noise.disturbance() + trial.force_density];
    let mut pairs: Vec<Pair> = Vec::new();
    let mut history: Vec<PairRow> = Vec::with_capacity(if smooth { rows } else { 0 });
    let (mut state, mut slips) = ([0.0; STATES], Slips::default());
    let mut uncertainty = Uncertainty::default();
    for row in 0..rows {
        if trial.restart[row] {
            let (position, rate) = (trial.position[row], trial.rate_after(row));
            state = [position, rate, position, rate];
            slips = Slips::default();
            let effort = inputs.effort[(row + 1).min(rows - 1)];
            uncertainty =
                Uncertainty { covariance: unknown_pair(trial, &link, encoder, effort), ..Uncertainty::default() };
            if smooth {
                let spread = of_stretch(&uncertainty.covariance);
                history.push(PairRow { gain: [0.0; STATES], coupled: true, pair: 0, stretch: 0.0, spread });
            }
            out.velocity[row] = rate;
            continue;
        }
        let step = trial.time[row] - trial.time[row - 1];
        let at = pair_of(&mut pairs, step, 1e-9 * trial.period_s, || Pair::new(law, &link, densities, step));
        let pair = &pairs[at];
        let coupled = advance_pair(law, &link, &mut state, &mut slips, [inputs.effort[row], inputs.force[row]], pair);
        let regime = usize::from(coupled);
        uncertainty.update(at, pair, regime, measured, encoder);
        let Uncertainty { gain, variance, .. } = uncertainty;
        let innovation = trial.position[row] - state[measured];
        state.iter_mut().zip(gain).for_each(|(state, gain)| *state += gain * innovation);
        law.friction.follow(&mut slips, gain[0] * innovation);
        (out.innovation[row], out.variance[row], out.velocity[row]) = (innovation, variance, state[measured + 1]);
        if smooth {
            let (stretch, spread) = (state[0] - state[2], of_stretch(&uncertainty.covariance));
            history.push(PairRow { gain, coupled, pair: at, stretch, spread });
        }
    }
    if smooth {
        [out.disturbance, out.residual, out.stretch] = smoothed_pair(trial, &link, noise, &out, &history, &pairs);
    }
    out
}

/// Place in `pairs` of the one over `step`, to `tolerance`; a new one where none of the latest is.
fn pair_of(pairs: &mut Vec<Pair>, step: f64, tolerance: f64, new: impl FnOnce() -> Pair) -> usize {
    // A clock that jitters has as many steps as rows: only the latest are looked through.
    let oldest = pairs.len().saturating_sub(REMEMBERED_PAIRS);
    let near = |pair: &Pair| (pair.step - step).abs() <= tolerance;
    pairs[oldest..].iter().position(near).map(|latest| oldest + latest).unwrap_or_else(|| {
        pairs.push(new());
        pairs.len() - 1
    })
}

/// Covariance of a pair of which only one encoder row is known: its stretch under `effort`, its place in the play, its velocity.
fn unknown_pair(trial: &DriveTrial, link: &Link, encoder: f64, effort: f64) -> Matrix<STATES> {
    let stretch = effort * link.load_share / link.stiffness;
    let speed = trial.fastest().powi(2) + f64::MIN_POSITIVE;
    let hidden = encoder + 0.25 * link.play * link.play + stretch * stretch;
    let mut covariance = identity::<STATES>();
    let (known, other) = if link.encoder == Side::Load { (2, 0) } else { (0, 2) };
    (covariance[known][known], covariance[other][other]) = (encoder, hidden);
    (covariance[1][1], covariance[3][3]) = (speed, speed);
    covariance
}

/// Disturbance smoother, as that of one body with the pair of each row; what it leaves of each encoder row; and the motor's smoothed lead
/// over the load, x + P r of each row with what all later rows say (P. de Jong, *J. Am. Stat. Assoc.* 83, 1988).
fn smoothed_pair(
    trial: &DriveTrial,
    link: &Link,
    noise: &Noise,
    pass: &Innovations,
    history: &[PairRow],
    pairs: &[Pair],
) -> [Vec<f64>; 3] {
    let measured = if link.encoder == Side::Load { 2 } else { 0 };
    let [mut force, mut residual, mut lead] = [(); 3].map(|()| vec![0.0; trial.len()]);
    let mut next = [0.0; STATES];
    for row in (0..trial.len()).rev() {
        let PairRow { gain, coupled, pair, stretch, spread } = &history[row];
        lead[row] = stretch + spread.iter().zip(&next).map(|(spread, next)| spread * next).sum::<f64>();
        if trial.restart[row] {
            next = [0.0; STATES];
            continue;
        }
        let pair = &pairs[*pair];
        let along: f64 = gain.iter().zip(&next).map(|(gain, next)| gain * next).sum();
        let mut adjoint = next;
        let weighted = pass.innovation[row] / pass.variance[row] - along;
        residual[row] = noise.encoder() * weighted;
        adjoint[measured] += weighted;
        let regime = usize::from(*coupled);
        let seen: f64 = pair.response[regime].iter().zip(&adjoint).map(|(response, adjoint)| response * adjoint).sum();
        force[row] = noise.disturbance() / pair.step * seen;
        next = transposed_product(&pair.transition[regime], &adjoint);
    }
    [force, residual, lead]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pair with the encoder on its motor, without friction.
    fn pair_law(stiffness: f64) -> (DriveLaw, Link) {
        let link =
            Link { stiffness, damping: 0.0, play: 0.0, load_share: 0.3, load_viscous: 0.0, encoder: Side::Motor };
        (DriveLaw { link: Some(link), ..DriveLaw::nominal(0.6, 0.0, 0.0) }, link)
    }

    /// Steps of a millisecond by a third of a radian of the pair's own swing each, as one substep takes.
    #[test]
    fn a_pair_swings_as_fast_as_its_link_is_stiff() {
        let (law, link) = pair_law(12_000.0);
        let pair = Pair::new(&law, &link, [1.0; 2], 1e-3);
        assert_eq!(pair.substeps, 1);
        let (mut stepped, mut exact) = ([1e-3, 0.0, 0.0, 0.0], [1e-3, 0.0, 0.0, 0.0]);
        for row in 0..500 {
            advance_pair(&law, &link, &mut stepped, &mut Slips::default(), [0.0; 2], &pair);
            exact = pair.transition[1].map(|line| line.iter().zip(&exact).map(|(a, x)| a * x).sum());
            let stretch = |state: [f64; STATES]| state[0] - state[2];
            // By the stretch in the middle of a step alone the angle would be wrong by 0.0012 a row, 0.6 at the end. What is left is
            // where the energy of a step is counted, (swing step)^2 / 24 of the stretch.
            assert!((stretch(stepped) - stretch(exact)).abs() < 1e-5, "{row} {} {}", stretch(stepped), stretch(exact));
        }
    }

    #[test]
    fn a_load_that_is_pushed_stretches_its_link_by_force_over_stiffness() {
        let (law, link) = pair_law(12_000.0);
        let pair = Pair::new(&law, &link, [1.0; 2], 1e-3);
        // Pulled from both ends by 3 N.
        let mut state = [3.0 / 12_000.0, 0.0, 0.0, 0.0];
        for _ in 0..500 {
            advance_pair(&law, &link, &mut state, &mut Slips::default(), [3.0, 3.0], &pair);
        }
        assert!((state[0] - state[2] - 3.0 / 12_000.0).abs() < 1e-12, "{state:?}");
    }

    /// A row of 1.6 rad of the pair's swing, at once and in a thousand steps of the other rule, on a flank of a play and against dry friction.
    #[test]
    fn a_coupled_row_at_once_is_a_thousand_short_ones() {
        let (law, link) = pair_law(300_000.0);
        let link = Link { damping: 4.0, play: 1e-3, load_viscous: 1.0, ..link };
        let mut law = DriveLaw { viscous: 2.0, link: Some(link), ..law };
        (law.friction.coulomb, law.offset) = (3.0, 1.5);
        let (row, short) = (Pair::new(&law, &link, [1.0; 2], 1e-3), Pair::new(&law, &link, [1.0; 2], 1e-6));
        assert!(row.substeps > 4 && short.substeps == 1);
        let start = [0.61e-3, 0.2, 0.0, 0.19];
        let at_once = after_coupled_row(&law, &link, &start, [40.0, 5.0], &row).expect("it stays coupled");
        let mut stepped = start;
        (0..1000).for_each(|_| {
            advance_pair(&law, &link, &mut stepped, &mut Slips::default(), [40.0, 5.0], &short);
        });
        // The short steps err by the square of their own swing, (1.6e-3)^2 / 24, of what moves within the row: 1e-3 of 0.2 m/s.
        for (state, scale) in [(0, 2e-4), (1, 0.2), (2, 2e-4), (3, 0.2)] {
            assert!((at_once[state] - stepped[state]).abs() < 1e-6 * scale, "{state}: {at_once:?} {stepped:?}");
        }
    }

    #[test]
    fn a_row_that_leaves_its_flank_or_turns_is_none_at_once() {
        let (law, link) = pair_law(300_000.0);
        let link = Link { play: 1e-3, ..link };
        let mut law = DriveLaw { link: Some(link), ..law };
        let row = Pair::new(&law, &link, [1.0; 2], 1e-3);
        let alone =
            |law: &DriveLaw, state: [f64; STATES]| after_coupled_row(law, &link, &state, [0.0; 2], &row).is_none();
        // In the play; leaving it at 2 m/s, four tenths of a millimetre beyond its end.
        assert!(alone(&law, [0.2e-3, 0.1, 0.0, 0.1]) && alone(&law, [0.9e-3, -1.0, 0.0, 1.0]));
        law.friction.coulomb = 5.0;
        // 5 N on 0.42 kg take 12 mm/s in a row.
        assert!(alone(&law, [0.5e-3, 1e-3, 0.0, 0.0]));
    }

    /// A load that is pushed by a force of its own, seen by an encoder of 1 um on the motor alone.
    #[test]
    fn the_lead_of_a_motor_is_smoothed_to_a_hundredth_of_it() {
        let (law, link) = pair_law(2_000.0);
        let exact = Coupled::new(&law, &link, 1e-3);
        let push = |row: usize, hz: f64| 2.0 * (std::f64::consts::TAU * hz * 1e-3 * row as f64).cos();
        let rows = 4000;
        let time: Vec<f64> = (0..rows).map(|row| 1e-3 * row as f64).collect();
        let effort: Vec<f64> = (0..rows).map(|row| push(row, 1.3)).collect();
        let force: Vec<f64> = (0..rows).map(|row| 0.5 * push(row, 2.9)).collect();
        // The filter begins with no stretch, give or take what the first effort would make of it, 0.3 mm.
        let mut state = [0.3e-3, 0.0, 0.0, 0.0];
        let (mut position, mut lead) = (vec![state[0]], vec![state[0] - state[2]]);
        for row in 1..rows {
            state = exact.after(&state, [effort[row - 1], -0.5 * (force[row - 1] + force[row])]);
            position.push(state[0] + 1e-6 * (row as f64 * 1.618).sin());
            lead.push(state[0] - state[2]);
        }
        let trial = DriveTrial::new("lead.csv".to_owned(), time, &position, effort, Some(force), 1);
        let noise = Noise { ln_disturbance: (1e-9f64).ln(), ln_encoder: (1e-12f64).ln() };
        let pass = two_bodies(&trial, &Inputs::of(&trial, &law), &law, link, &noise, true);
        let rms = |values: &mut dyn Iterator<Item = f64>| (values.map(|x| x * x).sum::<f64>() / rows as f64).sqrt();
        let error = rms(&mut pass.stretch.iter().zip(&lead).map(|(found, truth)| found - truth));
        // From the first row on, whose lead only later rows tell.
        assert!(error < 0.01 * rms(&mut lead.iter().copied()), "{error}");
        assert!((pass.stretch[0] - lead[0]).abs() < 0.02 * lead[0], "{} {}", pass.stretch[0], lead[0]);
    }

    #[test]
    fn the_variance_that_stands_is_the_fixed_point_of_riccatis_recursion() {
        let (law, link) = pair_law(2_000.0);
        let noise = Noise { ln_disturbance: (1e-6f64).ln(), ln_encoder: (1e-10f64).ln() };
        let time: Vec<f64> = (0..6000).map(|row| 1e-3 * f64::from(row)).collect();
        let trial = DriveTrial::new("still.csv".to_owned(), time.clone(), &vec![0.0; 6000], vec![0.0; 6000], None, 1);
        let pass = two_bodies(&trial, &Inputs::of(&trial, &law), &law, link, &noise, false);
        let densities = [noise.disturbance(), LOAD_DENSITY_SHARE * noise.disturbance()];
        let pair = Pair::new(&law, &link, densities, 1e-3);
        let mut covariance = identity::<STATES>();
        for _ in 0..100_000 {
            covariance = propagated(&pair.transition[1], &covariance, &pair.driving[1]);
            let line = covariance[0];
            let gain = line.map(|known| known / (line[0] + noise.encoder()));
            for (row, gain) in covariance.iter_mut().zip(gain) {
                row.iter_mut().zip(line).for_each(|(value, known)| *value -= gain * known);
            }
        }
        let standing = propagated(&pair.transition[1], &covariance, &pair.driving[1])[0][0] + noise.encoder();
        // A gain that stands to 1e-12 a row is off by that times the rows over which it forgets, some hundreds.
        assert!((pass.variance[5999] / standing - 1.0).abs() < 1e-9, "{} {standing}", pass.variance[5999]);
    }
}
