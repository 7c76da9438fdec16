//! The drive image in QEMU, as a user of its link sees it.
//!
//! Without the cross target or QEMU these tests say so and pass, unless `PALPATE_DEVICE=required` (as `cargo verify`
//! sets it where it has set them up).

#[path = "drive/cli.rs"]
mod cli;
#[path = "drive/cost.rs"]
mod cost;
#[path = "drive/faults.rs"]
mod faults;
#[path = "drive/fed.rs"]
mod fed;
#[path = "drive/rig.rs"]
mod rig;
