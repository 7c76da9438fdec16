//! Effects of the contact along a led motion, against closed forms.

use crate::bench::{DAMPING, MASS, RATE, REFERENCE, STIFFNESS, apart, close, force, largest, rig, run, with};
use palpate_lab::rig::{Contact, Drive, Reference, Rig};

/// Row, depth and rate of the rows in contact.
fn inside(rig: &Rig) -> impl Iterator<Item = (usize, f64, f64)> {
    let reference = rig.reference.unwrap();
    let rows = (rig.simulation.duration_s * RATE) as usize;
    (0..rows)
        .map(move |row| (row, reference.at(row as f64 / RATE)))
        .filter(|(_, (x, _))| *x > 0.0)
        .map(|(row, at)| (row, at.0, at.1))
}

#[test]
fn damping_that_grows_with_depth_is_its_equation() {
    let rig = with(&rig(REFERENCE, false), "[[effect]]\nname = \"hunt_crossley_damping\"\nalpha_n_s_m2 = 1200\n");
    let recording = run(&rig);
    let mut most = 0.0f64;
    for (row, x, v) in inside(&rig) {
        let expected = (STIFFNESS * x + (DAMPING + 1200.0 * x) * v).max(0.0);
        close(force(&recording)[row], expected, 1e-12, "force");
        most = most.max((1200.0 * x * v).abs());
    }
    assert!(most > 0.5, "{most} N of it");
}

/// Once touched, the surface pulls by one force, in it and above it, up to the height at which it lets go, and never before the touch.
#[test]
fn an_attraction_pulls_by_its_force_until_its_height() {
    let (pull, height) = (0.2, 3e-3);
    let table = format!(
        "[[effect]]\nname = \"adhesion\"\nform = \"attraction\"\npull_off_force_n = {pull}\nrelease_height_m = {height}\n"
    );
    let rig = with(&rig(REFERENCE, false), &table);
    let plain = run(&crate::bench::rig(REFERENCE, false));
    let recording = run(&rig);
    let (mut touched, mut above) = (false, 0);
    for row in 0..4000 {
        let (x, _) = REFERENCE.at(row as f64 / RATE);
        // A row within a micrometre of an edge may lie on either side of it.
        if x.abs() < 1e-6 || (x + height).abs() < 1e-4 {
            touched |= x > 0.0;
            continue;
        }
        touched = if x > 0.0 { true } else { touched && x > -height };
        let expected = force(&plain)[row] - if touched { pull } else { 0.0 };
        close(force(&recording)[row], expected, 1e-12, "force");
        above += usize::from(touched && x < 0.0);
    }
    assert!(above > 20, "{above} rows above the surface");
}

#[test]
fn a_spring_that_stiffens_or_softens_exponentially_is_its_equation() {
    for growth in [120.0f64, -120.0] {
        let table = format!("[[effect]]\nname = \"nonlinear_stiffness\"\nstiffening_1_m = {growth}\n");
        let rig = with(&rig(REFERENCE, false), &table);
        let recording = run(&rig);
        let mut most = 0.0f64;
        for (row, x, v) in inside(&rig) {
            let expected = (STIFFNESS * (growth * x).exp_m1() / growth + DAMPING * v).max(0.0);
            close(force(&recording)[row], expected, 1e-12, "force");
            most = most.max((expected - STIFFNESS * x).abs());
        }
        assert!(most > 1.0, "{most} N of it");
    }
}

/// Every finer form beside the law that it refines: at its own exponent or far from its corner it is that law.
#[test]
fn finer_forms_are_their_equations() {
    let gradual = |x: f64| 1e-3 * ((x - 5e-3) / 1e-3).exp().ln_1p();
    type Law = Box<dyn Fn(f64, f64) -> f64>;
    let laws: [(&str, Law); 4] = [
        (
            "name = \"nonlinear_stiffness\"\nsoftening_1_m = 40\n",
            Box::new(|x, _| STIFFNESS * (x / (1.0 + 40.0 * x) - x)),
        ),
        (
            "name = \"hunt_crossley_damping\"\ndamping_there_n_s_m = 9\nexponent = 1.5\nreference_depth_m = 0.006\n",
            Box::new(|x, v| 9.0 * (x / 6e-3).powf(1.5) * v),
        ),
        (
            "name = \"quadratic_damping\"\ndrag_there_n = 0.7\nexponent = 1.7\nreference_speed_m_s = 0.05\n",
            Box::new(|_, v| 0.7 * (v.abs() / 0.05).powf(1.7) * v.signum()),
        ),
        (
            "name = \"layered_stiffness\"\nadded_stiffness_n_m = 200\nlayer_depth_m = 0.005\ntransition_m = 0.001\n",
            Box::new(move |x, _| 200.0 * (gradual(x) - gradual(0.0))),
        ),
    ];
    for (table, law) in laws {
        let rig = with(&rig(REFERENCE, false), &format!("[[effect]]\n{table}"));
        let recording = run(&rig);
        let mut most = 0.0f64;
        for (row, x, v) in inside(&rig) {
            let expected = (STIFFNESS * x + DAMPING * v + law(x, v)).max(0.0);
            close(force(&recording)[row], expected, 1e-12, table);
            most = most.max(law(x, v).abs());
        }
        assert!(most > 0.2, "{most} N of {table}");
    }
}

#[test]
fn a_loop_that_yields_gradually_goes_in_as_its_closed_form() {
    let (height, depth) = (0.5, 1e-3);
    let table =
        format!("[[effect]]\nname = \"hysteresis\"\nloop_force_n = {height}\nyield_depth_m = {depth}\nsharpness = 1\n");
    let rig = with(&rig(REFERENCE, false), &table);
    let recording = run(&rig);
    // Going in for the first time dz = (1 - z) dx / yield_depth, from zero: z = 1 - exp(-x / yield_depth).
    let mut deepest = 0.0;
    let first = inside(&rig).take_while(|(row, _, v)| *row < 1000 && *v > 0.0);
    for (row, x, v) in first {
        let expected = STIFFNESS * x + DAMPING * v - height * (-x / depth).exp_m1();
        // A step of at most 0.15 mm, by the left end of the slope: half of its share of the yield depth, at the steepest 0.37.
        close(force(&recording)[row], expected, 0.03 * height, "force");
        deepest = x;
    }
    assert!(deepest > 3.0 * depth, "{deepest}");
}

#[test]
fn a_maxwell_branch_relaxes_as_its_closed_form() {
    let reference = Reference { period_s: 4.0, contact_s: 3.0, sine_amplitude: 0.0, ..REFERENCE };
    let (branch, time) = (150.0, 0.4);
    let table = format!(
        "[[effect]]\nname = \"stress_relaxation\"\nbranch_stiffness_n_m = {branch}\nrelaxation_time_s = {time}\n"
    );
    let recording = run(&with(&rig(reference, false), &table));
    let extra = |row: usize| {
        let (x, v) = reference.at(row as f64 / RATE);
        force(&recording)[row] - STIFFNESS * x - DAMPING * v
    };
    // z(t) = branch x integral of v(s) exp(-(t - s) / time) over the time in contact, by the midpoint rule.
    let (end, fine) = (1.5, 1e-5);
    let expected: f64 = (0..(end / fine) as usize)
        .map(|at| (at as f64 + 0.5) * fine)
        .map(|s| (reference.at(s), s))
        .filter(|((x, _), _)| *x > 0.0)
        .map(|((_, v), s)| branch * v * (-(end - s) / time).exp() * fine)
        .sum();
    assert!(expected > 0.3);
    close(extra(1500), expected, 1e-4 * expected, "what has built up");
    // Held: nothing but exp(-t / time) is left.
    close(extra(2300) / extra(1500), (-0.8f64 / time).exp(), 1e-6, "what is left 0.8 s later");
}

/// A branch that begins anew holds in the second touch what that touch alone has strained; one that stays holds what the first has left as well.
#[test]
fn a_branch_that_begins_anew_forgets_the_last_touch() {
    let (branch, time) = (150.0, 1.5);
    let table = |form: &str| {
        format!(
            "[[effect]]\nname = \"stress_relaxation\"\nform = \"{form}\"\nbranch_stiffness_n_m = {branch}\nrelaxation_time_s = {time}\n"
        )
    };
    let [anew, stays] = ["one_branch_anew", "one_branch"].map(|form| run(&with(&rig(REFERENCE, false), &table(form))));
    let fine = 1e-5;
    let held = |from: f64, end: f64| -> f64 {
        let instants = ((from / fine) as usize..(end / fine) as usize).map(|at| (at as f64 + 0.5) * fine);
        let strained = instants.map(|s| (REFERENCE.at(s), s)).filter(|((x, _), _)| *x > 0.0);
        strained.map(|((_, v), s)| branch * v * (-(end - s) / time).exp() * fine).sum()
    };
    let mut apart = 0.0f64;
    for (row, x, v) in inside(&rig(REFERENCE, false)).filter(|(row, ..)| *row > 2000 && row % 50 == 0) {
        // Where nothing pushes the force is cut, and the branch is not seen.
        if force(&anew)[row].min(force(&stays)[row]) <= 0.0 {
            continue;
        }
        let [anew, stays] = [&anew, &stays].map(|run| force(run)[row] - STIFFNESS * x - DAMPING * v);
        let end = row as f64 / RATE;
        // A step is straight: half a row of the fastest motion, and the touch begins within one.
        let tolerance = 2e-3 * branch * 10e-3;
        let begun = (0..row).rev().find(|before| REFERENCE.at(*before as f64 / RATE).0 <= 0.0).unwrap_or(0);
        close(anew, held(begun as f64 / RATE, end), tolerance, "anew");
        close(stays, held(0.0, end), tolerance, "stays");
        apart = apart.max((anew - stays).abs());
    }
    assert!(apart > 0.1, "{apart} N");
}

/// On a straight spring a memory of the force is the memory of the depth, whatever its law of time.
#[test]
fn a_memory_that_multiplies_a_straight_spring_is_the_one_beside_it() {
    let pairs = [
        ("branch_stiffness_n_m = 150\nrelaxation_time_s = 0.4", 150.0, "fading_ratio = RATIO\nrelaxation_time_s = 0.4"),
        (
            "memory_stiffness_n_m = 80\nexponent = 0.3\nreference_time_s = 0.5",
            80.0,
            "memory_ratio = RATIO\nexponent = 0.3\nreference_time_s = 0.5",
        ),
    ];
    for (beside, stiffness, multiplied) in pairs {
        let multiplied = multiplied.replace("RATIO", &format!("{:?}", stiffness / STIFFNESS));
        let [one, other, none] = [Some(beside.to_owned()), Some(multiplied), None].map(|values| {
            let table =
                values.map_or(String::new(), |values| format!("[[effect]]\nname = \"stress_relaxation\"\n{values}\n"));
            run(&with(&rig(REFERENCE, false), &table))
        });
        let (one, other, none) = (force(&one), force(&other), force(&none));
        assert!(apart(one, none) > 0.1, "{beside}");
        // Sums of some thousand steps, each rounded.
        assert!(apart(one, other) < 1e-10 * largest(one), "{beside}: {:.3e} N apart", apart(one, other));
    }
}

#[test]
fn a_dent_stays_and_is_as_deep_as_it_says() {
    let rig = with(&rig(REFERENCE, false), "[[effect]]\nname = \"plastic_set\"\nset_ratio = 0.4\n");
    let recording = run(&rig);
    let deepest = (0..200_000).fold(0.0f64, |most, at| most.max(REFERENCE.at(f64::from(at) * 1e-5).0));
    let dent = 0.4 * deepest;
    let mut missed = 0;
    for (row, x, v) in inside(&rig).filter(|(row, x, _)| *row > 2500 && *x <= 0.99 * deepest) {
        let expected = if x > dent { (STIFFNESS * (x - dent) + DAMPING * v).max(0.0) } else { 0.0 };
        // The deepest point falls between two instants: a nanometre of dent.
        close(force(&recording)[row], expected, 3e-7, "second contact");
        missed += usize::from(x < dent);
    }
    assert!(missed > 20, "{missed} rows within the dent");
}

#[test]
fn what_sticks_pulls_on_release_and_never_before() {
    let table = "[[effect]]\nname = \"adhesion\"\npull_off_force_n = 0.3\nrelease_height_m = 0.002\n";
    let rig = with(&rig(REFERENCE, false), table);
    let recording = run(&rig);
    let pulls: Vec<_> = (0..4000).filter(|&row| force(&recording)[row] < 0.0).collect();
    assert!(pulls.len() > 10, "{} rows", pulls.len());
    for row in pulls {
        let (x, v) = REFERENCE.at(row as f64 / RATE);
        assert!(v < 0.0 && x > -0.002 - 1e-9 && row > 1000, "row {row}: {x} m, {v} m/s");
        assert!(force(&recording)[row] >= -0.3);
    }
    let least = force(&recording).iter().copied().fold(0.0, f64::min);
    close(least, -0.3, 1e-12, "greatest pull");
}

/// Within the surface what sticks pulls with the law that acts there, and not with the straight line of its stiffness.
#[test]
fn a_spring_that_sticks_pulls_with_its_own_law() {
    let spring = "[[effect]]\nname = \"nonlinear_stiffness\"\nexponent = 2\nreference_depth_m = 0.006\n";
    let adhesion = "[[effect]]\nname = \"adhesion\"\npull_off_force_n = 5\nrelease_height_m = 0.0001\n";
    let recording = run(&with(&rig(REFERENCE, false), &format!("{spring}{adhesion}")));
    let mut pulls = 0;
    for (row, x, v) in inside(&rig(REFERENCE, false)).filter(|(_, _, v)| *v < 0.0) {
        let expected = STIFFNESS * 6e-3 * (x / 6e-3).powi(2) + DAMPING * v;
        close(force(&recording)[row], expected, 1e-12, "while leaving");
        pulls += usize::from(expected < -0.01);
    }
    assert!(pulls > 5, "{pulls} rows of it");
}

#[test]
fn play_keeps_the_force_until_it_is_taken_up() {
    let play = 5e-4;
    let table = format!("[[effect]]\nname = \"lost_motion\"\nplay_m = {play}\n");
    let mut rig = with(&rig(REFERENCE, false), &table);
    rig.contact = rig.contact.map(|contact| Contact { damping: 0.0, ..contact });
    let recording = run(&rig);
    let (x, f) = (&recording.position, force(&recording));
    let mut reversals = 0;
    for row in 1100..1900 {
        if x[row] > x[row - 1] && x[row] >= x[row + 1] && x[row] > 5e-3 {
            reversals += 1;
            let back = (row..row + 200).take_while(|&at| x[row] - x[at] < 0.99 * play).last().unwrap();
            assert!(back > row + 3);
            // The tip stays where the true crest between two instants put it.
            (row + 1..=back).for_each(|at| assert_eq!(f[at].to_bits(), f[row + 1].to_bits(), "row {at}"));
            close(f[row], STIFFNESS * (x[row] - 0.5 * play), 1e-4, "at the crest");
            assert!(f[back + 40] < f[row] - 0.01, "the force falls once the play is taken up");
        }
    }
    assert!(reversals >= 2, "{reversals}");
}

#[test]
fn a_mass_that_is_gathered_takes_its_energy_and_no_blow() {
    let (mass, depth) = (1.5, 2e-3);
    let table =
        format!("[[effect]]\nname = \"environment_mass\"\nmoved_mass_kg = {mass}\ngathering_depth_m = {depth}\n");
    let led = with(&rig(REFERENCE, false), &table);
    let recording = run(&led);
    for (row, x, v) in inside(&led).filter(|(row, ..)| (820..1900).contains(row)) {
        let time = row as f64 / RATE;
        let a = (REFERENCE.at(time + 1e-5).1 - REFERENCE.at(time - 1e-5).1) / 2e-5;
        // The rate of m(x) v, less half of m'(x) v^2 that goes into the motion.
        let momentum = |at: f64| {
            let (x, v) = REFERENCE.at(at);
            mass * -(-x.max(0.0) / depth).exp_m1() * v
        };
        let (before, after) = (momentum(time - 1e-6), momentum(time + 1e-6));
        let half = 0.5 * mass * (-x / depth).exp() / depth * v * v;
        let expected = (STIFFNESS * x + DAMPING * v + (after - before) / 2e-6 - half).max(0.0);
        // Differences over 2 us of a momentum of 0.1 N s, to sixteen digits, and of an acceleration over 20 us.
        close(force(&recording)[row], expected, 1e-4 + 1e-6 * a.abs(), "led");
    }
}

#[test]
fn a_mass_that_is_carried_along_is_a_mass() {
    let table = "[[effect]]\nname = \"environment_mass\"\nmoved_mass_kg = 2.0\n";
    // Led: F = K x + B v + m a, in the middle of a contact.
    let led = with(&rig(REFERENCE, false), table);
    let recording = run(&led);
    for (row, x, v) in inside(&led).filter(|(row, ..)| (1200..1900).contains(row)) {
        let time = row as f64 / RATE;
        let a = (REFERENCE.at(time + 1e-5).1 - REFERENCE.at(time - 1e-5).1) / 2e-5;
        let expected = (STIFFNESS * x + DAMPING * v + 2.0 * a).max(0.0);
        close(force(&recording)[row], expected, 1e-5, "led");
    }
    // Driven and clamped: it moves as if the drive were as much heavier, and it is heavier than the drive.
    let mut clamped = rig(REFERENCE, true);
    clamped.contact = clamped.contact.map(|contact| Contact { bilateral: true, ..contact });
    let mut heavy = clamped.clone();
    heavy.drive = heavy.drive.map(|drive| Drive { inertia: MASS + 2.0, ..drive });
    let (carried, heavy) = (run(&with(&clamped, table)), run(&heavy));
    assert!(largest(&heavy.position) > 5e-3);
    let error = apart(&heavy.position, &carried.position);
    assert!(error < 1e-6, "{error:.1e}");
}
