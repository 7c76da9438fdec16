//! Effects of the force sensor.

use crate::bench::{DAMPING, RATE, REFERENCE, STIFFNESS, close, force, rig, run, with};
use palpate_lab::rig::{Rig, Sensors};

#[test]
fn a_delay_of_whole_rows_is_a_shifted_trace_and_the_motion_is_the_nominal_one() {
    let rig = rig(REFERENCE, true);
    let nominal = run(&rig);
    let late = run(&with(&rig, "[[effect]]\nname = \"channel_delay\"\ndelay_s = 0.003\n"));
    assert_eq!((&late.position, &late.effort), (&nominal.position, &nominal.effort));
    for row in 3..4000 {
        close(force(&late)[row], force(&nominal)[row - 3], 1e-12, "three rows late");
    }
}

#[test]
fn a_delay_of_a_part_of_a_row_is_the_force_of_that_instant() {
    let late = run(&with(&rig(REFERENCE, false), "[[effect]]\nname = \"channel_delay\"\ndelay_s = 0.0004\n"));
    for row in 1200..1900 {
        let (x, v) = REFERENCE.at(row as f64 / RATE - 0.0004);
        close(force(&late)[row], STIFFNESS * x + DAMPING * v, 1e-6, "0.4 ms late");
    }
}

#[test]
fn what_is_beyond_the_sensor_is_felt_in_free_motion_too() {
    let feels = run(&with(&rig(REFERENCE, false), "[[effect]]\nname = \"tool_inertia\"\nbeyond_mass_kg = 0.1\n"));
    let pulse = std::f64::consts::TAU * REFERENCE.sine_frequency_hz;
    for row in 1..750 {
        let a = -REFERENCE.sine_amplitude * pulse * pulse * (pulse * row as f64 / RATE).sin();
        close(force(&feels)[row], 0.1 * a, 1e-6, "free motion");
    }
}

/// A cable by its place and water by its speed, in free motion and in contact.
#[test]
fn a_parasitic_force_is_a_polynomial_of_place_or_speed() {
    let reads =
        |table: &str| run(&with(&rig(REFERENCE, false), &format!("[[effect]]\nname = \"parasitic_force\"\n{table}")));
    let plain = run(&rig(REFERENCE, false));
    let cable = reads(
        "form = \"by_place\"\norigin_m = -0.004\nlength_m = 0.01\nconstant_n = 0.1\nlinear_n = 0.2\nsquare_n = 0.3\ncubic_n = 0.4\n",
    );
    let water = reads("form = \"by_speed\"\nspeed_m_s = 0.05\nlinear_n = 0.2\nsquare_n = 0.3\n");
    for row in 0..4000 {
        let (x, v) = REFERENCE.at(row as f64 / RATE);
        let (place, speed) = ((x + 0.004) / 0.01, v / 0.05);
        let pulls = 0.1 + place * (0.2 + place * (0.3 + place * 0.4));
        close(force(&cable)[row] - force(&plain)[row], pulls, 1e-9, "cable");
        close(force(&water)[row] - force(&plain)[row], 0.2 * speed + 0.3 * speed * speed.abs(), 1e-9, "water");
    }
}

#[test]
fn a_zero_settles_and_a_range_ends_in_a_knee() {
    let plain = run(&rig(REFERENCE, false));
    let reads = |table: &str| run(&with(&rig(REFERENCE, false), &format!("[[effect]]\n{table}")));
    let drifts = reads("name = \"force_drift\"\nsettled_n = 0.4\ntime_constant_s = 1.5\n");
    let ends = reads("name = \"force_saturation\"\nlimit_n = 2.5\nknee = 0.04\n");
    assert!(force(&plain).iter().any(|force| *force > 3.0));
    for (row, force_there) in force(&plain).iter().enumerate() {
        let zero = 0.4 * (1.0 - (-(row as f64 / RATE) / 1.5).exp());
        close(force(&drifts)[row], force_there + zero, 1e-12, "zero");
        let over = force_there.abs() - 2.5;
        close(force(&ends)[row], force_there - 0.1 * (over / 0.1).exp().ln_1p(), 1e-12, "range");
    }
}

#[test]
fn effects_come_before_noise_and_steps_and_the_chance_stays_the_same() {
    let noisy = Sensors { force_resolution: Some(0.05), force_noise: Some(0.09), ..rig(REFERENCE, true).sensors };
    let rig = Rig { sensors: noisy, ..rig(REFERENCE, true) };
    let nominal = run(&rig);
    let biased = run(&with(&rig, "[[effect]]\nname = \"force_bias\"\nbias_n = 1.0\n"));
    for (one, other) in force(&nominal).iter().zip(force(&biased)) {
        close(other - one, 1.0, 1e-12, "bias");
        close(other / 0.05, (other / 0.05).round(), 1e-9, "whole steps");
    }
}

/// Mount, response, zero, range: what is stated last in the rig file still acts first where it is nearer to the tool.
#[test]
fn effects_of_the_sensor_act_from_the_tool_outwards_whatever_their_order_in_the_file() {
    let [gain, bias, limit] = [
        "name = \"force_gain\"\ngain_error = 0.5\n",
        "name = \"force_bias\"\nbias_n = 0.4\n",
        "name = \"force_saturation\"\nlimit_n = 2.5\nknee = 0.01\n",
    ]
    .map(|table| format!("[[effect]]\n{table}"));
    let plain = run(&rig(REFERENCE, false));
    for tables in [format!("{gain}{bias}{limit}"), format!("{limit}{bias}{gain}")] {
        let reads = run(&with(&rig(REFERENCE, false), &tables));
        let mut clipped = 0;
        for (found, there) in force(&reads).iter().zip(force(&plain)) {
            let before_range = 1.5 * there + 0.4;
            let over = before_range.abs() - 2.5;
            let expected = before_range.abs() - 0.025 * (over / 0.025).exp().ln_1p();
            close(found.abs(), expected, 1e-9, "gain, then zero, then range");
            clipped += usize::from(over > 0.5);
        }
        assert!(clipped > 100, "{clipped} rows beyond the range");
    }
}
