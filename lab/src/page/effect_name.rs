//! Names of effects as a reader sees them.

/// Effects that are named after people, as keys hold them without underscores, and as they are written.
const PROPER_NAMES: [(&str, &str); 3] =
    [("coulomb", "Coulomb"), ("stribeck", "Stribeck"), ("hunt crossley", "Hunt-Crossley")];

/// The key of an effect, or a list of keys, as words: "coulomb_friction" is "Coulomb friction".
pub(crate) fn effect_name(key: &str) -> String {
    let spaced = key.replace('_', " ");
    PROPER_NAMES.iter().fold(spaced, |text, (plain, proper)| text.replace(plain, proper))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_people_keep_their_capitals_and_hyphen() {
        let shown = effect_name("hunt_crossley_damping, coulomb_friction and gravity_load");
        assert_eq!(shown, "Hunt-Crossley damping, Coulomb friction and gravity load");
    }
}
