//! Which of the estimators run.

use crate::estimator_bank::method::Method;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// A set of methods.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Methods(u16);

impl Methods {
    /// With `method` in it.
    #[must_use]
    pub const fn with(self, method: Method) -> Self {
        Self(self.0 | method.bit())
    }

    /// How many are in it.
    pub const fn count(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether `method` is in it.
    pub const fn contains(self, method: Method) -> bool {
        self.0 & method.bit() != 0
    }

    /// Those in it, in the order of [`Method::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Method> {
        Method::ALL.into_iter().filter(move |method| self.contains(*method))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_methods_of_a_set_come_in_their_order() {
        let set = Methods::default().with(Method::DirectionalRls).with(Method::Ewrls).with(Method::Bls);
        assert!(set.iter().eq([Method::Ewrls, Method::Bls, Method::DirectionalRls]));
        assert!(Methods::default().iter().eq([]));
    }
}
