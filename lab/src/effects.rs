//! The physics that a rig's nominal model can lack, one effect a file.
//!
//! An effect is a named term that is off at zero: it changes what the contact bears ([`ContactState`]), what the drive has to
//! overcome ([`DriveState`]), or what the force sensor makes of the force ([`Reading`]). It is written once and runs in two
//! places: along a recorded motion, when `diagnose` asks what it would have changed, and in `palpate simulate`.
//!
//! To add one: write a file with a [`EffectSpec`] and an [`Effect`], and name it in [`ALL`]. Nothing else knows the list.

mod contact;
pub mod contact_simulator;
mod contact_state;
mod cubic_segment;
mod drive;
mod drive_state;
mod effect_spec;
mod excitation_stats;
mod first_order_lag;
mod foundation;
mod reading;
mod resolved;
mod sensor;

pub use contact::hysteresis::{HYSTERESIS_BETWEEN, HYSTERESIS_SLIP};
pub use contact::layered_stiffness::LAYERS_OF_FORMS;
pub use contact::learned::{LEARNED_FORM, LEARNED_KNOTS};
pub use contact::learned_damping::{DAMPING_BY_SPEED, DAMPING_BY_SPEED_AND_DEPTH, DAMPING_KNOTS};
pub use contact_simulator::{ActiveEffect, ContactSimulator};
pub use contact_state::{ContactState, gate, ramp, rounded};
pub use drive::cogging::{MOST_PATTERNS, waves};
pub use drive::transmission_compliance::MOST_DAMPING_RATIO;
pub use drive_state::DriveState;
pub use effect_spec::{EffectSpec, Form, Limit, Parameter, Place, Stage, key_of, slug};
pub use excitation_stats::{ExcitationStats, FrequencySearch, Start, ToneWeight, geometric, linear};
pub use first_order_lag::lagged;
pub use foundation::Foundation;
pub use reading::Reading;
pub use resolved::{Resolved, interval_key, resolve_all, to_table};
pub use sensor::mains_hum::MAINS_TOLERANCE;
pub use sensor::parasitic_force::{PARASITIC_BY_PLACE, PARASITIC_BY_SPEED, parasitic_powers};

/// The internal state of an effect with state, from one sample to the next; all zero at the start of a trial. Each effect says what
/// its entries mean.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EffectState([f64; STATE_SIZE]);

/// Entries of an effect's state: as many as the effect with the most of them needs.
const STATE_SIZE: usize = 25;

impl std::ops::Deref for EffectState {
    type Target = [f64; STATE_SIZE];

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl std::ops::DerefMut for EffectState {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.0
    }
}

/// Physics beyond the nominal model.
pub trait Effect: Sync {
    /// What it is called and what is known of it.
    fn spec(&self) -> &'static EffectSpec;

    /// Where a search for its parameters starts, for form `form`, in the measures of `scene`.
    fn starts(&self, form: usize, scene: &ExcitationStats) -> Vec<Start>;

    /// Laws of which one has to be there for form `form` to differ from a simpler one; none where it always does.
    fn builds_on(&self, _form: usize) -> &'static [Foundation] {
        &[]
    }

    /// The simpler form that form `form` is where none of what it builds on is there, and its values from `values` beside a spring of
    /// `stiffness`: the same law, or the nearest to it.
    fn simpler(&self, _form: usize, _values: &[f64], _stiffness: f64) -> Option<(usize, Vec<f64>)> {
        None
    }

    /// Name, form and values of another effect that form `form` is where one of its `values` is zero; `None` where there is none.
    fn special_case(&self, _form: usize, _values: &[f64]) -> Option<(&'static str, usize, Vec<f64>)> {
        None
    }

    /// The form that holds form `form` with `values` as a special case and one feature more, with values that its search starts from;
    /// `None` where there is none.
    fn refined(&self, _form: usize, _values: &[f64], _scene: &ExcitationStats) -> Option<(usize, Vec<Vec<f64>>)> {
        None
    }

    /// How many multiples of its frequency, itself the first, a form that repeats in time has.
    fn harmonics(&self, _form: usize) -> usize {
        1
    }

    /// Whether the force may fall on the way in by form `form`, and rise again: over a click, or where a dome snaps through.
    fn may_fall(&self, _form: usize) -> bool {
        false
    }

    /// Whether form `form` with `values` is what the effect's statement says, and no other law in its clothes, where the tool goes
    /// `deepest` below the surface, m or rad.
    fn is_itself(&self, _form: usize, _values: &[f64], _deepest: f64) -> bool {
        true
    }

    /// For a form that repeats in time: where to look for its frequency. Its `starts` are then empty.
    fn frequency_search(&self, _form: usize, _scene: &ExcitationStats) -> Option<FrequencySearch> {
        None
    }

    /// Frequencies, Hz, of which it has one where it is a line of the spectrum, as a tone of the mains is: no law of a contact has one.
    fn lines(&self) -> &'static [f64] {
        &[]
    }

    /// Acts on the contact. `values` are in the order of the form's parameters.
    fn act_on_contact(&self, _form: usize, _values: &[f64], _state: &mut EffectState, _touch: &mut ContactState) {}

    /// Acts on the drive.
    fn act_on_drive(&self, _form: usize, _values: &[f64], _state: &mut EffectState, _push: &mut DriveState) {}

    /// The estimator of the library that follows it on the drive, with its regressor; `None` where none does.
    fn on_drive(&self) -> Option<&'static str> {
        None
    }

    /// Acts on the reading of the force sensor, over a whole trial.
    fn act_on_reading(&self, _form: usize, _values: &[f64], _reading: &mut Reading<'_>) {}
}

/// Every effect, in the order in which `palpate effects` lists them.
pub static ALL: [&dyn Effect; 30] = [
    &contact::nonlinear_stiffness::NonlinearStiffness,
    &contact::layered_stiffness::LayeredStiffness,
    &contact::hunt_crossley_damping::HuntCrossleyDamping,
    &contact::quadratic_damping::QuadraticDamping,
    &contact::stress_relaxation::StressRelaxation,
    &contact::hysteresis::Hysteresis,
    &contact::plastic_set::PlasticSet,
    &contact::adhesion::Adhesion,
    &contact::lost_motion::LostMotion,
    &contact::time_varying_stiffness::TimeVaryingStiffness,
    &contact::surface_motion::SurfaceMotion,
    &contact::environment_mass::EnvironmentMass,
    &drive::coulomb_friction::CoulombFriction,
    &drive::stribeck_friction::StribeckFriction,
    &drive::sublinear_friction::SublinearFriction,
    &drive::load_dependent_friction::LoadDependentFriction,
    &drive::gravity_load::GravityLoad,
    &drive::cogging::Cogging,
    &drive::backlash::Backlash,
    &drive::transmission_compliance::TransmissionCompliance,
    &drive::effort_saturation::EffortSaturation,
    &drive::effort_lag::EffortLag,
    &sensor::force_bias::ForceBias,
    &sensor::force_drift::ForceDrift,
    &sensor::tool_inertia::ToolInertia,
    &sensor::channel_delay::ChannelDelay,
    &sensor::force_lag::ForceLag,
    &sensor::force_saturation::ForceSaturation,
    &sensor::force_gain::ForceGain,
    &sensor::mains_hum::MainsHum,
];

/// The element for what no effect explains. It is none of [`ALL`]: no search asks for it, and no list names it.
pub static LEARNED: &contact::learned::Learned = &contact::learned::Learned;

/// The same for what goes with the speed in contact.
pub static LEARNED_DAMPING: &contact::learned_damping::LearnedDamping = &contact::learned_damping::LearnedDamping;

/// A force of free motion at the sensor. It is none of [`ALL`]: that something pulls is known of it, and not what.
pub static PARASITIC_FORCE: &sensor::parasitic_force::ParasiticForce = &sensor::parasitic_force::ParasiticForce;

/// The effect of that name.
#[must_use]
pub fn find(name: &str) -> Option<&'static dyn Effect> {
    let unlisted: [&dyn Effect; 3] = [LEARNED, LEARNED_DAMPING, PARASITIC_FORCE];
    ALL.into_iter().chain(unlisted).find(|effect| effect.spec().name == name)
}
