//! Numbers as a reader writes them: "298 ± 4 N/m", "20.1 ± 0.3 mN/m".

const PREFIXES: [(i32, &str); 9] =
    [(-15, "f"), (-12, "p"), (-9, "n"), (-6, "µ"), (-3, "m"), (0, ""), (3, "k"), (6, "M"), (9, "G")];

/// A value with its unit, to four significant digits.
pub(super) fn plain(value: f64, unit: &str) -> String {
    rounded(value, unit, 4)
}

/// A value with its unit, to `digits` significant digits.
pub(super) fn rounded(value: f64, unit: &str, digits: i32) -> String {
    if !value.is_finite() {
        return "unknown".into();
    }
    let (factor, prefix) = scale(value.abs());
    let scaled = value / factor;
    let figures = trim(&fixed(scaled, digits - 1 - magnitude(scaled)));
    format!("{figures}\u{a0}{prefix}{}", unit.replace(' ', "\u{a0}"))
}

/// A value with the half-width of its interval, to two significant digits of the latter.
pub(super) fn with_interval(value: f64, half_width: f64, unit: &str) -> String {
    if !half_width.is_finite() || half_width <= 0.0 || !value.is_finite() {
        return plain(value, unit);
    }
    let (factor, prefix) = scale(value.abs().max(half_width));
    let decimals = 1 - magnitude(half_width / factor);
    let (value, half_width) = (fixed(value / factor, decimals), fixed(half_width / factor, decimals));
    // On a phone a line may break before the interval, and nowhere else.
    let unit = unit.replace(' ', "\u{a0}");
    format!("{value} ±\u{a0}{half_width}\u{a0}{prefix}{unit}")
}

/// Seconds; never kiloseconds.
pub(super) fn seconds(value: f64) -> String {
    if value < 1.0 { plain(value, "s") } else { format!("{}\u{a0}s", trim(&fixed(value, 2 - magnitude(value)))) }
}

/// A share, to two or three significant digits.
pub(super) fn percent(value: f64) -> String {
    format!("{}\u{a0}%", fixed(value, 1 - magnitude(value)))
}

/// A count with its thousands set apart.
pub(super) fn count(value: usize) -> String {
    let digits = value.to_string();
    let groups: Vec<&str> = digits.as_bytes().rchunks(3).rev().filter_map(|g| std::str::from_utf8(g).ok()).collect();
    groups.join("\u{202f}")
}

fn scale(size: f64) -> (f64, &'static str) {
    // A hair above, so that 999.96 does not become "1000" of the smaller unit.
    let thousands = (3.0 * (f64::from(magnitude(size * 1.000_05)) / 3.0).floor()) as i32;
    let exponent = thousands.clamp(-15, 9);
    let prefix = PREFIXES.iter().find(|(e, _)| *e == exponent).map_or("", |(_, prefix)| prefix);
    (10f64.powi(exponent), prefix)
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
