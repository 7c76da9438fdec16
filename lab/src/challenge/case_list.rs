//! Which cases there are: a fixed list of 1580, of which a run takes all or an even sample.

use palpate_cases::effect::registry::ALL;
use palpate_cases::external_simulators::supported;
use palpate_cases::{CaseRequest, EffectSelection, SimulatorKind};
use rand::SeedableRng as _;
use rand::seq::SliceRandom as _;
use rand_chacha::ChaCha8Rng;

/// One case to be drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct ListedCase {
    /// Its place in the whole list, which with seed and source makes it what it is.
    pub index: u64,
    /// Whose simulation plays it.
    pub source: SimulatorKind,
    /// What is not left to chance.
    pub request: CaseRequest,
}

/// Simulators that nobody here wrote.
const OTHERS: [SimulatorKind; 3] = [SimulatorKind::Mujoco, SimulatorKind::Drake, SimulatorKind::Exudyn];

/// The whole list: half of it in our own simulation, with 20 of each effect of the list, half in those of others, with 20 of
/// each effect that they have.
#[must_use]
pub fn all_cases() -> Vec<ListedCase> {
    let mut groups: Vec<(usize, SimulatorKind, EffectSelection)> = vec![
        (150, SimulatorKind::Own, EffectSelection::Nothing),
        (104, SimulatorKind::Mujoco, EffectSelection::Nothing),
        (103, SimulatorKind::Drake, EffectSelection::Nothing),
        (103, SimulatorKind::Exudyn, EffectSelection::Nothing),
        (40, SimulatorKind::Own, EffectSelection::Outside { name: None, strength: None }),
        (20, SimulatorKind::Mujoco, EffectSelection::Outside { name: None, strength: None }),
        (20, SimulatorKind::Own, EffectSelection::Pair { names: None, strength: None }),
        (7, SimulatorKind::Mujoco, EffectSelection::Pair { names: None, strength: None }),
        (7, SimulatorKind::Drake, EffectSelection::Pair { names: None, strength: None }),
        (6, SimulatorKind::Exudyn, EffectSelection::Pair { names: None, strength: None }),
    ];
    let single = |name: &str| EffectSelection::Single { name: Some(name.to_owned()), strength: None };
    groups.extend(ALL.iter().filter(|known| known.listed).map(|known| (20, SimulatorKind::Own, single(known.name))));
    for source in OTHERS {
        let offered = supported::effects_of(source).effects.iter().filter(|known| known.listed);
        groups.extend(offered.map(|known| (20, source, single(known.name))));
    }
    let every = groups.into_iter().flat_map(|(count, source, what)| std::iter::repeat_n((source, what), count));
    let entry = |(index, (source, what)): (usize, (SimulatorKind, EffectSelection))| ListedCase {
        index: index as u64,
        source,
        request: CaseRequest { selection: Some(what), ..CaseRequest::default() },
    };
    every.enumerate().map(entry).collect()
}

/// At most `count` of the cases that `sources` can play, evenly from the whole list, in an order that `seed` shuffles: a run
/// that was broken off has seen something of all.
#[must_use]
pub fn sample(count: usize, sources: &[SimulatorKind], seed: u64) -> Vec<ListedCase> {
    let all: Vec<ListedCase> = all_cases().into_iter().filter(|entry| sources.contains(&entry.source)).collect();
    let count = count.min(all.len());
    let place = |nth: usize| (2 * nth + 1) * all.len() / (2 * count);
    let mut taken: Vec<ListedCase> = (0..count).map(|nth| all[place(nth)].clone()).collect();
    taken.shuffle(&mut ChaCha8Rng::seed_from_u64(seed));
    taken
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(entries: &[ListedCase], of: impl Fn(&ListedCase) -> bool) -> usize {
        entries.iter().filter(|entry| of(entry)).count()
    }

    #[test]
    fn the_whole_list_is_what_the_protocol_asks_for() {
        let all = all_cases();
        assert!(count(&all, |entry| entry.request.selection == Some(EffectSelection::Nothing)) >= 300);
        assert!(2 * count(&all, |entry| entry.source != SimulatorKind::Own) >= all.len());
        for known in ALL.iter().filter(|known| known.listed) {
            let wanted = EffectSelection::Single { name: Some(known.name.to_owned()), strength: None };
            let own = |entry: &ListedCase| {
                entry.source == SimulatorKind::Own && entry.request.selection.as_ref() == Some(&wanted)
            };
            assert_eq!(count(&all, own), 20, "{}", known.name);
        }
    }

    #[test]
    fn a_sample_is_even_and_a_case_keeps_its_index() {
        let (all, some) = (all_cases(), sample(158, &SimulatorKind::ALL, 3));
        assert_eq!(some.len(), 158);
        assert!(some.iter().all(|entry| all[entry.index as usize] == *entry));
        let nothing = |entry: &ListedCase| entry.request.selection == Some(EffectSelection::Nothing);
        assert!(count(&some, nothing).abs_diff(count(&all, nothing) / 10) <= 1);
        assert_ne!(sample(158, &SimulatorKind::ALL, 4), some);
        assert!(sample(10_000, &[SimulatorKind::Own], 3).iter().all(|entry| entry.source == SimulatorKind::Own));
    }

    #[test]
    fn the_nth_case_of_a_sample_stands_in_the_middle_of_its_share_of_the_list() {
        let all = all_cases();
        let mut taken: Vec<u64> = sample(7, &SimulatorKind::ALL, 3).iter().map(|entry| entry.index).collect();
        taken.sort_unstable();
        let expected: Vec<u64> = (0..7).map(|nth| (all.len() as u64 * (2 * nth + 1)) / 14).collect();
        assert_eq!(taken, expected);
    }
}
