//! The tests are tested: single breaks of the code, each of which one named test notices; and what mutation testing leaves.

mod list;
mod survivors;
