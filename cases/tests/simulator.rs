//! The simulator against closed forms and against itself.

use palpate_cases::closed_loop::{Encoder, LoopSetup, SAMPLE_PERIOD_S, SimulatedTrial, simulate_trial};
use palpate_cases::effect::registry::ALL;
use palpate_cases::effect::{self, NominalMotion, SimulatedEffect};
use palpate_cases::excitation::{self, Excitation};
use palpate_cases::nominal::{NominalParameters, PdGains};
use palpate_cases::physics::RigModel;
use palpate_cases::physics::contact::Contact;
use palpate_cases::physics::drive::Drive;
use palpate_cases::rng::{Stream, stream};
use palpate_cases::scale::Scale;

const RIG: NominalParameters =
    NominalParameters { mass: 0.5, viscous: 3.0, stiffness: 600.0, damping: 6.0, surface: 0.001, bilateral: false };
const CONTROL: PdGains = PdGains { proportional: 800.0, derivative: 20.0, filter_hz: 100.0 };
const DT: f64 = 5e-5;

fn scene() -> NominalMotion {
    let travel = (-0.006, 0.006);
    NominalMotion {
        nominal: RIG,
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
fn simulate(nominal: NominalParameters, steps: usize, configure: impl Fn(&mut RigModel)) -> SimulatedTrial {
    let depths = excitation::depth_path(Excitation::Rich, &nominal, 0.005, &mut stream(3, 0, Stream::Excitation));
    let reference = excitation::reference_for(&depths[..8000], &nominal, &CONTROL);
    let mut model = RigModel::new(nominal, 0, SAMPLE_PERIOD_S / steps as f64);
    configure(&mut model);
    let encoder = Encoder { step: 1e-12, offset: 0.0 };
    simulate_trial(&LoopSetup { nominal, control: CONTROL, encoder, steps }, model, &reference)
}

fn apart(one: &[f64], other: &[f64]) -> f64 {
    (one.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / one.len() as f64).sqrt()
}

#[test]
fn halving_the_step_quarters_the_error_of_a_smooth_trial() {
    let glued = NominalParameters { bilateral: true, ..RIG };
    let [coarse, middle, fine] = [10, 20, 40].map(|steps| simulate(glued, steps, |_| ()).force);
    let ratio = apart(&coarse, &middle) / apart(&middle, &fine);
    assert!((3.6..4.4).contains(&ratio), "{ratio}");
    assert!(apart(&middle, &fine) < 1e-5, "{}", apart(&middle, &fine));
}

#[test]
fn halving_the_step_changes_no_effect_beyond_the_floor() {
    let rng = stream(4, 0, Stream::Effect);
    for known in &ALL {
        let shape = effect::draw(known.name, &scene(), &rng).unwrap();
        let size = shape.size_range().initial;
        let [usual, fine] = [20, 40].map(|steps| simulate(RIG, steps, |model| shape.apply(size, model)));
        let (moved, pressed) = (apart(&usual.position, &fine.position), apart(&usual.force, &fine.force));
        assert!(moved < 1e-6, "{}: {moved} m", known.name);
        assert!(pressed < 2e-3, "{}: {pressed} N", known.name);
    }
}

/// Flies at 0.1 m/s against a surface that damps nothing, and comes back.
fn bounce(configure: impl Fn(&mut Contact)) -> f64 {
    let rig = NominalParameters { viscous: 0.0, damping: 0.0, surface: 0.0, ..RIG };
    let mut contact = Contact::new(rig);
    configure(&mut contact);
    let mut drive = Drive::new(rig);
    drive.rest_at(-0.001, &mut contact, DT);
    drive.tool.velocity = 0.1;
    for step in 0..10_000 {
        drive.step(0.0, &mut contact, f64::from(step) * DT, DT);
    }
    assert!(drive.tool.position < 0.0);
    -drive.tool.velocity
}

#[test]
fn an_elastic_surface_returns_the_energy_of_the_blow() {
    let shapes = ["nonlinear_stiffness", "layered_stiffness", "environment_mass", "buckling"];
    assert!((bounce(|_| ()) - 0.1).abs() < 1e-5, "{}", bounce(|_| ()));
    for name in shapes {
        for index in 0..4 {
            let shape = effect::draw(name, &scene(), &stream(5, index, Stream::Effect)).unwrap();
            let mut model = RigModel::new(RIG, 0, DT);
            shape.apply(shape.size_range().initial, &mut model);
            let away = bounce(|contact| {
                let other = model.contact.clone();
                (contact.spring, contact.layer, contact.bump, contact.entrained_mass) =
                    (other.spring, other.layer, other.bump, other.entrained_mass);
            });
            // A hump stands a little beyond the surface, a step that the tool falls over only once.
            let close = if name == "buckling" { 2e-3 } else { 1e-4 };
            assert!((away - 0.1).abs() < close, "{name} {index}: {away}");
        }
    }
}

#[test]
fn mass_that_is_moved_along_takes_no_energy() {
    let rig = NominalParameters { viscous: 0.0, damping: 0.0, surface: 0.0, ..RIG };
    let mut model = RigModel::new(rig, 0, DT);
    any("environment_mass").apply(10.0, &mut model);
    let RigModel { mut drive, mut contact, .. } = model;
    drive.rest_at(-0.001, &mut contact, DT);
    drive.tool.velocity = 0.1;
    let mut deepest = 0f64;
    for step in 0..4000 {
        drive.step(0.0, &mut contact, f64::from(step) * DT, DT);
        deepest = deepest.max(drive.tool.position);
    }
    // Where it turns nothing moves, and all of the energy is in the spring.
    let expected = 0.1 * (rig.mass / rig.stiffness).sqrt();
    assert!((deepest / expected - 1.0).abs() < 3e-3, "{deepest} {expected}");
}

#[test]
fn a_lagging_effort_brings_the_speed_of_its_step_response() {
    let rig = NominalParameters { viscous: 0.0, ..RIG };
    let mut model = RigModel::new(rig, 0, DT);
    let time = 0.004;
    any("effort_lag").apply(time, &mut model);
    let RigModel { mut drive, mut contact, .. } = model;
    drive.rest_at(-0.1, &mut contact, DT);
    (0..300).for_each(|step| drive.step(1.0, &mut contact, f64::from(step) * DT, DT));
    let t = 300.0 * DT;
    let expected = (t - time * (1.0 - (-t / time).exp())) / rig.mass;
    assert!((drive.tool.velocity - expected).abs() < 1e-12, "{} {expected}", drive.tool.velocity);
}

#[test]
fn a_tool_below_its_friction_stands_exactly_and_above_it_obeys_newton() {
    let rig = NominalParameters { viscous: 0.0, ..RIG };
    let shape = effect::draw("coulomb_friction", &scene(), &stream(6, 0, Stream::Effect)).unwrap();
    let mut model = RigModel::new(rig, 0, DT);
    shape.apply(5.0, &mut model);
    let (forward, _) = model.drive.friction.coulomb;
    let RigModel { mut drive, mut contact, .. } = model;
    drive.rest_at(-0.01, &mut contact, DT);
    for step in 0..1000 {
        drive.step(0.999 * forward, &mut contact, f64::from(step) * DT, DT);
        assert_eq!((drive.tool.position, drive.tool.velocity), (-0.01, 0.0));
    }
    (0..200).for_each(|step| drive.step(forward + 0.3, &mut contact, f64::from(step) * DT, DT));
    let (t, a) = (200.0 * DT, 0.3 / rig.mass);
    assert!((drive.tool.velocity - a * t).abs() < 1e-12, "{}", drive.tool.velocity);
    assert!((drive.tool.position + 0.01 - 0.5 * a * t * t).abs() < 1e-12);
}

#[test]
fn a_stiff_transmission_is_one_mass() {
    let shape = effect::draw("transmission_compliance", &scene(), &stream(7, 0, Stream::Effect)).unwrap();
    let [one, two] = [0.0, 1.0].map(|size| {
        simulate(RIG, 20, |model| {
            if size > 0.0 {
                shape.apply(size, model);
            }
        })
    });
    assert!(apart(&one.position, &two.position) < 2e-6, "{}", apart(&one.position, &two.position));
    assert!(apart(&one.position, &two.position) > 0.0);
}

#[test]
fn backlash_lets_the_motor_move_alone_through_its_gap() {
    let shape = effect::draw("backlash", &scene(), &stream(8, 0, Stream::Effect)).unwrap();
    let mut model = RigModel::new(RIG, 0, DT);
    shape.apply(50.0, &mut model);
    let gap = shape.parameters(50.0)[0].value;
    let RigModel { mut drive, mut contact, .. } = model;
    drive.rest_at(-0.01, &mut contact, DT);
    let mut step = 0;
    while drive.motor.position + 0.01 < 0.49 * gap {
        drive.step(0.2, &mut contact, f64::from(step) * DT, DT);
        assert_eq!(drive.tool.position, -0.01);
        step += 1;
    }
    (0..2000).for_each(|step| drive.step(0.2, &mut contact, f64::from(step) * DT, DT));
    assert!(drive.tool.position > -0.01);
    assert!(drive.motor.position - drive.tool.position < 0.51 * gap);
}

fn any(name: &str) -> Box<dyn SimulatedEffect> {
    effect::draw(name, &scene(), &stream(9, 0, Stream::Effect)).unwrap()
}

/// Force over a slow path of depths.
fn press(shape: &dyn SimulatedEffect, size: f64, depths: &[f64], seconds: f64) -> Vec<f64> {
    let mut model = RigModel::new(RIG, 0, DT);
    shape.apply(size, &mut model);
    let steps = (seconds / DT) as usize;
    let mut forces = Vec::new();
    let mut at = 0;
    for leg in depths.windows(2) {
        for step in 1..=steps {
            let depth = leg[0] + (leg[1] - leg[0]) * step as f64 / steps as f64;
            at += 1;
            model.contact.advance(RIG.surface + depth, at as f64 * DT, DT);
        }
        forces.push(model.contact.react(0.0).at(0.0));
    }
    forces
}

#[test]
fn a_hysteresis_loop_does_not_depend_on_speed() {
    let path = [0.0, 0.004, 0.002, 0.003, 0.001];
    let forms: Vec<_> = (0..6)
        .map(|index| {
            let shape = effect::draw("hysteresis", &scene(), &stream(9, index, Stream::Effect)).unwrap();
            let [slow, fast] = [1.0, 0.05].map(|seconds| press(shape.as_ref(), 3.0, &path, seconds));
            assert!(slow.iter().zip(&fast).all(|(a, b)| (a - b).abs() < 1e-3), "{slow:?} {fast:?}");
            // On the way down at 2 mm it pushes less than the bare spring, by most of its height.
            assert!(slow[1] < 0.002 * RIG.stiffness - 0.05, "{slow:?}");
            // A small way back does not reverse it, however long it takes.
            let back = press(shape.as_ref(), 3.0, &[0.0, 0.004, 0.004 - 2e-5], 1.0);
            assert!((0.012..0.15).contains(&(back[0] - back[1])), "{back:?}");
            shape.form()
        })
        .collect();
    assert!(forms.iter().any(|form| *form != forms[0]), "only one form was tried");
}

#[test]
fn lost_motion_is_flat_at_a_reversal() {
    let shape = any("lost_motion");
    let gap = shape.parameters(10.0)[0].value;
    let forces = press(shape.as_ref(), 10.0, &[0.0, 0.004, 0.004 - 0.5 * gap, 0.004 - 3.0 * gap], 0.1);
    assert_eq!(forces[0], forces[1]);
    assert!((forces[0] - forces[2] - 2.0 * gap * RIG.stiffness).abs() < 1e-9, "{forces:?}");
    let mut model = RigModel::new(RIG, 0, DT);
    shape.apply(10.0, &mut model);
    let at = |contact: &mut Contact, depth: f64| {
        contact.advance(RIG.surface + depth, 0.0, DT);
        contact.react(-0.1).at(0.0) - contact.react(0.0).at(0.0)
    };
    // Nor does a damper feel what does not reach it.
    assert!((at(&mut model.contact, 0.004) + 0.1 * RIG.damping).abs() < 1e-9);
    assert_eq!(at(&mut model.contact, 0.004 - 0.3 * gap), 0.0);
}

#[test]
fn a_neck_pulls_until_it_snaps_and_does_not_pull_on_approach() {
    let forces = press(any("adhesion").as_ref(), 4.0, &[-0.001, -1e-6, 0.003, -2e-4, -0.004, -1e-4], 0.1);
    assert_eq!((forces[0], forces[4]), (0.0, 0.0), "{forces:?}");
    assert!(forces[2] < -0.01 && forces[2] > -0.29, "{forces:?}");
    assert_eq!(forces[3], 0.0, "{forces:?}");
}

#[test]
fn a_dent_stays() {
    let forces = press(any("plastic_set").as_ref(), 6.0, &[0.0, 0.005, 0.002, 0.005, 0.002], 0.1);
    assert!(forces[1] < 0.002 * RIG.stiffness - 0.1, "{forces:?}");
    assert!((forces[1] - forces[3]).abs() < 1e-9 && (forces[0] - forces[2]).abs() < 1e-9, "{forces:?}");
}
