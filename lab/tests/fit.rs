//! The search for the best values: where it begins is not where it ends.

use palpate_lab::diagnose::fit::{self, Data};
use palpate_lab::diagnose::model::index;
use palpate_lab::diagnose::{sensed, study};
use palpate_lab::rig::Rig;
use palpate_lab::simulate::simulate;

const BENCH: &str = "[rig]\nname = \"bench\"\ncoordinate = \"linear\"\n\
    [contact]\nmodel = \"kelvin_voigt\"\nsurface_m = 0.0\nstiffness_n_m = 300\ndamping_n_s_m = 5\n\
    [sensors]\nposition_resolution_m = 5e-6\nforce_resolution_n = 0.005\nforce_noise_n = 0.01\n\
    [reference]\nfree_depth_m = -0.003\ncontact_depth_m = 0.008\nperiod_s = 1.6\ncontact_s = 1.1\n\
    smoothing_s = 0.05\nsine_amplitude_m = 0.002\nsine_frequency_hz = 3\n\
    [simulation]\nduration_s = 8\nrate_hz = 400\n";

/// A clock's fraction of a sample costs energy where it stands, at the start of a search as at its end: counted at the end
/// alone, no step can earn it, and the search does not move.
#[test]
fn a_search_that_begins_with_a_clock_at_its_bound_moves() {
    let rig = Rig::parse(BENCH, "rig.toml").unwrap();
    let recording = simulate(&rig, 1, "rig.toml").unwrap().recording;
    let study = study(&rig, "rig.toml", sensed(&rig, "rig.toml", &[recording]).unwrap(), 1).unwrap();
    let whitener = study.even_floors();
    let data = Data { trials: &study.studio.trials, whitener: &whitener, rows: None };
    let from = |late: f64, stiffness: f64| {
        let mut start = study.given.clone();
        (start[index::FORCE_TIMING], start[index::STIFFNESS]) = (late, stiffness);
        fit::fit(&data, &study.nominal, &start, &study.scene(&study.nominal, &start))
    };
    let bound = 0.25 / 400.0;
    let straight = from(0.0, 300.0);
    // A thousandth of K beside the best is less than the clock's nine of energy; the search has to go there all the same.
    let best = straight.values[index::STIFFNESS];
    let found = from(bound, 1.0005 * best);
    println!("{straight:?}\n{found:?}");
    // A search ends where a step earns less than a millionth of the energy and a thousandth.
    assert!((found.energy - straight.energy).abs() < 0.01 + 1e-5 * straight.energy, "{found:?}");
    assert!(found.values[index::FORCE_TIMING].abs() < 0.5 * bound, "{found:?}");
}
