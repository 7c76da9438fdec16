//! What is known of recordings of a contact beside their rows.

/// What bounds the search beside the recordings.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Circumstances {
    /// Whether the tool moves at one speed each way and never stays at a depth.
    pub is_one_speed: bool,
    /// Whether the tool is in contact from the first row to the last.
    pub is_never_free: bool,
    /// Effects that a motion like this one cannot show.
    pub unseen: Vec<&'static str>,
    /// Effects of the force sensor that the drive speaks against: it felt the force as it was read.
    pub refuted: Vec<&'static str>,
}

/// Effects by which the way out differs from the way in: not seen of one way alone.
const OF_BOTH_WAYS: [&str; 2] = ["hysteresis", "plastic_set"];

/// Effects of rate and time: at one speed, one way and without a hold each is a curve over depth as good as any.
const OF_RATE_AND_TIME: [&str; 4] =
    ["hunt_crossley_damping", "quadratic_damping", "stress_relaxation", "time_varying_stiffness"];

/// The sensor's zero that moves: without free motion, too, as good a curve as those. A surface that is looked for deeper makes free motion of a part of the contact.
const OF_TIME_IN_FREE_MOTION: [&str; 1] = ["force_drift"];

impl Circumstances {
    /// Those of recordings of which the checks found what `is_found` by its code.
    #[must_use]
    pub fn of(is_found: impl Fn(&str) -> bool) -> Self {
        // Held at one depth a memory fades and a loop does not.
        let (is_one_speed, is_one_way) = (is_found("one_speed") && is_found("no_hold"), is_found("one_way"));
        let of_both_ways = OF_BOTH_WAYS.into_iter().filter(|_| is_one_way);
        let (is_one_stroke, is_never_free) = (is_one_way && is_one_speed, is_found("never_free"));
        let of_rate = OF_RATE_AND_TIME.into_iter().filter(|_| is_one_stroke);
        let of_zero = OF_TIME_IN_FREE_MOTION.into_iter().filter(|_| is_one_stroke && is_never_free);
        let of_range = ["force_saturation"].into_iter().filter(|_| is_found("force_held"));
        Self {
            is_one_speed,
            is_never_free,
            unseen: of_both_ways.chain(of_rate).chain(of_zero).chain(of_range).collect(),
            refuted: Vec::new(),
        }
    }

    /// Whether an effect of this `name` is looked for.
    #[must_use]
    pub fn allow(&self, name: &str) -> bool {
        !self.unseen.contains(&name) && !self.refuted.contains(&name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the findings tell the user that the motion cannot show is not looked for in it.
    #[test]
    fn what_one_way_at_one_speed_does_not_show_is_not_looked_for() {
        let allowed = |codes: &[&str], name: &str| Circumstances::of(|code| codes.contains(&code)).allow(name);
        for (codes, loops, rates, zeros) in [
            (&[][..], true, true, true),
            (&["one_speed", "no_hold", "never_free"], true, true, true),
            (&["one_way", "one_speed", "never_free"], false, true, true),
            (&["one_way", "one_speed", "no_hold"], false, false, true),
            (&["one_way", "one_speed", "no_hold", "never_free"], false, false, false),
        ] {
            assert!(OF_BOTH_WAYS.iter().all(|name| allowed(codes, name) == loops), "{codes:?}");
            assert!(OF_RATE_AND_TIME.iter().all(|name| allowed(codes, name) == rates), "{codes:?}");
            assert!(OF_TIME_IN_FREE_MOTION.iter().all(|name| allowed(codes, name) == zeros), "{codes:?}");
            assert!(allowed(codes, "nonlinear_stiffness") && allowed(codes, "layered_stiffness"));
        }
        assert!(Circumstances::of(|code| code == "never_free").is_never_free);
        assert!(!Circumstances::of(|code| code == "one_speed").is_never_free);
        let refuted = Circumstances { refuted: vec!["force_lag"], ..Circumstances::default() };
        assert!(!refuted.allow("force_lag") && refuted.allow("force_bias"));
    }
}
