//! A tuned number, and how one of them is varied to see what depends on it.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::OnceLock;

use crate::bound::Bound;
use crate::error::UsageError;
use crate::threshold_margin::{note_comparison, note_use};

/// Where a tuned number comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// It follows from the reason that stands beside it.
    Derived,
    /// It is taken from the literature or a standard.
    Cited,
    /// It was set by trial on recordings.
    Chosen,
}

impl Origin {
    /// As it stands in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Derived => "derived",
            Self::Cited => "cited",
            Self::Chosen => "chosen",
        }
    }
}

/// A tuned number. It is compared and reckoned with as the `f64` that [`Threshold::value`] gives.
#[derive(Debug, Clone, Copy)]
pub struct Threshold {
    /// Room and name: "contact.LEAST_GAIN".
    pub name: &'static str,
    /// The number, where nothing is varied.
    pub nominal: f64,
    /// Its unit; "1" of a ratio or a share.
    pub unit: &'static str,
    /// What it decides.
    pub meaning: &'static str,
    /// Where it comes from.
    pub origin: Origin,
}

/// The threshold that this process varies, and the factor.
static VARIED: OnceLock<(&'static str, f64)> = OnceLock::new();

impl Threshold {
    /// The number, to be reckoned with; times the factor of [`vary`] where it is this one that is varied.
    #[must_use]
    pub fn value(self) -> f64 {
        note_use(self.name);
        self.varied()
    }

    pub(crate) fn varied(self) -> f64 {
        match VARIED.get() {
            Some((name, factor)) if *name == self.name => self.nominal * factor,
            _ => self.nominal,
        }
    }
}

/// Multiplies the one of `known` that `setting`, NAME=FACTOR, names by the factor, for as long as this process runs.
///
/// # Errors
/// No such threshold, no positive factor, or another one is varied already.
pub fn vary(setting: &str, known: impl Iterator<Item = Threshold>) -> Result<(), UsageError> {
    let fault = |found: &str, expected: &str| UsageError::new("--vary", found.to_owned(), expected);
    let (name, factor) =
        setting.split_once('=').ok_or_else(|| fault(setting, "NAME=FACTOR, as contact.LEAST_GAIN=1.3"))?;
    let factor = factor
        .parse::<f64>()
        .ok()
        .filter(|factor| factor.is_finite() && *factor > 0.0)
        .ok_or_else(|| fault(factor, "a factor above zero"))?;
    let threshold = known
        .into_iter()
        .find(|threshold| threshold.name == name)
        .ok_or_else(|| fault(name, "a threshold that `palpate sweep-thresholds --list` has"))?;
    VARIED.set((threshold.name, factor)).map_err(|_| fault(setting, "one threshold in a process"))
}

impl PartialEq<Threshold> for f64 {
    fn eq(&self, other: &Threshold) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

impl PartialOrd<Threshold> for f64 {
    fn partial_cmp(&self, other: &Threshold) -> Option<Ordering> {
        note_comparison(other.name, *self / other.nominal);
        self.partial_cmp(&other.varied())
    }
}

/// Arithmetic of a number and a threshold, in both orders.
macro_rules! arithmetic {
    ($($operation:ident $method:ident),*) => {$(
        impl $operation<Threshold> for f64 {
            type Output = Bound;
            fn $method(self, other: Threshold) -> Bound {
                self.$method(Bound::of(other))
            }
        }

        impl $operation<f64> for Threshold {
            type Output = Bound;
            fn $method(self, other: f64) -> Bound {
                Bound::of(self).$method(other)
            }
        }
    )*};
}

arithmetic!(Add add, Sub sub, Mul mul);

impl Div<f64> for Threshold {
    type Output = Bound;
    fn div(self, other: f64) -> Bound {
        Bound::of(self) / other
    }
}

impl Div<Threshold> for f64 {
    type Output = f64;
    fn div(self, other: Threshold) -> f64 {
        self / other.value()
    }
}

impl Neg for Threshold {
    type Output = Bound;
    fn neg(self) -> Bound {
        -Bound::of(self)
    }
}

/// Thresholds of one room, `NAME = value, unit, origin;` each below its meaning, and `ALL` of them.
macro_rules! thresholds {
    ($room:literal; $($(#[doc = $line:literal])+ $name:ident = $value:expr, $unit:literal, $origin:ident;)+) => {
        $(
            $(#[doc = $line])+
            #[doc = concat!("\nUnit: ", $unit, "; ", stringify!($origin), ".")]
            pub const $name: $crate::threshold::Threshold = $crate::threshold::Threshold {
                name: concat!($room, ".", stringify!($name)),
                nominal: $value,
                unit: $unit,
                meaning: concat!($($line),+),
                origin: $crate::threshold::thresholds!(@ $origin),
            };
        )+

        /// All of this room.
        pub const ALL: &[$crate::threshold::Threshold] = &[$($name),+];
    };
    (@ derived) => { $crate::threshold::Origin::Derived };
    (@ cited) => { $crate::threshold::Origin::Cited };
    (@ chosen) => { $crate::threshold::Origin::Chosen };
}
pub(crate) use thresholds;

#[cfg(test)]
mod tests {
    use super::*;

    const RATIO: Threshold =
        Threshold { name: "test.RATIO", nominal: 2.0, unit: "1", meaning: " A ratio.", origin: Origin::Chosen };

    #[test]
    fn a_threshold_is_reckoned_with_as_its_number() {
        assert!(1.9 < RATIO && 2.0 >= RATIO && 2.1 > RATIO && f64::NAN.partial_cmp(&RATIO).is_none());
        let bounds = [3.0 * RATIO, RATIO * 3.0, RATIO - 0.5, 0.5 - RATIO, RATIO + 1.0, RATIO / 4.0, -RATIO];
        assert_eq!(bounds.map(Bound::value), [6.0, 6.0, 1.5, -1.5, 3.0, 0.5, -2.0]);
        assert_eq!(4.0 / RATIO, 2.0);
    }

    #[test]
    fn what_is_no_setting_of_a_threshold_is_refused() {
        let refused = |setting: &str| vary(setting, std::iter::once(RATIO)).unwrap_err().to_string();
        assert!(refused("test.RATIO").contains("NAME=FACTOR"));
        for setting in ["test.RATIO=0", "test.RATIO=-1", "test.RATIO=nan", "test.RATIO=x"] {
            assert!(refused(setting).contains("a factor above zero"), "{setting}");
        }
        assert!(refused("test.OTHER=1.3").contains("found test.OTHER"));
        assert_eq!(RATIO.value(), 2.0);
    }
}
