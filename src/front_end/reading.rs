//! What a sample amounts to.

use crate::contact::Observation;

/// What one accepted sample amounts to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// The row of the regression, in internal units.
    pub observation: Observation,
    /// The tool is in the surface.
    pub contact: bool,
    /// The filters began anew at this sample: it is the first, or comes after a gap. Its rate is not known, so it is no
    /// row of the regression.
    pub restarted: bool,
}
