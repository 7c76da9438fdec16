//! By adskalman.

use adskalman::{CovarianceUpdateMethod, ObservationModel, StateAndCovariance};
use nalgebra::{Matrix1, Matrix2, OMatrix, RowVector2, U1, U2, Vector1, Vector2};
use palpate::{Impedance, Observation};

use crate::{COVARIANCE, FORGETTING};

/// The measurement of one observation.
struct Row {
    h: RowVector2<f32>,
    transposed: Vector2<f32>,
    noise: Matrix1<f32>,
}

impl ObservationModel<f32, U2, U1> for Row {
    fn H(&self) -> &OMatrix<f32, U1, U2> {
        &self.h
    }

    fn HT(&self) -> &OMatrix<f32, U2, U1> {
        &self.transposed
    }

    fn R(&self) -> &OMatrix<f32, U1, U1> {
        &self.noise
    }
}

/// A Kalman filter of two numbers that stand still.
pub struct Adskalman(StateAndCovariance<f32, U2>);

impl Default for Adskalman {
    fn default() -> Self {
        Self(StateAndCovariance::new(Vector2::zeros(), Matrix2::identity() * COVARIANCE))
    }
}

impl Adskalman {
    /// One observation.
    pub fn update(&mut self, o: &Observation) -> Impedance {
        let h = RowVector2::new(o.penetration, o.rate);
        let row = Row { h, transposed: h.transpose(), noise: Matrix1::new(FORGETTING) };
        if let Ok(next) =
            row.update(&self.0, &Vector1::new(o.force), CovarianceUpdateMethod::OptimalKalmanForcedSymmetric)
        {
            self.0 = StateAndCovariance::new(*next.state(), next.covariance() / FORGETTING);
        }
        let theta = self.0.state();
        Impedance { stiffness: theta.x, damping: theta.y }
    }
}
