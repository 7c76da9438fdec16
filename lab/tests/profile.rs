//! What the estimators cost on the device, and that their interrupt cannot panic.
//!
//! Without the cross target, QEMU or llvm-objdump these tests say so and pass, unless `PALPATE_DEVICE=required` (as `cargo verify`
//! sets it where it has set them up).

use palpate_lab::profile::{Profile, interrupt_image, panics_reached_from};
use palpate_lab::tools::{self, Leave, MissingTools};

/// Whether the tools are there; else a word, and an end where they are required.
fn ready() -> bool {
    match tools::for_profiling(Leave::Look) {
        Ok(_) => true,
        Err(MissingTools(missing)) => {
            assert!(std::env::var_os("PALPATE_DEVICE").is_none(), "{missing:?}");
            eprintln!("left out: {missing:?}");
            false
        }
    }
}

#[test]
fn every_update_is_counted_twice_alike_and_costs_what_its_budget_says() {
    if !ready() {
        return;
    }
    let steps = std::cell::RefCell::new(Vec::new());
    let profile = Profile::take(Leave::Look, &|step| steps.borrow_mut().push(step.to_owned()))
        .unwrap_or_else(|error| panic!("{error:#}"));
    let steps = steps.into_inner();
    assert!(steps.len() >= 5 && steps.iter().any(|step| step.contains("second count")), "{steps:?}");
    assert!(profile.passes() > 50_000, "{} passes", profile.passes());
    let beyond = profile.beyond_budget().unwrap_or_else(|error| panic!("{error:#}"));
    assert!(
        beyond.is_empty(),
        "beyond lab/budget.csv; where that is meant: cargo run --release -p palpate-lab -- profile --renew-budget\n{beyond}"
    );
    assert_eq!(profile.panics(), Vec::<String>::new(), "an update can come to these");
    let find = |name: &str, window: Option<u16>| {
        let found = profile.figures.iter().find(|f| f.name == name && f.window == window);
        found.unwrap_or_else(|| panic!("{name} {window:?} was not measured"))
    };
    for name in ["bls", "blms", "blmf", "newton_blmf"] {
        let [short, long] = [50, 300].map(|window| f64::from(find(name, Some(window)).instructions_worst));
        // Parts of a window begin more often in a short one, and nothing else depends on its length.
        assert!(long < 1.1 * short, "{name}: {long} instructions at 300 samples, {short} at 50");
    }
    for f in &profile.figures {
        let (name, json) = (&f.name, serde_json::to_value(f).expect("JSON"));
        for key in ["name", "window", "instructions_mean", "instructions_worst", "cycles_lo", "cycles_hi"] {
            assert!(json.get(key).is_some(), "{name}: no {key} in {json}");
        }
        assert!(json["stack_bytes"].is_u64() && json["state_bytes"].is_u64(), "{name}: {json}");
        assert!(f.cycles_lo <= f.cycles_hi && f.worst_cycles_lo <= f.worst_cycles_hi, "{name}");
        assert!(f64::from(f.cycles_lo) >= 0.9 * f.instructions_mean, "{name}: less than a cycle an instruction");
        assert!(f.stack_painted_bytes <= f.stack_bytes + 8, "{name}: more stack was seen than the code can use");
    }
    let whole = find("identify_all_four", Some(300));
    assert!(whole.share_of_1ms_percent < 10.0, "four laws on one ring take {} % of 1 ms", whole.share_of_1ms_percent);
}

#[test]
fn no_panic_can_be_reached_from_the_interrupt() {
    if !ready() {
        return;
    }
    let image = interrupt_image().unwrap_or_else(|error| panic!("{error:#}"));
    let reached = panics_reached_from(&image, "SysTick").unwrap_or_else(|error| panic!("{error:#}"));
    assert_eq!(reached, Vec::<String>::new(), "the interrupt can come to these");
    // The idle loop may panic, and does where its files fail: so a panic is seen where there is one.
    let idle = panics_reached_from(&image, "main").unwrap_or_else(|error| panic!("{error:#}"));
    assert!(!idle.is_empty(), "no panic is seen anywhere in the image");
}
