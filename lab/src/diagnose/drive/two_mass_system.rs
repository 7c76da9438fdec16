//! Two masses on a spring and damper over one step: transition, driving noise and response, coupled and apart.

use super::law::{DriveLaw, Link, Side};
use super::matrix::{Matrix, exponential, product, propagated};

/// Number of states of two bodies: motor position and velocity, load position and velocity.
pub const STATES: usize = 4;

/// A period of the pair's own swing has at least this many substeps.
const SUBSTEPS_PER_RADIAN: f64 = 1.0 / 0.35;

/// Most substeps of a row.
const MOST_SUBSTEPS: f64 = 64.0;

/// The pair over one step length: a transition and a driving noise apart, and coupled.
pub struct Pair {
    /// s
    pub step: f64,
    /// Parts that it is simulated in.
    pub substeps: usize,
    /// What the stretch of the link is taken further by, over its own acceleration, s^2.
    pub curving: f64,
    /// State after the step for each state before it.
    pub transition: [Matrix<STATES>; 2],
    /// Covariance that the disturbances add over the step.
    pub driving: [Matrix<STATES>; 2],
    /// State after the step for a constant force of one on the side that the encoder sees.
    pub response: [[f64; STATES]; 2],
    /// The whole step at once.
    pub coupled: Coupled,
}

/// The coupled pair over a whole step, exactly: state after it for each state before it, and for a constant force of one on the motor and on
/// the load.
pub struct Coupled {
    transition: Matrix<STATES>,
    on_motor: [f64; STATES],
    on_load: [f64; STATES],
}

impl Coupled {
    /// Over `step`.
    #[must_use]
    pub fn new(law: &DriveLaw, link: &Link, step: f64) -> Self {
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

    /// State after `state` under constant forces on motor and load.
    #[must_use]
    pub fn after(&self, state: &[f64; STATES], [on_motor, on_load]: [f64; 2]) -> [f64; STATES] {
        std::array::from_fn(|row| {
            let free: f64 = self.transition[row].iter().zip(state).map(|(a, x)| a * x).sum();
            free + self.on_motor[row] * on_motor + self.on_load[row] * on_load
        })
    }
}

impl Pair {
    /// Over `step`, with disturbances of the given densities on motor and load.
    #[must_use]
    pub fn new(law: &DriveLaw, link: &Link, [on_motor, on_load]: [f64; 2], step: f64) -> Self {
        let (motor, load) = masses(law, link);
        let swing = (link.stiffness * (1.0 / motor + 1.0 / load)).sqrt();
        let substeps = (swing * step * SUBSTEPS_PER_RADIAN).ceil().clamp(1.0, MOST_SUBSTEPS) as usize;
        let short = step / substeps as f64;
        let (pushed, mass) = if link.encoder == Side::Load { (3, load) } else { (1, motor) };
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
            let push = |mut state: [f64; STATES]| -> [f64; STATES] {
                state[pushed] += 0.5 * short / mass;
                let mut after: [f64; STATES] = once.map(|row| row.iter().zip(&state).map(|(a, x)| a * x).sum());
                after[pushed] += 0.5 * short / mass;
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

/// Inertia of motor and load.
#[must_use]
pub fn masses(law: &DriveLaw, link: &Link) -> (f64, f64) {
    let load = link.load_share * law.inertia;
    (law.inertia - load, load)
}
