//! Numbers as they are printed, read back to SI units with the room that their digits leave.

const PREFIXES: [(&str, i32); 9] =
    [("f", -15), ("p", -12), ("n", -9), ("µ", -6), ("m", -3), ("", 0), ("k", 3), ("M", 6), ("G", 9)];
const RAISED: [(char, char); 11] = [
    ('⁰', '0'),
    ('¹', '1'),
    ('²', '2'),
    ('³', '3'),
    ('⁴', '4'),
    ('⁵', '5'),
    ('⁶', '6'),
    ('⁷', '7'),
    ('⁸', '8'),
    ('⁹', '9'),
    ('⁻', '-'),
];

/// Plain letters: "kN s/m^2", "x 10^-7".
pub fn plain(text: &str) -> String {
    let mut plain = String::new();
    let mut raised = false;
    for letter in text.chars() {
        if let Some((_, digit)) = RAISED.iter().find(|(raised, _)| *raised == letter) {
            if !raised {
                plain.push('^');
            }
            plain.push(*digit);
            raised = true;
            continue;
        }
        raised = false;
        match letter {
            '\u{a0}' | '\u{202f}' => plain.push(' '),
            '−' => plain.push('-'),
            other => plain.push(other),
        }
    }
    plain
}

/// A number with half of its last digit, in SI units.
#[derive(Debug, Clone, Copy)]
pub struct Printed {
    pub value: f64,
    pub half_digit: f64,
}

impl Printed {
    /// A billionth more than half a digit: a number in the middle may have gone either way.
    pub fn holds(self, wanted: f64) -> bool {
        (self.value - wanted).abs() <= self.half_digit * (1.0 + 1e-6) + 1e-9 * wanted.abs()
    }
}

/// The numbers of `text`, each with the unit that follows it next.
pub fn numbers(text: &str, unit: &str) -> Vec<Printed> {
    let text = plain(text).replace("95 %:", "");
    let letters: Vec<char> = text.chars().collect();
    let mut found = Vec::new();
    let mut at = 0;
    while at < letters.len() {
        if letters[at] == '^' {
            at += 1;
            while letters.get(at).is_some_and(|letter| *letter == '-' || letter.is_ascii_digit()) {
                at += 1;
            }
            continue;
        }
        let signed = letters[at] == '-' && letters.get(at + 1).is_some_and(char::is_ascii_digit);
        let follows = at > 0 && (letters[at - 1].is_alphanumeric() || letters[at - 1] == '/');
        if follows || !(letters[at].is_ascii_digit() || signed) {
            at += 1;
            continue;
        }
        let end = (at + 1..letters.len())
            .find(|end| !letters[*end].is_ascii_digit() && letters[*end] != '.')
            .unwrap_or(letters.len());
        let digits: String = letters[at..end].iter().collect();
        let before: String = letters[..at].iter().collect();
        if !before.ends_with("× ") {
            let rest: String = letters[end..].iter().collect();
            let decimals = digits.split('.').nth(1).map_or(0, str::len) as i32;
            // What has no unit behind it is no such number: the 1 of 1/s, a figure of something else.
            if let Some(power) = exponent(&rest, unit) {
                let scale = 10f64.powi(power);
                let value: f64 = digits.trim_end_matches('.').parse().expect("digits");
                found.push(Printed { value: scale * value, half_digit: scale * 0.5 * 10f64.powi(-decimals) });
            }
        }
        at = end;
    }
    found
}

/// The power of ten of whatever unit comes next.
fn exponent(rest: &str, unit: &str) -> Option<i32> {
    let power = rest.find("× 10^").map(|at| {
        let digits: String =
            rest[at + "× 10^".len()..].chars().take_while(|c| c.is_ascii_digit() || *c == '-').collect();
        (at, digits.parse::<i32>().expect("a power"))
    });
    if unit == "1" || unit.is_empty() {
        return Some(power.map_or(0, |(_, power)| power));
    }
    let prefixed = PREFIXES.iter().filter_map(|(prefix, power)| {
        let word = format!(" {prefix}{unit}");
        rest.match_indices(&word)
            .find(|(at, _)| !rest[at + word.len()..].starts_with(|c: char| c.is_alphanumeric() || "/^".contains(c)))
            .map(|(at, _)| (at, *power))
    });
    let next = prefixed.min_by_key(|(at, _)| *at);
    match (power, next) {
        (Some((at, power)), Some((unit_at, prefix))) if at < unit_at => Some(power + prefix),
        (_, Some((_, prefix))) => Some(prefix),
        (_, None) => None,
    }
}

/// Whether `text` shows a value and its interval; `wanted` is value, low and high.
pub fn agrees(text: &str, unit: &str, wanted: &[f64; 3]) -> bool {
    let shown = numbers(text, unit);
    if !(wanted[1].is_finite() && wanted[2].is_finite()) {
        return text.contains("not bounded") && shown.first().is_some_and(|shown| shown.holds(wanted[0]));
    }
    match (text.contains('±'), shown.as_slice()) {
        // A half-width stands for ends that may be uneven by a fifth: what is shown is their mean.
        (true, [value, half]) => value.holds(wanted[0]) && half.holds(0.5 * (wanted[2] - wanted[1])),
        (false, [value, low, high]) => value.holds(wanted[0]) && low.holds(wanted[1]) && high.holds(wanted[2]),
        // Ends that no reader tells apart are one number.
        (false, [value, both]) => value.holds(wanted[0]) && (both.holds(wanted[1]) || both.holds(wanted[2])),
        (false, [value]) => value.holds(wanted[0]),
        _ => false,
    }
}

/// "92 %".
pub fn percent_agrees(text: &str, wanted: f64) -> bool {
    let text = plain(text);
    if text.contains("less than") {
        return (0.0..=1.001e-3).contains(&wanted);
    }
    if text.contains("none") {
        return wanted < 0.0;
    }
    let shown = numbers(&text, "%");
    // Nearly all is never rounded to all: 99.9 % stands for what lies above, too.
    shown.first().is_some_and(|shown| shown.holds(100.0 * wanted) || (wanted > 0.999 && shown.value > 99.8))
}
