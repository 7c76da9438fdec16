//! The improved rig file: the user's own text with the values that the diagnosis changed, each with where it comes from.

use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TomlError, Value};

use super::diagnosis::Nominal;
use crate::rig::Rig;

/// `text`, the file of `given`, with what `improved` has otherwise. Comments and order stay; a changed value is followed by its 95 %
/// interval and what stood there, effects that were found stand at the end below a comment that names `source`.
///
/// # Errors
/// `text` is no TOML.
pub fn model_file(
    text: &str,
    given: &Rig,
    improved: &Rig,
    nominal: &[Nominal],
    source: &str,
) -> Result<String, TomlError> {
    let mut document: DocumentMut = text.strip_prefix('\u{feff}').unwrap_or(text).parse()?;
    let (before, after): (DocumentMut, DocumentMut) = (given.to_toml().parse()?, improved.to_toml().parse()?);
    for (name, table) in after.iter().filter_map(|(name, item)| Some((name, item.as_table()?))) {
        for (key, value) in table.iter().filter_map(|(key, item)| Some((key, item.as_value()?))) {
            let old = before.get(name).and_then(|table| table.get(key));
            if old.and_then(Item::as_value).is_none_or(|old| !is_same(old, value)) {
                let is_new_table = before.get(name).is_none() || name == "simulation";
                put(&mut document, name, key, value, if is_new_table { None } else { Some(nominal) });
            }
        }
    }
    let effects = |document: &DocumentMut| document.get("effect").and_then(Item::as_array_of_tables).cloned();
    if let Some(found) = effects(&after) {
        merge(&mut document, &effects(&before).unwrap_or_default(), &found, source);
    }
    Ok(document.to_string())
}

fn is_same(one: &Value, other: &Value) -> bool {
    let plain = |value: &Value| value.clone().decorated("", "").to_string();
    match (number(one), number(other)) {
        (Some(one), Some(other)) => one == other,
        _ => plain(one) == plain(other),
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| Some(value.as_integer()? as f64))
}

/// Above a table that the given file does not have.
const TO_RUN: &str = "\n# Not in the file that was diagnosed: a motion between the ends of the recorded one, so that `palpate simulate` runs this.\n";

/// Puts a value into its table, with its interval among `fitted` and what stood there behind it; a value that was not fitted as it is.
fn put(document: &mut DocumentMut, table: &str, key: &str, value: &Value, fitted: Option<&[Nominal]>) {
    let made = || {
        let mut table = Table::new();
        table.decor_mut().set_prefix(TO_RUN);
        Item::Table(table)
    };
    let at = document.entry(table).or_insert_with(made);
    let Some(at) = at.as_table_like_mut() else { return };
    let Some(nominal) = fitted else {
        at.insert(key, Item::Value(rounded(value).decorated(" ", "")));
        return;
    };
    let old = at.get(key).and_then(Item::as_value);
    let stood = old.map_or_else(String::new, |old| format!("; before: {}", old.clone().decorated("", "")));
    let kept = old.and_then(|old| old.decor().suffix()?.as_str()).unwrap_or_default().trim().to_owned();
    let ends = nominal.iter().find(|row| row.name == key).map(|row| row.ci95);
    let interval = match ends {
        Some([low, high]) if low.is_finite() && high.is_finite() => {
            format!(", 95 %: {} to {}", short(low), short(high))
        }
        Some(_) => ", not bounded by the recordings".to_owned(),
        None => String::new(),
    };
    let gap = if kept.is_empty() { "" } else { " " };
    at.insert(key, Item::Value(rounded(value).decorated(" ", format!(" # fitted{interval}{stood}{gap}{kept}"))));
}

/// A number as a person writes it.
fn short(value: f64) -> String {
    let exponent = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    if (-3..6).contains(&exponent) {
        format!("{value:.*}", (4 - exponent).clamp(0, 9) as usize)
    } else {
        format!("{value:.4e}")
    }
}

/// The same value, very small and very large numbers by their exponent.
fn rounded(value: &Value) -> Value {
    let scientific = |number: f64| {
        let is_plain = number == 0.0 || (1e-4..1e9).contains(&number.abs());
        let text = if is_plain { format!("{number:?}") } else { format!("{number:e}") };
        text.parse().unwrap_or_else(|_| Value::from(number))
    };
    match value {
        Value::Float(number) => scientific(*number.value()),
        Value::Array(all) => {
            Value::Array(all.iter().map(|one| one.as_float().map_or_else(|| one.clone(), scientific)).collect())
        }
        other => other.clone().decorated("", ""),
    }
}

/// Effects that stand in the file keep their place and comments, values that changed are put in; the others follow.
fn merge(document: &mut DocumentMut, before: &ArrayOfTables, found: &ArrayOfTables, source: &str) {
    let name = |table: &Table| table.get("name").and_then(Item::as_str).unwrap_or_default().to_owned();
    let mut own = document.get("effect").and_then(Item::as_array_of_tables).cloned().unwrap_or_default();
    own.retain(|table| found.iter().any(|found| name(found) == name(table)));
    let is_known = |table: &Table| before.iter().any(|known| name(known) == name(table));
    for table in found {
        if let Some(known) = own.iter_mut().find(|known| is_known(table) && name(known) == name(table)) {
            fill(known, table);
            continue;
        }
        let mut added = Table::new();
        fill(&mut added, table);
        added.decor_mut().set_prefix(format!("\n# Found by palpate diagnose in {source}.\n"));
        own.push(added);
    }
    document.insert("effect", Item::ArrayOfTables(own));
}

/// What stands behind a value, to stay behind the new one.
fn old_comment(item: Option<&Item>) -> String {
    let suffix = item.and_then(Item::as_value).and_then(|value| value.decor().suffix()?.as_str());
    suffix.unwrap_or_default().to_owned()
}

fn fill(into: &mut Table, from: &Table) {
    for (key, value) in from.iter().filter_map(|(key, item)| Some((key, item.as_value()?))) {
        if into.get(key).and_then(Item::as_value).is_none_or(|old| !is_same(old, value)) {
            let behind = old_comment(into.get(key));
            into.insert(key, Item::Value(rounded(value).decorated(" ", behind)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# My bench.\n[rig]\nname = \"b\"\ncoordinate = \"linear\"\n\n[contact] # the pad\nmodel = \"kelvin_voigt\"\n\
        surface_m = 0.0\nstiffness_n_m = 300 # from the data sheet\ndamping_n_s_m = 5.0\n\n\
        # I know of this one.\n[[effect]]\nname = \"adhesion\"\npull_off_force_n = 0.5 # weighed\nrelease_height_m = 1e-3\n";

    #[test]
    fn comments_stay_and_changed_values_say_where_they_come_from() {
        let given = Rig::parse(TEXT, "rig.toml").unwrap();
        let mut improved = given.clone();
        let contact = improved.contact.as_mut().unwrap();
        contact.stiffness = 321.5;
        let found = "[[effect]]\nname = \"quadratic_damping\"\ncoefficient_n_s2_m2 = 12.0\n";
        let more = Rig::parse(&format!("{}\n{found}", given.to_toml()), "more.toml").unwrap();
        improved.effects = more.effects;
        let nominal = Nominal {
            name: "stiffness_n_m".into(),
            unit: "N/m".into(),
            given: 300.0,
            fitted: 321.5,
            ci95: [320.0, 323.0],
        };
        let text = model_file(TEXT, &given, &improved, &[nominal], "a.csv").unwrap();
        for kept in ["# My bench.", "[contact] # the pad", "# I know of this one.", "pull_off_force_n = 0.5 # weighed"]
        {
            assert!(text.contains(kept), "{kept:?} is not in\n{text}");
        }
        let changed = "stiffness_n_m = 321.5 # fitted, 95 %: 320.00 to 323.00; before: 300 # from the data sheet";
        assert!(text.contains(changed), "{text}");
        assert!(
            text.contains("damping_n_s_m = 5.0\n")
                && text.contains("# Found by palpate diagnose in a.csv.\n[[effect]]")
        );
        assert_eq!(Rig::parse(&text, "improved.toml").unwrap(), improved);
    }
}
