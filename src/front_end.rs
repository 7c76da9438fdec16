//! From sensor readings to rows of the regression.

mod contact_detector;
mod contact_model;
mod low_pass;
mod model_stream;
mod samples;
mod units;

pub use contact_detector::{ContactDetectorConfig, ContactDetectorState};
pub use contact_model::{ContactModel, MAX_PARAMETERS, contact_plane};
pub use low_pass::{LowPass, LowPassState};
pub use model_stream::{ModelStream, RegressionRow};
pub use samples::{Field, FrontEnd, FrontEndConfig, FrontEndState, Reading, Rejection, Velocity};
pub use units::Units;
