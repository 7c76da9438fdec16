//! Play between motor and tool.

use super::two_mass_link::TwoMassLink;
use crate::effects::{
    DriveState, Effect, EffectSpec, EffectState, ExcitationStats, Form, LoadSideSignals, Parameter, Place, Stage,
    Start, geometric, linear,
};
use crate::rig::Word;

/// See [`SPEC`].
pub struct Backlash;

static SPEC: EffectSpec = EffectSpec {
    name: "backlash",
    place: Place::Drive,
    stage: Stage::Transmission,
    max_instances: 1,
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
const FLANK_RATE_RATIO: f64 = 2.2;

/// Deviations of noise beyond which it is decided which side bears.
const CONTACT_SIDE_SIGMAS: f64 = 3.0;

/// Widths of the filter beyond which nothing is left of a step.
const RESPONSE_WIDTHS: f64 = 5.0;

/// Parts of the gap that the motor has gone through at the middles of four equal parts of its way, as shares of the time:
/// the effort grows from nothing, and the way as the cube of the time.
const TRAVERSE_TIME_FRACTIONS: [f64; 4] = [0.5, 0.721, 0.855, 0.956];

/// Longest way through the gap that is told, in widths of the filter: of a tool that rests, nothing says when the motor left.
const MAX_TRAVERSE_WIDTHS: f64 = 12.0;

/// A change of the side that bears.
struct Crossing {
    /// Row at which the motor strikes.
    strikes: f64,
    /// One where it pushes from then on, minus one where it holds back.
    turn: f64,
}

/// Lengths of the way through the gap that are tried.
const TRAVERSE_GRID: usize = 12;

/// Rows after the side is decided within which the strike is looked for.
const STRIKE_SEARCH_ROWS: usize = 2;

/// The changes of the side that bears.
fn crossings(side: &LoadSideSignals<'_>, tool: f64) -> Vec<Crossing> {
    let [speed, shake, force] = side.noise;
    let least = CONTACT_SIDE_SIGMAS * ((tool * shake).powi(2) + (side.viscous * speed).powi(2) + force * force).sqrt();
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
    while peak + 1 < rows && peak < at + STRIKE_SEARCH_ROWS && force(peak + 1) > force(peak) {
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
    /// Second derivative at row `at`, behind the filter, of the motor's lead over the tool, whose way through a gap of one took `span`
    /// rows.
    fn bend(&self, side: &LoadSideSignals<'_>, span: f64, at: usize) -> f64 {
        let quarter = |part: &f64| {
            let past = (at as f64 - self.strikes + (1.0 - part) * span) * side.step / side.filter_width;
            -past * (-0.5 * past * past).exp()
        };
        let sum: f64 = TRAVERSE_TIME_FRACTIONS.iter().map(quarter).sum();
        self.turn * 0.25 * sum / (std::f64::consts::TAU.sqrt() * side.filter_width * side.filter_width)
    }

    /// First row of the crossing, and what it takes of the effort from there on, where a gap of one takes `size`: of all lengths of
    /// the way the one that leaves the least of the balance. How long it took depends on an effort that grows from nothing,
    /// and is told by the recording itself.
    fn taken(&self, side: &LoadSideSignals<'_>, size: f64) -> (usize, Vec<f64>) {
        let longest = MAX_TRAVERSE_WIDTHS * side.filter_width / side.step;
        let first = (self.strikes - longest).max(0.0) as usize;
        let last =
            ((self.strikes + RESPONSE_WIDTHS * side.filter_width / side.step) as usize).min(side.velocity.len() - 1);
        let tried = geometric(0.5, longest, TRAVERSE_GRID).into_iter().map(|span| {
            let taken: Vec<f64> = (first..=last).map(|at| size * self.bend(side, span, at)).collect();
            let left: f64 =
                taken.iter().zip(first..).map(|(taken, at)| (side.balance_residual(at) - taken).powi(2)).sum();
            (left, taken)
        });
        let best = tried.min_by(|a, b| a.0.total_cmp(&b.0));
        (first, best.map_or_else(Vec::new, |(_, taken)| taken))
    }
}

impl Effect for Backlash {
    fn spec(&self) -> &'static EffectSpec {
        &SPEC
    }

    fn starts(&self, _form: usize, scene: &ExcitationStats) -> Vec<Start> {
        // Without a force sensor nothing tells which side of the teeth bears.
        if !scene.has_force {
            return Vec::new();
        }
        let (way, pulse) = (scene.travel.1 - scene.travel.0, FLANK_RATE_RATIO * scene.min_link_rate());
        let start = |share: f64| Start::sized(&[0.01 * way, share, share * scene.inertia * pulse * pulse], &[0]);
        linear(0.1, 0.79, 8).into_iter().map(start).collect()
    }

    /// The motor rests against the side that bears, and what the tool's side bears is seen: where that changes its sign, the motor
    /// has gone through the gap. What that takes is `m1` times the second derivative of its way, which ends in a stroke. A motor
    /// that is followed through the gap instead lands where the noise of the tool's position takes it.
    fn transmission_loss(&self, _form: usize, values: &[f64], side: &LoadSideSignals<'_>) -> Option<Vec<f64>> {
        let motor = values[1] * side.inertia;
        let mut all = vec![0.0; side.velocity.len()];
        for crossing in crossings(side, side.inertia - motor) {
            let (first, taken) = crossing.taken(side, motor * values[0]);
            all[first..].iter_mut().zip(&taken).for_each(|(all, taken)| *all += taken);
        }
        Some(all)
    }

    fn act_on_drive(&self, _form: usize, values: &[f64], state: &mut EffectState, push: &mut DriveState) {
        // Flanks that ring three times.
        let motor = values[1] * push.inertia;
        let damping = 0.6 * (values[2] * motor).max(0.0).sqrt();
        TwoMassLink { stiffness: values[2], damping, inertia: motor, viscous: 0.0, gap: values[0] }.carry(state, push);
    }
}
