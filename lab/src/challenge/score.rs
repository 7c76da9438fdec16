//! The score of all cases, in the layout of `palpate.challenge/1`.

use std::collections::BTreeMap;

use palpate_cases::truth::Kind;
use serde::{Deserialize, Serialize};

use super::recorded::row::Recorded;
use super::row::{Compared, Row};

/// A run: its score, and the cases it was made of.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Challenge {
    /// "palpate.challenge/1".
    pub schema: String,
    /// Of all cases.
    pub seed: u64,
    /// Of the answers, before the first diagnosis.
    pub sealed_sha256: String,
    /// How many.
    pub cases: usize,
    /// Nothing is missing.
    pub none: Nothing,
    /// One effect of the list.
    pub single: Single,
    /// Two effects of the list.
    pub pairs: Pairs,
    /// One effect that the list does not hold.
    pub outside: Outside,
    /// Of single effects that were named rightly.
    pub parameters: Parameters,
    /// Held-out residual over the floor where listed effects were named rightly, medians.
    pub residual_over_floor: Residual,
    /// Of one diagnosis.
    pub seconds_median: f64,
    /// Real recordings, where there were any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recorded: Option<Recorded>,
    /// What was left out of the run, and why.
    pub left_out: Vec<String>,
    /// Every case.
    pub rows: Vec<Row>,
}

/// Cases in which nothing is missing.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Nothing {
    /// How many.
    pub n: usize,
    /// Physics named, or unknown.
    pub false_alarms: usize,
}

/// Cases with one effect of the list.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Single {
    /// How many.
    pub n: usize,
    /// Physics named, or unknown.
    pub detected: usize,
    /// The effect and nothing else.
    pub named_rightly: usize,
    /// The effect among the answer and its rivals.
    pub within_rivals: usize,
    /// Names in answer and rivals where something was detected, mean.
    pub mean_set_size: f64,
    /// By strength.
    pub by_strength: Vec<Band>,
    /// By name.
    pub by_effect: BTreeMap<String, OfEffect>,
}

/// Cases of a band of strengths.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Band {
    /// Strength from which on.
    pub from: f64,
    /// Strength below which.
    pub to: f64,
    /// How many.
    pub n: usize,
    /// Physics named, or unknown.
    pub detected: usize,
    /// The effect and nothing else.
    pub named_rightly: usize,
}

/// Cases of one effect.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct OfEffect {
    /// How many.
    pub n: usize,
    /// The effect and nothing else.
    pub named_rightly: usize,
}

/// Cases with two effects of the list.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Pairs {
    /// How many.
    pub n: usize,
    /// Both and nothing else.
    pub named_rightly: usize,
}

/// Cases with an effect that the list does not hold.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Outside {
    /// How many.
    pub n: usize,
    /// Called unknown.
    pub owned: usize,
}

/// Parameters of effects that were named rightly.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Parameters {
    /// Relative, absolute value.
    pub median_error: f64,
    /// Share of the 95 % intervals that hold the truth.
    pub coverage: f64,
}

/// Held-out residual over the floor.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Residual {
    /// Nominal physics, values refitted.
    pub before_median: f64,
    /// With the named physics.
    pub after_median: f64,
}

/// Bounds of the bands of strength: half a decade each, and what lies beyond.
const BANDS: [f64; 7] = [0.0, 0.1, 0.316, 1.0, 3.16, 10.0, 1000.0];

impl Challenge {
    /// The score of `rows`, sealed by `sha256`.
    #[must_use]
    pub fn of(seed: u64, sha256: &str, rows: Vec<Row>, left_out: Vec<String>) -> Self {
        let of = |kind: Kind| rows.iter().filter(|row| row.kind == kind).collect::<Vec<_>>();
        let (none, single, pairs, outside) = (of(Kind::None), of(Kind::Single), of(Kind::Pair), of(Kind::Outside));
        let values: Vec<&Compared> = single.iter().flat_map(|row| &row.values).collect();
        let right = |pick: fn(&Row) -> Option<f64>| {
            median(single.iter().chain(&pairs).filter(|row| row.is_right()).filter_map(|row| pick(row)))
        };
        Self {
            schema: "palpate.challenge/1".to_owned(),
            seed,
            sealed_sha256: sha256.to_owned(),
            cases: rows.len(),
            none: Nothing { n: none.len(), false_alarms: count(&none, Row::is_false_alarm) },
            pairs: Pairs { n: pairs.len(), named_rightly: count(&pairs, Row::is_right) },
            outside: Outside { n: outside.len(), owned: count(&outside, Row::is_owned) },
            parameters: Parameters {
                median_error: median(values.iter().map(|value| value.error())),
                coverage: share(values.iter().filter(|value| value.covered).count(), values.len()),
            },
            residual_over_floor: Residual {
                before_median: right(|row| row.before),
                after_median: right(|row| row.after),
            },
            seconds_median: median(rows.iter().map(|row| row.seconds)),
            single: Single::of(&single),
            recorded: None,
            left_out,
            rows,
        }
    }
}

impl Single {
    fn of(rows: &[&Row]) -> Self {
        let detected: Vec<f64> =
            rows.iter().filter(|row| row.is_detected()).map(|row| row.offered().len() as f64).collect();
        let mut by_effect = BTreeMap::new();
        for row in rows {
            let effect = by_effect.entry(row.truth.join(" and ")).or_insert(OfEffect { n: 0, named_rightly: 0 });
            effect.n += 1;
            effect.named_rightly += usize::from(row.is_right());
        }
        Self {
            n: rows.len(),
            detected: detected.len(),
            named_rightly: count(rows, Row::is_right),
            within_rivals: count(rows, Row::is_within),
            mean_set_size: detected.iter().sum::<f64>() / detected.len().max(1) as f64,
            by_strength: BANDS.windows(2).filter_map(|bounds| Band::of(rows, bounds[0], bounds[1])).collect(),
            by_effect,
        }
    }
}

impl Band {
    fn of(rows: &[&Row], from: f64, to: f64) -> Option<Self> {
        let band: Vec<&Row> = rows.iter().filter(|row| (from..to).contains(&row.strength)).copied().collect();
        let (detected, named_rightly) = (count(&band, Row::is_detected), count(&band, Row::is_right));
        (!band.is_empty()).then_some(Self { from, to, n: band.len(), detected, named_rightly })
    }
}

fn count(rows: &[&Row], is: fn(&Row) -> bool) -> usize {
    rows.iter().filter(|row| is(row)).count()
}

/// `hits` of `of`; zero where there is none.
#[must_use]
pub fn share(hits: usize, of: usize) -> f64 {
    if of == 0 { 0.0 } else { hits as f64 / of as f64 }
}

/// The median; zero where there is none, for JSON has no word for what is no number.
#[must_use]
pub fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => 0.0,
        n if n % 2 == 1 => sorted[n / 2],
        n => 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]),
    }
}
