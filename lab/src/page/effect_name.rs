//! Names of effects as a reader sees them.

/// Names of people and compounds, as keys hold them without underscores, and as they are written.
const WRITTEN: [(&str, &str); 5] = [
    ("coulomb", "Coulomb"),
    ("stribeck", "Stribeck"),
    ("hunt crossley", "Hunt-Crossley"),
    ("load dependent", "load-dependent"),
    ("time varying", "time-varying"),
];

/// The key of an effect, or a list of keys, as words: "coulomb_friction" is "Coulomb friction".
pub(crate) fn effect_name(key: &str) -> String {
    let spaced = key.replace('_', " ");
    WRITTEN.iter().fold(spaced, |text, (plain, written)| text.replace(plain, written))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_people_keep_their_capitals_and_compounds_their_hyphen() {
        let shown = effect_name("hunt_crossley_damping, coulomb_friction and gravity_load");
        assert_eq!(shown, "Hunt-Crossley damping, Coulomb friction and gravity load");
        assert_eq!(effect_name("load_dependent_friction, force_lag"), "load-dependent friction, force lag");
    }
}
