//! The check of recordings, as experiments: a bench that presses and lets go, one thing wrong at a time.

#[path = "check/bench.rs"]
mod bench;

use bench::{Bench, MINUS, found, has, noise, rotary};

/// Every check by a piece of its sentence.
const ALL: [&str; 22] = [
    "in the time column",
    "clock is uneven",
    "differ in rate",
    "rate changes",
    "drop-out",
    "leaps by",
    "clips",
    "holds the force",
    "hung",
    "in every row",
    "falls as the tool goes in",
    "against the effort",
    "may be wrong",
    "never touched",
    "to the last",
    "at one speed",
    "never comes out",
    "never stays",
    "Only ",
    "too slow",
    "coarse",
    "at its limit",
];

#[test]
fn a_clean_bench_gives_nothing_to_say_at_any_scale() {
    for (length, force) in [(1.0, 1.0), (1e-6, 1e-9), (1e3, 1e4)] {
        assert_eq!(found(&[Bench::new().scaled(length, force)]), Vec::<String>::new());
    }
}

/// Asserts that `bad` gives a finding with `words` and `good` none, and that scale does not matter.
fn tells(words: &str, bad: Bench, good: Bench) {
    let texts = found(std::slice::from_ref(&bad));
    assert!(has(&texts, words), "{words}: not among {texts:#?}");
    let texts = found(std::slice::from_ref(&good));
    assert!(!has(&texts, words), "{words}: found where there is none, {texts:#?}");
    let small = found(&[bad.scaled(1e-6, 1e-9)]);
    assert!(has(&small, words), "{words}: not at the scale of a cell, {small:#?}");
    assert!(!has(&found(&[good.scaled(1e-6, 1e-9)]), words), "{words}: at the scale of a cell only");
}

#[test]
fn ten_rows_lost_are_a_gap_and_one_is_not() {
    tells("in the time column", Bench::new().without(700..710), Bench::new().without(700..701));
}

#[test]
fn a_clock_that_is_off_by_a_third_is_uneven() {
    let shaken = |by: f64| Bench::new().stamped(|row, time, step| time + if row % 2 == 0 { by * step } else { 0.0 });
    tells("clock is uneven", shaken(0.35), shaken(0.1));
}

#[test]
fn a_rate_that_changes_within_a_trial_is_told() {
    let slowed = |every: usize| Bench::new().kept(|row| row < 3000 || row % every == 0);
    tells("rate changes", slowed(2), slowed(1));
}

#[test]
fn rates_that_differ_between_trials_are_told_once() {
    let texts = found(&[Bench::new(), Bench::new().kept(|row| row % 2 == 0)]);
    assert!(has(&texts, "differ in rate"), "{texts:#?}");
    assert!(!has(&found(&[Bench::new(), Bench::new()]), "differ in rate"));
}

#[test]
fn a_single_reading_far_outside_is_a_drop_out() {
    let spike = |times: f64| Bench::new().force(move |row, force| if row == 200 { times * 9.0 } else { force });
    tells("drop-out", spike(10.0), spike(0.05));
    tells("trial-1.csv, force: 1 drop-out", spike(10.0), Bench::new());
}

#[test]
fn a_counter_that_is_reset_leaps() {
    let reset = |by: f64| Bench::new().position(move |row, x| if row > 4200 { x - by } else { x });
    tells("leaps by", reset(0.01), reset(0.0005));
}

#[test]
fn a_force_sensor_that_ends_early_clips() {
    let ended = |at: f64| Bench::new().force(move |_, force| force.min(at));
    tells("clips", ended(1.5), ended(9.0));
}

/// Both read no more than 2 N: the one tool stops there and creeps on by 1 mm, the other presses on to 9 mm as quickly as it came.
#[test]
fn a_force_that_the_machine_holds_is_told_from_a_sensor_that_ends() {
    let pressed = |depth: f64| {
        let points = [(0.0, -3.0), (4.0, depth), (24.0, depth + 1.0), (26.0, -3.0), (28.0, -3.0)];
        Bench::along(&points, false).force(|row, force| force.min(2.0) + 0.005 * noise(row + 7))
    };
    tells("holds the force", pressed(6.6), pressed(9.0));
}

#[test]
fn a_force_that_hangs_while_the_tool_moves_is_stuck() {
    let hung = |rows: usize| Bench::new().force_held(1100, rows);
    tells("hung", hung(150), hung(4));
}

#[test]
fn a_position_that_hangs_while_the_force_rises_is_stuck() {
    let hung = |rows: usize| Bench::new().position_held(1050, rows);
    let texts = found(&[hung(400)]);
    assert!(has(&texts, "The position stays at exactly"), "{texts:#?}");
    assert!(!has(&found(&[hung(20)]), "The position stays at exactly"));
}

#[test]
fn a_position_that_ends_while_the_force_rises_clips() {
    let ended = |at: f64| found(&[Bench::new().position(move |_, x| x.min(at))]);
    let texts = ended(0.005);
    assert!(texts[0].starts_with("grave") && texts[0].contains("its own end"), "{texts:#?}");
    assert!(!has(&ended(0.02), "its own end"));
}

#[test]
fn a_velocity_that_runs_while_the_position_stands_says_stuck() {
    let hung = |rows: usize| found(&[Bench::new().no_force().measured_velocity().position_held(1050, rows)]);
    assert!(has(&hung(150), "The position stays at exactly"), "{:#?}", hung(150));
    assert!(!has(&hung(5), "The position stays at exactly"));
}

#[test]
fn a_column_of_one_value_is_grave() {
    tells("position column is", Bench::new().position(|_, _| 0.003), Bench::new());
    tells("in every row", Bench::new().effort(|_, _| 2.0), Bench::new());
    tells("in every row", Bench::new().force(|_, _| 0.0), Bench::new());
}

#[test]
fn an_effort_at_its_end_while_the_tool_moves_is_at_its_limit() {
    let limited = |at: f64| Bench::new().effort(move |_, effort| effort.min(at));
    tells("at its limit", limited(0.5), limited(9.0));
}

#[test]
fn a_force_with_the_wrong_sign_is_grave() {
    tells("falls as the tool goes in", Bench::new().force(MINUS), Bench::new());
    // Two springs in the wrong order are no wrong sign: the force may fall a little.
    tells("falls as the tool goes in", Bench::new().force(MINUS), Bench::new().force(|row, f| f - 1e-4 * row as f64));
}

#[test]
fn an_effort_with_the_wrong_sign_is_grave() {
    tells("against the effort", Bench::new().effort(MINUS), Bench::new());
    tells("against the effort", Bench::new().effort(MINUS), Bench::new().effort(|_, effort| effort - 3.0));
}

#[test]
fn a_surface_that_is_never_passed_is_told_from_a_touch_that_never_was() {
    let texts = found(&[Bench::new().surface(0.02)]);
    assert!(has(&texts, "the force rises at a position of"), "{texts:#?}");
    let texts = found(&[Bench::new().surface(0.02).force(|row, _| 0.05 * bench::noise(row))]);
    assert!(has(&texts, "never touched: it stays"), "{texts:#?}");
    let texts = found(&[Bench::new().force(|row, _| 0.05 * bench::noise(row))]);
    assert!(has(&texts, "yet the force never rises"), "{texts:#?}");
    let texts = found(&[Bench::new().surface(0.001)]);
    assert!(!has(&texts, "surface"), "{texts:#?}");
}

#[test]
fn a_tool_that_is_always_in_contact_is_told() {
    tells("to the last", Bench::new().surface(-0.02), Bench::new());
}

#[test]
fn what_the_motion_leaves_undecided_is_told() {
    let steady = |fast: f64| {
        Bench::along(
            &[(0.0, -2.0), (4.0, 8.0), (8.0, 8.0), (12.0, -2.0), (14.0, -2.0), (14.0 + 4.0 / fast, 8.0), (20.0, -2.0)],
            false,
        )
    };
    tells("at one speed", Bench::along(&[(0.0, -2.0), (4.0, 8.0), (8.0, 8.0), (12.0, -2.0)], false), steady(3.0));
    let in_only = Bench::along(&[(0.0, -2.0), (4.0, 8.0), (12.0, 8.0)], true);
    tells("never comes out", in_only, Bench::new());
    let restless = Bench::along(&[(0.0, -2.0), (4.0, 8.0), (8.0, -2.0), (10.0, 5.0), (12.0, -2.0)], false);
    tells("never stays", restless, Bench::new());
    let one = Bench::along(&[(0.0, -2.0), (1.0, -2.0), (1.005, 8.0), (10.0, 8.2), (14.0, 8.0)], false);
    let two = Bench::along(&[(0.0, -2.0), (1.0, -2.0), (1.005, 8.0), (8.0, 8.2), (8.5, 3.0), (14.0, 3.1)], false);
    tells("Nine in ten rows", one, two);
}

#[test]
fn a_trial_needs_some_hundreds_of_rows() {
    tells("Only ", Bench::new().kept(|row| row % 51 == 0), Bench::new().kept(|row| row % 40 == 0));
    let texts = found(&[Bench::new().kept(|row| row % 40 == 0)]);
    assert!(has(&texts, "too slow for this rig"), "{texts:#?}");
    assert!(!has(&found(&[Bench::new().kept(|row| row % 4 == 0)]), "too slow for this rig"));
}

#[test]
fn an_encoder_of_ten_steps_is_coarse() {
    let stepped = |step: f64| Bench::new().position(move |_, x| (x / step).round() * step).resolution(step);
    tells("position sensor is coarse", stepped(9e-4), stepped(2e-4));
    let weak = |by: f64| Bench::new().force(move |row, f| by * f + 0.05 * bench::noise(row));
    tells("force sensor is coarse", weak(0.25), weak(1.0));
}

#[test]
fn millimetres_and_degrees_are_suspected() {
    tells("millimetres", Bench::new().position(|_, x| 1e3 * x), Bench::new().position(|_, x| 5.0 * x));
    let degrees = rotary(Bench::new().position(|_, x| x.to_degrees()));
    assert!(has(&found(std::slice::from_ref(&degrees)), "degrees"), "{:#?}", found(&[degrees]));
    assert!(!has(&found(&[rotary(Bench::new())]), "degrees"));
}

#[test]
fn missing_channels_are_named_and_none_is_grave() {
    let texts = found(&[Bench::new().no_effort()]);
    assert_eq!(texts.len(), 1, "{texts:#?}");
    assert!(texts[0].starts_with("mild") && has(&texts, "No effort was recorded"));
    let texts = found(&[Bench::new().no_force()]);
    assert!(texts.len() == 1 && has(&texts, "No force was recorded"), "{texts:#?}");
    let texts = found(&[Bench::new(), Bench::new().no_effort()]);
    assert!(has(&texts, "This trial has no effort while others have"), "{texts:#?}");
    let texts = found(&[Bench::new().measured_velocity()]);
    assert!(texts.len() == 1 && has(&texts, "velocity is not used"), "{texts:#?}");
}

#[test]
fn of_one_kind_the_worst_trial_is_named_and_the_others_are_counted() {
    let trials =
        [Bench::new().without(700..705), Bench::new().without(700..790), Bench::new().without(700..708), Bench::new()];
    let texts = found(&trials);
    assert_eq!(texts.len(), 1, "{texts:#?}");
    assert!(texts[0].contains("trial-2.csv") && texts[0].ends_with("2 other trials show the same."), "{texts:#?}");
}

#[test]
fn what_spoils_the_answer_is_grave_and_comes_first() {
    let texts = found(&[Bench::new().force(MINUS).without(700..710)]);
    assert!(texts[0].starts_with("grave") && texts.last().is_some_and(|text| text.starts_with("mild")), "{texts:#?}");
    assert!(
        texts.iter().filter(|text| ALL.iter().any(|words| text.contains(words))).count() == texts.len(),
        "{texts:#?}"
    );
}

#[test]
fn the_shortest_recordings_are_judged_without_a_stumble() {
    for rows in [2, 3, 5, 9, 40, 120] {
        let texts = found(&[Bench::new().kept(|row| row % 71 == 0 && row < 71 * rows)]);
        assert!(has(&texts, &format!("Only {rows} rows")), "{texts:#?}");
        found(&[Bench::new().no_effort().force(|_, _| 0.0).kept(|row| row < rows)]);
        found(&[rotary(Bench::new()).position(|_, _| 0.0).measured_velocity().kept(|row| row < rows)]);
    }
}
