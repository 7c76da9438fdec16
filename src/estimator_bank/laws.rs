//! The laws of all methods, each with its state, and the one of a method by its name.

use crate::block::{AdaptiveWindow, BlockLeastMeanFourth, BlockLeastMeanSquare, BlockLeastSquares};
use crate::estimator_bank::config::BANK_WINDOW;
use crate::estimator_bank::method::Method;
use crate::estimator_bank::validated_laws::ValidatedLaws;
use crate::quality::{Estimate, Flags};
use crate::recursive::{CusumRls, DirectionalRls, Ewrls, Gradient, ResetRls, Sprls};
use crate::stream::{EstimatorState, Event, Stream};
use crate::update_law::UpdateLaw;

/// One law of each kind with its state. The laws and states of methods that do not run are out of date: [`Laws::configure`]
/// renews those that will.
#[derive(Debug, Clone)]
pub struct Laws {
    rls: EstimatorState<Ewrls>,
    ewrls: EstimatorState<Ewrls>,
    sprls: EstimatorState<Sprls>,
    reset_rls: EstimatorState<ResetRls>,
    gradient: EstimatorState<Gradient>,
    bls: EstimatorState<BlockLeastSquares>,
    blms: EstimatorState<BlockLeastMeanSquare>,
    blmf: EstimatorState<BlockLeastMeanFourth>,
    newton_blmf: EstimatorState<BlockLeastMeanFourth>,
    cusum_rls: EstimatorState<CusumRls>,
    adaptive_bls: EstimatorState<AdaptiveWindow>,
    directional_rls: EstimatorState<DirectionalRls>,
}

/// What to do with the law of a method, whatever its type.
macro_rules! with_law {
    ($laws:expr, $method:expr, $law:ident => $todo:expr) => {
        with_law!(@ $laws, $method, $law, $todo, Rls rls, Ewrls ewrls, Sprls sprls, ResetRls reset_rls, Gradient gradient, Bls bls,
            Blms blms, Blmf blmf, NewtonBlmf newton_blmf, CusumRls cusum_rls, AdaptiveBls adaptive_bls,
            DirectionalRls directional_rls)
    };
    (@ $laws:expr, $method:expr, $law:ident, $todo:expr, $($name:ident $field:ident),+) => {
        match $method {
            $(Method::$name => {
                let $law = &mut $laws.$field;
                $todo
            })+
        }
    };
}

impl Laws {
    /// Each at its start.
    pub fn new(laws: &ValidatedLaws) -> Self {
        Self {
            rls: EstimatorState::new(laws.rls),
            ewrls: EstimatorState::new(laws.ewrls),
            sprls: EstimatorState::new(laws.sprls),
            reset_rls: EstimatorState::new(laws.reset_rls),
            gradient: EstimatorState::new(laws.gradient),
            bls: EstimatorState::new(laws.bls),
            blms: EstimatorState::new(laws.blms),
            blmf: EstimatorState::new(laws.blmf),
            newton_blmf: EstimatorState::new(laws.newton_blmf),
            cusum_rls: EstimatorState::new(laws.cusum_rls),
            adaptive_bls: EstimatorState::new(laws.adaptive_bls),
            directional_rls: EstimatorState::new(laws.directional_rls),
        }
    }

    /// Replaces the law of `method` and begins its state anew.
    pub fn configure(&mut self, method: Method, laws: &ValidatedLaws) {
        match method {
            Method::Rls => self.rls.configure(laws.rls),
            Method::Ewrls => self.ewrls.configure(laws.ewrls),
            Method::Sprls => self.sprls.configure(laws.sprls),
            Method::ResetRls => self.reset_rls.configure(laws.reset_rls),
            Method::Gradient => self.gradient.configure(laws.gradient),
            Method::Bls => self.bls.configure(laws.bls),
            Method::Blms => self.blms.configure(laws.blms),
            Method::Blmf => self.blmf.configure(laws.blmf),
            Method::NewtonBlmf => self.newton_blmf.configure(laws.newton_blmf),
            Method::CusumRls => self.cusum_rls.configure(laws.cusum_rls),
            Method::AdaptiveBls => self.adaptive_bls.configure(laws.adaptive_bls),
            Method::DirectionalRls => self.directional_rls.configure(laws.directional_rls),
        }
    }

    /// Begins the state of `method` anew.
    pub fn restart(&mut self, method: Method) {
        with_law!(self, method, law => law.restart());
    }

    /// [`EstimatorState::update`] of `method`.
    pub fn update(&mut self, method: Method, stream: &Stream<BANK_WINDOW>, event: &Event) -> Estimate {
        with_law!(self, method, law => law.update(stream, event))
    }

    /// [`EstimatorState::settle`] of `method`.
    pub fn settle(&mut self, method: Method, stream: &Stream<BANK_WINDOW>, event: &Event) -> Option<Estimate> {
        with_law!(self, method, law => law.settle(stream, event))
    }

    /// [`EstimatorState::learn`] of `method`.
    pub fn learn(&mut self, method: Method, stream: &Stream<BANK_WINDOW>, flags: Flags) -> Estimate {
        with_law!(self, method, law => learn(law, stream, flags))
    }
}

/// Each law's own function: together they would all pay for the registers and the stack of the longest.
#[inline(never)]
fn learn<L: UpdateLaw>(law: &mut EstimatorState<L>, stream: &Stream<BANK_WINDOW>, flags: Flags) -> Estimate {
    law.learn(stream, flags)
}
