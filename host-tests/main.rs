//! The library on a host, against other algorithms, other libraries, real recordings and bad weather.

mod degenerate;
mod fourth;
mod golden;
mod intervals;
mod invariants;
mod mathematics;
mod models;
mod parity;
mod recordings;
mod recovery;
mod reference;
mod rig;
mod running;
mod simulator;
mod tolerance;
