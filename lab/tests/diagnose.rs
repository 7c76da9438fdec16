//! `palpate diagnose` from end to end: a rig with physics that its file does not tell of, and what is found.

#[path = "diagnose/bench.rs"]
mod bench;
#[path = "diagnose/contract.rs"]
mod contract;
#[path = "diagnose/faults.rs"]
mod faults;
#[path = "diagnose/files.rs"]
mod files;
#[path = "diagnose/named.rs"]
mod named;
#[path = "diagnose/odd.rs"]
mod odd;
