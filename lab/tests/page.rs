//! The page of a replay: safe to pass on, true to the data, light enough to open.

#[path = "page/synthetic.rs"]
mod synthetic;

use palpate_lab::page::Page;
use synthetic::{AFM, BENCH, Touching, page};

fn written(page: &Page) -> String {
    let mut out = Vec::new();
    page.write(&mut out).expect("a vector takes everything");
    String::from_utf8(out).expect("a page is UTF-8")
}

/// Leaves the pages where a person can open them.
#[test]
fn pages_to_look_at() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let mut many: Vec<_> = (0..20)
        .map(|seed| {
            let stiffness = 200.0 + 10.0 * seed as f64;
            Touching { seed, stiffness, ..BENCH }.trial(&format!("trial-{}.csv", seed + 1))
        })
        .collect();
    many[3].contact.fill(false);
    many[3].methods.iter_mut().for_each(|method| method.summary = None);
    let mut bench = BENCH.page("bench A");
    bench.trials[0].notices.push("cut-off lowered to 2 Hz: the recording has 10 samples a second".into());
    let pages = [
        ("bench", bench),
        ("afm", AFM.page("cantilever on a cell")),
        ("nine", Touching { methods: 9, ..BENCH }.page("bench A")),
        ("many", page("bench A", many)),
    ];
    for (name, page) in pages {
        std::fs::write(folder.join(format!("{name}.html")), written(&page)).expect("cargo made this folder");
    }
}
