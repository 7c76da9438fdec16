//! The page of a replay: safe to pass on, true to the data, light enough to open.

#[path = "page/full.rs"]
mod full;
#[path = "page/reading.rs"]
mod reading;
#[path = "page/synthetic.rs"]
mod synthetic;

use full::Full;
use palpate_lab::page::Page;
use reading::{bytes, doubles, floats, prose};
use std::io::ErrorKind;
use synthetic::{AFM, BENCH, Recorded, Touching, odd, page, touching};

fn written(page: &Page) -> String {
    let mut out = Vec::new();
    page.write(&mut out).expect("a vector takes everything");
    String::from_utf8(out).expect("a page is UTF-8")
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

fn says(trial: Recorded, sentence: &str) {
    let prose = prose(&written(&page("bench A", vec![trial])));
    assert!(prose.contains(sentence), "{sentence:?} is not in {prose:?}");
}

#[test]
fn the_answer_opens_the_page_in_plain_words() {
    let mut trial = touching().trial("trial-1.csv");
    let summary = trial.methods[0].summary.as_mut().expect("it touches");
    (summary.stiffness, summary.stiffness_half_width) = (298.37, 4.13);
    (summary.damping, summary.damping_half_width) = (5.02, 0.31);
    summary.rmse_percent = 0.5;
    says(trial, "a stiffness of 298.4 ± 4.1 N/m and a damping of 5.02 ± 0.31 N s/m. So says block least squares");
}

#[test]
fn the_method_with_the_least_error_is_quoted() {
    let mut trial = touching().trial("trial-1.csv");
    for (index, method) in trial.methods.iter_mut().enumerate() {
        method.summary.as_mut().expect("it touches").rmse_percent = [f64::NAN, 4.0, 3.0, 5.0][index];
    }
    says(trial, "So says self-perturbing recursive least squares, which of 4 methods");
}

#[test]
fn an_interval_that_includes_zero_is_called_no_finding() {
    let mut trial = touching().trial("trial-1.csv");
    trial.methods.truncate(1);
    let summary = trial.methods[0].summary.as_mut().expect("it touches");
    (summary.damping, summary.damping_half_width) = (5.0, 12.0);
    says(trial, "5 ± 12 N s/m (this damping is not distinguishable from zero)");
}

#[test]
fn the_table_tells_how_far_a_method_is_from_the_rig_file() {
    let differs = |nominal: f64, words: &str| {
        let mut trial = touching().trial("trial-1.csv");
        trial.methods[0].summary.as_mut().expect("it touches").stiffness = 300.0;
        trial.nominal_stiffness = nominal;
        says(trial, words);
    };
    differs(200.0, "+50 %");
    differs(400.0, "−25 %");
    differs(300.0, "as stated");
    differs(20.0, "15 times as much");
    differs(3e6, "10\u{202f}000 times less");
}

#[test]
fn nothing_touched_nothing_run_and_nothing_recorded_are_said() {
    let mut free = touching().trial("free.csv");
    free.contact.fill(false);
    free.methods.iter_mut().for_each(|method| method.summary = None);
    says(free, "The tool touched nothing in the 3 s of this recording");

    let mut brief = touching().trial("brief.csv");
    brief.methods.iter_mut().for_each(|method| method.summary = None);
    says(brief, "no estimator could bound stiffness and damping");

    says(Touching { methods: 0, ..touching() }.trial("bare.csv"), "but no estimator was run on it");
    says(Touching { seconds: 0.0, ..touching() }.trial("empty.csv"), "The recording is empty");
    says(Touching { seconds: 0.001, ..touching() }.trial("single.csv"), "The tool touched nothing");
    assert!(prose(&written(&page("bench A", Vec::new()))).contains("No recording was replayed."));
}

#[test]
fn many_recordings_are_summed_up_and_each_has_its_section() {
    let trials = (0..20).map(|n| {
        let mut trial = Touching { seconds: 1.0, ..touching() }.trial(&format!("trial-{n}.csv"));
        trial.methods[0].summary.as_mut().expect("it touches").stiffness = 200.0 + 10.0 * f64::from(n);
        trial.methods[0].summary.as_mut().expect("it touches").rmse_percent = 0.1;
        trial
    });
    let html = written(&page("bench A", trials.collect()));
    assert!(prose(&html).contains("a stiffness between 200 N/m and 390 N/m"));
    assert_eq!(html.matches("<article").count(), 20);
    assert!(
        (1..=20).all(|n| html.contains(&format!("href=\"#trial-{n}\"")) && html.contains(&format!("id=\"trial-{n}\"")))
    );
}

#[test]
fn the_page_needs_no_network() {
    let html = written(&page("bench A", vec![touching().trial("a.csv"), touching().trial("b.csv")]));
    assert!(html.contains("default-src 'none'"));
    for way_out in
        [" src=", "@import", "url(", "<link", "<base", "<iframe", "fetch(", "XMLHttpRequest", "WebSocket", "import("]
    {
        assert!(!html.contains(way_out), "{way_out}");
    }
    assert!(html.match_indices("href=").all(|(at, _)| {
        // A place in this page, or the diagnosis that stands in the same folder.
        ["href=\"#", "href=\"report.html\""].iter().any(|place| html[at..].starts_with(place))
    }));
    // The name of SVG and the banner of the plotting library are names, which nothing follows.
    let named = ["http://www.w3.org/2000/svg", "https://github.com/leeoniya/uPlot"];
    assert!(
        html.match_indices("http")
            .filter(|(at, _)| html[at + 4..].trim_start_matches('s').starts_with("://"))
            .all(|(at, _)| named.iter().any(|name| html[at..].starts_with(name)))
    );
}

#[test]
fn hostile_names_stay_text() {
    let hostile = "</script><script>alert(1)</script><img src=x onerror=alert(1)>\"'&";
    let tame = written(&page("bench A", vec![touching().trial("a.csv"), touching().trial("b.csv")]));
    let mut trials = vec![touching().trial(hostile), touching().trial(hostile)];
    for trial in &mut trials {
        trial.notices.push(hostile.into());
        trial.methods[0].title = "</script><img src=x>";
    }
    let mut page = page(hostile, trials);
    page.ran_on = hostile.into();
    page.settings.iter_mut().for_each(|(label, value)| (*label, *value) = (hostile.into(), hostile.into()));
    let html = written(&page);
    for tag in ["<script", "</script", "<img"] {
        assert_eq!(html.matches(tag).count(), tame.matches(tag).count(), "{tag}");
    }
    assert!(html.contains("&lt;/script&gt;&lt;script&gt;alert(1)"));
    assert!(html.contains(r"\u003c/script>"));
    let attributes = html.match_indices("onerror=").count();
    assert_eq!(html.matches("&lt;img src=x onerror=alert(1)&gt;&quot;").count(), attributes);
}

#[test]
fn the_numbers_of_a_short_trial_come_back_to_the_bit() {
    let mut trial = touching().trial("trial-1.csv");
    trial.time.iter_mut().for_each(|time| *time += 1.7e9);
    trial.methods[1].estimates.stiffness[700] = f32::NAN;
    trial.methods[1].estimates.stiffness_half_width[701] = f32::INFINITY;
    let html = written(&page("bench A", vec![trial.clone()]));
    assert!(prose(&html).contains("Samples shown: all 3\u{202f}000."));
    assert_eq!(doubles(&html, "t0-time"), trial.time);
    assert_eq!(bytes(&html, "t0-contact"), trial.contact.iter().map(|&c| u8::from(c)).collect::<Vec<_>>());
    assert_eq!(bits(&floats(&html, "t0-penetration")), bits(&trial.penetration));
    assert_eq!(bits(&floats(&html, "t0-force")), bits(&trial.force));
    for (n, method) in trial.methods.iter().enumerate() {
        let column = |name: &str| bits(&floats(&html, &format!("t0-m{n}-{name}")));
        assert_eq!(column("stiffness"), bits(&method.estimates.stiffness));
        assert_eq!(column("stiffness-half-width"), bits(&method.estimates.stiffness_half_width));
        assert_eq!(column("damping"), bits(&method.estimates.damping));
        assert_eq!(column("damping-half-width"), bits(&method.estimates.damping_half_width));
        assert_eq!(column("innovation"), bits(&method.estimates.innovation));
    }
}

#[test]
fn what_is_not_finite_is_neither_an_answer_nor_bad_json() {
    let mut trial = touching().trial("trial-1.csv");
    trial.nominal_stiffness = f64::NAN;
    let summary = trial.methods[0].summary.as_mut().expect("it touches");
    (summary.stiffness, summary.rmse_percent) = (f64::NAN, 0.0);
    let summary = trial.methods[1].summary.as_mut().expect("it touches");
    (summary.damping_half_width, summary.rmse_percent) = (f64::INFINITY, f64::NAN);
    let html = written(&page("bench A", vec![trial]));
    let prose = prose(&html);
    assert!(!prose.contains("NaN") && !prose.contains("inf "), "{prose}");
    assert!(!prose.contains("So says block least squares"));
    let start = html.find(r#"id="description">"#).expect("a description") + r#"id="description">"#.len();
    let json = html[start..].split("</script>").next().expect("it ends");
    let json: serde_json::Value = serde_json::from_str(json).expect("valid JSON");
    assert_eq!(json["trials"][0]["nominal_stiffness"], serde_json::Value::Null);
}

#[test]
fn a_million_samples_are_thinned_and_keep_what_matters() {
    let mut trial = Touching { seconds: 1000.0, methods: 9, ..BENCH }.trial("long.csv");
    // One sample each, somewhere in the middle of things.
    trial.force[123_457] = 99.0;
    trial.penetration[234_567] = -0.5;
    trial.methods[6].estimates.innovation[345_678] = -42.0;
    trial.methods[8].estimates.innovation[345_679] = 41.0;
    trial.notices.push("a notice".into());
    let html = written(&page("bench A", vec![trial.clone()]));
    println!("{} bytes", html.len());
    assert!(html.len() < 15_000_000, "{} bytes", html.len());

    let time = doubles(&html, "t0-time");
    assert!((6_000..=12_000).contains(&time.len()), "{} rows", time.len());
    assert!(time.is_sorted_by(|a, b| a < b));
    assert_eq!((time.first(), time.last()), (trial.time.first(), trial.time.last()));
    assert!(floats(&html, "t0-force").contains(&99.0));
    assert!(floats(&html, "t0-penetration").contains(&-0.5));
    assert!(floats(&html, "t0-m6-innovation").contains(&-42.0));
    assert!(floats(&html, "t0-m8-innovation").contains(&41.0));
    let edges = (1..trial.contact.len()).filter(|&row| trial.contact[row] != trial.contact[row - 1]);
    let kept = |row: usize| time.binary_search_by(|t| t.total_cmp(&trial.time[row])).is_ok();
    assert!(edges.clone().count() > 100);
    assert!(edges.flat_map(|row| [row - 1, row]).all(kept));
    assert!(prose(&html).contains("samples shown (") && !prose(&html).contains("Samples shown: all"));
}

#[test]
fn a_contact_that_chatters_does_not_break_the_bound() {
    let mut trial = Touching { seconds: 100.0, ..BENCH }.trial("chatter.csv");
    trial.contact.iter_mut().enumerate().for_each(|(row, contact)| *contact = row % 2 == 0);
    let time = doubles(&written(&page("bench A", vec![trial])), "t0-time");
    assert!((6_000..=12_000).contains(&time.len()), "{} rows", time.len());
}

#[test]
fn twenty_long_recordings_share_the_weight() {
    let trial = Touching { seconds: 60.0, methods: 9, ..BENCH }.trial("trial.csv");
    let html = written(&page("bench A", vec![trial; 20]));
    assert!(html.len() < 15_000_000, "{} bytes", html.len());
    assert!(doubles(&html, "t19-time").len() > 1_000);
}

#[test]
fn columns_of_unequal_length_are_refused() {
    let mut torn = page("bench A", vec![touching().trial("torn.csv")]);
    torn.trials[0].drawn.estimates[2].damping.pop();
    let mut out = Vec::new();
    let error = torn.write(&mut out).expect_err("a column is short");
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    assert!(error.to_string().contains("torn.csv"));
    assert!(out.is_empty());
}

#[test]
fn a_full_disk_is_reported_wherever_it_strikes() {
    let page = page("bench A", vec![touching().trial("trial-1.csv")]);
    let whole = written(&page).len();
    for room in [0, 10_000, whole / 2, whole - 1] {
        let error = page.write(&mut Full(room)).expect_err("it does not fit");
        assert_eq!(error.kind(), ErrorKind::StorageFull);
    }
    page.write(&mut Full(whole)).expect("it fits");
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
        ("odd", page("odd ones", odd())),
    ];
    for (name, page) in pages {
        std::fs::write(folder.join(format!("{name}.html")), written(&page)).expect("cargo made this folder");
    }
}
