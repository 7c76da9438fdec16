//! Numbers as a reader writes them: "298 ± 4 N/m", "20.1 ± 0.3 mN/m", "3.20 × 10⁻⁹ kg".

const PREFIXES: [(i32, &str); 9] =
    [(-15, "f"), (-12, "p"), (-9, "n"), (-6, "µ"), (-3, "m"), (0, ""), (3, "k"), (6, "M"), (9, "G")];
/// Units that take a prefix. "mkg" is none, "m1/s" neither, and a kilosecond is for nobody.
const PREFIXED: [&str; 4] = ["N", "m", "rad", "Hz"];

/// A value with its unit, to four significant digits.
pub(crate) fn plain(value: f64, unit: &str) -> String {
    rounded(value, unit, 4)
}

/// A value with its unit, to `digits` significant digits.
pub(crate) fn rounded(value: f64, unit: &str, digits: i32) -> String {
    if !value.is_finite() {
        return "unknown".into();
    }
    let scale = Scale::of(value.abs(), unit);
    let scaled = value / scale.factor;
    let figures = trim(&fixed(scaled, digits - 1 - magnitude(scaled)));
    format!("{figures}{}", scale.words)
}

/// A value with the half-width of its interval, to two significant digits of the latter.
pub(crate) fn with_interval(value: f64, half_width: f64, unit: &str) -> String {
    if !half_width.is_finite() || half_width <= 0.0 || !value.is_finite() {
        return plain(value, unit);
    }
    let scale = Scale::of(value.abs().max(half_width), unit);
    let decimals = 1 - magnitude(half_width / scale.factor);
    let (value, half_width) = (fixed(value / scale.factor, decimals), fixed(half_width / scale.factor, decimals));
    // On a phone a line may break before the interval, and nowhere else.
    let sum = format!("{value} ±\u{a0}{half_width}");
    if scale.power { format!("({sum}){}", scale.words) } else { format!("{sum}{}", scale.words) }
}

/// The ends of a range, to two significant digits of its width.
pub(crate) fn between(low: f64, high: f64, unit: &str) -> String {
    let width = high - low;
    if width == 0.0 {
        return plain(low, unit);
    }
    if !width.is_finite() || width <= 0.0 {
        return format!("{} to {}", plain(low, unit), plain(high, unit));
    }
    // Ends that differ in the seventh digit are one number to every reader.
    if width < 1e-6 * low.abs().min(high.abs()) {
        return plain(0.5 * (low + high), unit);
    }
    let scale = Scale::of(low.abs().max(high.abs()), unit);
    let decimals = 1 - magnitude(width / scale.factor);
    let ends = [low, high].map(|end| fixed(end / scale.factor, decimals));
    let words = ends.join(" to ");
    if scale.power { format!("({words}){}", scale.words) } else { format!("{words}{}", scale.words) }
}

/// Seconds; never kiloseconds.
pub(crate) fn seconds(value: f64) -> String {
    match value.abs() {
        _ if !value.is_finite() => "unknown".into(),
        size if size < 1.0 => prefixed(value, "s"),
        _ => format!("{}\u{a0}s", trim(&fixed(value, 2 - magnitude(value)))),
    }
}

/// The factor of three powers of ten that makes `size` read well, and the unit with its prefix.
#[must_use]
pub(crate) fn prefixed_unit(size: f64, unit: &str) -> (f64, String) {
    let all = [(1e-9, "n"), (1e-6, "µ"), (1e-3, "m"), (1.0, ""), (1e3, "k")];
    let fits = all.iter().rev().find(|(factor, _)| size >= *factor).unwrap_or(&all[0]);
    if unit == "s" { (1.0, unit.to_owned()) } else { (fits.0, format!("{}{unit}", fits.1)) }
}

/// `value` to two significant digits, no more than three decimals.
#[must_use]
pub(crate) fn short(value: f64) -> String {
    let decimals = (1 - value.abs().max(1e-3).log10().floor() as i32).clamp(0, 3) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn prefixed(value: f64, unit: &str) -> String {
    let scale = Scale::prefixed(value.abs(), unit);
    let scaled = value / scale.factor;
    format!("{}{}", trim(&fixed(scaled, 3 - magnitude(scaled))), scale.words)
}

/// A coefficient of correlation; no rounding makes it one.
pub(crate) fn coefficient(value: f64) -> String {
    match value.abs() {
        size if size < 0.005 => "0".into(),
        size if size < 0.995 || size == 1.0 => fixed(value, 2),
        _ => fixed(value.clamp(-0.9999, 0.9999), 4),
    }
}

/// A share, to two or three significant digits.
pub(crate) fn percent(value: f64) -> String {
    if !value.is_finite() {
        return "unknown".into();
    }
    format!("{}\u{a0}%", fixed(value, 1 - magnitude(value)))
}

/// A count with its thousands set apart.
pub(crate) fn count(value: usize) -> String {
    let digits = value.to_string();
    let groups: Vec<&str> = digits.as_bytes().rchunks(3).rev().filter_map(|g| std::str::from_utf8(g).ok()).collect();
    groups.join("\u{202f}")
}

/// A unit as it is printed: "N s/m^2" is "N s/m²", and a number without unit has none.
pub(crate) fn unit(name: &str) -> String {
    let mut text = String::new();
    let mut raised = false;
    for letter in name.trim().chars() {
        match letter {
            '^' => raised = true,
            '-' | '0'..='9' if raised => text.push(superscript(letter)),
            ' ' => (text.push('\u{a0}'), raised = false).1,
            _ => (text.push(letter), raised = false).1,
        }
    }
    if text == "1" { String::new() } else { text }
}

fn superscript(letter: char) -> char {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    letter.to_digit(10).and_then(|digit| RAISED.get(digit as usize).copied()).unwrap_or('⁻')
}

/// What numbers are divided by, and what then follows them.
struct Scale {
    factor: f64,
    words: String,
    power: bool,
}

impl Scale {
    fn of(size: f64, name: &str) -> Self {
        let base = name.split([' ', '/']).next().unwrap_or_default();
        // A hair above, so that 999.96 does not become "1000" of the smaller unit.
        let exponent = magnitude(size * 1.000_05);
        match exponent {
            -15..12 if PREFIXED.contains(&base) => Self::prefixed(size, name),
            -15..-3 if name == "s" => Self::prefixed(size, name),
            -3..5 => Self { factor: 1.0, words: spaced(&unit(name)), power: false },
            _ => {
                let raised: String = exponent.to_string().chars().map(superscript).collect();
                let words = format!("\u{a0}×\u{a0}10{raised}{}", spaced(&unit(name)));
                Self { factor: 10f64.powi(exponent), words, power: true }
            }
        }
    }

    fn prefixed(size: f64, name: &str) -> Self {
        let thousands = (3.0 * (f64::from(magnitude(size * 1.000_05)) / 3.0).floor()) as i32;
        let exponent = thousands.clamp(-15, 9);
        let prefix = PREFIXES.iter().find(|(e, _)| *e == exponent).map_or("", |(_, prefix)| prefix);
        Self { factor: 10f64.powi(exponent), words: format!("\u{a0}{prefix}{}", unit(name)), power: false }
    }
}

fn spaced(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!("\u{a0}{unit}") }
}

/// The power of ten of the leading digit; 0 for zero.
fn magnitude(value: f64) -> i32 {
    if value == 0.0 || !value.is_finite() { 0 } else { value.abs().log10().floor() as i32 }
}

fn fixed(value: f64, decimals: i32) -> String {
    let text = format!("{value:.*}", decimals.clamp(0, 9) as usize);
    let is_zero = text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.'));
    if is_zero { text.replace('-', "") } else { text.replace('-', "−") }
}

fn trim(text: &str) -> String {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spaced(text: String) -> String {
        text.replace(['\u{a0}', '\u{202f}'], " ")
    }

    #[test]
    fn the_prefix_follows_the_size() {
        assert_eq!(spaced(plain(300.0, "N/m")), "300 N/m");
        assert_eq!(spaced(plain(0.0, "N/m")), "0 N/m");
        assert_eq!(spaced(plain(0.0201, "N/m")), "20.1 mN/m");
        assert_eq!(spaced(plain(-1.5e-6, "N s/m")), "−1.5 µN s/m");
        assert_eq!(spaced(plain(999.99, "N/m")), "1 kN/m");
        assert_eq!(spaced(plain(f64::NAN, "N/m")), "unknown");
    }

    #[test]
    fn what_takes_no_prefix_takes_a_power_of_ten() {
        assert_eq!(spaced(plain(0.8, "kg")), "0.8 kg");
        assert_eq!(spaced(plain(3.2e-9, "kg m^2")), "3.2 × 10⁻⁹ kg m²");
        assert_eq!(spaced(plain(1.5, "1")), "1.5");
        assert_eq!(spaced(with_interval(2.6e-4, 4.3e-4, "s")), "260 ± 430 µs");
        assert_eq!(spaced(between(0.2, 0.9, "s")), "0.20 to 0.90 s");
        assert_eq!(spaced(plain(12.34, "N s/m^2")), "12.34 N s/m²");
        assert_eq!(spaced(plain(2.5e13, "N/m^3")), "2.5 × 10¹³ N/m³");
        assert_eq!(spaced(with_interval(-3.21e-7, 4e-9, "1/s")), "(−3.210 ± 0.040) × 10⁻⁷ 1/s");
    }

    #[test]
    fn a_range_has_the_digits_of_its_width() {
        assert_eq!(spaced(between(11.9, 12.71, "N s/m^2")), "11.90 to 12.71 N s/m²");
        assert_eq!(spaced(between(2.0, 2.0, "N")), "2 N");
        assert_eq!(spaced(between(-1e-9, 3e-9, "N")), "−1.0 to 3.0 nN");
        assert_eq!(spaced(between(4.999_999_9e-5, 5.000_000_1e-5, "m/s")), "50 µm/s");
        assert_eq!(spaced(between(f64::NAN, 3e-9, "N")), "unknown to 3 nN");
    }

    #[test]
    fn the_interval_decides_the_digits() {
        assert_eq!(spaced(with_interval(298.37, 4.13, "N/m")), "298.4 ± 4.1 N/m");
        assert_eq!(spaced(with_interval(5.0, 12.0, "N s/m")), "5 ± 12 N s/m");
        assert_eq!(spaced(with_interval(2.011e-2, 3.1e-4, "N/m")), "20.11 ± 0.31 mN/m");
        assert_eq!(spaced(with_interval(5.0, f64::INFINITY, "N/m")), "5 N/m");
    }

    #[test]
    fn times_shares_and_counts_read_plainly() {
        assert_eq!(spaced(seconds(1234.0)), "1234 s");
        assert_eq!(spaced(seconds(0.0251)), "25.1 ms");
        assert_eq!(spaced(percent(12.34)), "12 %");
        assert_eq!(spaced(percent(2.345)), "2.3 %");
        assert_eq!(spaced(count(1_000_000)), "1 000 000");
    }
}
