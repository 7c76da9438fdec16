//! What the front end keeps from sample to sample.

use crate::contact::Observation;
use crate::front_end::contact_detector::ContactDetectorState;
use crate::front_end::low_pass::LowPassState;
use crate::front_end::previous_sample::PreviousSample;

/// State of the filters and of the contact detection, and the previous sample.
#[derive(Debug, Clone, Copy, Default)]
pub struct FrontEndState {
    pub(super) previous: PreviousSample,
    /// There is a previous sample.
    pub(super) begun: bool,
    /// The filters have taken no input since they began anew.
    pub(super) filters_empty: bool,
    /// There is a previous sample, the filters have taken one, and no time was skipped: what the usual sample asks for, in one.
    pub(super) running: bool,
    pub(super) skipped: f32,
    pub(super) penetration: LowPassState,
    pub(super) rate: LowPassState,
    pub(super) force: LowPassState,
    pub(super) contact_detector: ContactDetectorState,
}

impl FrontEndState {
    /// Filters at rest in the first row whose rate is known. The model holds between their states from then on, so a tool
    /// that is already moving causes no transient; what stays for a settling time is the noise of this one row.
    pub(super) fn start_filters(&mut self, row: &Observation) {
        self.penetration = LowPassState::at_rest(row.penetration);
        self.rate = LowPassState::at_rest(row.rate);
        self.force = LowPassState::at_rest(row.force);
        self.filters_empty = false;
    }
}
