//! A trial's motion: the candidates that decide most of what is open, as many as its time holds.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::candidates::{self, Candidate};
use super::coverage::Coverage;
use super::departures::{Departure, departures, information};
use super::discrimination::{LinearizedResponse, Noise, range, steps, whitened};
use super::explanation::Explanation;
use super::limits::Limits;
use super::loop_model::LoopModel;
use super::parameters::Parameter;
use super::path::MotionLimits;
use super::prediction::predict;
use super::recorded::Recorded;
use super::reference::reference_along;
use crate::recording::Recording;
use crate::rig::Rig;

/// Energy at which two explanations count as distinguished: chance alone leaves less but once in two thousand times.
pub const DECISIVE_ENERGY: f64 = 12.0;

/// Share of [`DECISIVE_ENERGY`] below which a motion tells nothing of a question.
const LEAST_SHARE: f64 = 0.05;

/// Parts of the greatest speed and depth at which a motion is tried, until every explanation keeps the limits.
const EASE: [f64; 6] = [1.0, 0.75, 0.55, 0.4, 0.28, 0.18];

/// Growth of the visited way, to either side, that one trial may risk.
const MAX_GROWTH: f64 = 0.5;

/// Share of the effort limit that accelerations may ask for.
const ACCELERATION_SHARE: f64 = 0.35;

/// Relative half-width of an interval to which a parameter is wanted.
const WANTED_HALF_WIDTH: f64 = 0.1;

/// Deviations in the half-width of a 95 % interval.
const DEVIATIONS_95: f64 = 1.96;

/// Share of all states in reach that a trial has to add to be worth it for that alone.
const LEAST_NEW_STATES: f64 = 0.08;

/// Nats of a listed effect, the mean of all, that a trial has to tell to be worth it for that alone: those by which the recordings then tell
/// twice as much of it, half of ln 2.
const LEAST_INFORMATION: f64 = 0.5 * std::f64::consts::LN_2;

/// Worth of all states in reach, in questions.
const COVERAGE_WORTH: f64 = 1.5;

/// Worth of a nat of every listed effect that the recordings could hide, in questions: that of all states in reach. Chosen: on the bench of the tests, after a slow trial, at twice
/// as much the plan is the same, and at half of it tells 1.00 nats for 1.06.
const DEPARTURES_WORTH: f64 = 1.5;

/// Span over which a planned speed is taken, s.
const SPEED_SPAN_S: f64 = 0.02;

/// What recordings leave open.
#[derive(Debug, Clone, PartialEq)]
pub enum Question {
    /// The answer or an alternative: its index among the explanations.
    Alternative(usize),
    /// A value of the answer whose interval is too wide: the parameter and the half-width.
    Interval(Parameter, f64),
}

/// The motion of the next trial.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Position to be commanded, one a row of the loop.
    pub reference: Vec<f64>,
    /// What the motions are, in order.
    pub motions: Vec<String>,
    /// For each question, in its order: energy that is expected, of [`DECISIVE_ENERGY`].
    pub expected: Vec<f64>,
    /// Share of the states in reach that it adds.
    pub new_states: f64,
    /// Nats that it is expected to tell of a listed effect that the answer does not hold, the mean of all.
    pub departures: f64,
}

impl Plan {
    /// Whether it is expected to tell anything new beside what is open.
    #[must_use]
    pub fn searches_on(&self) -> bool {
        self.new_states >= LEAST_NEW_STATES || self.departures >= LEAST_INFORMATION
    }

    /// Whether it is expected to tell anything.
    #[must_use]
    pub fn is_worth_running(&self) -> bool {
        self.searches_on() || self.expected.iter().any(|energy| *energy >= LEAST_SHARE * DECISIVE_ENERGY)
    }
}

/// What a design starts from.
pub struct Situation<'a> {
    /// What could be, the answer first; at least one.
    pub explanations: &'a [Explanation],
    /// What is open.
    pub questions: &'a [Question],
    /// What was recorded.
    pub trials: &'a [Recording],
    /// What must not be passed.
    pub limits: &'a Limits,
    /// Expected noise of each channel.
    pub noise: Noise,
    /// The position loop.
    pub closed_loop: LoopModel,
    /// Share of speed and depth at which a trial before was cut off; 1 where none was.
    pub ease: f64,
    /// Whether effects that the recordings could hide are searched for, beside what is open.
    pub searches: bool,
}

/// A candidate as every explanation would record it.
struct Tried {
    what: String,
    reference: Vec<f64>,
    seconds: f64,
    /// Energy for each question.
    energy: Vec<f64>,
    /// Energy of each departure.
    departures: Vec<f64>,
    states: Coverage,
}

/// The motion that decides most of what is open; `None` where no motion at all keeps the limits under every explanation.
#[must_use]
pub fn plan(situation: &Situation<'_>) -> Option<Plan> {
    let room = situation.motion_limits()?;
    let recorded = situation.recorded();
    let hidden = situation.hidden(&recorded[0]);
    let count = candidates::motions(room).len();
    let tried: Vec<Tried> =
        (0..count).into_par_iter().filter_map(|number| situation.attempt(room, number, &recorded, &hidden)).collect();
    situation.compose(tried, &hidden)
}

impl Situation<'_> {
    fn answer(&self) -> &Rig {
        &self.explanations[0].rig
    }

    /// The way that was visited.
    fn visited(&self) -> Option<(f64, f64)> {
        let positions = self.trials.iter().flat_map(|trial| trial.position.iter().copied());
        let (low, high) = positions.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        (low < high).then_some((low, high))
    }

    /// The room of a motion: the limits less the margin, not far beyond what was visited, no deeper than any explanation
    /// bears by its nominal law.
    fn motion_limits(&self) -> Option<MotionLimits> {
        let kept = self.limits.with_margin();
        let [mut low, mut high] = kept.position;
        let rig = self.answer();
        let visited = self.visited();
        if let Some((from, to)) = visited {
            low = low.max(from - MAX_GROWTH * (to - from));
            high = high.min(to + MAX_GROWTH * (to - from));
        }
        let softest = |contact: crate::rig::Contact| {
            let force = kept.force.unwrap_or(f64::INFINITY).min(kept.effort.unwrap_or(f64::INFINITY));
            contact.surface + force / contact.stiffness.max(f64::MIN_POSITIVE)
        };
        let deepest = self.explanations.iter().filter_map(|explanation| explanation.rig.contact).map(softest);
        high = deepest.fold(high, f64::min);
        let surface = rig
            .contact
            .map(|contact| contact.surface)
            .filter(|surface| low < *surface || rig.contact.is_some_and(|c| c.bilateral));
        let first = self.trials.first().and_then(|trial| trial.position.first().copied());
        // A clamped tool starts where it rests: elsewhere the contact pulls before the loop has an effort, and no motion is smooth.
        let rest = rig.contact.filter(|contact| contact.bilateral).map(|contact| contact.surface);
        let start =
            rest.or(first).unwrap_or_else(|| surface.map_or(0.5 * (low + high), |surface| 0.5 * (low + surface)));
        let free = rig.contact.is_none_or(|contact| !contact.bilateral && contact.surface > low);
        let by_effort = kept.effort.map(|effort| {
            let inertia = rig.drive.map_or(self.closed_loop.drive.inertia, |drive| drive.inertia);
            ACCELERATION_SHARE * effort / inertia.max(f64::MIN_POSITIVE)
        });
        let by_frequency = 0.5 * kept.speed * std::f64::consts::TAU * kept.frequency_hz;
        let limits = MotionLimits {
            start: start.clamp(low, high),
            low,
            high,
            surface: surface.map(|surface| surface.clamp(low, high)),
            free,
            speed: kept.speed,
            acceleration: by_effort.map_or(by_frequency, |effort| effort.min(by_frequency)),
            seconds: kept.duration_s,
            band: kept.frequency_hz,
        };
        (high > low && limits.start.is_finite()).then(|| limits.eased(self.ease))
    }

    /// Travel that steps of values are scaled by: the same for all motions, so that their information adds up.
    fn travel(&self) -> f64 {
        self.visited().map_or(self.limits.position[1] - self.limits.position[0], |(low, high)| high - low)
    }

    /// Each explanation along what was recorded.
    fn recorded(&self) -> Vec<Recorded<'_>> {
        let along = |explanation: &Explanation| {
            Recorded::new(&explanation.rig, self.trials, &self.closed_loop, &self.noise, self.travel())
        };
        self.explanations.par_iter().map(along).collect()
    }

    /// The effects that the recordings could hide, of which `recorded` is the answer's part.
    fn hidden(&self, recorded: &Recorded<'_>) -> Vec<Departure> {
        if !self.searches || self.trials.is_empty() {
            return Vec::new();
        }
        departures(self.answer(), self.trials, recorded)
    }

    /// Candidate `number` as quick and deep as every explanation lets it be.
    fn attempt(
        &self,
        room: MotionLimits,
        number: usize,
        recorded: &[Recorded<'_>],
        hidden: &[Departure],
    ) -> Option<Tried> {
        EASE.iter().find_map(|part| {
            let candidate = candidates::motions(room.eased(*part)).into_iter().nth(number)?;
            let step = self.closed_loop.rate_hz.recip();
            let reference = reference_along(&candidate.path.rows(step), self.answer(), &self.closed_loop);
            let predicted = self.predicted(&reference)?;
            let all_keep = predicted.iter().all(|recording| self.keeps(recording));
            all_keep.then(|| self.judge(candidate, reference, &predicted, recorded, hidden)).flatten()
        })
    }

    /// What every explanation would record; `None` where one cannot be simulated.
    fn predicted(&self, reference: &[f64]) -> Option<Vec<Recording>> {
        self.explanations
            .iter()
            .map(|explanation| predict(&explanation.rig, &self.closed_loop, reference).ok())
            .collect()
    }

    /// Whether `recording` leaves the margin of every limit.
    fn keeps(&self, recording: &Recording) -> bool {
        let kept = self.limits.with_margin();
        let within = |values: Option<&Vec<f64>>, most: Option<f64>| {
            let most = most.unwrap_or(f64::INFINITY);
            values.is_none_or(|values| values.iter().all(|value| value.abs() <= most))
        };
        let [low, high] = kept.position;
        let span = (SPEED_SPAN_S * self.closed_loop.rate_hz).round().max(1.0) as usize;
        let most = kept.speed * span as f64 / self.closed_loop.rate_hz;
        let position = &recording.position;
        // Where it starts is where the rig stands; a start outside of the margin is no fault of the motion.
        let start = position.first().copied().unwrap_or(low);
        position.iter().all(|x| (low.min(start)..=high.max(start)).contains(x))
            && (span..position.len()).all(|at| (position[at] - position[at - span]).abs() <= most)
            && within(recording.force.as_ref(), kept.force)
            && within(recording.effort.as_ref(), kept.effort)
    }

    fn judge(
        &self,
        candidate: Candidate,
        reference: Vec<f64>,
        predicted: &[Recording],
        recorded: &[Recorded<'_>],
        hidden: &[Departure],
    ) -> Option<Tried> {
        let known = |at: usize| recorded[at].information();
        let shown: Vec<DVector<f64>> = predicted.iter().map(|recording| whitened(recording, &self.noise)).collect();
        let along = |at: usize| {
            let rig = &self.explanations[at].rig;
            let steps = steps(rig, self.travel());
            let response = LinearizedResponse::new(rig, &steps, &self.closed_loop, &reference, &self.noise).ok()?;
            Some((steps, response))
        };
        let (own_steps, own) = along(0)?;
        let energy = self.questions.iter().map(|question| match question {
            Question::Alternative(other) => {
                // Each as the truth once, and the mean of what the other's refit leaves: where one can do all that the other
                // does, only its own truth distinguishes them.
                let reverse = own.discrepancy(&shown[*other], known(0));
                let forward = along(*other).map_or(0.0, |(_, response)| response.discrepancy(&shown[0], known(*other)));
                0.5 * (forward + reverse)
            }
            Question::Interval(parameter, half_width) => {
                let at = own_steps.iter().position(|(own, _)| own == parameter);
                at.map_or(0.0, |at| self.interval_energy(parameter, own_steps[at].1, *half_width, at, &own, known(0)))
            }
        });
        let departures = hidden.iter().map(|departure| {
            let response = predict(&departure.rig, &self.closed_loop, &reference).ok();
            response.map_or(0.0, |response| own.discrepancy(&whitened(&response, &self.noise), known(0)))
        });
        Some(Tried {
            energy: energy.collect(),
            departures: departures.collect(),
            states: Coverage::of(&predicted[0], self.limits),
            seconds: candidate.path.seconds(),
            what: candidate.what,
            reference,
        })
    }

    /// Information about `parameter`, value `at` of a step `step` each, in the energy that narrows its interval to what is wanted.
    ///
    /// What the recordings are counted to hold and what their interval shows differ by what models leave of a recording: the
    /// information of a planned motion is discounted as theirs is.
    fn interval_energy(
        &self,
        parameter: &Parameter,
        step: f64,
        half_width: f64,
        at: usize,
        own: &LinearizedResponse,
        known: &DMatrix<f64>,
    ) -> f64 {
        let per_step = |half_width: f64| (DEVIATIONS_95 * step / half_width.max(f64::MIN_POSITIVE)).powi(2);
        let counted = known.clone().cholesky().map_or(0.0, |solver| solver.inverse()[(at, at)].recip());
        let discount = (per_step(half_width) / counted.max(f64::MIN_POSITIVE)).min(1.0);
        let wanted = WANTED_HALF_WIDTH * parameter.get(self.answer()).unwrap_or(0.0).abs();
        DECISIVE_ENERGY * discount * own.marginal_information(at, known) / per_step(wanted)
    }

    /// The candidates that decide most a second, one after the other until the time is up.
    fn compose(&self, mut tried: Vec<Tried>, hidden: &[Departure]) -> Option<Plan> {
        let mut visited = Coverage::of_all(self.trials, self.limits);
        let mut reach = visited.clone();
        tried.iter().for_each(|one| reach.add(&one.states));
        let before = visited.len();
        let mut plan = Plan {
            reference: Vec::new(),
            motions: Vec::new(),
            expected: vec![0.0; self.questions.len()],
            new_states: 0.0,
            departures: 0.0,
        };
        let mut shown = vec![0.0; hidden.len()];
        let mut left = self.limits.duration_s;
        loop {
            tried.retain(|one| one.seconds <= left || plan.reference.is_empty());
            let told = information(hidden, &shown);
            let worth = |one: &Tried| {
                let sum: Vec<f64> = shown.iter().zip(&one.departures).map(|(before, energy)| before + energy).collect();
                let added = information(hidden, &sum) - told;
                let states = visited.added_by(&one.states) as f64 / reach.len().max(1) as f64;
                (self.decided(one, &plan.expected) + COVERAGE_WORTH * states + DEPARTURES_WORTH * added) / one.seconds
            };
            let Some(best) = (0..tried.len()).max_by(|a, b| worth(&tried[*a]).total_cmp(&worth(&tried[*b]))) else {
                break;
            };
            if worth(&tried[best]) <= 0.0 && !plan.reference.is_empty() {
                break;
            }
            let chosen = &tried[best];
            plan.reference.extend(&chosen.reference);
            plan.motions.push(chosen.what.clone());
            plan.expected.iter_mut().zip(&chosen.energy).for_each(|(sum, energy)| *sum += energy);
            shown.iter_mut().zip(&chosen.departures).for_each(|(sum, energy)| *sum += energy);
            visited.add(&chosen.states);
            left -= chosen.seconds;
        }
        plan.departures = information(hidden, &shown);
        plan.new_states = (visited.len() - before) as f64 / reach.len().max(1) as f64;
        // One after the other they may do what none does alone: a load that drifts, a dent that deepens.
        let all_keep =
            |plan: &Plan| self.predicted(&plan.reference).is_some_and(|all| all.iter().all(|one| self.keeps(one)));
        (!plan.reference.is_empty() && range(&plan.reference) > 0.0 && all_keep(&plan)).then_some(plan)
    }

    /// Questions that `one` decides, where `expected` is what the motions before it tell.
    fn decided(&self, one: &Tried, expected: &[f64]) -> f64 {
        let decided = |energy: f64| (energy / DECISIVE_ENERGY).min(1.0);
        expected.iter().zip(&one.energy).map(|(before, energy)| decided(before + energy) - decided(*before)).sum()
    }
}
