//! The page of a diagnosis: it says what the answer says, shows what there is, and is safe to pass on.

#[path = "report/answers.rs"]
mod answers;
#[path = "page/full.rs"]
mod full;
#[path = "page/reading.rs"]
mod reading;
#[path = "report/safe.rs"]
mod safe;
#[path = "report/signal.rs"]
mod signal;

use answers::{explained, nano, no_mismatch, parameters, unknown, value};
use palpate_lab::diagnose::report::diagnosis::{Correlations, Diagnosis, Finding, Phase, PlotData, Verdict};
use palpate_lab::diagnose::report::html;
use palpate_lab::diagnose::report::summary::summary;
use palpate_lab::rig::Coordinate;
use reading::{bytes, doubles, floats, prose};
use signal::{Size, trace};

type Report = (Diagnosis, PlotData);

fn written((answer, pictures): &Report) -> String {
    let mut out = Vec::new();
    html::write(answer, pictures, &mut out).expect("a vector takes everything");
    String::from_utf8(out).expect("a page is UTF-8")
}

fn every_kind() -> [(&'static str, Report); 5] {
    [
        ("explained", explained()),
        ("no-mismatch", no_mismatch()),
        ("parameters", parameters()),
        ("unknown", unknown()),
        ("nano", nano()),
    ]
}

#[track_caller]
fn says(diagnosis: &Report, sentences: &[&str]) {
    let prose = prose(&written(diagnosis));
    for sentence in sentences {
        assert!(prose.contains(sentence), "{sentence:?} is not in {prose:?}");
    }
}

#[test]
fn two_effects_and_an_alternative_are_shown_with_figures() {
    says(
        &explained(),
        &[
            "The damping grows with depth and the drive drags; the simulation knows neither.",
            "Hunt-Crossley damping",
            "acts in the contact",
            "F = K x + B v + alpha x v",
            "812 ± 14 N s/m²",
            "1.430 ± 0.050 N",
            "1.12 N (95 %: 0.81 to 1.21 N)",
            "chance alone does as much in fewer than 1 of 1000 cases",
            "the named physics takes away 97 %",
            "Explained by Hunt-Crossley damping and Coulomb friction",
            "of the mean square that the law without it leaves above the noise; chance",
            "How this was made",
            "SHA-256 abab",
            "82 % of what the simulation misses in the force lies at onset, as the contact begins, in trial-1.csv, 2.61 to 2.95 s, x 0-2 mm, v &gt; 0.1 m/s.",
            "quadratic damping not ruled out",
            "press at one speed to 3 mm and to 9 mm",
            "Before you rely on this",
            "318.4 ± 2.3 N/m",
            "0.8110 ± 0.0040 kg",
        ],
    );
}

#[test]
fn values_that_are_only_estimated_together_are_described() {
    let (mut answer, pictures) = explained();
    let names = ["stiffness_n_m", "damping_n_s_m", "hunt_crossley_damping.alpha"].map(str::to_owned);
    let matrix = |rho: f64| vec![vec![1.0, 0.3, -0.1], vec![0.3, 1.0, rho], vec![-0.1, rho, 1.0]];
    let of = |rho: f64| Correlations { channel: "force", parameters: names.to_vec(), matrix: matrix(rho) };
    answer.correlations = vec![of(-0.973)];
    let report = (answer.clone(), pictures.clone());
    says(
        &report,
        &[
            "damping_n_s_m and hunt_crossley_damping.alpha are only estimated together: their errors have a correlation of −0.97.",
            "If one is larger than estimated, the other is smaller,",
        ],
    );
    let page = written(&report);
    for mark in ["<details open>", "<td class=\"below strong\">−0.97</td>", "<td class=\"above weak\">0.30</td>"] {
        assert!(page.contains(mark), "{mark}");
    }
    answer.correlations = vec![of(0.85)];
    says(&(answer, pictures), &["No two errors have a correlation beyond ±0.9"]);
}

#[test]
fn nothing_missing_reads_well_and_shows_nothing_empty() {
    let diagnosis = no_mismatch();
    says(
        &diagnosis,
        &[
            "No mismatch",
            "differs from these recordings by no more than",
            "No stretch of the recordings stands out",
            "Nothing is needed for these motions",
        ],
    );
    let html = written(&diagnosis);
    for absent in
        ["id=\"physics\"", "id=\"evidence\"", "id=\"findings\"", "Before you rely on this", "with the named physics"]
    {
        assert!(!html.contains(absent), "{absent}");
    }
    for present in ["id=\"fit\"", "id=\"where\"", "id=\"trials\"", "id=\"nominal\"", "id=\"checked\"", "id=\"next\""] {
        assert!(html.contains(present), "{present}");
    }
}

#[test]
fn other_values_are_no_missing_physics() {
    let diagnosis = parameters();
    says(&diagnosis, &["Other values, no other physics", "412.0 ± 2.3 N/m", "+37 %", "differ"]);
    assert!(!written(&diagnosis).contains("id=\"physics\""));
}

#[test]
fn what_is_unknown_is_owned_and_located() {
    says(
        &unknown(),
        &[
            "Unknown physics",
            "none of the 8 effects that were tried explains it",
            "Most of it, 74 % in the force, lies while drawing back, in trial-1.csv, 3.20 to 3.70 s, x 3-9 mm",
            "no effect that was tried takes that away",
            "record more of where it lies (while drawing back, x 3-9 mm, v &lt; -0.02 m/s)",
        ],
    );
}

/// What was found out stands in the head of the page, above what is merely remarked.
#[test]
fn effort_in_the_force_reading_is_told_above_the_pictures() {
    let (mut answer, pictures) = unknown();
    answer.findings.push(Finding {
        code: "effort_in_force",
        grave: false,
        place: "force".into(),
        text: "The force reading follows the drive's effort by a factor of 0.3.".into(),
    });
    answer.summary = summary(&answer, Coordinate::Linear);
    let diagnosis = (answer, pictures);
    says(&diagnosis, &["The force reading holds effort of the drive", "the drive was judged by the force without it"]);
    assert!(!written(&diagnosis).contains("effects that were tried explains it"));
}

/// It was taken off, so that what stands beside it must not be told as unexplained.
#[test]
fn a_force_of_free_motion_is_told_above_the_pictures() {
    let (mut answer, pictures) = unknown();
    answer.findings.push(Finding {
        code: "parasitic_force",
        grave: false,
        place: "force".into(),
        text: "The force sensor shows a force before anything is touched that goes with the speed.".into(),
    });
    answer.summary = summary(&answer, Coordinate::Linear);
    assert!(answer.summary.starts_with("The force reading holds a force that acts in free motion, too"));
    let diagnosis = (answer, pictures);
    says(&diagnosis, &["shows a force where nothing is touched, which no contact has", "judged by what is left"]);
    assert!(!written(&diagnosis).contains("effects that were tried explains it"));
}

#[test]
fn figures_stay_readable_from_nano_to_kilo() {
    says(
        &nano(),
        &[
            "321.0 ± 4.0 nN m s/rad²",
            "−1.20 ± 0.30 nN m",
            "(2.50 ± 0.20) × 10⁻¹² kg m²",
            "730.0 ± 5.0 µN m/rad",
            "Partly explained",
        ],
    );
    let mut diagnosis = explained();
    diagnosis.0.physics[0].parameters = vec![value("alpha", 12_345.0, "N s/m^2", 70.0)];
    says(&diagnosis, &["12.345 ± 0.070 kN s/m²"]);
}

#[test]
fn every_picture_of_bars_has_words() {
    for (name, diagnosis) in every_kind() {
        let html = written(&diagnosis);
        let body = &html[..html.find("</main>").expect("a body")];
        let pictures = body.matches("<svg class=").count();
        assert!(pictures > 0, "{name}");
        assert_eq!(pictures, body.matches("role=\"img\" aria-label=\"").count(), "{name}");
        for tag in
            ["section", "figure", "details", "svg", "table", "ul", "ol", "dl", "article", "g", "text", "template"]
        {
            let opened = html.matches(&format!("<{tag}>")).count() + html.matches(&format!("<{tag} ")).count();
            assert_eq!(opened, html.matches(&format!("</{tag}>")).count(), "{name}: {tag}");
        }
    }
}

#[test]
fn identifiers_and_links_belong_together() {
    for (name, diagnosis) in every_kind() {
        let html = written(&diagnosis);
        let ids: Vec<&str> = html.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        let mut once = ids.clone();
        once.sort_unstable();
        once.dedup();
        assert_eq!(once.len(), ids.len(), "{name}: an identifier twice");
        let links = ["href=\"#", "aria-labelledby=\""].into_iter().flat_map(|mark| html.split(mark).skip(1));
        for target in links.filter_map(|rest| rest.split('"').next()) {
            assert!(ids.contains(&target), "{name}: nothing is called {target}");
        }
    }
}

#[test]
fn the_numbers_of_a_short_trial_come_back_to_the_bit() {
    let diagnosis = explained();
    let html = written(&diagnosis);
    let trace = &diagnosis.1.traces[3];
    assert_eq!(doubles(&html, "t3-time"), trace.time);
    assert_eq!(bytes(&html, "t3-seen"), trace.valid.iter().map(|&seen| u8::from(seen)).collect::<Vec<_>>());
    for (name, values) in [
        ("depth", &trace.depth),
        ("measured", &trace.measured),
        ("given", &trace.as_given),
        ("refitted", &trace.refitted),
        ("improved", &trace.improved),
        ("floor", &trace.expected_noise),
    ] {
        assert_eq!(&floats(&html, &format!("t3-{name}")), values, "{name}");
    }
}

#[test]
fn a_million_rows_are_thinned_and_keep_spikes_and_the_worst_place() {
    let (mut answer, mut pictures) = explained();
    let size = Size { depth: 9e-3, force: 4.0, rows: 1_000_000, rate: 1000.0, lacks: [1.0, 0.9, 0.0] };
    let mut long = trace(&size, "trial-1.csv", "force", 7);
    long.measured[654_321] = 99.0;
    long.improved[123_456] = -77.0;
    long.time.iter_mut().for_each(|time| *time += 1.7e9);
    pictures.traces = vec![long];
    (answer.locations[0].start_s, answer.locations[0].end_s) = (500.0, 500.5);
    let html = written(&(answer, pictures));
    assert!(html.len() < 2_000_000, "{} bytes", html.len());
    let time = doubles(&html, "t0-time");
    assert!((6_000..=12_000).contains(&time.len()), "{} rows", time.len());
    assert!(time.is_sorted_by(|a, b| a < b));
    assert!(time[0] == 0.0 && time.last().is_some_and(|last| (last - 999.999).abs() < 1e-6));
    assert!(floats(&html, "t0-measured").contains(&99.0));
    assert!(floats(&html, "t0-improved").contains(&-77.0));
    assert!(time.iter().filter(|t| (500.0..=500.5).contains(*t)).count() >= 500);
}

#[test]
fn many_trials_share_the_weight() {
    let (answer, mut pictures) = explained();
    let size = Size { depth: 9e-3, force: 4.0, rows: 20_000, rate: 1000.0, lacks: [1.0, 0.9, 0.0] };
    pictures.traces = (0..40).map(|n| trace(&size, &format!("trial-{n}.csv"), "force", n)).collect();
    let html = written(&(answer, pictures));
    assert!(html.len() < 15_000_000, "{} bytes", html.len());
    assert_eq!(html.matches("<details class=\"trial\"").count(), 40);
    assert_eq!(html.matches(" open>").count(), 1);
}

#[test]
fn nothing_but_a_verdict_is_still_a_page() {
    let (answer, mut pictures) = no_mismatch();
    pictures.traces.clear();
    pictures.maps.clear();
    let answer = Diagnosis { verdict: Verdict::NoMismatch, nominal: Vec::new(), checked: Vec::new(), ..answer };
    says(
        &(answer, pictures),
        &[
            "There is no recording to draw",
            "No nominal value was refitted",
            "No effect was tried",
            "gave no cause for remark",
        ],
    );
}

#[test]
fn many_places_are_folded() {
    let mut diagnosis = explained();
    let place = diagnosis.0.locations[0].clone();
    diagnosis.0.locations = vec![place; 20];
    diagnosis.0.locations[19].phase = Phase::Release;
    says(&diagnosis, &["14 more places", "at release, as the contact ends"]);
}

/// Leaves the pages where a person can open them, if asked for a folder.
#[test]
fn pages_to_look_at() {
    let Some(folder) = std::env::var_os("PALPATE_PAGES") else { return };
    for (name, diagnosis) in every_kind() {
        let path = std::path::Path::new(&folder).join(format!("{name}.html"));
        std::fs::write(path, written(&diagnosis)).expect("the folder exists");
    }
}
