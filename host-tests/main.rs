//! The library on a host, against other algorithms, other libraries, real recordings and bad weather.

mod golden;
mod parity;
mod recordings;
mod reference;
mod simulator;
mod tolerance;
