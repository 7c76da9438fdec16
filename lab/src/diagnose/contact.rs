//! The contact by a model of its force: position in, force out.

pub mod broken_line;
pub mod circumstances;
mod colour;
pub mod composed;
pub mod criteria;
pub mod fit;
pub mod held_out;
pub mod interval;
pub mod learned;
mod lines;
pub mod model;
pub mod motion;
pub mod nominal;
pub mod outcome;
pub mod own_values;
pub mod prepare;
pub mod projection;
pub mod refined;
pub mod scales;
pub mod seen_layers;
pub mod selection;
pub mod spline;
#[cfg(test)]
pub mod testing;
pub mod tones;
pub mod trial;
pub mod variance;
pub mod worth;
