//! Drawn cases with one effect: how many were named, by strength and by effect.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::case_counts::count;
use super::case_score::CaseScore;
use super::scored_case::ScoredCase as _;

/// Cases with one effect of the list.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SingleEffectCounts {
    /// How many.
    pub n: usize,
    /// Physics named, or unknown.
    pub detected: usize,
    /// The effect and nothing else.
    pub named_rightly: usize,
    /// The effect among the answer and its alternatives.
    pub within_rivals: usize,
    /// Names in answer and alternatives where something was detected, mean.
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

/// Bounds of the bands of strength: half a decade each, and what lies beyond.
const BANDS: [f64; 7] = [0.0, 0.1, 0.316, 1.0, 3.16, 10.0, 1000.0];

impl SingleEffectCounts {
    /// The counts of `rows`.
    #[must_use]
    pub fn of(rows: &[&CaseScore]) -> Self {
        let detected: Vec<f64> =
            rows.iter().filter(|row| row.is_detected()).map(|row| row.answer.offered().len() as f64).collect();
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
