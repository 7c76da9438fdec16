//! What the front end makes of readings, sample by sample.

use super::*;

fn paper() -> FrontEnd {
    let config = FrontEndConfig { velocity: Velocity::Paper, bilateral: true, ..FrontEndConfig::BENCH };
    FrontEnd::new(config).expect("sound settings")
}

fn sample(position: f32, elapsed: f32) -> Sample {
    Sample { position, force: 1.0, elapsed }
}

#[test]
fn the_rate_is_kept_within_the_range_in_both_directions() {
    for direction in [1.0, -1.0] {
        let (front_end, mut state) = (paper(), FrontEndState::default());
        front_end.update(&mut state, sample(0.0, 1e-3)).expect("a sample");
        // A metre in a nanosecond, taken by filters that begin with it.
        let reading = front_end.update(&mut state, sample(direction, 1e-9)).expect("a sample");
        let rate = reading.observation.rate;
        assert!((rate / (direction * FrontEnd::MAX_MAGNITUDE) - 1.0).abs() < 1e-6, "{rate}");
    }
}

#[test]
fn the_rate_of_a_held_tool_ends_at_zero_and_never_in_subnormal_numbers() {
    let (front_end, mut state) = (paper(), FrontEndState::default());
    let mut smallest = f32::INFINITY;
    let mut last = f32::NAN;
    for k in 0..2_000_u16 {
        let position = 1e-3 * f32::from(k.min(50));
        last = front_end.update(&mut state, sample(position, 1e-3)).expect("a sample").observation.rate.abs();
        assert!(last == 0.0 || last >= FrontEnd::MIN_RATE, "{last:e} at {k}");
        if last > 0.0 {
            smallest = last.min(smallest);
        }
    }
    assert_eq!(last, 0.0);
    assert!(smallest < 1e-17, "it died away, down to {smallest:e}");
}

/// Units of powers of two, so that every conversion is exact.
fn scaled(velocity: Velocity, bilateral: bool) -> FrontEnd {
    let units = Units { penetration: 0.25, rate: 0.5, force: 2.0 };
    let config = FrontEndConfig { surface: 1.0, velocity, bilateral, units, ..FrontEndConfig::BENCH };
    FrontEnd::new(config).expect("sound settings")
}

#[test]
fn a_sample_is_taken_from_the_surface_in_internal_units() {
    let front_end = scaled(Velocity::Paper, true);
    assert_eq!(front_end.internal(&Sample { position: 1.5, force: 3.0, elapsed: 1e-3 }), (2.0, 1.5));
    assert_eq!(front_end.internal(&Sample { position: 0.5, force: -3.0, elapsed: 1e-3 }), (-2.0, -1.5));
}

#[test]
fn a_row_is_the_mean_and_the_slope_of_two_samples() {
    let previous = PreviousSample { position: 1.0, force: 3.0 };
    let now = PreviousSample { position: 4.0, force: 6.0 };
    let row = scaled(Velocity::Matched, false).unfiltered_row(&previous, &now, 0.125);
    // One internal unit of penetration a second is half one of rate.
    assert_eq!(row, Observation { penetration: 2.5, rate: 3.0 / 0.125 * 0.5, force: 4.5 });
}

#[test]
fn the_rate_is_that_of_the_tool_in_the_paper_s_filter_and_that_of_the_depth_in_the_matched_one() {
    for (velocity, bilateral, position, depth) in [
        (Velocity::Paper, false, -2.0, 0.0),
        (Velocity::Matched, false, 0.0, 0.0),
        (Velocity::Paper, true, -2.0, -2.0),
        (Velocity::Matched, true, -2.0, -2.0),
    ] {
        let (now, found, _) = scaled(velocity, bilateral).touch(&mut FrontEndState::default(), -2.0, 1.0);
        assert_eq!((now.position, found), (position, depth), "{velocity:?} {bilateral}");
    }
}

#[test]
fn a_period_is_the_nominal_one_within_a_ten_thousandth() {
    let front_end = paper();
    for (elapsed, nominal) in
        [(1e-3, true), (1.00009e-3, true), (0.99991e-3, true), (1.0002e-3, false), (0.9998e-3, false)]
    {
        assert_eq!(front_end.is_nominal(elapsed), nominal, "{elapsed}");
    }
}

#[test]
fn samples_in_a_row_are_worth_one_by_the_bandwidth_of_the_filter() {
    for (cutoff, worth) in [(20.0, 22.507_907), (40.0, 11.253_954), (400.0, 1.125_395_4), (450.0, f32::NAN)] {
        let front_end = FrontEnd::new(FrontEndConfig { cutoff, ..FrontEndConfig::BENCH });
        // 1000 / (2 * 1.110721 * cutoff), the noise bandwidth of a second-order Butterworth filter.
        match front_end {
            Ok(front_end) => assert!((front_end.correlated_samples() / worth - 1.0).abs() < 1e-5, "{cutoff}"),
            Err(error) => assert_eq!((cutoff, error.parameter), (450.0, "cutoff")),
        }
    }
}

/// The short way of the usual sample against the long way of any, on samples with every kind of disturbance.
#[test]
fn the_short_way_and_the_long_way_tell_the_same_bits() {
    for velocity in [Velocity::Paper, Velocity::Matched] {
        for bilateral in [false, true] {
            let front_end = scaled(velocity, bilateral);
            let [mut shortest, mut short, mut long] = [FrontEndState::default(); 3];
            let mut in_contact = 0;
            for k in 0..400_u16 {
                // In and out of the surface; within it none to six samples in a row below the threshold, of which five end a contact.
                let phase = f32::from(k % 50) / 50.0 - 0.2;
                let force = if k % 11 < k / 50 % 7 { 0.0 } else { 1.0 + phase };
                let mut sample = Sample { position: 1.0 + 0.01 * phase, force, elapsed: 1e-3 };
                match k % 37 {
                    5 => sample.position = f32::NAN,
                    11 => sample.position = 3e6,
                    13 => sample.force = 3e6,
                    17 => sample.force = f32::INFINITY,
                    19 => sample.elapsed = 2e-3,
                    23 => sample.elapsed = 1e-3 * 1.5,
                    29 => sample.elapsed = 0.0,
                    31 if k > 200 => sample.elapsed = 10.0,
                    _ => {}
                }
                let expected = front_end.update_unusual(&mut long, &sample);
                assert_eq!(front_end.update(&mut short, sample), expected, "{velocity:?} {bilateral} {k}");
                let found = match front_end.update_in_contact(&mut shortest, &sample) {
                    Some(observation) => {
                        in_contact += 1;
                        Ok(Reading { observation, contact: true, restarted: false })
                    }
                    None => front_end.update(&mut shortest, sample),
                };
                assert_eq!(found, expected, "in contact, {velocity:?} {bilateral} {k}");
            }
            assert!(in_contact > 150, "{in_contact}");
        }
    }
}

#[test]
fn the_time_of_a_rejected_sample_belongs_to_the_next() {
    let (front_end, mut state) = (paper(), FrontEndState::default());
    front_end.update(&mut state, sample(0.0, 1e-3)).expect("a sample");
    assert!(front_end.update(&mut state, sample(f32::NAN, 2e-3)).is_err());
    assert!(front_end.update(&mut state, sample(f32::NAN, f32::NAN)).is_err());
    assert!(front_end.update(&mut state, sample(f32::NAN, -1.0)).is_err());
    // 4 mm in 2 + 2 ms, by filters that begin with this row.
    let rate = front_end.update(&mut state, sample(4e-3, 2e-3)).expect("a sample").observation.rate;
    assert!((rate - 1.0).abs() < 1e-5, "{rate}");
}

#[test]
fn a_bilateral_contact_is_always_one() {
    for (bilateral, contact) in [(true, true), (false, false)] {
        let (front_end, mut state) = (scaled(Velocity::Matched, bilateral), FrontEndState::default());
        let reading = front_end.update(&mut state, Sample { position: 0.5, force: 0.0, elapsed: 1e-3 });
        let reading = reading.expect("a sample");
        assert_eq!((reading.contact, reading.observation.penetration), (contact, if bilateral { -2.0 } else { 0.0 }));
    }
}
