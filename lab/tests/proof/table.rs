//! The score as tables of Markdown.

use std::collections::BTreeMap;

use palpate_cases::truth::Kind;

use crate::row::{Compared, Row};

/// Bounds of the bands of strength.
const BANDS: [f64; 7] = [0.0, 0.3, 1.0, 2.0, 3.0, 10.0, f64::INFINITY];

/// All tables.
pub fn report(rows: &[Row]) -> String {
    let of = |kind: Kind| rows.iter().filter(|row| row.kind == kind).collect::<Vec<_>>();
    let (none, single, pairs, outside) = (of(Kind::None), of(Kind::Single), of(Kind::Pair), of(Kind::Outside));
    let listed: Vec<&Row> = single.iter().chain(&pairs).copied().collect();
    let mut text = format!("# Proof on concealed physics\n\n{} cases.\n\n", rows.len());
    text += "| | of | |\n|---|---|---|\n";
    text += &line("false alarms where nothing is missing", &none, Row::is_false_alarm);
    text += &line("one effect: detected", &single, Row::is_detected);
    text += &line("one effect: named rightly", &single, Row::is_right);
    text += &line("one effect: truth within the answer and its rivals", &single, Row::is_within);
    text += &line("two effects: named rightly", &pairs, Row::is_right);
    text += &line("two effects: truth within the answer and its rivals", &pairs, Row::is_within);
    text += &line("outside of the list: detected", &outside, Row::is_detected);
    text += &line("outside of the list: owned as unknown", &outside, Row::is_owned);
    text += &line("outside of the list: owned, and nothing else named", &outside, Row::is_right);
    text += &line("not diagnosed at all", &rows.iter().collect::<Vec<_>>(), |row| row.failure.is_some());
    let set = mean(listed.iter().filter(|row| row.is_detected()).map(|row| row.offered().len() as f64));
    let right =
        |pick: fn(&Row) -> Option<f64>| median(listed.iter().filter(|row| row.is_right()).filter_map(|r| pick(r)));
    text += "\n| | |\n|---|---|\n";
    text += &format!("| mean number of names offered where detected | {set:.2} |\n");
    text += &format!("| named rightly: residual over floor, median, before | {:.2} |\n", right(|row| row.before));
    text += &format!("| named rightly: residual over floor, median, after | {:.2} |\n", right(|row| row.after));
    text += &format!("| seconds, median | {:.1} |\n", median(rows.iter().map(|row| row.seconds)));
    text += &bands("One effect, by strength", &single);
    text += &bands("Outside of the list, by strength", &outside);
    text += &by_effect("One effect, by name", &single);
    text += &by_effect("Outside of the list, by name", &outside);
    text += &values(&single);
    text
}

fn line(what: &str, rows: &[&Row], is: fn(&Row) -> bool) -> String {
    let hits = rows.iter().filter(|row| is(row)).count();
    format!("| {what} | {hits}/{} | {} |\n", rows.len(), percent(hits, rows.len()))
}

const HEAD: &str = "| n | detected | named rightly | within | names offered |\n|---|---|---|---|---|---|\n";

fn columns(rows: &[&Row]) -> String {
    let share = |is: fn(&Row) -> bool| percent(rows.iter().filter(|row| is(row)).count(), rows.len());
    let offered = mean(rows.iter().filter(|row| row.is_detected()).map(|row| row.offered().len() as f64));
    let (seen, right, within) = (share(Row::is_detected), share(Row::is_right), share(Row::is_within));
    format!("| {} | {seen} | {right} | {within} | {offered:.2} |\n", rows.len())
}

fn bands(title: &str, rows: &[&Row]) -> String {
    let mut text = format!("\n## {title}\n\n| strength {HEAD}");
    for bounds in BANDS.windows(2) {
        let (low, high) = (bounds[0], bounds[1]);
        let band: Vec<&Row> = rows.iter().filter(|row| (low..high).contains(&row.strength)).copied().collect();
        if !band.is_empty() {
            text += &format!("| {low} to {high} {}", columns(&band));
        }
    }
    text
}

fn by_effect(title: &str, rows: &[&Row]) -> String {
    let mut groups = BTreeMap::<String, Vec<&Row>>::new();
    for row in rows {
        groups.entry(row.truth.join(" and ")).or_default().push(row);
    }
    let lines: String = groups.iter().map(|(name, rows)| format!("| {name} {}", columns(rows))).collect();
    format!("\n## {title}\n\n| effect {HEAD}{lines}")
}

/// Of what is named rightly, where the truth has the same law.
fn values(rows: &[&Row]) -> String {
    let mut groups = BTreeMap::<&str, Vec<&Compared>>::new();
    let all: Vec<&Compared> = rows.iter().flat_map(|row| &row.values).collect();
    for value in &all {
        groups.entry(&value.name).or_default().push(value);
    }
    groups.insert("all", all);
    let mut text = String::from(
        "\n## Parameters\n\n| parameter | n | median error | inside the 95 % interval |\n|---|---|---|---|\n",
    );
    for (name, values) in groups {
        let covered = values.iter().filter(|value| value.covered).count();
        let error = 100.0 * median(values.iter().map(|value| value.error()));
        text += &format!("| {name} | {} | {error:.1} % | {} |\n", values.len(), percent(covered, values.len()));
    }
    text
}

fn percent(hits: usize, of: usize) -> String {
    if of == 0 { "-".to_owned() } else { format!("{:.1} %", 100.0 * hits as f64 / of as f64) }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => sorted[n / 2],
        n => 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]),
    }
}
