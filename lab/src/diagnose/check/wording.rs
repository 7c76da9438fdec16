//! Numbers with units, as a person writes them.

/// Three digits with the prefix that suits: "3.2 mm", "0.5 s", "210 nN".
pub fn quantity(value: f64, unit: &str) -> String {
    let size = value.abs();
    // Angles and torques are written plain: nobody says kiloradian.
    let plain = size == 0.0 || !size.is_finite() || (0.01..1e4).contains(&size) && !unit.starts_with('m');
    let prefixes = [(1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p")];
    let fit = prefixes.into_iter().find(|(scale, _)| size >= 0.999_5 * scale);
    match (plain, fit) {
        (false, Some((scale, prefix))) => format!("{} {prefix}{unit}", digits(value / scale)),
        _ => format!("{} {unit}", digits(value)),
    }
}

/// Three digits and no zeros at the end.
pub fn digits(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !size.is_finite() {
        return format!("{value}");
    }
    if !(1e-4..1e7).contains(&size) {
        return format!("{value:.2e}");
    }
    let places = (2 - size.log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// "1 row", "7 rows".
pub fn count(number: usize, one: &str) -> String {
    if number == 1 { format!("1 {one}") } else { format!("{number} {one}s") }
}
