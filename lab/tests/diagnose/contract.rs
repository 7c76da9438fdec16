//! The JSON as others rely on it, key by key.

use serde_json::Value;

use crate::bench::late;

fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value[key].as_array().unwrap_or_else(|| panic!("{key} is no list in {value}"))
}

/// Every key is there and no text is empty.
fn texts(value: &Value, keys: &[&str]) {
    for key in keys {
        assert!(value[key].as_str().is_some_and(|text| !text.is_empty()), "{key} in {value}");
    }
}

/// Every key is there and a number; JSON knows no NaN, which would be a null.
fn numbers(value: &Value, keys: &[&str]) {
    keys.iter().for_each(|key| assert!(value[key].is_f64(), "{key} in {value}"));
}

fn one_of(value: &Value, words: &[&str]) {
    assert!(words.iter().any(|word| value == word), "{value} is none of {words:?}");
}

/// A value lies within its own interval.
fn interval(value: &Value, at: &str) {
    let ends: Vec<f64> = list(value, "ci95").iter().map(|end| end.as_f64().expect("no null")).collect();
    let at = value[at].as_f64().unwrap();
    assert!(ends.len() == 2 && ends[0] <= at && at <= ends[1], "{value}");
}

#[test]
fn the_json_is_the_contracts() {
    let (answer, _) = late();
    assert_eq!(answer["schema"], "palpate.diagnosis/1");
    one_of(&answer["verdict"], &["no_mismatch", "parameters", "explained", "partly_explained", "unknown"]);
    assert!(!list(answer, "physics").is_empty() && !list(answer, "rivals").is_empty());
    for physics in list(answer, "physics") {
        texts(physics, &["name", "statement"]);
        one_of(&physics["acts_in"], &["contact", "drive", "sensor"]);
        numbers(&physics["evidence"], &["held_out_gain", "p_value"]);
        assert!((0.0..=1.0).contains(&physics["evidence"]["p_value"].as_f64().unwrap()), "{physics}");
        for parameter in list(physics, "parameters") {
            texts(parameter, &["name", "unit"]);
            interval(parameter, "value");
        }
    }
    for rival in list(answer, "rivals") {
        assert!(list(rival, "physics").iter().all(Value::is_string));
        numbers(rival, &["held_out_gain"]);
        texts(rival, &["separated_by"]);
    }
    assert!(!list(answer, "locations").is_empty());
    for location in list(answer, "locations") {
        one_of(&location["channel"], &["force", "effort"]);
        one_of(&location["trial"], &["trial-1.csv", "trial-2.csv"]);
        one_of(&location["phase"], &["free", "onset", "loading", "hold", "unloading", "release"]);
        numbers(location, &["start_s", "end_s", "share"]);
        texts(location, &["states"]);
        let (start, end) = (location["start_s"].as_f64().unwrap(), location["end_s"].as_f64().unwrap());
        assert!(0.0 <= start && start <= end && end <= 5.0, "{location}");
    }
    let fit = &answer["fit"];
    assert_eq!((&fit["unit"], &fit["held_out"]), (&"N".into(), &true.into()));
    numbers(fit, &["noise_floor", "as_given", "refitted", "improved", "explained_share"]);
    let checked = list(answer, "checked");
    assert!(checked.iter().all(Value::is_string) && checked.contains(&"force_bias".into()));
    assert!(!list(answer, "correlations").is_empty());
    for one in list(answer, "correlations") {
        one_of(&one["channel"], &["force", "effort"]);
        let (names, rows) = (list(one, "parameters"), list(one, "matrix"));
        assert!(names.len() >= 2 && names.iter().all(Value::is_string) && rows.len() == names.len(), "{one}");
        for (at, row) in rows.iter().enumerate() {
            let row: Vec<f64> = row.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect();
            assert!(row.len() == names.len() && row[at] == 1.0, "{one}");
            assert!(row.iter().all(|number| (-1.0..=1.0).contains(number)), "{one}");
            let column = rows.iter().map(|row| row[at].as_f64().unwrap());
            assert!(row.iter().zip(column).all(|(a, b)| (a - b).abs() < 1e-9), "{one}");
        }
    }
    for nominal in list(answer, "nominal") {
        texts(nominal, &["name", "unit"]);
        interval(nominal, "fitted");
    }
}
