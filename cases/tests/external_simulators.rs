//! External simulators against our own at a far finer step: the same rig, the same trial, the same law. They are
//! left out, with a word, where the simulators have not been set up (`cases --source mujoco` does that).

use std::path::PathBuf;

use palpate_cases::closed_loop::{self, Encoder, LoopSetup, SAMPLE_PERIOD_S, SimulatedTrial};
use palpate_cases::effect::actuator::{EffortLag, EffortSaturation};
use palpate_cases::effect::delay::{ChannelDelay, ToolInertia};
use palpate_cases::effect::force_range::ForceSaturation;
use palpate_cases::effect::friction::{CoulombFriction, StribeckFriction};
use palpate_cases::effect::gravity::GravityLoad;
use palpate_cases::effect::stiffness::NonlinearStiffness;
use palpate_cases::effect::transmission::TransmissionCompliance;
use palpate_cases::effect::{NominalMotion, SimulatedEffect, effect_rng};
use palpate_cases::excitation::{self, Excitation};
use palpate_cases::external_simulators::shape;
use palpate_cases::nominal::{NominalParameters, PdGains};
use palpate_cases::physics::RigModel;
use palpate_cases::python;
use palpate_cases::rng::{Stream, stream};
use palpate_cases::scale::Scale;
use palpate_cases::{CaseRequest, EffectSelection, ExternalSimulator, Simulator, SimulatorKind, draw_in};

const RIG: NominalParameters =
    NominalParameters { mass: 0.5, viscous: 3.0, stiffness: 600.0, damping: 6.0, surface: 0.001, bilateral: false };
const CONTROL: PdGains = PdGains { proportional: 800.0, derivative: 20.0, filter_hz: 100.0 };
const ENCODER: Encoder = Encoder { step: 1e-12, offset: 0.0 };

/// Error of a reading of the finest force sensor of a case, N: what is far below it is in no recording.
const FLOOR: f64 = 0.0101;

fn simulator(source: SimulatorKind) -> Option<ExternalSimulator> {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../target/python"));
    let home = std::env::var_os("PALPATE_PYTHON_HOME").map_or_else(beside, PathBuf::from);
    match python::find(&home, &python::SIMULATORS) {
        Ok(python) => Some(ExternalSimulator::start(&python, source).unwrap()),
        Err(missing) => {
            eprintln!("left out: {missing}");
            None
        }
    }
}

fn scene(nominal: NominalParameters) -> NominalMotion {
    let travel = (-0.006, 0.006);
    NominalMotion {
        nominal,
        depth: 0.005,
        force: 3.5,
        effort: 5.0,
        speed: 0.03,
        travel,
        duration: 8.0,
        scale: Scale::BENCH,
    }
}

/// The first eight seconds of a rich trial.
fn path(nominal: NominalParameters) -> Vec<f64> {
    let depths = excitation::depth_path(Excitation::Rich, &nominal, 0.005, &mut stream(3, 0, Stream::Excitation));
    excitation::reference_for(&depths[..8000], &nominal, &CONTROL)
}

fn setup(nominal: NominalParameters) -> LoopSetup {
    LoopSetup { nominal, control: CONTROL, encoder: ENCODER, steps: 200 }
}

fn ours(nominal: NominalParameters, configure: impl FnOnce(&mut RigModel)) -> SimulatedTrial {
    let mut model = RigModel::new(nominal, 0, SAMPLE_PERIOD_S / 200.0);
    configure(&mut model);
    closed_loop::simulate_trial(&setup(nominal), model, &path(nominal))
}

fn theirs(
    simulator: &mut ExternalSimulator,
    nominal: NominalParameters,
    effect: Option<(&'static str, f64)>,
) -> SimulatedTrial {
    let shape = effect.map(|(name, size)| (shape::draw(name, &scene(nominal), &shapes()).unwrap(), size));
    let effects: Vec<_> = shape.iter().map(|(shape, size)| (shape, *size)).collect();
    simulator.run(&setup(nominal), &[path(nominal)], &effects).unwrap().remove(0)
}

fn shapes() -> palpate_cases::rng::CaseRng {
    stream(4, 0, Stream::Effect)
}

/// RMS difference of force and of effort over the floor, but for the rows at which either tool crosses the surface:
/// on which side of the damper's step they fall is a matter of micrometres.
fn apart(nominal: NominalParameters, one: &SimulatedTrial, other: &SimulatedTrial) -> (f64, f64) {
    let near = |trial: &SimulatedTrial, row: usize| {
        !nominal.bilateral
            && (trial.position[row] - nominal.surface).abs() < 2.0 * trial.velocity[row].abs() * SAMPLE_PERIOD_S
    };
    let rows: Vec<usize> = (1..one.force.len()).filter(|row| !near(one, *row) && !near(other, *row)).collect();
    assert!(rows.len() > 7000, "{} rows", rows.len());
    let rms = |a: &[f64], b: &[f64]| {
        let sum: f64 = rows.iter().map(|row| (a[*row] - b[*row]).powi(2)).sum();
        (sum / rows.len() as f64).sqrt() / FLOOR
    };
    (rms(&one.force, &other.force), rms(&one.effort, &other.effort))
}

/// Our own shape of the effect that a simulator is told by the same name.
fn own_effect(name: &str, motion: &NominalMotion) -> Box<dyn SimulatedEffect> {
    let rng = &mut effect_rng(name, &shapes());
    match name {
        "nonlinear_stiffness" => Box::new(NonlinearStiffness::power(motion, rng)),
        "coulomb_friction" => Box::new(CoulombFriction::even(motion)),
        "stribeck_friction" => Box::new(StribeckFriction::exponential(motion, rng)),
        "gravity_load" => Box::new(GravityLoad::constant(motion, rng)),
        "transmission_compliance" => Box::new(TransmissionCompliance::draw(motion, rng)),
        "effort_saturation" => Box::new(EffortSaturation::draw(motion)),
        "effort_lag" => Box::new(EffortLag),
        "tool_inertia" => Box::new(ToolInertia { mass: motion.nominal.mass }),
        "channel_delay" => Box::new(ChannelDelay),
        "force_saturation" => Box::new(ForceSaturation::sharp(motion)),
        _ => panic!("{name} has no own_effect"),
    }
}

/// Holds `simulator` against our own simulation: without an effect, clamped and not, and with each of `effects`, which
/// have a size and how close they are to come. Without it the same trial is off by far more.
fn compare_simulators(source: SimulatorKind, plain: f64, effects: &[(&'static str, f64, f64)]) {
    let Some(mut simulator) = simulator(source) else { return };
    for bilateral in [false, true] {
        let nominal = NominalParameters { bilateral, ..RIG };
        let (force, effort) = apart(nominal, &ours(nominal, |_| ()), &theirs(&mut simulator, nominal, None));
        eprintln!("{source:?} plain, bilateral {bilateral}: {force:.3} {effort:.3}");
        assert!(force < plain && effort < plain, "bilateral {bilateral}: {force} {effort}");
    }
    let nothing = ours(RIG, |_| ());
    for (name, size, close) in effects {
        let own = ours(RIG, |model| own_effect(name, &scene(RIG)).apply(*size, model));
        let (force, effort) = apart(RIG, &own, &theirs(&mut simulator, RIG, Some((name, *size))));
        let (there, felt) = apart(RIG, &own, &nothing);
        eprintln!("{source:?} {name}: {force:.3} {effort:.3}, its own {there:.3} {felt:.3}");
        assert!(force < *close && effort < *close, "{name}: {force} {effort}");
        assert!(there.max(felt) > 2.0 * close, "{name}: {there} {felt}");
    }
}

// A tenth of the floor: what a step of 0.1 ms leaves of a trial with twenty touches. MuJoCo's friction creeps where ours
// holds, so the tool stands elsewhere by micrometres and the controller pushes on: the effort tells.
#[test]
fn mujoco_plays_the_nominal_rig_and_its_effects() {
    let effects = [
        ("coulomb_friction", 2.0, 6.0),
        ("gravity_load", 5.0, 0.15),
        ("transmission_compliance", 150.0, 0.15),
        ("effort_saturation", 1.5, 0.15),
        ("effort_lag", 0.005, 0.15),
        ("tool_inertia", 0.2, 0.15),
        ("channel_delay", 0.0025, 0.15),
        ("force_saturation", 1.0, 0.15),
    ];
    compare_simulators(SimulatorKind::Mujoco, 0.1, &effects);
}

// Steps of half a millisecond: a touch is noticed at the end of one. The tip's inertia is a mean over two of them, between
// which the commanded effort leaps.
#[test]
fn drake_plays_the_nominal_rig_and_its_effects() {
    let effects = [
        ("coulomb_friction", 2.0, 0.2),
        ("gravity_load", 5.0, 0.2),
        ("transmission_compliance", 150.0, 0.2),
        ("effort_saturation", 1.5, 0.2),
        ("tool_inertia", 0.2, 0.4),
    ];
    compare_simulators(SimulatorKind::Drake, 0.15, &effects);
}

// Bristles bend by micrometres before they slip.
#[test]
fn exudyn_plays_the_nominal_rig_and_its_effects() {
    let effects = [
        ("nonlinear_stiffness", 0.3, 0.05),
        ("coulomb_friction", 2.0, 0.5),
        ("stribeck_friction", 3.0, 0.5),
        ("gravity_load", 5.0, 0.05),
        ("transmission_compliance", 150.0, 0.05),
    ];
    compare_simulators(SimulatorKind::Exudyn, 0.03, &effects);
}

/// Share of a sample by which `rest` is the rate of `signal`: the shift of least squares.
fn late(rows: &[usize], signal: &[f64], rest: &[f64]) -> f64 {
    let rate = |row: usize| 0.5 * (signal[row + 1] - signal[row - 1]);
    let (above, below) = rows
        .iter()
        .fold((0.0, 0.0), |(above, below), row| (above + rate(*row) * rest[*row], below + rate(*row) * rate(*row)));
    above / below
}

/// Samples by which the force comes late against `K p + B v` of the recorded positions, and against what the recorded
/// effort has left over of `m a + b v`: all by differences about a row, for a recording has no more.
fn lateness(nominal: &NominalParameters, trial: &SimulatedTrial) -> (f64, f64) {
    let (x, force, effort) = (&trial.position, &trial.force, &trial.effort);
    let near = |row: usize| !nominal.bilateral && x[row - 3..=row + 3].iter().any(|x| x - nominal.surface < 1e-4);
    let rows: Vec<usize> = (4..x.len() - 4).filter(|row| !near(*row)).collect();
    assert!(rows.len() > 2000, "{} rows in contact", rows.len());
    let apart = |of: &dyn Fn(usize, f64, f64) -> f64| -> Vec<f64> {
        (0..x.len())
            .map(|row| {
                if row == 0 || row + 1 == x.len() {
                    return 0.0;
                }
                let (v, a) =
                    ((x[row + 1] - x[row - 1]) / (2.0 * SAMPLE_PERIOD_S), x[row + 1] - 2.0 * x[row] + x[row - 1]);
                of(row, v, a / SAMPLE_PERIOD_S.powi(2))
            })
            .collect()
    };
    // An effort is held from its row to the next: about a row it is the mean of two.
    let left = |row: usize| 0.5 * (effort[row - 1] + effort[row]) - force[row];
    let law = |row: usize, v: f64, _: f64| nominal.stiffness * (x[row] - nominal.surface) + nominal.damping * v;
    let contact = apart(&|row, v, a| law(row, v, a) - force[row]);
    let drive = apart(&|row, v, a| left(row) - nominal.mass * a - nominal.viscous * v);
    (late(&rows, force, &contact), late(&rows, force, &drive))
}

// MuJoCo's steps of a tenth of a row take their velocity half a step before; Drake's damper lags or leads by a quarter of
// a sample, a few per cent beside the spring. Read at the ends of its steps, Drake's force was
// late by 0.30 against the drive and, clamped, by a whole step against the contact.
#[test]
fn force_position_and_effort_of_a_row_belong_to_one_instant() {
    for source in [SimulatorKind::Mujoco, SimulatorKind::Drake, SimulatorKind::Exudyn] {
        let Some(mut simulator) = simulator(source) else { return };
        for bilateral in [false, true] {
            let nominal = NominalParameters { bilateral, ..RIG };
            let (contact, drive) = lateness(&nominal, &theirs(&mut simulator, nominal, None));
            eprintln!("{source:?}, bilateral {bilateral}: force late by {contact:.4} and {drive:.4} of a sample");
            assert!(contact.abs() < 0.1 && drive.abs() < 0.1, "{source:?} {bilateral}: {contact} {drive}");
        }
    }
}

/// RMS over the floor of the mean force against `law` of depth, velocity and acceleration, all means over a
/// millisecond in contact, and of the mean force itself.
fn against(trial: &SimulatedTrial, law: impl Fn(f64, f64, f64) -> f64) -> (f64, f64) {
    let (mut sum, mut all, mut count) = (0.0, 0.0, 0.0);
    for row in 1..trial.force.len() - 1 {
        let depth = |row: usize| trial.position[row] - RIG.surface;
        // Neither touching nor leaving: the mean of a law with a step is no law of the means.
        if [row - 1, row, row + 1].into_iter().any(|row| depth(row) < 1e-4 || trial.force[row] <= 0.0) {
            continue;
        }
        let v = (trial.position[row + 1] - trial.position[row]) / SAMPLE_PERIOD_S;
        let a = (trial.velocity[row + 1] - trial.velocity[row]) / SAMPLE_PERIOD_S;
        let force = trial.force_mean[row];
        sum += (force - law(0.5 * (depth(row) + depth(row + 1)), v, a)).powi(2);
        all += force * force;
        count += 1.0;
    }
    assert!(count > 2000.0, "{count} rows in contact");
    (f64::sqrt(sum / count) / FLOOR, f64::sqrt(all / count) / FLOOR)
}

#[test]
fn drake_has_the_contact_of_hunt_and_crossley() {
    let Some(mut simulator) = simulator(SimulatorKind::Drake) else { return };
    let rig = NominalParameters { damping: 0.0, ..RIG };
    let trial = theirs(&mut simulator, rig, Some(("hunt_crossley_damping", 10.0)));
    let (left, all) = against(&trial, |p, v, _| RIG.stiffness * p * (1.0 + 10.0 * v).max(0.0));
    let (without, _) = against(&trial, |p, _, _| RIG.stiffness * p);
    // A step's force is that of its end.
    eprintln!("Drake hunt_crossley_damping: {left:.3} of {all:.3}, without it {without:.3}");
    assert!(left < 0.6 && without > 10.0, "{left} {without}");
}

#[test]
fn mujocos_impedance_is_a_mass_that_is_moved_along() {
    let Some(mut simulator) = simulator(SimulatorKind::Mujoco) else { return };
    let nominal = |p: f64, v: f64| RIG.stiffness * p + RIG.damping * v;
    let trial = theirs(&mut simulator, RIG, Some(("environment_mass", 4.0)));
    let (left, all) = against(&trial, |p, v, a| nominal(p, v) + 0.2 * RIG.mass * a);
    let (without, _) = against(&trial, |p, v, _| nominal(p, v));
    eprintln!("Mujoco environment_mass: {left:.3} of {all:.3}, without it {without:.3}");
    assert!(left < 0.1 && without > 3.0, "{left} {without}");
}

#[test]
fn mujocos_soft_constraint_stiffens_by_its_manual() {
    let Some(mut simulator) = simulator(SimulatorKind::Mujoco) else { return };
    let shape = shape::draw("soft_constraint", &scene(RIG), &shapes()).unwrap();
    let values: Vec<f64> =
        palpate_cases::effect::EffectShape::parameters(&shape, 1.0).iter().map(|it| it.value).collect();
    let [low, high, width] = values[..] else { panic!("{values:?}") };
    // d(p) by the manual, midpoint 1/2 and power 2; the inverse inertia w cancels but for the mass: 1/(3 m).
    let impedance = |p: f64| {
        let x = (p / width).min(1.0);
        let y = if x < 0.5 { 2.0 * x * x } else { 1.0 - 2.0 * (1.0 - x) * (1.0 - x) };
        low + y * (high - low)
    };
    let weight = |d: f64| d / (1.0 - d);
    let middle = 0.5 * (low + high);
    let law = |p: f64, v: f64, a: f64| {
        let d = impedance(p);
        let ratio = weight(d) / weight(middle);
        ratio * (RIG.stiffness * p * d / middle + RIG.damping * v) + 3.0 * RIG.mass * weight(d) * a
    };
    let trial = theirs(&mut simulator, RIG, Some(("soft_constraint", 1.0)));
    let (left, all) = against(&trial, law);
    let (without, _) = against(&trial, |p, v, _| RIG.stiffness * p + RIG.damping * v);
    eprintln!("Mujoco soft_constraint: {left:.3} of {all:.3}, without it {without:.3}");
    assert!(left < 0.15 && without > 10.0, "{left} {without}");
}

#[test]
fn nothing_is_nothing_wherever_it_is_drawn() {
    let request =
        CaseRequest { selection: Some(EffectSelection::Nothing), effort: Some(true), ..CaseRequest::default() };
    for source in [SimulatorKind::Mujoco, SimulatorKind::Drake, SimulatorKind::Exudyn] {
        let Some(mut simulator) = simulator(source) else { return };
        let truth = draw_in(&mut simulator, 32, 0, &request).unwrap().truth;
        eprintln!("{source:?}: {:.4} of the floor", truth.strength);
        assert!(truth.effects.is_empty() && truth.strength < 0.3, "{source:?}: {}", truth.strength);
    }
}

#[test]
fn a_case_is_drawn_as_at_home() {
    let selection = EffectSelection::single("gravity_load", Some(3.0));
    let request =
        CaseRequest { selection: Some(selection), bench: Some(true), rotary: Some(false), ..CaseRequest::default() };
    for source in [SimulatorKind::Mujoco, SimulatorKind::Exudyn] {
        let Some(mut simulator) = simulator(source) else { return };
        let case = draw_in(&mut simulator, 31, 0, &request).unwrap();
        assert_eq!(case.truth.source, source);
        assert!((case.truth.strength / 3.0 - 1.0).abs() < 0.05, "{}", case.truth.strength);
        assert_eq!(case, draw_in(&mut simulator, 31, 0, &request).unwrap());
        let other = CaseRequest { selection: Some(EffectSelection::single("adhesion", None)), ..request.clone() };
        assert!(draw_in(&mut simulator, 31, 0, &other).unwrap_err().to_string().contains("adhesion"));
    }
}
