//! The design of experiments, on rigs alone.

use palpate_lab::experiment_design::departures::{Departure, departures, information};
use palpate_lab::experiment_design::discrimination::{LinearizedResponse, Noise, prior, steps, whitened};
use palpate_lab::experiment_design::loop_model::LoopModel;
use palpate_lab::experiment_design::planner::{DECISIVE_ENERGY, Situation};
use palpate_lab::experiment_design::prediction::predict;
use palpate_lab::experiment_design::recorded::Recorded;
use palpate_lab::experiment_design::{Explanation, Limits, Plan, Question, plan};
use palpate_lab::recording::Recording;
use palpate_lab::rig::Rig;
use palpate_lab::simulate::simulate;

const COULOMB: &str = "[[effect]]\nname = \"coulomb_friction\"\nlevel_n = 0.35\n";
const STRIBECK: &str =
    "[[effect]]\nname = \"stribeck_friction\"\nlevel_n = 0.3\nbreakaway_excess_n = 0.2\nstribeck_speed_m_s = 0.01\n";
const RELAXATION: &str =
    "[[effect]]\nname = \"stress_relaxation\"\nbranch_stiffness_n_m = 60.0\nrelaxation_time_s = 0.4\n";
const DRAG: &str = "[[effect]]\nname = \"quadratic_damping\"\nquadratic_n_s2_m2 = 30.0\n";

/// The bench with `effects`, its trial short.
pub fn bench(effects: &str) -> Rig {
    let text = include_str!("../../rigs/bench.toml")
        .replace("duration_s = 60.0", "duration_s = 8.0")
        .replace("period_s = 30.0", "period_s = 4.0")
        .replace("contact_s = 15.0", "contact_s = 1.5");
    Rig::parse(&(text + effects), "bench.toml").unwrap()
}

pub const LIMITS: Limits = Limits {
    position: [-0.02, 0.02],
    speed: 0.4,
    effort: Some(25.0),
    force: Some(8.0),
    duration_s: 20.0,
    frequency_hz: 20.0,
};

/// A plan for what tells `explanations` apart, within `limits`, after one ordinary recording of the first.
fn planned(explanations: &[&str], limits: &Limits, recorded: bool) -> (Option<Plan>, Vec<Explanation>, LoopModel) {
    let explanations: Vec<Explanation> = explanations
        .iter()
        .map(|effects| Explanation { physics: vec![(*effects).to_owned()], rig: bench(effects) })
        .collect();
    let trials: Vec<Recording> =
        if recorded { vec![simulate(&explanations[0].rig, 1, "bench").unwrap().recording] } else { Vec::new() };
    let closed_loop = LoopModel::new(&explanations[0].rig, &trials);
    let questions: Vec<Question> = (1..explanations.len()).map(Question::Alternative).collect();
    let noise = if recorded {
        Noise::of(&explanations[0].rig, &trials, [0.0; 2])
    } else {
        Noise { position: 3e-5, force: Some(0.09), effort: Some(0.1) }
    };
    let situation = Situation {
        explanations: &explanations,
        questions: &questions,
        trials: &trials,
        limits,
        noise,
        closed_loop,
        ease: 1.0,
        searches: false,
    };
    (plan(&situation), explanations, closed_loop)
}

#[test]
fn a_plan_decides_between_two_frictions_and_keeps_the_margin_under_both() {
    let (plan, explanations, closed_loop) = planned(&[COULOMB, STRIBECK], &LIMITS, true);
    let plan = plan.unwrap();
    assert!(plan.expected[0] >= DECISIVE_ENERGY, "{:?} {:?}", plan.expected, plan.motions);
    assert!(plan.motions.iter().any(|motion| motion.contains("reversals")), "{:?}", plan.motions);
    let kept = LIMITS.with_margin();
    for explanation in &explanations {
        let trial = predict(&explanation.rig, &closed_loop, &plan.reference).unwrap();
        let peak = |values: &[f64]| values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        assert!(trial.position.iter().all(|x| (kept.position[0]..=kept.position[1]).contains(x)));
        assert!(peak(trial.force.as_ref().unwrap()) <= kept.force.unwrap());
        assert!(peak(trial.effort.as_ref().unwrap()) <= kept.effort.unwrap());
    }
}

#[test]
fn the_margin_is_kept_under_the_alternative_as_well() {
    // The alternative is four times as stiff beyond 4 mm: a motion that suits the answer alone would press too hard.
    let layered = "[[effect]]\nname = \"layered_stiffness\"\nlayer_depth_m = 0.004\nadded_stiffness_n_m = 900.0\n";
    let tight = Limits { force: Some(4.0), ..LIMITS };
    let (alone, ..) = planned(&[RELAXATION], &tight, true);
    let (both, explanations, closed_loop) = planned(&[RELAXATION, layered], &tight, true);
    let force = |plan: &Plan| {
        let trial = predict(&explanations[1].rig, &closed_loop, &plan.reference).unwrap();
        trial.force.unwrap().iter().fold(0.0, |most: f64, value| most.max(*value))
    };
    assert!(force(&alone.unwrap()) > 4.0);
    assert!(force(&both.unwrap()) <= tight.with_margin().force.unwrap());
}

#[test]
fn what_responds_alike_cannot_be_told_and_the_plan_says_so() {
    let (plan, ..) = planned(&[RELAXATION, RELAXATION], &LIMITS, true);
    assert!(plan.unwrap().expected[0] < 1e-3);
}

#[test]
fn relaxation_is_told_from_damping_by_more_than_one_motion() {
    let (plan, ..) = planned(&[RELAXATION, DRAG], &LIMITS, true);
    assert!(plan.unwrap().expected[0] >= DECISIVE_ENERGY);
}

#[test]
fn without_a_recording_the_first_trial_explores() {
    let (plan, ..) = planned(&[""], &LIMITS, false);
    let plan = plan.unwrap();
    assert!(plan.is_worth_running() && plan.new_states > 0.3, "{plan:?}");
}

#[test]
fn a_clamped_tool_starts_where_its_contact_rests() {
    // The contact is twice as stiff as the position loop, and was recorded from 2 mm off its rest: begun there, every motion would
    // leap by more than the limits allow, and none was found.
    let mut rig = bench("");
    let contact = rig.contact.as_mut().unwrap();
    contact.bilateral = true;
    contact.surface = 0.001;
    contact.stiffness = 1600.0;
    let time: Vec<f64> = (0..8000).map(|row| row as f64 * 1e-3).collect();
    let position: Vec<f64> = time.iter().map(|t| 0.001 - 0.002 * (2.0 * t).cos()).collect();
    let force = position.iter().map(|x| 1600.0 * (x - 0.001)).collect();
    let trials = [Recording { time, position, force: Some(force), ..Recording::default() }];
    let closed_loop = LoopModel::new(&rig, &trials);
    let explanations = [Explanation { physics: Vec::new(), rig: rig.clone() }];
    let limits = Limits { position: [-0.0015, 0.0035], force: Some(4.0), effort: Some(4.0), ..LIMITS };
    let noise = Noise::of(&rig, &trials, [0.0; 2]);
    let situation = Situation {
        explanations: &explanations,
        questions: &[],
        trials: &trials,
        limits: &limits,
        noise,
        closed_loop,
        ease: 1.0,
        searches: true,
    };
    let plan = plan(&situation).unwrap();
    assert!(plan.is_worth_running(), "{plan:?}");
    let predicted = predict(&rig, &closed_loop, &plan.reference).unwrap();
    let deepest = predicted.force.unwrap().iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    assert!(deepest <= limits.with_margin().force.unwrap(), "{deepest}");
}

/// A contact that was pressed slowly, once, and the bench alone explains it. A trial of six seconds cannot show all: the one that searches for effects of the list tells more of them,
/// counted along its motion, than the one that goes where nothing was yet.
#[test]
fn where_nothing_is_open_a_trial_shows_what_the_recordings_could_hide() {
    let rig = bench("");
    let (slow, short) = (Limits { speed: 0.02, ..LIMITS }, Limits { duration_s: 6.0, ..LIMITS });
    let closed_loop = LoopModel::new(&rig, &[]);
    let answer = [Explanation { physics: Vec::new(), rig: rig.clone() }];
    let noise = Noise { position: 3e-5, force: Some(0.09), effort: Some(0.1) };
    let situation = |trials: &[Recording], limits: &Limits, searches: bool| {
        let (explanations, questions) = (&answer, &[]);
        plan(&Situation { explanations, questions, trials, limits, noise, closed_loop, ease: 1.0, searches }).unwrap()
    };
    let first = situation(&[], &slow, false);
    let trials = [predict(&rig, &closed_loop, &first.reference).unwrap()];
    let [found, blind] = [true, false].map(|searches| situation(&trials, &short, searches));
    assert!(found.searches_on(), "{found:?}");
    assert_eq!(blind.departures, 0.0);
    let travel = 0.02;
    let hidden = departures(&rig, &trials, &Recorded::new(&rig, &trials, &closed_loop, &noise, travel));
    let steps = steps(&rig, travel);
    let told = |plan: &Plan| {
        let along = |rig: &Rig| predict(rig, &closed_loop, &plan.reference).unwrap();
        let own = LinearizedResponse::new(&rig, &steps, &closed_loop, &plan.reference, &noise).unwrap();
        let energy = |hidden: &Departure| own.discrepancy(&whitened(&along(&hidden.rig), &noise), &prior(steps.len()));
        information(&hidden, &hidden.iter().map(energy).collect::<Vec<f64>>())
    };
    assert!(
        told(&found) > 1.05 * told(&blind),
        "{} {}: {:?} {:?}",
        told(&found),
        told(&blind),
        found.motions,
        blind.motions
    );
}
