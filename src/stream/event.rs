//! What a sample meant to the contact.

use crate::front_end::Reading;
use crate::quality::Flags;

/// What a sample meant to the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// The reading.
    pub reading: Reading,
    /// Contact was lost at this sample.
    pub lost: bool,
    /// [`Flags::RESTARTED`] and [`Flags::LITTLE_MOVEMENT`] where they hold.
    pub flags: Flags,
}
