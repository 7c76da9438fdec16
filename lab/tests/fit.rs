//! The search for the best values: where it begins is not where it ends.

use palpate_lab::diagnose::estimation::levenberg_marquardt::{self, FitData};
use palpate_lab::diagnose::model::index;
use palpate_lab::diagnose::{problem, sensed};
use palpate_lab::rig::Rig;
use palpate_lab::simulate::simulate;

const BENCH: &str = "[rig]\nname = \"bench\"\ncoordinate = \"linear\"\n\
    [contact]\nmodel = \"kelvin_voigt\"\nsurface_m = 0.0\nstiffness_n_m = 300\ndamping_n_s_m = 5\n\
    [sensors]\nposition_resolution_m = 5e-6\nforce_resolution_n = 0.005\nforce_noise_n = 0.01\n\
    [reference]\nfree_depth_m = -0.003\ncontact_depth_m = 0.008\nperiod_s = 1.6\ncontact_s = 1.1\n\
    smoothing_s = 0.05\nsine_amplitude_m = 0.002\nsine_frequency_hz = 3\n\
    [simulation]\nduration_s = 8\nrate_hz = 400\n";

/// A clock's fraction of a sample costs energy where it stands, at the start of a search as at its end: counted at the end
/// alone, no step can earn it, and a search that begins with a clock at its bound does not move.
#[test]
fn a_search_that_begins_with_a_clock_at_its_bound_moves() {
    let rig = Rig::parse(BENCH, "rig.toml").unwrap();
    // Two samples late, of which the clock may take a quarter of one.
    let late = format!("{BENCH}[[effect]]\nname = \"channel_delay\"\ndelay_s = 0.005\n");
    let recording = simulate(&Rig::parse(&late, "rig.toml").unwrap(), 1, "rig.toml").unwrap().recording;
    let study = problem(&rig, "rig.toml", sensed(&rig, "rig.toml", &[recording]).unwrap(), 1).unwrap();
    let whitener = study.uniform_noise_models();
    let data = FitData { trials: &study.sampler.trials, whitener: &whitener, rows: None };
    let search = |start: &[f64]| {
        levenberg_marquardt::fit(&data, &study.nominal, start, &study.excitation_stats(&study.nominal, start))
    };
    let best = search(&study.given);
    assert!((best.values[index::FORCE_TIMING].abs() * 400.0 - 0.25).abs() < 1e-9, "{best:?}");
    // Beside the best in K by so little that there is less to earn than the nine that the clock costs at its bound.
    let beside = |share: f64| {
        let mut values = best.values.clone();
        values[index::STIFFNESS] *= 1.0 + share;
        (data.energy(&study.nominal, &values) - best.energy, values)
    };
    let share = 1e-3 * (4.0 / beside(1e-3).0).sqrt();
    let (rise, start) = beside(share);
    assert!((1.0..9.0).contains(&rise), "{rise}");
    let found = search(&start);
    println!("{best:?}\n{rise}\n{found:?}");
    // A search ends where a step earns less than a millionth of the energy.
    assert!(
        (found.energy - best.energy).abs() < 1e-5 * best.energy && found.energy < best.energy + 0.1 * rise,
        "{found:?}"
    );
}
