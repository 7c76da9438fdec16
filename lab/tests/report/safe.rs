//! Nothing that a page is made of can break it, and it asks nothing of anybody.

use crate::answers::explained;
use crate::full::Full;
use crate::{Report, every_kind, written};
use palpate_lab::diagnose::report::diagnosis::{BinnedResidual, PlotData};
use palpate_lab::diagnose::report::html;
use std::io::ErrorKind;

#[test]
fn the_page_needs_no_network() {
    for (name, diagnosis) in every_kind() {
        let html = written(&diagnosis);
        assert!(html.contains("default-src 'none'"));
        for way_out in [
            " src=",
            "@import",
            "url(",
            "<link",
            "<base",
            "<iframe",
            "fetch(",
            "XMLHttpRequest",
            "WebSocket",
            "import(",
        ] {
            assert!(!html.contains(way_out), "{name}: {way_out}");
        }
        // The name of SVG and the banner of the plotting library are names, which nothing follows.
        let named = ["http://www.w3.org/2000/svg", "https://github.com/leeoniya/uPlot"];
        let addresses =
            html.match_indices("http").filter(|(at, _)| html[at + 4..].trim_start_matches('s').starts_with("://"));
        assert!(addresses.into_iter().all(|(at, _)| named.iter().any(|known| html[at..].starts_with(known))), "{name}");
    }
}

#[test]
fn hostile_names_stay_text() {
    let hostile = "</script><script>alert(1)</script><img src=x onerror=alert(1)>\"'&";
    let tame = written(&explained());
    let (mut answer, mut pictures) = explained();
    pictures.rig = hostile.into();
    pictures.evidence[0].trial = hostile.into();
    let run = pictures.run.as_mut().expect("there is one");
    (run.command, run.inputs[0].0) = (hostile.into(), hostile.into());
    answer.summary = hostile.into();
    answer.locations.iter_mut().for_each(|place| (place.trial, place.states) = (hostile.into(), hostile.into()));
    pictures
        .traces
        .iter_mut()
        .filter(|trace| trace.trial == "trial-1.csv")
        .for_each(|trace| trace.trial = hostile.into());
    answer.findings.iter_mut().for_each(|finding| (finding.place, finding.text) = (hostile.into(), hostile.into()));
    answer.alternatives[0].separated_by = hostile.into();
    answer.alternatives[0].physics[0] = hostile.into();
    answer.nominal[0].name = hostile.into();
    answer.nominal[0].unit = hostile.into();
    answer.physics[0].statement = hostile.into();
    answer.physics[0].on_drive = Some(hostile.into());
    answer.physics[0].parameters[0].unit = hostile.into();
    pictures.maps[0].labels[0] = hostile.into();
    pictures.maps[0].unit = hostile.into();
    pictures.experiment.as_mut().expect("there is one").text = hostile.into();
    let html = written(&(answer, pictures));
    for tag in ["<script", "</script", "<img"] {
        assert_eq!(html.matches(tag).count(), tame.matches(tag).count(), "{tag}");
    }
    assert!(html.contains("&lt;/script&gt;&lt;script&gt;alert(1)"));
    let attributes = html.matches("onerror=").count();
    assert_eq!(html.matches("onerror=alert(1)&gt;&quot;").count(), attributes);
}

#[test]
fn what_is_no_number_is_unknown() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (name, diagnosis) in every_kind() {
            let html = written(&spoilt(diagnosis, bad));
            let shown = &html[html.find("<main>").expect("a body")..html.find("<script").expect("data")];
            for letters in ["NaN", "inf ", "inf%", "inf\"", "inf\u{a0}", "inf<", "null"] {
                assert!(
                    !shown.contains(letters),
                    "{name}: {letters:?} near {:?}",
                    shown.find(letters).map(|at| &shown[at.saturating_sub(60)..at + 20])
                );
            }
            assert!(shown.contains("unknown"), "{name}");
            let start = html.find(r#"id="description">"#).expect("a description") + r#"id="description">"#.len();
            let json = html[start..].split("</script>").next().expect("it ends");
            serde_json::from_str::<serde_json::Value>(json).expect("valid JSON");
        }
    }
}

/// Every number of a diagnosis gone bad.
fn spoilt((mut answer, mut pictures): Report, bad: f64) -> Report {
    for fit in answer.channels.iter_mut().chain([&mut answer.fit]) {
        (fit.as_given, fit.refitted, fit.improved, fit.noise_floor, fit.explained_share, fit.band_hz) =
            (bad, bad, bad, bad, bad, bad);
    }
    for physics in &mut answer.physics {
        (physics.evidence.held_out_gain, physics.evidence.p_value) = (bad, bad);
        physics.parameters.iter_mut().for_each(|value| (value.value, value.ci95) = (bad, [bad, bad]));
    }
    answer.alternatives.iter_mut().for_each(|rival| rival.held_out_gain = bad);
    answer.locations.iter_mut().for_each(|place| (place.share, place.start_s, place.end_s) = (bad, bad, bad));
    answer.nominal.iter_mut().for_each(|value| (value.given, value.fitted, value.ci95) = (bad, bad, [bad, bad]));
    for map in &mut pictures.maps {
        [&mut map.before, &mut map.after, &mut map.share].into_iter().for_each(|values| values.fill(bad));
    }
    pictures.evidence.iter_mut().for_each(|plot| (plot.state[3], plot.improved[4]) = (bad as f32, bad as f32));
    pictures.experiment.iter_mut().for_each(|next| next.reference[7] = bad);
    for trace in &mut pictures.traces {
        trace.improved.fill(bad as f32);
        trace.expected_noise.fill(bad as f32);
    }
    (answer, pictures)
}

#[test]
fn vectors_of_unequal_length_are_refused() {
    let refused = |spoil: fn(&mut PlotData), named: &str| {
        let (answer, mut pictures) = explained();
        spoil(&mut pictures);
        let mut out = Vec::new();
        let error = html::write(&answer, &pictures, &mut out).expect_err("a vector is short");
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
        assert!(error.to_string().contains(named) && out.is_empty(), "{error}");
    };
    refused(|pictures| pictures.traces[1].expected_noise.truncate(9), "trial-1.csv");
    refused(|pictures| pictures.evidence[0].state.truncate(9), "depth");
    refused(|pictures| pictures.traces[1].learned.push(0.0), "trial-1.csv");
    refused(|pictures| pictures.maps[1].share.truncate(1), "depth");
    refused(|pictures| pictures.maps[2] = BinnedResidual { before: vec![1.0], ..pictures.maps[2].clone() }, "speed");
    refused(|pictures| pictures.experiment.iter_mut().for_each(|next| next.time.truncate(3)), "experiment");
}

#[test]
fn a_full_disk_is_reported_wherever_it_strikes() {
    let (answer, pictures) = explained();
    let whole = written(&(answer.clone(), pictures.clone())).len();
    for room in [0, 10_000, whole / 2, whole - 1] {
        let error = html::write(&answer, &pictures, &mut Full(room)).expect_err("it does not fit");
        assert_eq!(error.kind(), ErrorKind::StorageFull);
    }
    html::write(&answer, &pictures, &mut Full(whole)).expect("it fits");
}
