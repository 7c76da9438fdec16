//! Play between motor and tool.

use std::sync::LazyLock;

use super::link::Link;
use crate::effects::{
    Card, Effect, Form, Memory, Parameter, Place, Push, Scene, Side, Stage, Start, geometric, linear,
};
use crate::rig::Word;

/// See [`CARD`].
pub struct Backlash;

static CARD: Card = Card {
    name: "backlash",
    place: Place::Drive,
    stage: Stage::Transmission,
    most: 1,
    statement: "Between motor and tool there is play: after a reversal the motor runs free before it takes the tool along",
    forms: &[Form {
        name: "two_masses",
        equation: "m1 d2y/dt2 = effort - T, m1 = motor_share m; T = 0 while |y - x| < gap/2, a stiff damped link beyond; (m - m1) a + b v = T - F",
        parameters: &[
            Parameter::new("gap", Word::new("m", "rad"), "whole width of the play", 0.0, f64::INFINITY),
            Parameter::new("motor_share", Word::same("1"), "share of the inertia on the motor's side", 0.02, 0.8),
            Parameter::fixed(
                "link_stiffness",
                Word::new("N/m", "N m/rad"),
                "of the flanks, in a simulation: as stiff as the recording could not tell from rigid",
            ),
        ],
    }],
    excited_by: "reversals of the effort, in free motion and in contact",
    resembles: &["coulomb_friction", "transmission_compliance", "lost_motion"],
    source: "M. Nordin, P.-O. Gutman, Automatica 38 (2002) 1633",
};

/// Swings of the flanks, over those of the slowest link that can be told: stiff beside all that a recording shows.
const FLANKS: f64 = 2.2;

/// Deviations of noise beyond which it is decided which side bears.
const DECIDED: f64 = 3.0;

/// Widths of the filter beyond which nothing is left of a step.
const REACH: f64 = 5.0;

/// The motor's way through the gap as powers of the time: the effort grows from nothing, is there at once, or the tool was
/// stopped and the motor goes on; or it grows late.
const POWERS: [f64; 4] = [3.0, 2.0, 1.0, 5.0];

/// Rows from the peak to the strike that are tried: where the force goes on growing by itself, it peaks later.
const SHIFTS: [f64; 4] = [0.0, -1.0, -2.0, -3.0];

/// The same about the best of them.
const NEAR: [f64; 4] = [-0.6, -0.3, 0.3, 0.6];

/// Longest way through the gap that is told, in widths of the filter: of a tool that rests, nothing says when the motor left.
const LONGEST: f64 = 12.0;

/// A change of the side that bears.
struct Crossing {
    /// Row at which the motor strikes.
    strikes: f64,
    /// One where it pushes from then on, minus one where it holds back.
    turn: f64,
}

/// How the motor went through the gap.
#[derive(Clone, Copy)]
struct Way {
    /// Rows that it took.
    span: f64,
    /// Rows from the peak of the force to the strike.
    shift: f64,
    /// Shares of the time at which it was in the middle of each of four equal parts.
    parts: [f64; 4],
}

/// `-x exp(-x^2 / 2)`: what the filter makes of the second derivative of a step, but for its size. By a table, straight between
/// its places: off by less than 1e-4 of its peak.
fn doublet(x: f64) -> f64 {
    static TABLE: LazyLock<Vec<f64>> = LazyLock::new(|| {
        let at = |place: usize| place as f64 / PLACES - REACH;
        (0..=(2.0 * REACH * PLACES) as usize + 1).map(at).map(|x| -x * (-0.5 * x * x).exp()).collect()
    });
    if x.abs() >= REACH {
        return 0.0;
    }
    let place = (x + REACH) * PLACES;
    let below = place as usize;
    TABLE[below] + (place - below as f64) * (TABLE[below + 1] - TABLE[below])
}

/// Places of the table from one width of the filter to the next.
const PLACES: f64 = 64.0;

/// The middles of four equal parts of a way that goes as `power` of the time.
fn parts(power: f64) -> [f64; 4] {
    [0.125, 0.375, 0.625, 0.875].map(|part: f64| part.powf(power.recip()))
}

/// Lengths of the way through the gap that are tried.
const SPANS: usize = 8;

/// Rows after the side is decided within which the strike is looked for.
const LATE: usize = 2;

/// The changes of the side that bears.
fn crossings(side: &Side<'_>, tool: f64) -> Vec<Crossing> {
    let [speed, shake, force] = side.noise;
    let least = DECIDED * ((tool * shake).powi(2) + (side.viscous * speed).powi(2) + force * force).sqrt();
    let mut crossings = Vec::new();
    let mut bears = 0.0;
    for at in 0..side.velocity.len() {
        let now = side.borne(tool, at);
        if now.abs() > least {
            let turn = now.signum();
            if turn != bears && bears != 0.0 {
                crossings.push(Crossing {
                    strikes: strike(&|at| turn * side.borne(tool, at), at, side.velocity.len()),
                    turn,
                });
            }
            bears = turn;
        }
    }
    crossings
}

/// Where `force` peaks at row `at` or soon after it, of `rows`: the motor strikes, and what the tool bears jumps.
fn strike(force: &dyn Fn(usize) -> f64, at: usize, rows: usize) -> f64 {
    let mut peak = at;
    while peak + 1 < rows && peak < at + LATE && force(peak + 1) > force(peak) {
        peak += 1;
    }
    if peak == 0 || peak + 1 >= rows {
        return peak as f64;
    }
    let [before, here, after] = [peak - 1, peak, peak + 1].map(force);
    let bend = before - 2.0 * here + after;
    peak as f64 + if bend < 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

impl Crossing {
    /// Second derivative in `rows` rows from `first` on, behind the filter, of the motor's lead over the tool, on its `way` through a
    /// gap of `size`.
    fn bend(&self, side: &Side<'_>, way: &Way, size: f64, first: usize, rows: usize) -> Vec<f64> {
        let mut bend = vec![0.0; rows];
        let size = 0.25 * size * self.turn / (std::f64::consts::TAU.sqrt() * side.blur * side.blur);
        let width = side.blur / side.step;
        // Four equal parts of the gap, each gone through at once at the time of its middle.
        for part in way.parts {
            let there = self.strikes + way.shift - (1.0 - part) * way.span - first as f64;
            let from = (there - REACH * width).max(0.0) as usize;
            let to = ((there + REACH * width).max(0.0) as usize + 1).min(rows);
            for (row, bend) in bend.iter_mut().enumerate().take(to).skip(from) {
                *bend += size * doublet((row as f64 - there) / width);
            }
        }
        bend
    }

    /// Rows that the crossing, after one that struck at `before`, may have taken something of.
    fn rows(&self, side: &Side<'_>, before: f64) -> (usize, usize, f64) {
        let longest = (LONGEST * side.blur / side.step).min(self.strikes - before).max(1.0);
        let tail = REACH * side.blur / side.step;
        let first = (self.strikes - longest - tail).max(0.0) as usize;
        (first, ((self.strikes + tail) as usize).min(side.velocity.len() - 1), longest)
    }

    /// What a crossing through a gap of one, that takes `size`, takes of the effort in the rows from `first` on, of which `rest` is
    /// to be explained: of all ways the one that leaves the least of it. How long it took depends on an effort that grows
    /// from nothing, and is told by the recording itself.
    fn taken(&self, side: &Side<'_>, size: f64, first: usize, longest: f64, rest: &[f64]) -> Vec<f64> {
        let tried = |way: Way| {
            let taken = self.bend(side, &way, size, first, rest.len());
            let left: f64 = taken.iter().zip(rest).map(|(taken, rest)| (rest - taken).powi(2)).sum();
            (left, way, taken)
        };
        type Tried = (f64, Way, Vec<f64>);
        let better = |best: Tried, way: Way| {
            let other = tried(way);
            if other.0 < best.0 { other } else { best }
        };
        let plain = Way { span: 0.5, shift: 0.0, parts: parts(POWERS[0]) };
        let spans = geometric(0.5, longest.max(1.0), SPANS);
        let all = spans.iter().flat_map(|span| SHIFTS.map(|shift| Way { span: *span, shift, ..plain }));
        let mut best = all.fold(tried(plain), better);
        best = NEAR.map(|near| Way { shift: best.1.shift + near, ..best.1 }).into_iter().fold(best, better);
        let ratio = (spans[1] / spans[0]).sqrt();
        let way = best.1;
        let bent = POWERS.into_iter().flat_map(|power| {
            [1.0, ratio, ratio.recip()].map(|part| Way { span: part * way.span, parts: parts(power), ..way })
        });
        best = bent.fold(best, better);
        best = NEAR.map(|near| Way { shift: best.1.shift + 0.4 * near, ..best.1 }).into_iter().fold(best, better);
        // A motor that hung between the teeth had no gap to go through.
        if best.0 < rest.iter().map(|rest| rest * rest).sum() { best.2 } else { vec![0.0; rest.len()] }
    }
}

/// What all `crossings` take, where each takes `size` of a gap of one.
fn taken(crossings: &[Crossing], side: &Side<'_>, size: f64) -> Vec<f64> {
    let mut all = vec![0.0; side.velocity.len()];
    let mut own: Vec<Vec<f64>> = vec![Vec::new(); crossings.len()];
    // One crossing begins where the one before has not faded: each is told from what the others leave.
    for _ in 0..SWEEPS {
        let mut before = f64::NEG_INFINITY;
        for (crossing, own) in crossings.iter().zip(&mut own) {
            let (first, last, longest) = crossing.rows(side, before);
            all[first..].iter_mut().zip(own.iter()).for_each(|(all, own)| *all -= own);
            let rest: Vec<f64> = (first..=last).map(|at| side.rest(at) - all[at]).collect();
            *own = crossing.taken(side, size, first, longest, &rest);
            all[first..].iter_mut().zip(own.iter()).for_each(|(all, own)| *all += own);
            before = crossing.strikes;
        }
    }
    all
}

/// How often each crossing is told from what the others leave.
const SWEEPS: usize = 2;

impl Effect for Backlash {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn starts(&self, _form: usize, scene: &Scene) -> Vec<Start> {
        // Without a force sensor nothing tells which side of the teeth bears.
        if !scene.has_force {
            return Vec::new();
        }
        let (way, pulse) = (scene.travel.1 - scene.travel.0, FLANKS * scene.link_rate());
        let start = |share: f64| Start::sized(&[0.01 * way, share, share * scene.inertia * pulse * pulse], &[0]);
        linear(0.1, 0.79, 8).into_iter().map(start).collect()
    }

    /// The motor rests against the side that bears, and what the tool's side bears is seen: where that changes its sign, the motor
    /// has gone through the gap. What that takes is `m1` times the second derivative of its way, which ends in a stroke. A motor
    /// that is followed through the gap instead lands where the noise of the tool's position takes it.
    fn ahead(&self, _form: usize, values: &[f64], side: &Side<'_>) -> Option<Vec<f64>> {
        let motor = values[1] * side.inertia;
        Some(taken(&crossings(side, side.inertia - motor), side, motor * values[0]))
    }

    fn push(&self, _form: usize, values: &[f64], memory: &mut Memory, push: &mut Push) {
        // Flanks that ring three times.
        let motor = values[1] * push.inertia;
        let damping = 0.6 * (values[2] * motor).max(0.0).sqrt();
        Link { stiffness: values[2], damping, inertia: motor, viscous: 0.0, gap: values[0] }.carry(memory, push);
    }
}
