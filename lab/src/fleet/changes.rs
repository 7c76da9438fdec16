//! What changed between two tables of one fleet.

use std::collections::BTreeMap;

use super::row::Row;
use super::table::{Rig, Table};

/// One difference between an earlier answer and this one.
#[derive(Debug, Clone, PartialEq)]
pub enum Change {
    /// It could be diagnosed before; why it cannot any more.
    Failed(String),
    /// It was in the earlier table and is in this one no more.
    Gone,
    /// Its verdict, before and after.
    Verdict(String, String),
    /// An effect is named that was not.
    Named(String),
    /// An effect is not named any more.
    NoLongerNamed(String),
    /// A value has left its interval.
    Value(ValueChange),
    /// It could not be diagnosed before; its verdict.
    Recovered(String),
    /// It was not in the earlier table; its verdict, empty where it failed.
    New(String),
}

/// A value whose two 95 % intervals have no point in common.
#[derive(Debug, Clone, PartialEq)]
pub struct ValueChange {
    /// The effect, or [`super::row::NOMINAL`].
    pub effect: String,
    /// Name of the value.
    pub parameter: String,
    /// Its unit.
    pub unit: String,
    /// Estimate, lower and upper end before.
    pub before: [f64; 3],
    /// The same now.
    pub after: [f64; 3],
}

/// The changes of one rig, gravest first.
#[derive(Debug, Clone, PartialEq)]
pub struct RigChanges {
    /// Name of the rig.
    pub rig: String,
    /// At least one.
    pub changes: Vec<Change>,
}

/// The changes of a fleet.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Comparison {
    /// Rigs that changed, gravest first, in the order of the table where equally grave.
    pub rigs: Vec<RigChanges>,
    /// Rigs that could be diagnosed both times.
    pub compared: usize,
    /// How many of those have the very same inputs as before.
    pub same_inputs: usize,
    /// Values that were compared.
    pub values: usize,
}

/// Compares `after` with `before`, rigs by their names.
#[must_use]
pub fn compare(before: &Table, after: &Table) -> Comparison {
    let earlier: BTreeMap<&str, Rig<'_>> = before.rigs().map(|rig| (rig.name(), rig)).collect();
    let mut comparison = Comparison::default();
    for rig in after.rigs() {
        let changes = match earlier.get(rig.name()) {
            None => vec![Change::New(rig.head().verdict.clone())],
            Some(before) => comparison.of_rig(*before, rig),
        };
        comparison.note(rig.name(), changes);
    }
    for rig in before.rigs().filter(|rig| !after.rigs().any(|other| other.name() == rig.name())) {
        comparison.note(rig.name(), vec![Change::Gone]);
    }
    comparison.rigs.sort_by_key(|rig| rig.changes.first().map(Change::rank));
    comparison
}

impl Comparison {
    fn note(&mut self, rig: &str, mut changes: Vec<Change>) {
        changes.sort_by(|one, other| one.rank().cmp(&other.rank()).then(other.distance().total_cmp(&one.distance())));
        if !changes.is_empty() {
            self.rigs.push(RigChanges { rig: rig.to_owned(), changes });
        }
    }

    fn of_rig(&mut self, before: Rig<'_>, after: Rig<'_>) -> Vec<Change> {
        match (before.is_failed(), after.is_failed()) {
            (true, true) => return Vec::new(),
            (true, false) => return vec![Change::Recovered(after.head().verdict.clone())],
            (false, true) => return vec![Change::Failed(after.head().error.clone())],
            (false, false) => {}
        }
        self.compared += 1;
        self.same_inputs += usize::from(before.head().inputs_sha256 == after.head().inputs_sha256);
        let mut changes = Vec::new();
        if before.head().verdict != after.head().verdict {
            changes.push(Change::Verdict(before.head().verdict.clone(), after.head().verdict.clone()));
        }
        let (old, new) = (before.effects(), after.effects());
        let absent = |names: &[&str], from: &[&str]| -> Vec<String> {
            names.iter().filter(|name| !from.contains(name)).map(|name| (*name).to_owned()).collect()
        };
        changes.extend(absent(&new, &old).into_iter().map(Change::Named));
        changes.extend(absent(&old, &new).into_iter().map(Change::NoLongerNamed));
        let old: BTreeMap<_, &Row> = keyed(before).into_iter().collect();
        for (key, row) in keyed(after) {
            let Some(earlier) = old.get(&key) else { continue };
            self.values += 1;
            changes.extend(left_interval(earlier, row).map(Change::Value));
        }
        changes
    }
}

/// Effect, name, unit and number of a value.
type ValueKey<'a> = (&'a str, &'a str, &'a str, usize);

/// The values of `rig`, by effect, name, unit and number among those of the same name.
fn keyed(rig: Rig<'_>) -> Vec<(ValueKey<'_>, &Row)> {
    let mut counts = BTreeMap::new();
    rig.values()
        .map(|row| {
            let name = (row.effect.as_str(), row.parameter.as_str(), row.unit.as_str());
            let count = counts.entry(name).or_insert(0);
            *count += 1;
            ((name.0, name.1, name.2, *count), row)
        })
        .collect()
}

/// The change from `before` to `after` where their intervals are disjoint. An interval is open where it has no end.
fn left_interval(before: &Row, after: &Row) -> Option<ValueChange> {
    let of = |row: &Row| {
        let [low, high] = [row.ci95_low.unwrap_or(f64::NEG_INFINITY), row.ci95_high.unwrap_or(f64::INFINITY)];
        Some([row.value?, low, high])
    };
    let (old, new) = (of(before)?, of(after)?);
    let is_disjoint = old[2] < new[1] || new[2] < old[1];
    is_disjoint.then(|| ValueChange {
        effect: after.effect.clone(),
        parameter: after.parameter.clone(),
        unit: after.unit.clone(),
        before: old,
        after: new,
    })
}

impl Change {
    /// How grave it is, 0 the gravest.
    fn rank(&self) -> u8 {
        match self {
            Self::Failed(_) => 0,
            Self::Gone => 1,
            Self::Verdict(..) => 2,
            Self::Named(_) => 3,
            Self::NoLongerNamed(_) => 4,
            Self::Value(_) => 5,
            Self::Recovered(_) => 6,
            Self::New(_) => 7,
        }
    }

    /// How far a value went, in the half-widths of its intervals; 0 of any other change.
    fn distance(&self) -> f64 {
        match self {
            Self::Value(change) => change.distance(),
            _ => 0.0,
        }
    }
}

impl ValueChange {
    /// The change over the sum of both half-widths.
    #[must_use]
    pub fn distance(&self) -> f64 {
        let half = |[_, low, high]: [f64; 3]| 0.5 * (high - low);
        let ratio = (self.after[0] - self.before[0]).abs() / (half(self.before) + half(self.after));
        if ratio.is_nan() { 0.0 } else { ratio }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fleet::table::tests::{failed, result};

    /// The changes of the rigs of two nights.
    fn changes(before: &[crate::fleet::worker::RigResult], after: &[crate::fleet::worker::RigResult]) -> Comparison {
        compare(&Table::of(before), &Table::of(after))
    }

    fn one(before: &[(&str, f64, f64)], after: &[(&str, f64, f64)]) -> Vec<Change> {
        let found = changes(&[result("a", before, 300.0)], &[result("a", after, 300.0)]);
        found.rigs.into_iter().flat_map(|rig| rig.changes).collect()
    }

    #[test]
    fn the_same_answer_is_no_change() {
        let night = [result("a", &[("gravity_load", 2.0, 0.1)], 300.0), failed("b", "gone")];
        let found = changes(&night, &night);
        assert_eq!(found, Comparison { rigs: Vec::new(), compared: 1, same_inputs: 1, values: 2 });
    }

    #[test]
    fn a_value_changes_where_the_intervals_have_no_point_in_common() {
        assert_eq!(one(&[("gravity_load", 2.0, 0.1)], &[("gravity_load", 2.15, 0.1)]), []);
        assert_eq!(one(&[("gravity_load", 2.0, 0.1)], &[("gravity_load", 1.85, 0.1)]), []);
        for moved in [2.25, 1.75] {
            let found = one(&[("gravity_load", 2.0, 0.1)], &[("gravity_load", moved, 0.1)]);
            let [Change::Value(change)] = found.as_slice() else { panic!("{found:?}") };
            assert_eq!((change.effect.as_str(), change.before[0], change.after[0]), ("gravity_load", 2.0, moved));
            assert!((change.distance() - 1.25).abs() < 1e-9);
        }
        // Without an end there is nothing to leave.
        assert_eq!(one(&[("gravity_load", 2.0, f64::NAN)], &[("gravity_load", 9.0, 0.1)]), []);
        let nominal = changes(&[result("a", &[], 300.0)], &[result("a", &[], 303.0)]);
        assert!(matches!(&nominal.rigs[0].changes[..], [Change::Value(change)] if change.effect == "nominal"));
    }

    #[test]
    fn names_and_verdicts_that_come_and_go_are_changes() {
        let found = one(&[("backlash", 1.0, 0.1)], &[("gravity_load", 1.0, 0.1)]);
        assert_eq!(found, [Change::Named("gravity_load".to_owned()), Change::NoLongerNamed("backlash".to_owned())]);
        let found = one(&[], &[("backlash", 1.0, 0.1)]);
        assert_eq!(found[0], Change::Verdict("no_mismatch".to_owned(), "explained".to_owned()));
    }

    #[test]
    fn rigs_that_come_go_fail_and_recover_are_told_gravest_first() {
        let fine = |name| result(name, &[], 300.0);
        let found = changes(
            &[fine("a"), fine("b"), failed("c", "x"), fine("e")],
            &[fine("new"), failed("a", "no such file"), fine("c"), result("e", &[], 310.0)],
        );
        let told: Vec<(&str, &Change)> = found.rigs.iter().map(|rig| (rig.rig.as_str(), &rig.changes[0])).collect();
        assert_eq!(told[..2], [("a", &Change::Failed("no such file".to_owned())), ("b", &Change::Gone)]);
        assert!(matches!(told[2], ("e", Change::Value(_))));
        assert_eq!(
            told[3..],
            [("c", &Change::Recovered("no_mismatch".to_owned())), ("new", &Change::New("no_mismatch".to_owned())),]
        );
        assert_eq!((found.compared, found.same_inputs), (1, 1));
    }
}
