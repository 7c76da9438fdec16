//! `palpate effects` as a user meets it.

use assert_cmd::Command;
use palpate_lab::effects::{ALL, key_of};
use palpate_lab::rig::Coordinate;
use predicates::str::contains;

fn effects() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_palpate"));
    command.arg("effects");
    command
}

fn shown(arguments: &[&str]) -> String {
    let output = effects().args(arguments).assert().success().stderr("").get_output().stdout.clone();
    String::from_utf8(output).unwrap()
}

#[test]
fn the_page_tells_all_that_is_known_within_eighty_columns() {
    let page = shown(&[]);
    assert!(page.lines().all(|line| line.chars().count() <= 80));
    assert!(!page.contains('\u{1b}'), "no colour in a pipe");
    // Paragraphs are wrapped: words are compared, not lines.
    let flat = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let page = flat(&page);
    for effect in ALL {
        let spec = effect.spec();
        let laws = spec.forms.iter().flat_map(|form| {
            let parameters = form.parameters.iter().flat_map(|p| [p.name, p.meaning, p.unit.linear, p.unit.rotary]);
            [form.name, form.equation].into_iter().chain(parameters.filter(|word| *word != "1"))
        });
        let card_words = [spec.name, spec.place.name(), spec.statement, spec.excited_by, spec.source];
        for words in card_words.into_iter().chain(laws).chain(spec.resembles.iter().copied()) {
            assert!(page.contains(&flat(words)), "{}: {words}", spec.name);
        }
    }
}

#[test]
fn names_choose_and_a_wrong_one_is_a_fault_of_the_command_line() {
    let page = shown(&["cogging", "force_bias"]);
    assert!(page.contains("cogging (acts in the drive)") && page.contains("force_bias (acts in the sensor)"));
    assert!(!page.contains("adhesion ("), "{page}");
    let assert = effects().arg("coging").assert().code(2).stdout("");
    assert.stderr(contains("unknown effect \"coging\"")).stderr(contains("cogging perhaps"));
}

#[test]
fn machines_get_the_same_as_json_on_standard_output_or_in_a_file() {
    let text = shown(&["--json", "-"]);
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(document["schema"], "palpate.effects/1");
    let listed = document["effects"].as_array().unwrap();
    assert_eq!(listed.len(), ALL.len());
    for (entry, effect) in listed.iter().zip(ALL) {
        let spec = effect.spec();
        assert_eq!((&entry["name"], &entry["acts_in"]), (&spec.name.into(), &spec.place.name().into()));
        let parameter = &spec.forms[0].parameters[0];
        let shown = &entry["forms"][0]["parameters"][0];
        assert_eq!(shown["rotary"]["key"], key_of(parameter, Coordinate::Rotary));
        assert_eq!(shown["high"].as_f64(), parameter.high.is_finite().then_some(parameter.high));
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("effects.json");
    effects().arg("--json").arg(&path).assert().success().stdout("");
    assert_eq!(std::fs::read_to_string(path).unwrap(), text);
    effects().args(["--json", "absent/effects.json"]).assert().code(1).stderr(contains("absent/effects.json"));
}
