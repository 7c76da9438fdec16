//! Effects: their tables in a rig file, what they do to a simulated trial, and `palpate effects`.

#[path = "effects/bench.rs"]
mod bench;
#[path = "effects/contact.rs"]
mod contact;
#[path = "effects/drive.rs"]
mod drive;
#[path = "effects/listing.rs"]
mod listing;
#[path = "effects/sensor.rs"]
mod sensor;
#[path = "effects/table.rs"]
mod table;
#[path = "effects/together.rs"]
mod together;
