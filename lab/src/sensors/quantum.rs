//! The step of a rounded reading.

/// A gap lies on the lattice when it is this near to a whole number of steps, in steps.
const LATTICE_TOLERANCE: f64 = 0.15;

/// A lattice misses by no more than this part of the largest reading, the last of seven printed digits, ...
const RELATIVE_PRECISION: f64 = 1e-6;

/// ... or by so many units of the last decimal. A ramp at constant speed also steps evenly, but not as evenly as that.
const MAX_DECIMAL_MISS: f64 = 1.5;

/// Share of gaps that must lie on the lattice. Of gaps that know no lattice 30 % do so by chance.
const MIN_LATTICE_FRACTION: f64 = 0.9;

/// Below so many gaps chance alone may put 90 % of them on a lattice; then the readings must also repeat.
const MIN_DISTINCT_VALUES: usize = 12;

/// Mean length of an unbroken run of single steps from which it is a motion and no sensor. A rounded ramp of nearly one
/// step a reading breaks its runs as soon as the speed is off by one part in as many.
const MAX_EVEN_RUN: usize = 12;

/// The largest step of which all readings are whole multiples apart; 0 where there is none.
///
/// The gaps between neighbours among the sorted distinct readings lie on a lattice when the sensor rounds. A count that
/// was printed with few digits (0.000244, 0.000488, 0.000732, 0.000977) is found as that count, not as the last digit, as
/// long as the digits are at least four times finer. Steps below 64 units in the last place of the largest reading are the
/// number format's, not the sensor's. A recording of nothing but digits has the last digit for its step, which is true.
#[must_use]
pub fn quantum(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let grain = 8.0 * f64::EPSILON * largest;
    let mut gaps = gaps_of(sorted);
    gaps.retain(|gap| *gap > grain);
    if gaps.is_empty() {
        return 0.0;
    }
    gaps.sort_unstable_by(f64::total_cmp);
    let repeats = gaps.len() + 1 < values.len() / 2;
    if gaps.len() < MIN_DISTINCT_VALUES && !repeats {
        return 0.0;
    }
    let decimal = last_decimal(values, largest);
    let slack = (RELATIVE_PRECISION * largest).max(MAX_DECIMAL_MISS * decimal);
    let step = candidates(&gaps)
        .filter(|step| *step > 8.0 * grain)
        .filter_map(|step| lattice(&gaps, step, slack))
        .fold(0.0, f64::max);
    match is_even_motion(values, step) {
        false => step,
        true if decimal > 8.0 * grain => decimal,
        true => 0.0,
    }
}

/// What lies between neighbours, in the room of the values themselves: a long recording is not held once more.
fn gaps_of(mut sorted: Vec<f64>) -> Vec<f64> {
    (1..sorted.len()).for_each(|at| sorted[at - 1] = sorted[at] - sorted[at - 1]);
    sorted.pop();
    sorted
}

/// Whether `step` is what the motion does from one reading to the next: a perfect ramp, not a rounded one. A rounded ramp
/// hesitates or leaps somewhere; a perfect one moves by exactly one step, reading after reading.
fn is_even_motion(values: &[f64], step: f64) -> bool {
    let counts = values.windows(2).map(|pair| ((pair[1] - pair[0]) / step).abs().round());
    let (mut moves, mut single, mut starts, mut before) = (0usize, 0usize, 0usize, 0.0);
    for count in counts {
        moves += usize::from(count > 0.0);
        single += usize::from(count == 1.0);
        starts += usize::from(count > 0.0 && before == 0.0);
        before = count;
    }
    step > 0.0 && single as f64 > MIN_LATTICE_FRACTION * moves as f64 && moves >= MAX_EVEN_RUN * starts
}

/// The power of ten of which all readings are multiples, 0 where there is none above the number format's own grain.
fn last_decimal(values: &[f64], largest: f64) -> f64 {
    let first = largest.log10().ceil();
    (0..14)
        .map(|digit| 10f64.powf(first - f64::from(digit)))
        .find(|unit| {
            values.iter().all(|value| {
                let count = value / unit;
                (count - count.round()).abs() <= 8.0 * f64::EPSILON * (largest / unit)
            })
        })
        .unwrap_or(0.0)
}

/// Gaps from the small end, whole and divided: one of them is a step wherever there are steps.
fn candidates(gaps: &[f64]) -> impl Iterator<Item = f64> + '_ {
    [0.0, 0.01, 0.05, 0.1, 0.25, 0.5]
        .into_iter()
        .map(|share| gaps[(share * (gaps.len() - 1) as f64) as usize])
        .flat_map(|gap| (1..=5).map(move |parts| gap / f64::from(parts)))
}

/// The step nearest to `step` on whose lattice the gaps lie to within `slack`, `None` where they do not.
///
/// `gaps` ascend. Few steps fix the step roughly; each fourfold longer reach sharpens it enough to count the next.
fn lattice(gaps: &[f64], step: f64, slack: f64) -> Option<f64> {
    let mut step = step;
    let mut reach = 2.0;
    let mut judged = 0;
    while judged < gaps.len() && reach < 1e5 {
        judged = gaps.partition_point(|gap| *gap < (reach + 0.5) * step);
        let (product, square) = gaps[..judged].iter().fold((0.0, 0.0), |(product, square), gap| {
            let count = (gap / step).round();
            (product + count * gap, square + count * count)
        });
        if square > 0.0 {
            step = product / square;
        }
        if share_near(&gaps[..judged], step, slack) < MIN_LATTICE_FRACTION {
            return None;
        }
        reach *= 4.0;
    }
    // A lattice that only a few small gaps were measured against is no finding.
    (2 * judged >= gaps.len()).then_some(step)
}

fn share_near(gaps: &[f64], step: f64, slack: f64) -> f64 {
    if gaps.is_empty() {
        return 1.0;
    }
    let near = |gap: &&f64| {
        let count = (*gap / step).round();
        (*gap - count * step).abs() < slack.min(LATTICE_TOLERANCE * step)
    };
    gaps.iter().filter(near).count() as f64 / gaps.len() as f64
}
