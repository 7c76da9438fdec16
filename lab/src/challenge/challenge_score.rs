//! The score of all cases, in the layout of `palpate.challenge/1`.

use std::collections::BTreeMap;

use palpate_cases::truth::CaseKind;
use serde::{Deserialize, Serialize};

use super::case_score::{CaseScore, ParameterScore};
use super::recordings::specimen_score::RecordingScores;

/// A run: its score, and the cases it was made of.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ChallengeScore {
    /// "palpate.challenge/1".
    pub schema: String,
    /// Of all cases.
    pub seed: u64,
    /// Of the answers, before the first diagnosis.
    pub sealed_sha256: String,
    /// How many.
    pub cases: usize,
    /// Nothing is missing.
    pub none: NoEffectCounts,
    /// One effect of the list.
    pub single: SingleEffectCounts,
    /// Two effects of the list.
    pub pairs: PairCounts,
    /// One effect that the list does not hold.
    pub outside: OutsideCounts,
    /// Of single effects that were named rightly.
    pub parameters: ParameterStatistics,
    /// Held-out residual over the floor where listed effects were named rightly, medians.
    pub residual_over_floor: ResidualStatistics,
    /// Of one diagnosis.
    pub seconds_median: f64,
    /// Real recordings, where there were any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recorded: Option<RecordingScores>,
    /// What was left out of the run, and why.
    pub left_out: Vec<String>,
    /// Every case.
    pub rows: Vec<CaseScore>,
}

/// Cases in which nothing is missing.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct NoEffectCounts {
    /// How many.
    pub n: usize,
    /// Physics named, or unknown.
    pub false_alarms: usize,
}

/// Cases with one effect of the list.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SingleEffectCounts {
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
    pub by_strength: Vec<StrengthBand>,
    /// By name.
    pub by_effect: BTreeMap<String, EffectCounts>,
}

/// Cases of a band of strengths.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct StrengthBand {
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
pub struct EffectCounts {
    /// How many.
    pub n: usize,
    /// The effect and nothing else.
    pub named_rightly: usize,
}

/// Cases with two effects of the list.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct PairCounts {
    /// How many.
    pub n: usize,
    /// Both and nothing else.
    pub named_rightly: usize,
}

/// Cases with an effect that the list does not hold.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct OutsideCounts {
    /// How many.
    pub n: usize,
    /// Called unknown.
    pub owned: usize,
}

/// Parameters of effects that were named rightly.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ParameterStatistics {
    /// Relative, absolute value.
    pub median_error: f64,
    /// Share of the 95 % intervals that hold the truth.
    pub coverage: f64,
}

/// Held-out residual over the floor.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ResidualStatistics {
    /// Nominal physics, values refitted.
    pub before_median: f64,
    /// With the named physics.
    pub after_median: f64,
}

/// Bounds of the bands of strength: half a decade each, and what lies beyond.
const BANDS: [f64; 7] = [0.0, 0.1, 0.316, 1.0, 3.16, 10.0, 1000.0];

impl ChallengeScore {
    /// The score of `rows`, sealed by `sha256`.
    #[must_use]
    pub fn of(seed: u64, sha256: &str, rows: Vec<CaseScore>, left_out: Vec<String>) -> Self {
        let of = |kind: CaseKind| rows.iter().filter(|row| row.kind == kind).collect::<Vec<_>>();
        let (none, single, pairs, outside) =
            (of(CaseKind::None), of(CaseKind::Single), of(CaseKind::Pair), of(CaseKind::Outside));
        let values: Vec<&ParameterScore> = single.iter().flat_map(|row| &row.values).collect();
        let right = |pick: fn(&CaseScore) -> Option<f64>| {
            median(single.iter().chain(&pairs).filter(|row| row.is_right()).filter_map(|row| pick(row)))
        };
        Self {
            schema: "palpate.challenge/1".to_owned(),
            seed,
            sealed_sha256: sha256.to_owned(),
            cases: rows.len(),
            none: NoEffectCounts { n: none.len(), false_alarms: count(&none, CaseScore::is_false_alarm) },
            pairs: PairCounts { n: pairs.len(), named_rightly: count(&pairs, CaseScore::is_right) },
            outside: OutsideCounts { n: outside.len(), owned: count(&outside, CaseScore::is_owned) },
            parameters: ParameterStatistics {
                median_error: median(values.iter().map(|value| value.error())),
                coverage: share(values.iter().filter(|value| value.covered).count(), values.len()),
            },
            residual_over_floor: ResidualStatistics {
                before_median: right(|row| row.before),
                after_median: right(|row| row.after),
            },
            seconds_median: median(rows.iter().map(|row| row.seconds)),
            single: SingleEffectCounts::of(&single),
            recorded: None,
            left_out,
            rows,
        }
    }
}

impl SingleEffectCounts {
    fn of(rows: &[&CaseScore]) -> Self {
        let detected: Vec<f64> =
            rows.iter().filter(|row| row.is_detected()).map(|row| row.offered().len() as f64).collect();
        let mut by_effect = BTreeMap::new();
        for row in rows {
            let effect = by_effect.entry(row.truth.join(" and ")).or_insert(EffectCounts { n: 0, named_rightly: 0 });
            effect.n += 1;
            effect.named_rightly += usize::from(row.is_right());
        }
        Self {
            n: rows.len(),
            detected: detected.len(),
            named_rightly: count(rows, CaseScore::is_right),
            within_rivals: count(rows, CaseScore::is_within),
            mean_set_size: detected.iter().sum::<f64>() / detected.len().max(1) as f64,
            by_strength: BANDS.windows(2).filter_map(|bounds| StrengthBand::of(rows, bounds[0], bounds[1])).collect(),
            by_effect,
        }
    }
}

impl StrengthBand {
    fn of(rows: &[&CaseScore], from: f64, to: f64) -> Option<Self> {
        let band: Vec<&CaseScore> = rows.iter().filter(|row| (from..to).contains(&row.strength)).copied().collect();
        let (detected, named_rightly) = (count(&band, CaseScore::is_detected), count(&band, CaseScore::is_right));
        (!band.is_empty()).then_some(Self { from, to, n: band.len(), detected, named_rightly })
    }
}

fn count(rows: &[&CaseScore], is: fn(&CaseScore) -> bool) -> usize {
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
