//! What every estimator is: settings that turn a state and the newest observation into the next estimate.

use crate::quality::Step;
use crate::window::Recent;

/// An estimation law. The implementor is the checked configuration; what it has learnt is in `State`.
///
/// All numbers are in internal units ([`crate::Units`]). Observations are finite and at most
/// [`crate::FrontEnd::MAX_MAGNITUDE`] in size; under that condition no update leaves the state non-finite.
pub trait UpdateLaw {
    /// What is learnt.
    type State: Clone + core::fmt::Debug;

    /// The state before the first observation of a contact.
    fn initial_state(&self) -> Self::State;

    /// Forgets what the estimate rests on (covariance, noise, window) but keeps the estimate itself.
    fn reset_memory(&self, state: &mut Self::State);

    /// How many of the latest observations it uses; 1 for a recursive law.
    fn window(&self) -> usize;

    /// One update. The newest of `recent` is new; the older ones were given before, in this order. A law on a window
    /// that finds another number of them than it has followed sums them anew, once, at a cost that grows with the window.
    fn update(&self, state: &mut Self::State, recent: Recent<'_>) -> Step;
}
