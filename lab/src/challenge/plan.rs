//! Which cases there are: a fixed list of 1580, of which a run takes all or an even sample.

use palpate_cases::effect::name::ALL;
use palpate_cases::elsewhere::offer;
use palpate_cases::{Source, What, Wish};
use rand::SeedableRng as _;
use rand::seq::SliceRandom as _;
use rand_chacha::ChaCha8Rng;

/// One case to be drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Its place in the whole list, which with seed and source makes it what it is.
    pub index: u64,
    /// Whose simulation plays it.
    pub source: Source,
    /// What is not left to chance.
    pub wish: Wish,
}

/// Simulators that nobody here wrote.
const OTHERS: [Source; 3] = [Source::Mujoco, Source::Drake, Source::Exudyn];

/// The whole list: half of it in our own simulation, with 20 of each effect of the list, half in those of others, with 20 of
/// each effect that they have.
#[must_use]
pub fn whole() -> Vec<Entry> {
    let mut groups: Vec<(usize, Source, What)> = vec![
        (150, Source::Own, What::Nothing),
        (104, Source::Mujoco, What::Nothing),
        (103, Source::Drake, What::Nothing),
        (103, Source::Exudyn, What::Nothing),
        (40, Source::Own, What::Outside { name: None, strength: None }),
        (20, Source::Mujoco, What::Outside { name: None, strength: None }),
        (20, Source::Own, What::Pair { names: None, strength: None }),
        (7, Source::Mujoco, What::Pair { names: None, strength: None }),
        (7, Source::Drake, What::Pair { names: None, strength: None }),
        (6, Source::Exudyn, What::Pair { names: None, strength: None }),
    ];
    let single = |name: &str| What::Single { name: Some(name.to_owned()), strength: None };
    groups.extend(ALL.iter().filter(|known| known.listed).map(|known| (20, Source::Own, single(known.name))));
    for source in OTHERS {
        let offered = offer::of(source).effects.iter().filter(|known| known.listed);
        groups.extend(offered.map(|known| (20, source, single(known.name))));
    }
    let every = groups.into_iter().flat_map(|(count, source, what)| std::iter::repeat_n((source, what), count));
    let entry = |(index, (source, what)): (usize, (Source, What))| Entry {
        index: index as u64,
        source,
        wish: Wish { what: Some(what), ..Wish::default() },
    };
    every.enumerate().map(entry).collect()
}

/// At most `count` of the cases that `sources` can play, evenly from the whole list, in an order that `seed` shuffles: a run
/// that was broken off has seen something of all.
#[must_use]
pub fn sample(count: usize, sources: &[Source], seed: u64) -> Vec<Entry> {
    let all: Vec<Entry> = whole().into_iter().filter(|entry| sources.contains(&entry.source)).collect();
    let count = count.min(all.len());
    let place = |nth: usize| (2 * nth + 1) * all.len() / (2 * count);
    let mut taken: Vec<Entry> = (0..count).map(|nth| all[place(nth)].clone()).collect();
    taken.shuffle(&mut ChaCha8Rng::seed_from_u64(seed));
    taken
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(entries: &[Entry], of: impl Fn(&Entry) -> bool) -> usize {
        entries.iter().filter(|entry| of(entry)).count()
    }

    #[test]
    fn the_whole_list_is_what_the_protocol_asks_for() {
        let all = whole();
        assert!(count(&all, |entry| entry.wish.what == Some(What::Nothing)) >= 300);
        assert!(2 * count(&all, |entry| entry.source != Source::Own) >= all.len());
        for known in ALL.iter().filter(|known| known.listed) {
            let wanted = What::Single { name: Some(known.name.to_owned()), strength: None };
            let own = |entry: &Entry| entry.source == Source::Own && entry.wish.what.as_ref() == Some(&wanted);
            assert_eq!(count(&all, own), 20, "{}", known.name);
        }
    }

    #[test]
    fn a_sample_is_even_and_a_case_keeps_its_index() {
        let (all, some) = (whole(), sample(158, &Source::ALL, 3));
        assert_eq!(some.len(), 158);
        assert!(some.iter().all(|entry| all[entry.index as usize] == *entry));
        let nothing = |entry: &Entry| entry.wish.what == Some(What::Nothing);
        assert!(count(&some, nothing).abs_diff(count(&all, nothing) / 10) <= 1);
        assert_ne!(sample(158, &Source::ALL, 4), some);
        assert!(sample(10_000, &[Source::Own], 3).iter().all(|entry| entry.source == Source::Own));
    }
}
