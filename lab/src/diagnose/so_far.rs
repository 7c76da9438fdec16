//! The answer as a search has it so far, for who waits: a partial answer.

/// `names` of effects, and which `part` of the missing force they leave, in root mean square.
#[must_use]
pub fn so_far(names: &[&str], part: f64) -> String {
    if names.is_empty() {
        return "nothing so far".to_owned();
    }
    format!("so far {}, {:.0} % of the missing force left", names.join(" and "), 100.0 * part)
}

#[cfg(test)]
mod tests {
    use super::so_far;

    #[test]
    fn a_partial_answer_says_what_it_leaves() {
        assert_eq!(so_far(&[], 1.0), "nothing so far");
        let two = so_far(&["coulomb_friction", "effort_lag"], 0.123);
        assert_eq!(two, "so far coulomb_friction and effort_lag, 12 % of the missing force left");
    }
}
