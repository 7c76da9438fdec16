//! Which effects are missing: forward selection, cross-validation, the verdict, confidence intervals.

pub mod confidence_interval;
pub mod cross_validation;
pub mod forward_selection;
pub mod verdict;
