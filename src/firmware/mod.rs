//! What only the target has: clock, interrupt, semihosting.

mod board;
mod replay;
mod tick;
