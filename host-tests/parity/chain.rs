//! The front end, and the whole way from samples to the estimate.

use super::{Case, EPS, Parity};
use crate::reference::{self, RegressionRow};
use crate::rig;
use crate::tolerance::Ledger;
use palpate::{
    BlockConfig, BlockLeastSquares, Flags, FrontEnd, FrontEndConfig, FrontEndState, Identifier, Sample, StreamConfig,
    Velocity,
};

/// The textbook front end on all samples, in SI.
fn textbook(case: &Case, velocity: Velocity) -> Vec<RegressionRow> {
    let mut front_end = reference::FrontEnd::new(&FrontEndConfig { velocity, ..case.front_end });
    case.samples.iter().map(|sample| front_end.update(sample)).collect()
}

fn largest(rows: &[RegressionRow], pick: fn(&RegressionRow) -> f64) -> f64 {
    rows.iter().map(|row| pick(row).abs()).fold(0.0, f64::max)
}

fn front_end(velocity: Velocity, name: &str) {
    for (kind, cases) in [("simulated", Case::simulated()), ("recorded", Case::recorded())] {
        let mut errors: [Ledger; 3] = Default::default();
        for case in &cases {
            let units = case.front_end.units;
            let library = FrontEnd::new(FrontEndConfig { velocity, ..case.front_end }).expect("sound settings");
            let mut state = FrontEndState::default();
            let rows = textbook(case, velocity);
            let full = [largest(&rows, |r| r.x), largest(&rows, |r| r.v), largest(&rows, |r| r.force)];
            let period = f64::from(case.front_end.period);
            // Ten roundings of the full scale; and in the rate the rounding of the position, over one period.
            let tolerance = full.map(|f| 3e-6 * f);
            let way = |sample: &Sample| f64::from(sample.position - case.front_end.surface).abs();
            let farthest = case.samples.iter().map(way).fold(0.0, f64::max);
            let tolerance = [tolerance[0], tolerance[1] + EPS * farthest / period, tolerance[2]];
            for (row, sample) in rows.iter().zip(&case.samples) {
                let o = library.update(&mut state, *sample).expect("a good sample").observation;
                let si = [o.penetration * units.penetration, o.rate * units.rate, o.force * units.force];
                for (i, want) in [row.x, row.v, row.force].into_iter().enumerate() {
                    let what = format!("{name} on {}, channel {i}", case.name);
                    errors[i].compare(&what, si[i].into(), want, full[i], tolerance[i]);
                }
            }
        }
        if !cases.is_empty() {
            let [depth, mut all, force] = errors;
            all.conclude(&format!("front end {name}, rate, {kind}"), 5000);
            // Of the paper's front end depth and force are the sensors' own numbers, so exact; all three never are.
            all.join(&depth);
            all.join(&force);
            all.conclude(&format!("front end {name}, all, {kind}"), 15_000);
        }
    }
}

#[test]
fn the_matched_front_end_is_the_textbook_filter() {
    front_end(Velocity::Matched, "matched");
}

#[test]
fn the_paper_front_end_is_the_textbook_filter() {
    front_end(Velocity::Paper, "paper");
}

/// Samples through the identifier against samples through the textbook filter and QR, wherever both K and B are solved for.
fn samples_to_estimate(parity: &mut Parity, case: &Case, window: u16) {
    let law = BlockLeastSquares::new(BlockConfig::of(window)).expect("sound settings");
    let stream = StreamConfig { front_end: case.front_end, ..StreamConfig::BENCH };
    let mut identifier = Identifier::<_, 300>::new(stream, law).expect("sound settings");
    let rows = textbook(case, Velocity::Matched);
    let (mut contact, mut checkpoints) = (Vec::new(), Vec::new());
    for (k, (row, sample)) in rows.iter().zip(&case.samples).enumerate() {
        let estimate = identifier.update(*sample).expect("a good sample");
        if estimate.flags.contains(Flags::NO_CONTACT) {
            contact.clear();
            continue;
        }
        contact.push(*row);
        let full = contact.len() >= usize::from(window);
        if k % 11 == 0 && full && !estimate.flags.intersects(Flags::DAMPING_HELD | Flags::HELD) {
            let seen = &contact[contact.len() - usize::from(window)..];
            checkpoints.push((estimate.impedance, reference::least_squares(seen), super::rounding(seen)));
        }
    }
    parity.contact(&case.name, &checkpoints);
}

#[test]
fn samples_to_estimate_on_simulated_contacts() {
    let mut parity = Parity::new("matched, bls 300, whole way", [5e-6, 5e-5], 4.0);
    Case::simulated().iter().for_each(|case| samples_to_estimate(&mut parity, case, 300));
    parity.conclude("simulated", 3000);
}

#[test]
fn samples_to_estimate_on_recorded_contacts() {
    let cases = Case::recorded();
    // A single holds the absolute position: 27 um of travel leave 6e-7 of 2.5 um of depth, and a rate one period worse.
    let mut parity = Parity::new("matched, bls 50, whole way", [5e-5, 1e-3], 16.0);
    cases.iter().for_each(|case| samples_to_estimate(&mut parity, case, 50));
    if !cases.is_empty() {
        parity.conclude("recorded", 300);
    }
}

#[test]
fn the_bench_runs_the_very_laws_that_are_tested_bare() {
    let case = Case::simulated().swap_remove(3);
    let (mut bench, mut laws, mut compared) = (rig::bench(StreamConfig::BENCH), rig::Bare::all(), 0);
    for sample in &case.samples[..3000] {
        let estimates = bench.update(*sample).expect("a good sample");
        if estimates[0].flags.contains(Flags::NO_CONTACT) {
            continue;
        }
        let newest = bench.recent().newest().expect("a row");
        for (law, e) in laws.iter_mut().zip(&estimates) {
            let step = (law.update)(newest);
            assert_eq!((e.impedance, e.innovation), (step.estimate, step.innovation), "{}", law.method.name());
            compared += 1;
        }
    }
    assert!(compared > 9 * 2000, "{compared}");
}
