//! Effects of the drive in closed loop.

use crate::bench::{MASS, REFERENCE, largest, rig, run, with};
use palpate_lab::rig::{Control, Reference, Rig};

const CONTROL: Control = Control {
    proportional: 775.0,
    derivative: 10.0,
    derivative_filter_hz: None,
    effort_saturation: 25.0,
    rate_hz: 1000.0,
};

/// A drive that touches nothing.
fn free(reference: Reference) -> Rig {
    Rig { contact: None, ..rig(reference, true) }
}

#[test]
fn a_drive_that_cannot_break_away_does_not_move() {
    let mut rig = with(&free(REFERENCE), "[[effect]]\nname = \"coulomb_friction\"\nlevel_n = 1.0\n");
    rig.control = Some(Control { effort_saturation: 0.999, ..CONTROL });
    let recording = run(&rig);
    assert!(largest(recording.effort.as_ref().unwrap()) > 0.99);
    assert!(recording.position.iter().all(|x| x.to_bits() == recording.position[0].to_bits()));
}

#[test]
fn friction_holds_at_rest_and_slides_against_the_motion() {
    let level = 0.9;
    let reference = Reference { sine_amplitude: 0.0, ..REFERENCE };
    let table = format!("[[effect]]\nname = \"coulomb_friction\"\nlevel_n = {level}\n");
    let recording = run(&with(&free(reference), &table));
    let (x, effort) = (&recording.position, recording.effort.as_ref().unwrap());
    let still: Vec<_> = (1..x.len()).filter(|&row| x[row].to_bits() == x[row - 1].to_bits()).collect();
    let stuck_off_target = still.iter().filter(|&&row| effort[row].abs() > 0.05).count();
    assert!(still.len() > 1000 && stuck_off_target > 100, "{} still, {stuck_off_target} of them pushed", still.len());
    assert!(still.iter().all(|&row| effort[row - 1].abs() <= level));
    // Sliding: m a + b v + level sign(v) = effort, the effort held over a row.
    let mut slid = 0;
    for row in 2..x.len() - 2 {
        let before = (x[row] - x[row - 1]) / 1e-3;
        let after = (x[row + 1] - x[row]) / 1e-3;
        let next = (x[row + 2] - x[row + 1]) / 1e-3;
        if before.abs().min(after.abs()).min(next.abs()) > 5e-3 && before * next > 0.0 {
            // Over two rows the mean velocities differ by the mean of the two efforts.
            let pull = 0.5 * (effort[row] + effort[row + 1]) - 4.0 * after - level * after.signum();
            let a = (next - after) / 1e-3;
            assert!((MASS * a - pull).abs() < 0.02, "row {row}: {} N and {pull} N", MASS * a);
            slid += 1;
        }
    }
    assert!(slid > 100, "{slid}");
}

#[test]
fn the_tool_waits_while_the_motor_crosses_the_gap() {
    let (gap, motor) = (2e-3, 0.3);
    // Backwards first: at the start the motor lies at the forward flank.
    let reference = Reference { free_depth: 10e-3, contact_depth: -10e-3, sine_amplitude: 0.0, ..REFERENCE };
    let table = format!(
        "[[effect]]\nname = \"backlash\"\ngap_m = {gap}\nmotor_share = {}\nlink_stiffness_n_m = 30000\n",
        motor / MASS
    );
    let recording = run(&with(&free(reference), &table));
    let (x, effort) = (&recording.position, recording.effort.as_ref().unwrap());
    let (mut way, mut speed, mut row) = (0.0f64, 0.0, 0);
    while way.abs() < gap {
        assert_eq!(x[row].to_bits(), x[0].to_bits(), "row {row}: the gap is still open");
        way += 1e-3 * speed + 0.5e-6 * effort[row] / motor;
        speed += 1e-3 * effort[row] / motor;
        row += 1;
    }
    assert!(row > 805, "crossed at row {row}");
    assert!(x[row + 2] < x[0] - 1e-6, "and then it is taken along: {} m", x[row + 2] - x[0]);
}

#[test]
fn a_stiff_link_is_no_link_and_a_soft_one_rings() {
    let nominal = run(&free(REFERENCE));
    let linked = |stiffness: f64, ratio: f64| {
        let table = format!(
            "[[effect]]\nname = \"transmission_compliance\"\nlink_stiffness_n_m = {stiffness}\n\
             motor_share = 0.375\ndamping_ratio = {ratio}\n"
        );
        let recording = run(&with(&free(REFERENCE), &table));
        crate::bench::apart(&nominal.position, &recording.position)
    };
    let (stiff, stiffer, soft) = (linked(1e6, 0.27), linked(4e6, 0.27), linked(3e3, 0.05));
    println!("apart by {stiff:.1e}, {stiffer:.1e}, {soft:.1e}");
    assert!(stiff < 1e-3 && stiffer < 0.6 * stiff && soft > 0.01);
}

/// Friction at the motor brakes the motor: through a stiff link that is the same, through a soft one it is not.
#[test]
fn friction_may_sit_on_either_side_of_a_link() {
    let at = |stiffness: f64, share: f64| {
        let table = format!(
            "[[effect]]\nname = \"transmission_compliance\"\nlink_stiffness_n_m = {stiffness}\n\
             motor_share = 0.375\ndamping_ratio = 0.1\nfriction_share = {share}\n"
        );
        run(&with(&free(REFERENCE), &table)).position
    };
    let apart = |stiffness: f64| crate::bench::apart(&at(stiffness, 0.0), &at(stiffness, 1.0));
    let (stiff, soft) = (apart(1e6), apart(3e3));
    println!("apart by {stiff:.1e} and {soft:.1e}");
    assert!(stiff < 1e-4 && soft > 30.0 * stiff);
    let plain = "[[effect]]\nname = \"transmission_compliance\"\nlink_stiffness_n_m = 3000\n\
                 motor_share = 0.375\ndamping_ratio = 0.1\n";
    assert_eq!(run(&with(&free(REFERENCE), plain)).position, at(3e3, 0.0));
}

#[test]
fn a_link_is_resolved_whichever_side_is_the_lighter() {
    // The same link seen on rows four times as dense: the steps follow the rows, so the two agree only where both are
    // fine enough for 20 kN/m on 16 g, 180 Hz, on either side.
    let ends = |share: f64, rate_hz: f64| {
        let table = format!(
            "[[effect]]\nname = \"transmission_compliance\"\nlink_stiffness_n_m = 2e4\nmotor_share = {share}\n\
             damping_ratio = 0.3\n"
        );
        let mut rig = with(&free(REFERENCE), &table);
        rig.simulation.rate_hz = rate_hz;
        let every = (rate_hz / 1000.0) as usize;
        run(&rig).position.into_iter().step_by(every).collect::<Vec<_>>()
    };
    for share in [0.02, 0.5, 0.8] {
        let apart = crate::bench::apart(&ends(share, 1000.0), &ends(share, 4000.0));
        println!("share {share}: {apart:.1e} apart");
        assert!(apart < 2e-3, "share {share}: {apart:.1e} apart");
    }
}

#[test]
fn a_motor_as_heavy_as_the_whole_is_refused() {
    let table = "[[effect]]\nname = \"transmission_compliance\"\nlink_stiffness_n_m = 1e4\nmotor_share = 1.0\n\
                 damping_ratio = 0.05\n";
    let rig = with(&free(REFERENCE), table);
    let error = palpate_lab::simulate::simulate(&rig, 1, "rig.toml").unwrap_err().to_string();
    assert!(error.contains("motor_share") && error.contains("from 0.02 to 0.8"), "{error}");
}

/// The level of friction at rest is that of the side to which the drive is pushed, not of the one from which it pushes.
#[test]
fn a_drive_at_rest_is_held_by_the_friction_of_the_side_that_it_is_pushed_to() {
    let table = "[[effect]]\nname = \"coulomb_friction\"\nforward_level_n = 1.0\nbackward_level_n = 0.3\n";
    let travel = |depth: f64| {
        let reference = Reference { free_depth: 0.0, contact_depth: depth, sine_amplitude: 0.0, ..REFERENCE };
        let mut rig = with(&free(reference), table);
        rig.control = Some(Control { effort_saturation: 0.8, ..CONTROL });
        let recording = run(&rig);
        assert!(largest(recording.effort.as_ref().unwrap()) > 0.79);
        largest(&recording.position.iter().map(|x| x - recording.position[0]).collect::<Vec<_>>())
    };
    assert_eq!(travel(10e-3), 0.0, "0.8 N against 1.0 N");
    assert!(travel(-10e-3) > 1e-3, "0.8 N against 0.3 N: {} m", travel(-10e-3));
}
