//! What a person wants to know of a channel before choosing it.

use crate::recording::data_file::{Channel, Content};
use crate::terminal::printable;

/// A pause as long as this many median periods is a gap.
const GAP_PERIODS: f64 = 3.0;

/// A channel in numbers.
pub struct ChannelSummary {
    /// As a rig file names it.
    pub name: String,
    count: usize,
    /// Values a second, from the median period.
    rate_hz: Option<f64>,
    range: Option<[f64; 2]>,
    notes: Vec<String>,
}

impl ChannelSummary {
    /// Of `channel`, on its own clock or on that of the file's column of time, given by name and values.
    pub fn of(channel: &Channel, time: Option<(&str, &[f64])>) -> Self {
        let name = printable(&channel.name);
        let values = match &channel.content {
            Content::Numbers(values) => values,
            Content::Other(what) => {
                return Self { name, count: 0, rate_hz: None, range: None, notes: vec![what.clone()] };
            }
        };
        let mut notes = Vec::new();
        let clock = channel.clock.as_deref().or(time.map(|(_, clock)| clock));
        let clock = clock.filter(|clock| {
            if clock.len() != values.len() {
                notes.push(format!("{} values but {} times", values.len(), clock.len()));
            }
            clock.len() == values.len()
        });
        let is_time = time.is_some_and(|(time, _)| time == channel.name);
        let period = clock.and_then(median_period);
        // Gaps are listed where the time is listed, or where every channel has its own.
        if let (Some(clock), Some(period)) = (clock, period)
            && (is_time || channel.clock.is_some())
        {
            notes.extend(gaps(clock, period));
        }
        notes.extend(blemishes(values));
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        let range = [finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max)];
        let range = Some(range).filter(|range| range[0] <= range[1]);
        Self { name, count: values.len(), rate_hz: period.map(f64::recip), range, notes }
    }

    /// A line of the listing, the name in `width` letters.
    pub fn line(&self, width: usize) -> String {
        let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), six_digits);
        let rate = self.rate_hz.map_or_else(|| "-".to_owned(), |rate| format!("{rate:.2}"));
        let [low, high] = [0, 1].map(|end| number(self.range.map(|range| range[end])));
        let (name, count, notes) = (&self.name, self.count, self.notes.join("; "));
        format!("{name:width$}  {count:>9}  {rate:>10}  {low:>12}  {high:>12}  {notes}").trim_end().to_owned() + "\n"
    }
}

/// Six significant digits; a power of ten where there would be many zeros.
fn six_digits(value: f64) -> String {
    let magnitude = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    if !(-4..7).contains(&magnitude) {
        return format!("{value:.5e}");
    }
    let text = format!("{value:.*}", (5 - magnitude).max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Seconds; `None` where time does not go on.
fn median_period(clock: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = clock.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1).filter(|period| *period > 0.0)
}

fn gaps(clock: &[f64], period: f64) -> Vec<String> {
    let steps = || clock.windows(2).map(|pair| (pair[0], pair[1] - pair[0]));
    let gaps: Vec<_> = steps().filter(|(_, step)| *step > GAP_PERIODS * period).collect();
    let longest = gaps.iter().copied().max_by(|one, two| one.1.total_cmp(&two.1));
    let backward = steps().filter(|(_, step)| *step <= 0.0).count();
    let mut notes = Vec::new();
    if let Some((start, step)) = longest {
        notes.push(format!("{} gaps, the longest of {step:.3} s at {start:.3} s", gaps.len()));
    }
    if backward > 0 {
        notes.push(format!("time does not increase {backward} times"));
    }
    notes
}

fn blemishes(values: &[f64]) -> Vec<String> {
    let missing = values.iter().filter(|value| !value.is_finite()).count();
    let mut notes = Vec::new();
    if missing > 0 {
        notes.push(format!("{missing} values are no finite number"));
    }
    if values.len() > 1 && values.iter().all(|value| *value == values[0]) {
        notes.push("constant".to_owned());
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::six_digits;

    #[test]
    fn a_number_that_can_be_read_at_once_has_no_power_of_ten() {
        let shown = [0.0, 12.419, -278.781, 0.246469, -2.093e-5, 3e9, 1_234_567.8].map(six_digits);
        assert_eq!(shown, ["0", "12.419", "-278.781", "0.246469", "-2.09300e-5", "3.00000e9", "1234568"]);
    }
}
