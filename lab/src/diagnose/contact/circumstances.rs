//! What is known of recordings of a contact beside their rows.

/// What bounds the search beside the recordings.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Circumstances {
    /// Whether the tool moves at one speed each way and never stays at a depth.
    pub is_one_speed: bool,
    /// Effects of the force sensor that the drive speaks against: it felt the force as it was read.
    pub refuted: Vec<&'static str>,
}
