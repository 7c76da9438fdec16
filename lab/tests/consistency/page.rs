//! The numbers of a page against those of the JSON.

use serde_json::Value;

use crate::printed::{agrees, numbers, percent_agrees, plain};
use crate::reading::{bytes, doubles, floats, prose};
use crate::{all, float, near, text};

/// The part of `html` from behind `from` up to `to`; nothing where either is absent.
pub fn part<'a>(html: &'a str, from: &str, to: &str) -> &'a str {
    html.split_once(from).map_or("", |(_, rest)| rest.split_once(to).map_or("", |(part, _)| part))
}

/// What a reader sees of a fragment.
pub fn words(fragment: &str) -> String {
    let mut text = String::new();
    let mut inside = false;
    for letter in fragment.chars() {
        match letter {
            '<' => inside = true,
            '>' => inside = false,
            _ if !inside => text.push(letter),
            _ => {}
        }
    }
    plain(&text).replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
}

pub fn contradictions(json: &Value, html: &str) -> Vec<String> {
    let mut wrong: Vec<String> = Vec::new();
    let all_words = plain(&prose(html)).replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    if !all_words.contains(&plain(text(json, "summary"))) {
        wrong.push("page: another summary".to_owned());
    }
    wrong.extend(cards(json, html));
    wrong.extend(fits(json, html));
    wrong.extend(shares(json, html));
    wrong.extend(places(json, html));
    wrong.extend(nominal(json, html));
    wrong.extend(traces(json, html));
    wrong
}

fn cards(json: &Value, html: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    let cards: Vec<&str> =
        html.split("<article class=\"effect").skip(1).map(|card| card.split("</article>").next().unwrap()).collect();
    let physics = all(json, "physics");
    if cards.len() != physics.len() {
        wrong.push(format!("page: {} cards of {} effects", cards.len(), physics.len()));
    }
    for (card, physics) in cards.iter().zip(physics) {
        if !words(card).contains(&plain(text(physics, "statement"))) {
            wrong.push(format!("page: {} says something else", physics["name"]));
        }
        for value in all(physics, "parameters") {
            let shown = part(part(card, &format!("<code>{}</code>", text(value, "name")), "</div>"), "<dd>", "</dd>");
            let wanted = [&value["value"], &value["ci95"][0], &value["ci95"][1]].map(float);
            if !agrees(&words(shown), text(value, "unit"), &wanted) {
                wrong.push(format!("page: {:?} is not {value}", words(shown)));
            }
        }
        let gain = part(card, "it takes away ", " of the mean square that the law without it leaves");
        if physics["name"] != "unknown" && !percent_agrees(gain, float(&physics["evidence"]["held_out_gain"])) {
            wrong.push(format!("page: {gain:?} is not {}", physics["evidence"]));
        }
    }
    wrong
}

/// Root mean squares, and the share that the named physics takes.
fn fits(json: &Value, html: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    for fit in all(json, "channels") {
        let name = if fit["channel"] == "effort" { "drive effort" } else { "force" };
        let label = part(html, &format!("aria-label=\"Typical error of the {name}. "), "\"");
        for (words, key) in [
            ("as given: ", "as_given"),
            ("values refitted: ", "refitted"),
            ("with named physics: ", "improved"),
            ("expected noise: ", "noise_floor"),
        ] {
            let Some((_, shown)) = label.split_once(words) else {
                if key != "improved" {
                    wrong.push(format!("page: no {key} of the {name}"));
                }
                continue;
            };
            let shown = shown.split(';').next().unwrap().trim_end_matches('.');
            let wanted = float(&fit[key]);
            if !numbers(shown, text(fit, "unit")).first().is_some_and(|shown| shown.holds(wanted)) {
                wrong.push(format!("page: {key} of the {name}, {shown:?}, is not {wanted}"));
            }
        }
        let taken = words(part(
            html,
            &format!(
                "Of the mean square that refitted values leave in the {name} above the noise, the named physics takes away "
            ),
            "</strong>",
        ));
        if !taken.is_empty() && !percent_agrees(&taken, float(&fit["explained_share"])) {
            wrong.push(format!("page: {taken:?} of the {name} is not {}", fit["explained_share"]));
        }
    }
    wrong
}

/// The answer and its alternatives, on one measure.
fn shares(json: &Value, html: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    let section = part(html, "id=\"evidence\"", "</section>");
    let tables = section.split("<table class=\"rivals\">").skip(1);
    let rows: Vec<[String; 2]> = tables
        .flat_map(|table| table.split("<tr").skip(2))
        .map(|row| [words(part(row, "<th scope=\"row\">", "</th>")), words(part(row, "<td>", "</td>"))])
        .collect();
    let [answers, others]: [Vec<&[String; 2]>; 2] =
        [" answer", " not ruled out"].map(|end| rows.iter().filter(|[name, _]| name.ends_with(end)).collect());
    let named = |channel: &Value| {
        all(json, "physics").iter().any(|physics| physics["name"] != "unknown" && physics["channel"] == *channel)
    };
    let channels: Vec<&Value> = all(json, "channels").iter().filter(|fit| named(&fit["channel"])).collect();
    if answers.len() != channels.len() || others.len() != all(json, "rivals").len() {
        wrong.push(format!("page: {} answers and {} alternatives", answers.len(), others.len()));
    }
    for ([_, share], fit) in answers.iter().zip(channels) {
        if !percent_agrees(share, float(&fit["explained_share"])) {
            wrong.push(format!("page: {share} is not {}", fit["explained_share"]));
        }
    }
    for other in all(json, "rivals") {
        let names: Vec<String> =
            all(other, "physics").iter().map(|name| name.as_str().unwrap().replace('_', " ").to_lowercase()).collect();
        let of_names = |row: &&&[String; 2]| {
            names.iter().all(|name| row[0].to_lowercase().replace('-', " ").contains(name.as_str()))
        };
        let gain = float(&other["held_out_gain"]);
        if !others.iter().filter(of_names).any(|row| percent_agrees(&row[1], gain)) {
            wrong.push(format!("page: no {names:?} with {gain}"));
        }
    }
    wrong
}

fn places(json: &Value, html: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    let shown: Vec<String> = html
        .split("<ol class=\"places\"")
        .skip(1)
        .flat_map(|list| list.split("</ol>").next().unwrap().split("<li>").skip(1))
        .map(words)
        .collect();
    let places = all(json, "locations");
    if shown.len() != places.len() {
        wrong.push(format!("page: {} of {} places", shown.len(), places.len()));
    }
    for (shown, place) in shown.iter().zip(places) {
        let time = shown.split(&format!("{}, ", text(place, "trial"))).nth(1).unwrap_or_default();
        let ends = numbers(time.split(" s,").next().map(|time| format!("{time} s")).unwrap_or_default().as_str(), "s");
        let wanted = ["start_s", "end_s"].map(|key| float(&place[key]));
        let is_there = matches!(ends.as_slice(), [start, end] if start.holds(wanted[0]) && end.holds(wanted[1]));
        if !is_there
            || !percent_agrees(shown.split(" of what").next().unwrap(), float(&place["share"]))
            || !shown.contains(&plain(text(place, "states")))
        {
            wrong.push(format!("page: {shown:?} is not {place}"));
        }
    }
    let mut channels: Vec<&str> = places.iter().map(|place| text(place, "channel")).collect();
    channels.dedup();
    for channel in channels {
        let sum: f64 =
            places.iter().filter(|place| place["channel"] == channel).map(|place| float(&place["share"])).sum();
        if sum > 1.0 + 1e-9 {
            wrong.push(format!("json: places of the {channel} hold {sum} of it"));
        }
    }
    wrong
}

fn nominal(json: &Value, html: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    let table = part(html, "id=\"nominal\"", "</section>");
    for row in all(json, "nominal") {
        let cells: Vec<&str> =
            part(table, &format!("<code>{}</code></th>", text(row, "name")), "</tr>").split("<td>").skip(1).collect();
        let [given, fitted, agreement] = cells.as_slice() else {
            wrong.push(format!("page: no {}", row["name"]));
            continue;
        };
        let number = |key: &str| float(&row[key]);
        let ends = [0, 1].map(|end| float(&row["ci95"][end]));
        let unit = text(row, "unit");
        let fitted = words(fitted.split("<small>").next().unwrap());
        if !agrees(&fitted, unit, &[number("fitted"), ends[0], ends[1]]) {
            wrong.push(format!("page: {fitted:?} is not {row}"));
        }
        if text(row, "name").starts_with("effort_") {
            continue;
        }
        if !numbers(&words(given), unit).first().is_some_and(|given| given.holds(number("given"))) {
            wrong.push(format!("page: {:?} is not {row}", words(given)));
        }
        let agreed = match ends {
            [low, high] if !(low.is_finite() && high.is_finite()) => "not bounded",
            [low, high] if low <= number("given") && number("given") <= high => "agree",
            _ => "differ",
        };
        if words(agreement) != agreed {
            wrong.push(format!("page: {:?} of {row}", words(agreement)));
        }
    }
    wrong
}

/// What the pictures draw has the residuals and the expected noise that the figures state.
fn traces(json: &Value, html: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    let description: Value = serde_json::from_str(part(html, "id=\"description\">", "</script>")).unwrap();
    for fit in all(json, "channels") {
        for (line, key) in
            [("given", "as_given"), ("refitted", "refitted"), ("improved", "improved"), ("floor", "noise_floor")]
        {
            let (mut sum, mut count) = (0.0, 0);
            for trace in all(&description, "trials")
                .iter()
                .flat_map(|trial| all(trial, "traces"))
                .filter(|trace| trace["channel"] == fit["channel"])
            {
                let column = |name: &str| floats(html, &format!("t{}-{name}", trace["id"]));
                let (measured, simulated) = (column("measured"), column(line));
                let rows = doubles(html, &format!("t{}-time", trace["id"])).len();
                if [measured.len(), simulated.len()] != [rows; 2] {
                    wrong.push(format!("page: columns of {rows} and other rows"));
                }
                let seen = bytes(html, &format!("t{}-seen", trace["id"]));
                let rows = measured.iter().zip(&simulated).zip(&seen).filter(|(_, seen)| **seen == 1);
                let is_noise = line == "floor";
                let left = rows.map(|((m, s), _)| if is_noise { f64::from(*s) } else { f64::from(*m) - f64::from(*s) });
                left.for_each(|left| (sum, count) = (sum + left * left, count + 1));
            }
            let (drawn, stated) = ((sum / f64::from(count.max(1))).sqrt(), float(&fit[key]));
            // Columns are in single precision, of forces a thousand times the residual.
            if !near(drawn, stated, 5e-3) {
                wrong.push(format!(
                    "page: the picture's {key} of the {} is {drawn}, not {stated}",
                    text(fit, "channel")
                ));
            }
        }
    }
    wrong
}

/// The page with another first column of measured force.
pub fn with_another_trace(html: &str) -> String {
    let column = part(html, "id=\"t0-refitted\">", "</script>");
    html.replace(column, part(html, "id=\"t0-given\">", "</script>"))
}
