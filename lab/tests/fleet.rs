//! `palpate diagnose-all` as a user runs it: broken rigs, restarts, changed inputs, jobs, and the night before.

#[path = "diagnose/bench.rs"]
#[allow(dead_code, reason = "its other users need the rest")]
mod bench;
#[path = "fleet/night.rs"]
mod night;

use std::fs;

use night::{FLEET, Night, rows};
use palpate_lab::recording::data_file::{Content, DataFile};

#[test]
fn a_fleet_gives_a_table_a_page_and_each_rig_what_diagnose_gives() {
    let night = Night::new(&FLEET);
    night.run("out", &[]).success();
    let table = rows(&night.path("out/table.csv"));
    let of = |rig: &str| table.iter().filter(|row| row["rig"] == rig).collect::<Vec<_>>();
    let faded: Vec<_> = of("fades").into_iter().filter(|row| row["effect"] == "stress_relaxation").collect();
    assert_eq!(faded.len(), 2, "two values of one effect");
    assert!(faded.iter().all(|row| row["verdict"] == "explained" && row["effects"] == "stress_relaxation"));
    let branch = faded.iter().find(|row| row["parameter"] == "branch_stiffness").unwrap();
    let number = |name: &str| branch[name].parse::<f64>().unwrap();
    assert!(number("ci95_low") < number("value") && number("value") < number("ci95_high"));
    assert!((number("value") / 60.0 - 1.0).abs() < 0.2 && branch["unit"] == "N/m");
    assert!((number("residual_improved") / number("expected_noise") - number("residual_over_noise")).abs() < 1e-12);
    let plain = of("plain");
    assert!(plain.iter().all(|row| row["effect"] == "nominal"), "{plain:?}");
    assert!(plain.iter().any(|row| row["parameter"] == "stiffness_n_m" && row["given"] == "300.0"));
    // The same bytes as the command gives on its own.
    night.diagnose("fades", "alone.json");
    assert_eq!(night.read("out/rigs/fades/diagnosis.json"), night.read("alone.json"));
    for file in ["report.html", "improved.toml"] {
        assert!(night.path("out/rigs/fades").join(file).is_file(), "{file}");
    }
    let page = night.read("out/index.html");
    assert!(page.contains("href=\"rigs/fades/report.html\"") && page.contains("stress relaxation"));
    assert!(!page.contains("What changed"));
}

#[test]
fn parquet_and_csv_hold_the_same_numbers() {
    let night = Night::new(&FLEET);
    night.run("out", &[]).success();
    let table = rows(&night.path("out/table.csv"));
    let parquet = DataFile::read(&night.path("out/table.parquet")).unwrap();
    for name in ["value", "ci95_low", "ci95_high", "expected_noise", "p_value"] {
        let channel = parquet.channels.iter().find(|channel| channel.name == name).unwrap();
        let Content::Numbers(numbers) = &channel.content else { panic!("{name}: {:?}", channel.content) };
        let csv: Vec<f64> = table.iter().map(|row| row[name].parse().unwrap_or(f64::NAN)).collect();
        let bits = |numbers: &[f64]| numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(numbers), bits(&csv), "{name}");
    }
}

#[test]
fn a_rig_that_fails_is_a_row_and_no_other_rig_notices() {
    let night = Night::new(&FLEET);
    night.run("whole", &[]).success();
    night.write("fleet/broken/rig.toml", "[rig]\nname = 3\n");
    night.write("fleet/broken/trial-1.csv", "t_s,position_m,force_N\n0,0,0\n");
    fs::create_dir(night.path("fleet/empty")).unwrap();
    fs::copy(night.path("fleet/plain/rig.toml"), night.path("fleet/empty/rig.toml")).unwrap();
    let told = night.run("out", &[]).success().get_output().stderr.clone();
    assert!(String::from_utf8_lossy(&told).contains("4 rigs: 2 failed"), "{}", String::from_utf8_lossy(&told));
    let table = rows(&night.path("out/table.csv"));
    let error = |rig: &str| table.iter().find(|row| row["rig"] == rig).unwrap()["error"].clone();
    assert!(error("broken").contains("rig.toml:2") && error("broken").contains("found 3"), "{}", error("broken"));
    assert!(error("empty").contains("no recording"), "{}", error("empty"));
    let others: Vec<_> = table.iter().filter(|row| row["error"].is_empty()).cloned().collect();
    assert_eq!(others, rows(&night.path("whole/table.csv")));
    let page = night.read("out/index.html");
    assert!(page.contains("2 failed") && page.contains("no recording"));
    assert!(!night.path("out/rigs/broken/diagnosis.json").exists());
}

#[test]
fn a_fleet_of_which_no_rig_can_be_diagnosed_has_failed_and_says_why_in_its_table() {
    let night = Night::new(&["plain"]);
    night.write("fleet/plain/trial-1.csv", "");
    let told = night.run("out", &[]).code(1).get_output().stderr.clone();
    assert!(String::from_utf8_lossy(&told).contains("none of the 1 rigs"));
    assert!(rows(&night.path("out/table.csv"))[0]["error"].contains("an empty file"));
}

#[test]
fn what_is_done_is_not_done_again_and_what_changed_is() {
    let night = Night::new(&FLEET);
    night.run("out", &[]).success();
    let table = night.read("out/table.csv");
    let written =
        |rig: &str| fs::metadata(night.path("out/rigs").join(rig).join("diagnosis.json")).unwrap().modified().unwrap();
    let before = FLEET.map(written);
    // As after an interruption: one rig is not whole, and there is neither table nor page.
    fs::remove_file(night.path("out/rigs/plain/run.json")).unwrap();
    fs::remove_file(night.path("out/table.csv")).unwrap();
    let told = night.run("out", &[]).success().get_output().stderr.clone();
    assert!(String::from_utf8_lossy(&told).contains("1 done before"));
    assert_eq!(night.read("out/table.csv"), table);
    assert_eq!(
        FLEET.map(|rig| written(rig) == before[FLEET.iter().position(|name| *name == rig).unwrap()]),
        [true, false]
    );
    // Other recordings of one rig: its answer is that of the new ones.
    let faded = written("fades");
    night.replace("plain", "stiff");
    night.run("out", &[]).success();
    assert_eq!(written("fades"), faded);
    let stiffness = rows(&night.path("out/table.csv"))
        .into_iter()
        .find(|row| row["rig"] == "plain" && row["parameter"] == "stiffness_n_m")
        .unwrap();
    assert!((stiffness["value"].parse::<f64>().unwrap() / 330.0 - 1.0).abs() < 0.02, "{stiffness:?}");
    // A recording that is gone takes its answer with it.
    fs::write(night.path("fleet/plain/trial-2.csv"), "t_s\n").unwrap();
    night.run("out", &[]).success();
    assert!(!night.path("out/rigs/plain/diagnosis.json").exists());
}

#[test]
fn one_job_and_two_write_the_same_bytes() {
    let night = Night::new(&FLEET);
    night.run("one", &["--jobs", "1"]).success();
    night.run("two", &["--jobs", "2"]).success();
    let mut files = vec!["table.csv".to_owned(), "table.parquet".to_owned(), "index.html".to_owned()];
    files.extend(
        FLEET.iter().flat_map(|rig| ["diagnosis.json", "improved.toml"].map(|file| format!("rigs/{rig}/{file}"))),
    );
    for file in files {
        let [one, two] = ["one", "two"].map(|out| fs::read(night.path(out).join(&file)).unwrap());
        assert!(one == two, "{file}");
    }
}

#[test]
fn the_page_shows_what_changed_since_the_night_before() {
    let night = Night::new(&FLEET);
    night.run("monday", &[]).success();
    night.run("same", &["--against", "monday"]).success();
    assert!(night.read("same/index.html").contains("Nothing changed."));
    night.replace("plain", "stiff");
    night.replace("fades", "plain");
    let told = night.run("tuesday", &["--against", "monday"]).success().get_output().stderr.clone();
    assert!(String::from_utf8_lossy(&told).contains("2 changed"));
    let page = night.read("tuesday/index.html");
    let changed = &page[page.find("What changed").unwrap()..page.find("Which rigs stand out").unwrap()];
    assert!(changed.contains("stiffness_n_m") && changed.contains("330"), "{changed}");
    assert!(changed.contains("verdict") && changed.contains("stress relaxation"), "{changed}");
    // The table that is replaced may be the one before.
    night.run("monday", &["--against", "monday"]).success();
    assert!(night.read("monday/index.html").contains("2 changed"));
}

#[test]
fn a_manifest_lists_rigs_of_one_rig_file() {
    let night = Night::new(&FLEET);
    night.write(
        "fleet.csv",
        "name,rig,recording\nA 1,fleet/plain/rig.toml,fleet/plain/trial-1.csv\nA 1,fleet/plain/rig.toml,fleet/plain/trial-2.csv\n",
    );
    night.write(
        "fleet.toml",
        "[[rig]]\nname = \"A 1\"\nrig = \"fleet/plain/rig.toml\"\nrecordings = [\"fleet/plain/trial-1.csv\", \"fleet/plain/trial-2.csv\"]\n",
    );
    night.command("fleet.csv", "csv", &[]).success();
    night.command("fleet.toml", "toml", &[]).success();
    assert_eq!(night.read("csv/table.csv"), night.read("toml/table.csv"));
    assert!(night.read("csv/table.csv").lines().nth(1).unwrap().starts_with("A 1,"));
    assert!(night.read("csv/index.html").contains("rigs/A%201/report.html"));
}

#[test]
fn what_is_no_fleet_and_what_is_no_output_are_refused() {
    let night = Night::new(&["plain"]);
    let refused = |source: &str, out: &str, rest: &[&str], words: &str| {
        let told = night.command(source, out, rest).code(1).get_output().stderr.clone();
        let told = String::from_utf8_lossy(&told).into_owned();
        assert!(told.contains(words), "{told}");
    };
    refused("nowhere", "out", &[], "no such file or folder");
    fs::create_dir(night.path("bare")).unwrap();
    refused("bare", "out", &[], "no rig");
    // Though it looks like an output: one of its rigs is called as the folder of the rigs is.
    night.replace("rigs", "plain");
    refused("fleet", "fleet", &[], "the fleet itself");
    night.write("thesis/thesis.tex", "");
    refused("fleet", "thesis", &[], "something else");
    refused("fleet", "out", &["--against", "thesis"], "no such file");
    assert!(!night.path("out").exists(), "nothing is written of a run that is refused");
}
