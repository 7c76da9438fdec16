//! Which rigs stand out of their fleet: by their answer, or by a value far from that of the others.

use crate::page::effect_name::effect_name;
use std::collections::BTreeMap;

use super::row::NOMINAL;
use super::table::{Rig, Table};
use crate::challenge::statistics::median;

/// Fewest rigs that a rig is held against: below, nothing is usual.
pub const MIN_RIGS: usize = 8;
/// Greatest modified z-score that does not stand out (Iglewicz and Hoaglin 1993).
pub const MAX_Z: f64 = 3.5;
/// Share of the rigs from which an answer is common: where none is, no effect is rare.
pub const COMMON_SHARE: f64 = 0.5;
/// Share of the rigs up to which an effect is rare, and from which it is usual.
pub const RARE_SHARE: f64 = 0.1;
/// See [`RARE_SHARE`].
pub const USUAL_SHARE: f64 = 0.9;
/// From the median absolute deviation to the standard deviation of normal numbers.
const DEVIATION_OF_MAD: f64 = 1.4826;
/// Half-width of a 95 % interval in standard errors of normal numbers.
const HALF_WIDTH_95: f64 = 1.96;

/// What stands for the effect where the quantity is the residual over the expected noise.
const RESIDUAL: &str = "residual";

/// One value of every rig that has it.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// The effect, [`NOMINAL`], or "residual" for that over the expected noise.
    pub effect: String,
    /// Name of the value.
    pub parameter: String,
    /// Its unit; "1" where it is held against the rig file.
    pub unit: String,
    /// Whether values are over those that the rig file states: rigs may be of different size.
    pub is_relative: bool,
    /// Median over the rigs.
    pub median: f64,
    /// One a rig, in the order of the table.
    pub points: Vec<Point>,
}

/// The value of one rig.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Name of the rig.
    pub rig: String,
    /// Estimate, lower and upper end of its 95 % interval, NaN where it has none.
    pub value: [f64; 3],
    /// Modified z-score: distance from the median over the spread of the fleet and the standard error of the value; 0 where
    /// rigs are too few.
    pub z: f64,
}

/// Why a rig stands out.
#[derive(Debug, Clone, PartialEq)]
pub enum Reason {
    /// It could not be diagnosed.
    Failed(String),
    /// Structure beyond the expected noise that no effect on the list explains.
    Unknown,
    /// It names an effect that few others do: how many, of how many.
    RareEffect(String, usize, usize),
    /// It lacks an effect that nearly all others name: how many, of how many.
    LacksEffect(String, usize, usize),
    /// A value far from the median: effect, name, unit, whether over the rig file's, value, median, modified z-score.
    Value(Box<FarValue>),
}

/// A value far from the median of its quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct FarValue {
    /// The quantity, without its points.
    pub quantity: Quantity,
    /// The rig's.
    pub point: Point,
}

/// A rig that stands out, for at least one reason.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlier {
    /// Name of the rig.
    pub rig: String,
    /// Gravest first.
    pub reasons: Vec<Reason>,
}

/// The quantities of `table` that at least two rigs have: those of the rig files, of effects, and the residual over the noise.
#[must_use]
pub fn quantities(table: &Table) -> Vec<Quantity> {
    let mut groups: BTreeMap<(bool, String, String, String), Vec<RigValue<'_>>> = BTreeMap::new();
    for rig in table.rigs() {
        for (key, value, given) in values(rig) {
            let (effect, parameter, unit) = key;
            groups
                .entry((![NOMINAL, RESIDUAL].contains(&effect.as_str()), effect, parameter, unit))
                .or_default()
                .push((rig.name(), value, given));
        }
    }
    let several = groups.into_iter().filter(|(_, points)| points.len() > 1);
    several.map(|((_, effect, parameter, unit), points)| quantity(effect, parameter, unit, &points)).collect()
}

/// Name of a rig, estimate with its interval, and what the rig file states.
type RigValue<'a> = (&'a str, [f64; 3], Option<f64>);

/// Effect, name and unit of a value, estimate with its interval, and what the rig file states.
type Value = ((String, String, String), [f64; 3], Option<f64>);

/// The first value of each name of `rig`, and what its rig file states.
fn values(rig: Rig<'_>) -> Vec<Value> {
    let mut found: Vec<Value> = Vec::new();
    let noise = rig.head().residual_over_noise.filter(|ratio| *ratio > 0.0);
    let key = |effect: &str, parameter: &str, unit: &str| (effect.to_owned(), parameter.to_owned(), unit.to_owned());
    found.extend(noise.map(|ratio| (key(RESIDUAL, "residual_over_noise", "1"), [ratio, f64::NAN, f64::NAN], None)));
    for row in rig.values() {
        let name = key(&row.effect, &row.parameter, &row.unit);
        if let (false, Some(value)) = (found.iter().any(|(other, ..)| *other == name), row.value) {
            found.push((name, [value, end(row.ci95_low), end(row.ci95_high)], row.given.filter(|given| *given != 0.0)));
        }
    }
    found
}

fn end(given: Option<f64>) -> f64 {
    given.unwrap_or(f64::NAN)
}

fn quantity(effect: String, parameter: String, unit: String, points: &[RigValue<'_>]) -> Quantity {
    let is_relative = points.iter().all(|(_, _, given)| given.is_some());
    let scaled = |(rig, value, given): &RigValue<'_>| {
        let over = given.filter(|_| is_relative).unwrap_or(1.0);
        let [value, low, high] = value.map(|number| number / over);
        // A negative value of the rig file turns the interval round.
        Point { rig: (*rig).to_owned(), value: [value, low.min(high), low.max(high)], z: 0.0 }
    };
    let mut points: Vec<Point> = points.iter().map(scaled).collect();
    let centre = median(points.iter().map(|point| point.value[0]));
    if points.len() >= MIN_RIGS {
        let spread = DEVIATION_OF_MAD * median(points.iter().map(|point| (point.value[0] - centre).abs()));
        points.iter_mut().for_each(|point| point.z = z_score(point.value, centre, spread));
    }
    let unit = if is_relative { "1".to_owned() } else { unit };
    Quantity { effect, parameter, unit, is_relative, median: centre, points }
}

/// Distance of a value from `centre` in deviations: `spread` is that of the fleet, and its own uncertainty adds to it.
fn z_score([value, low, high]: [f64; 3], centre: f64, spread: f64) -> f64 {
    let width = high - low;
    let standard_error = if width.is_nan() { 0.0 } else { width / (2.0 * HALF_WIDTH_95) };
    let z = (value - centre) / spread.hypot(standard_error);
    if z.is_nan() { 0.0 } else { z }
}

/// The rigs of `table` that stand out, gravest first; `quantities` are its own.
#[must_use]
pub fn outliers(table: &Table, quantities: &[Quantity]) -> Vec<Outlier> {
    let diagnosed: Vec<Rig<'_>> = table.rigs().filter(|rig| !rig.is_failed()).collect();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for name in diagnosed.iter().flat_map(Rig::effects) {
        *counts.entry(name).or_default() += 1;
    }
    let is_like = has_common_answer(&diagnosed);
    let mut found: Vec<Outlier> = Vec::new();
    for rig in table.rigs() {
        let mut reasons = by_answer(rig);
        if is_like && !rig.is_failed() {
            reasons.extend(by_effects(rig, &counts, diagnosed.len()));
        }
        let own = quantities.iter().filter_map(|quantity| far_value(rig.name(), quantity));
        reasons.extend(own.map(|far| Reason::Value(Box::new(far))));
        reasons.sort_by(|one, other| one.rank().cmp(&other.rank()).then(other.distance().total_cmp(&one.distance())));
        if !reasons.is_empty() {
            found.push(Outlier { rig: rig.name().to_owned(), reasons });
        }
    }
    let grave =
        |outlier: &Outlier| outlier.reasons.first().map_or((u8::MAX, 0.0), |first| (first.rank(), first.distance()));
    found.sort_by(|one, other| {
        let (one, other) = (grave(one), grave(other));
        one.0.cmp(&other.0).then(other.1.total_cmp(&one.1))
    });
    found
}

/// Whether so many of `rigs` name the same effects that others stand out of them.
fn has_common_answer(rigs: &[Rig<'_>]) -> bool {
    let mut counts: BTreeMap<Vec<&str>, usize> = BTreeMap::new();
    for rig in rigs {
        let mut names = rig.effects();
        names.sort_unstable();
        *counts.entry(names).or_default() += 1;
    }
    let most = counts.values().max().copied().unwrap_or_default();
    rigs.len() >= MIN_RIGS && most as f64 >= COMMON_SHARE * rigs.len() as f64
}

fn by_answer(rig: Rig<'_>) -> Vec<Reason> {
    if rig.is_failed() {
        return vec![Reason::Failed(rig.head().error.clone())];
    }
    if rig.effects().contains(&"unknown") { vec![Reason::Unknown] } else { Vec::new() }
}

/// Effects that it alone has or lacks; `counts` says how many of the `of` rigs have each.
fn by_effects(rig: Rig<'_>, counts: &BTreeMap<&str, usize>, of: usize) -> Vec<Reason> {
    let (own, mut reasons) = (rig.effects(), Vec::new());
    let share = |count: usize| count as f64 / of as f64;
    for (name, &count) in counts.iter().filter(|(name, _)| **name != "unknown") {
        let is_named = own.contains(name);
        if is_named && share(count) <= RARE_SHARE {
            reasons.push(Reason::RareEffect((*name).to_owned(), count, of));
        }
        if !is_named && share(count) >= USUAL_SHARE {
            reasons.push(Reason::LacksEffect((*name).to_owned(), count, of));
        }
    }
    reasons
}

fn far_value(rig: &str, quantity: &Quantity) -> Option<FarValue> {
    let point = quantity.points.iter().find(|point| point.rig == rig && point.z.abs() > MAX_Z)?;
    Some(FarValue { quantity: Quantity { points: Vec::new(), ..quantity.clone() }, point: point.clone() })
}

impl Reason {
    /// How grave it is, 0 the gravest.
    fn rank(&self) -> u8 {
        match self {
            Self::Failed(_) => 0,
            Self::Unknown => 1,
            Self::RareEffect(..) | Self::LacksEffect(..) => 2,
            Self::Value(_) => 3,
        }
    }

    /// How far a value is, 0 of any other reason.
    fn distance(&self) -> f64 {
        match self {
            Self::Value(far) => far.point.z.abs(),
            _ => 0.0,
        }
    }
}

/// A value's name for people: the key of the rig file, or that of its effect and its own.
#[must_use]
pub fn label(effect: &str, parameter: &str) -> String {
    match effect {
        NOMINAL => parameter.to_owned(),
        RESIDUAL => "residual over noise".to_owned(),
        effect => format!("{}: {}", effect_name(effect), parameter.replace('_', " ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fleet::table::tests::{failed, result};
    use crate::fleet::worker::RigResult;

    /// `count` alike rigs with a gravity load of about 2 N, named by their numbers.
    fn alike(count: usize) -> Vec<RigResult> {
        let load = |at: usize| 2.0 + 0.01 * (at % 5) as f64;
        (0..count).map(|at| result(&format!("r{at}"), &[("gravity_load", load(at), 0.02)], 300.0)).collect()
    }

    fn found(results: &[RigResult]) -> Vec<Outlier> {
        let table = Table::of(results);
        outliers(&table, &quantities(&table))
    }

    #[test]
    fn alike_rigs_do_not_stand_out_and_a_far_value_does() {
        assert_eq!(found(&alike(10)), []);
        let mut rigs = alike(10);
        rigs[3] = result("r3", &[("gravity_load", 2.4, 0.02)], 300.0);
        let outliers = found(&rigs);
        let [Outlier { rig, reasons }] = outliers.as_slice() else { panic!("{outliers:?}") };
        let [Reason::Value(far)] = reasons.as_slice() else { panic!("{reasons:?}") };
        assert_eq!((rig.as_str(), far.quantity.effect.as_str()), ("r3", "gravity_load"));
        // By hand: median 2.02, median absolute deviation 0.015, standard error 0.02 / 1.96.
        let expected = (2.4 - 2.02) / (0.022_239_f64.powi(2) + (0.02_f64 / 1.96).powi(2)).sqrt();
        assert!((far.point.z - expected).abs() < 1e-6 * expected, "{}", far.point.z);
        assert!((far.quantity.median - 2.02).abs() < 1e-12);
    }

    #[test]
    fn a_value_that_is_not_known_well_does_not_stand_out() {
        let mut rigs = alike(10);
        rigs[3] = result("r3", &[("gravity_load", 2.4, 0.4)], 300.0);
        assert_eq!(found(&rigs), []);
    }

    #[test]
    fn values_of_the_rig_file_are_held_against_what_it_states() {
        let table = Table::of(&alike(9));
        let all = quantities(&table);
        let stiffness = all.iter().find(|quantity| quantity.parameter == "stiffness_n_m").unwrap();
        assert!(stiffness.is_relative && stiffness.unit == "1");
        assert_eq!((stiffness.median, stiffness.points.len()), (1.0, 9));
    }

    #[test]
    fn rare_and_lacking_effects_stand_out_of_enough_rigs() {
        let rare = |count: usize| {
            let mut rigs = alike(count);
            rigs[0] = result("r0", &[("backlash", 1.0, 0.1)], 300.0);
            found(&rigs)
        };
        let reasons = &rare(10)[0].reasons;
        assert!(reasons.contains(&Reason::RareEffect("backlash".to_owned(), 1, 10)), "{reasons:?}");
        assert!(reasons.contains(&Reason::LacksEffect("gravity_load".to_owned(), 9, 10)), "{reasons:?}");
        assert_eq!(rare(MIN_RIGS - 1), []);
        // Two of ten are a fifth: neither rare nor usual.
        let mut rigs = alike(10);
        rigs[0] = result("r0", &[("backlash", 1.0, 0.1)], 300.0);
        rigs[1] = result("r1", &[("backlash", 1.0, 0.1)], 300.0);
        assert_eq!(found(&rigs), []);
    }

    #[test]
    fn where_no_answer_is_common_no_effect_is_rare() {
        let unlike = |common: usize| {
            let mut rigs = alike(12);
            for (at, rig) in rigs.iter_mut().enumerate().skip(common) {
                *rig = result(&format!("r{at}"), &[(&format!("effect_{at}"), 1.0, 0.1)], 300.0);
            }
            found(&rigs).len()
        };
        assert_eq!((unlike(6), unlike(5)), (6, 0));
    }

    #[test]
    fn failures_come_first_then_the_unknown_then_the_farthest() {
        let mut rigs = alike(30);
        rigs[5] = result("r5", &[("gravity_load", 2.3, 0.02)], 300.0);
        rigs[6] = result("r6", &[("gravity_load", 2.9, 0.02)], 300.0);
        rigs[7] = result("r7", &[("gravity_load", 2.0, 0.02), ("unknown", 1.0, 0.1)], 300.0);
        rigs[8] = failed("r8", "no such file");
        let names: Vec<String> = found(&rigs).into_iter().map(|outlier| outlier.rig).collect();
        assert_eq!(names, ["r8", "r7", "r6", "r5"]);
    }
}
