//! The same pad in other units, on slower, unsteady and broken clocks.

use crate::bench::{BENCH, Case, FADES, Size, names};

/// [`FADES`] on a bench of another size.
fn fades(size: Size) -> Case {
    let stiffness = 60.0 * size.newton / size.metre;
    let table = FADES.replace("branch_stiffness_n_m = 60", &format!("branch_stiffness_n_m = {stiffness:e}"));
    Case::led(size, &table.replace("= 0.3", &format!("= {}", 0.3 * size.second)))
}

#[test]
fn on_micrometres_and_nanonewtons() {
    names(&fades(Size { metre: 1e-4, newton: 1e-9, ..BENCH }).diagnose(&[]), "stress_relaxation");
}

#[test]
fn on_metres_and_kilonewtons() {
    names(&fades(Size { metre: 1e2, newton: 1e3, ..BENCH }).diagnose(&[]), "stress_relaxation");
}

#[test]
fn at_ten_samples_a_second() {
    names(&fades(Size { second: 20.0, rate_hz: 10.0, ..BENCH }).diagnose(&[]), "stress_relaxation");
}

#[test]
fn at_fifty_samples_a_second() {
    names(&fades(Size { second: 4.0, rate_hz: 50.0, ..BENCH }).diagnose(&[]), "stress_relaxation");
}

/// The tool crosses the surface from one row to the next: the law is found from the rows before and behind, and the clock is found
/// fault with.
#[test]
fn at_fifty_samples_a_second_of_quick_contacts() {
    let answer = fades(Size { rate_hz: 50.0, duration_s: 10.0, ..BENCH }).diagnose(&[]);
    names(&answer, "stress_relaxation");
    let findings = answer["findings"].as_array().unwrap();
    let slow = findings.iter().filter_map(|finding| finding["text"].as_str()).find(|text| text.contains("too slow"));
    assert!(slow.is_some_and(|text| text.contains("Record at")), "{findings:?}");
}

#[test]
fn at_fifty_thousand_samples_a_second() {
    names(&fades(Size { rate_hz: 5e4, ..BENCH }).diagnose(&[]), "stress_relaxation");
}

#[test]
fn with_a_quarter_of_a_second_lost() {
    let case = fades(BENCH);
    case.rewrite(|row, _| !(900..1000).contains(&row));
    names(&case.diagnose(&[]), "stress_relaxation");
}

#[test]
fn on_a_wildly_unsteady_clock() {
    // Two of five rows are missing: the clock of the rows is unsteady, and each stamp is true.
    let case = fades(Size { rate_hz: 1000.0, ..BENCH });
    case.rewrite(|row, _| (row * 7 + row * row / 3) % 5 > 1);
    names(&case.diagnose(&[]), "stress_relaxation");
}

#[test]
fn with_a_row_left_out_here_and_there() {
    let case = fades(BENCH);
    case.rewrite(|row, _| row * row % 97 != 1);
    names(&case.diagnose(&[]), "stress_relaxation");
}
