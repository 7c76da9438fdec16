//! What the page says in words and small figures beside the numbers of its cards, and what goes to standard error.

use serde_json::Value;

use crate::page::{part, words};
use crate::printed::{numbers, percent_agrees, plain};
use crate::reading::prose;
use crate::{all, float, text};

/// Everything that does not agree with `json`.
pub fn contradictions(json: &Value, html: &str, model: &str, stderr: &str) -> Vec<String> {
    let mut wrong = verdict(json, html);
    wrong.extend(summary(json));
    wrong.extend(multiples(json, html));
    wrong.extend(chance(json, html));
    wrong.extend(folds(json, html));
    wrong.extend(correlations(json, html));
    wrong.extend(checked(json, html));
    wrong.extend(findings(json, html, stderr));
    wrong.extend(before(json, model));
    wrong
}

fn verdict(json: &Value, html: &str) -> Vec<String> {
    let heading = words(part(html, "<h1 class=\"verdict", "</h1>"));
    let heading = heading.rsplit_once('"').map_or(heading.as_str(), |(_, heading)| heading);
    let wanted = match text(json, "verdict") {
        "no_mismatch" => "No mismatch",
        "parameters" => "Other values, no other physics",
        "explained" => "Explained by ",
        "partly_explained" => "Partly explained by ",
        _ => "Unknown physics",
    };
    if heading.starts_with(wanted) { Vec::new() } else { vec![format!("page: {heading:?} is not {wanted:?}")] }
}

/// Every figure of the summary is one of the fit's; of what is missing in the other channel, one of that channel's.
fn summary(json: &Value) -> Vec<String> {
    let (fit, channels) = (&json["fit"], all(json, "channels"));
    let said = text(json, "summary");
    let (own, other) = said.split_once(" something is missing that").unwrap_or((said, ""));
    let strange = |said: &str, fit: &Value| -> Vec<String> {
        let stated = ["as_given", "refitted", "improved", "noise_floor"].map(|key| float(&fit[key]));
        let shown = numbers(said, text(fit, "unit"));
        let strange = shown.iter().filter(|shown| !stated.iter().any(|stated| shown.holds(*stated)));
        strange.map(|shown| format!("summary: {shown:?} is none of {fit}")).collect()
    };
    let mut wrong = strange(own, fit);
    if !other.is_empty() {
        wrong.extend(strange(other, channels.get(1).unwrap_or(fit)));
    }
    wrong
}

/// "= 83 × noise" at each bar, and the multiples in the sentence below the heading.
fn multiples(json: &Value, html: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    let holds = |shown: &str, wanted: f64| {
        shown.contains("million") && wanted >= 1e6
            || numbers(shown, "1").first().is_some_and(|shown| shown.holds(wanted))
    };
    for (bars, fit) in html.split("<svg class=\"bars\"").skip(1).zip(all(json, "channels")) {
        for bar in bars.split("</svg>").next().unwrap().split("<text x=\"0\"").skip(1) {
            let (name, figure) =
                (words(&format!("<{}", bar.split("</text>").next().unwrap())), words(part(bar, "<tspan", "</tspan>")));
            let key = match name.as_str() {
                "as given" => "as_given",
                "values refitted" => "refitted",
                "with named physics" => "improved",
                "with a learned curve" => "learned",
                _ => continue,
            };
            let shown = figure.trim_start_matches(|c: char| c != '=').trim_matches(['=', ' ']);
            if !holds(shown, float(&fit[key]) / float(&fit["noise_floor"])) {
                wrong.push(format!("page: {figure:?} of {name:?} is not {fit}"));
            }
        }
    }
    let aside = words(part(html, "<p class=\"aside\">", "</p>"));
    if let Some((_, rest)) = aside.split_once("What stays, ") {
        let times = rest.split(", is ").nth(1).and_then(|rest| rest.split(" times").next()).unwrap_or_default();
        let fit = &json["fit"];
        if !holds(times, float(&fit["improved"]) / float(&fit["noise_floor"])) {
            wrong.push(format!("page: {aside:?} is not {fit}"));
        }
    }
    wrong
}

/// "chance alone does as much in 1 of 40 cases".
fn chance(json: &Value, html: &str) -> Vec<String> {
    let cards =
        html.split("<article class=\"effect").skip(1).map(|card| words(card.split("</article>").next().unwrap()));
    let wrong = cards.zip(all(json, "physics")).filter(|(_, physics)| physics["name"] != "unknown").filter(
        |(card, physics)| {
            let p = float(&physics["evidence"]["p_value"]);
            let rare = card.contains("chance alone does as much in fewer than 1 of 1000 cases");
            let often = card.contains("chance alone does as much more often than not");
            let one_of =
                card.split("as much in 1 of ").nth(1).and_then(|rest| rest.split(' ').next()?.parse::<f64>().ok());
            let is_told = match p {
                p if p < 1e-3 => rare,
                p if p < 0.5 => one_of.is_some_and(|cases| (cases - 1.0 / p).abs() <= 0.5 + 1e-9),
                _ => often,
            };
            !is_told
        },
    );
    wrong.map(|(_, physics)| format!("page: another chance than {}", physics["evidence"])).collect()
}

/// The line of each trial tells its largest place.
fn folds(json: &Value, html: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    for fold in html.split("<details class=\"trial\"").skip(1) {
        let line = words(part(fold, "<summary>", "</summary>"));
        let of_trial = all(json, "locations").iter().filter(|place| line.starts_with(&plain(text(place, "trial"))));
        let largest = of_trial.max_by(|a, b| float(&a["share"]).total_cmp(&float(&b["share"])));
        let is_told = match largest {
            None => line.ends_with("no place stands out"),
            Some(place) => {
                let share = line.strip_prefix(&plain(text(place, "trial"))).unwrap_or_default();
                percent_agrees(share.split(" of the ").next().unwrap(), float(&place["share"]))
                    && line.contains(&plain(text(place, "states")))
            }
        };
        if !is_told {
            wrong.push(format!("page: {line:?} is not {largest:?}"));
        }
    }
    wrong
}

/// The lower triangle, row by row.
fn correlations(json: &Value, html: &str) -> Vec<String> {
    let tables: Vec<&str> = html.split("<table class=\"correlations\">").skip(1).collect();
    let of_json = all(json, "correlations");
    let mut wrong = Vec::new();
    if tables.len() != of_json.len() {
        wrong.push(format!("page: {} of {} correlations", tables.len(), of_json.len()));
    }
    for (table, one) in tables.iter().zip(of_json) {
        let rows: Vec<&str> = table.split("</table>").next().unwrap().split("<tr").skip(2).collect();
        for (at, (row, wanted)) in rows.iter().zip(all(one, "matrix")).enumerate() {
            let name = one["parameters"][at].as_str().unwrap_or_default();
            let cells: Vec<String> = row.split("<td").skip(1).map(|cell| words(&format!("<td{cell}"))).collect();
            let is_told = row.contains(&format!("<code>{name}</code>")) && cells.len() == at;
            let agree = cells.iter().zip(wanted.as_array().unwrap()).all(|(cell, wanted)| {
                let wanted = float(wanted);
                // No rounding makes one of a coefficient, nor tells less than a hundredth.
                cell.parse::<f64>().is_ok_and(|shown| (shown - wanted).abs() <= 0.005 + 1e-9)
            });
            if !(is_told && agree) {
                wrong.push(format!("page: {cells:?} of {name} is not {wanted}"));
            }
        }
    }
    wrong
}

fn checked(json: &Value, html: &str) -> Vec<String> {
    let section = words(part(html, "id=\"checked\"", "</section>"));
    let count = all(json, "checked").len();
    let mut wrong = Vec::new();
    if count > 0 && !section.contains(&format!("{count} effects were tried")) {
        wrong.push(format!("page: not {count} effects in {section:?}"));
    }
    let told = section.to_lowercase().replace('-', " ");
    let names = all(json, "checked").iter().filter_map(Value::as_str).map(|name| name.replace('_', " "));
    wrong.extend(names.filter(|name| !told.contains(name.as_str())).map(|name| format!("page: {name} was not tried")));
    wrong
}

/// What the recordings showed stands on the page and on standard error.
fn findings(json: &Value, html: &str, stderr: &str) -> Vec<String> {
    let page =
        plain(&prose(html)).replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&").replace("&quot;", "\"");
    let console = plain(stderr);
    let mut wrong = Vec::new();
    for finding in all(json, "findings") {
        let told = plain(text(finding, "text"));
        for (place, of) in [("page", &page), ("console", &console)] {
            if !of.contains(&told) {
                wrong.push(format!("{place}: nothing says {told:?}"));
            }
        }
    }
    wrong
}

/// What a refitted value replaces is what the file gave.
fn before(json: &Value, model: &str) -> Vec<String> {
    let rows = all(json, "nominal").iter().filter_map(|row| {
        let line = model.lines().find(|line| line.starts_with(&format!("{} = ", text(row, "name"))))?;
        let stood = line.split("; before: ").nth(1)?.split_whitespace().next()?.parse::<f64>().ok()?;
        (stood != float(&row["given"])).then(|| format!("model: {line:?} is not {row}"))
    });
    rows.collect()
}
