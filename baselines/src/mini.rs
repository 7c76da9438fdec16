//! By minikalman, its buffers on the heap: its builder for others is a macro for statics.

use minikalman::prelude::*;
use minikalman::regular::builder::KalmanFilterBuilder;
use palpate::{Impedance, Observation};

use crate::{COVARIANCE, FORGETTING};

/// A Kalman filter of two numbers that stand still; what it returns takes one observation.
pub fn minikalman() -> impl FnMut(&Observation) -> Impedance {
    let builder = KalmanFilterBuilder::<2, f32>::default();
    let mut filter = builder.build();
    let mut measured = builder.observations().build::<1>();
    filter.state_transition_mut().apply(|f| {
        f.set_at(0, 0, 1.0);
        f.set_at(1, 1, 1.0);
    });
    filter.estimate_covariance_mut().apply(|p| {
        p.set_at(0, 0, COVARIANCE);
        p.set_at(1, 1, COVARIANCE);
    });
    measured.measurement_noise_covariance_mut().apply(|r| r.set_at(0, 0, FORGETTING));
    move |o| {
        measured.observation_matrix_mut().apply(|h| {
            h.set_at(0, 0, o.penetration);
            h.set_at(0, 1, o.rate);
        });
        measured.measurement_vector_mut().apply(|z| z.set_at(0, 0, o.force));
        filter.correct(&mut measured);
        filter.estimate_covariance_mut().apply(|p| {
            for entry in p.as_mut_slice() {
                *entry /= FORGETTING;
            }
        });
        let theta = filter.state_vector().as_matrix();
        Impedance { stiffness: theta.get_at(0, 0), damping: theta.get_at(1, 0) }
    }
}
