//! The listed effects that recordings could still hide: what a trial is designed to show where no alternative is open.
//!
//! An answer that names nothing, or not enough, has no other explanation to be designed against. It can still be wrong by any effect of
//! the list that the recordings show too little of. Each is a *potential term* of the answer (W. DuMouchel, B. Jones, "A simple Bayesian
//! modification of D-optimal designs to reduce dependence on an assumed model", Technometrics 36 (1994) 37; A. C. Atkinson, "Planning
//! experiments to detect inadequate regression models", Biometrika 59 (1972) 275): a term whose size is not known, but for its scale.
//! With E the energy, in units of the noise, by which the effect at that scale changes the responses so far, after the best change of
//! the answer's values, and e what a further motion adds, that motion tells
//!
//! ```text
//!     I = 1/2 ln((1 + E + e) / (1 + E))        nats of the size of the term
//! ```
//!
//! (D. V. Lindley, "On a measure of the information provided by an experiment", Annals of Mathematical Statistics 27 (1956) 986, for a
//! normal size of that scale).

use rayon::prelude::*;

use super::explanation::excitation_stats;
use super::recorded::Recorded;
use crate::effects::{self, to_table};
use crate::recording::Recording;
use crate::rig::Rig;

/// Places of the search of one effect that are tried, an even sample of them; for the time that it takes.
const MOST_TRIED: usize = 4;

/// Of those, places at which it is a departure: where the recordings would have shown the least of it.
const MOST_PLACES: usize = 2;

/// A listed effect at one place from which a diagnosis searches its values.
#[derive(Debug, Clone)]
pub struct Departure {
    /// The effect's number among the departures' effects.
    pub effect: usize,
    /// The answer's rig with it.
    pub rig: Rig,
    /// Energy by which it would have changed the recordings.
    pub shown: f64,
}

/// Every effect of the list that `answer` does not hold, beside it, and what `trials` would have shown of it, of which `recorded` is the
/// answer's part. Effects that repeat along time or way are searched by their spectrum and have no place to start from: they are left out.
#[must_use]
pub fn departures(answer: &Rig, trials: &[Recording], recorded: &Recorded<'_>) -> Vec<Departure> {
    let stats = excitation_stats(answer, trials);
    let missing =
        effects::ALL.iter().filter(|effect| answer.effects.iter().all(|table| table.name != effect.spec().name));
    let rigs: Vec<(usize, Rig)> = missing
        .enumerate()
        .flat_map(|(number, effect)| {
            let starts = effect.starts(0, &stats);
            let every = starts.len().div_ceil(MOST_TRIED).max(1);
            let with = |values: &[f64]| {
                let mut rig = answer.clone();
                rig.effects.push(to_table(*effect, 0, rig.coordinate, values, None));
                rig
            };
            starts.iter().step_by(every).map(|start| (number, with(&start.values))).collect::<Vec<_>>()
        })
        .collect();
    let shown: Vec<f64> = rigs.par_iter().map(|(_, rig)| recorded.energy(rig)).collect();
    let all = rigs.into_iter().zip(shown).map(|((effect, rig), shown)| Departure { effect, rig, shown });
    let mut all: Vec<Departure> = all.filter(|departure| departure.shown.is_finite()).collect();
    all.sort_by(|a, b| a.effect.cmp(&b.effect).then(a.shown.total_cmp(&b.shown)));
    let is_least = |at: &usize| *at < MOST_PLACES || all[*at - MOST_PLACES].effect != all[*at].effect;
    (0..all.len()).filter(is_least).map(|at| all[at].clone()).collect()
}

/// How many effects `departures` are of.
#[must_use]
pub fn effects_of(departures: &[Departure]) -> usize {
    departures.iter().map(|departure| departure.effect + 1).max().unwrap_or(0)
}

/// Nats that a motion with `energy` of each of `departures` tells beside what was shown, the mean of the effects: of each effect by the
/// place of which it tells most.
#[must_use]
pub fn information(departures: &[Departure], energy: &[f64]) -> f64 {
    let count = effects_of(departures);
    let mut most = vec![0.0f64; count];
    for (departure, energy) in departures.iter().zip(energy) {
        let told = 0.5 * (energy / (1.0 + departure.shown)).ln_1p();
        most[departure.effect] = most[departure.effect].max(told);
    }
    most.iter().sum::<f64>() / count.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::super::discrimination::Noise;
    use super::super::loop_model::LoopModel;
    use super::*;
    use crate::simulate::simulate;

    const NOISE: Noise = Noise { position: 3e-5, force: Some(0.09), effort: Some(0.1) };

    fn bench() -> Rig {
        let text = include_str!("../../rigs/bench.toml").replace("duration_s = 60.0", "duration_s = 8.0");
        let text = text.replace("period_s = 30.0", "period_s = 4.0").replace("contact_s = 15.0", "contact_s = 1.5");
        Rig::parse(&text, "bench.toml").unwrap()
    }

    fn departure(effect: usize, shown: f64) -> Departure {
        Departure { effect, rig: Rig::default(), shown }
    }

    /// Half the logarithm of the ratio of what is known after and before, by the better of the first effect's two places: 1 + 3 after 1, and 1 + 8 after 1 + 2.
    #[test]
    fn information_is_that_of_the_best_place_of_each_effect() {
        let all = [departure(0, 5.0), departure(0, 0.0), departure(1, 2.0)];
        let told = information(&all, &[0.0, 3.0, 6.0]);
        assert!((told - 0.25 * (4f64.ln() + 3f64.ln())).abs() < 1e-12, "{told}");
        assert_eq!((information(&all, &[0.0; 3]), information(&[], &[])), (0.0, 0.0));
    }

    /// Energies add up over recordings whose refit is one: twice the same shows twice as much, but for the little that the values were known beforehand.
    #[test]
    fn twice_the_recording_shows_twice_as_much() {
        let rig = bench();
        let trial = simulate(&rig, 1, "bench").unwrap().recording;
        let closed_loop = LoopModel::new(&rig, std::slice::from_ref(&trial));
        let of =
            |trials: &[Recording]| departures(&rig, trials, &Recorded::new(&rig, trials, &closed_loop, &NOISE, 0.02));
        let (once, twice) = (of(std::slice::from_ref(&trial)), of(&[trial.clone(), trial.clone()]));
        assert_eq!(once.len(), twice.len());
        assert!(effects_of(&once) > 20, "{}", effects_of(&once));
        let pairs: Vec<(f64, f64)> = once.iter().zip(&twice).map(|(one, two)| (one.shown, two.shown)).collect();
        assert!(pairs.iter().filter(|(one, _)| *one > 1.0).count() > 20, "{pairs:?}");
        for (one, two) in pairs.into_iter().filter(|(one, _)| *one > 1.0) {
            assert!((two / one - 2.0).abs() < 0.05, "{one} {two}");
        }
    }

    /// What the answer holds already is no departure from it, and each is the answer with one effect more.
    #[test]
    fn each_departure_is_the_answer_with_one_effect_that_it_lacks() {
        let mut rig = bench();
        let friction = crate::effects::find("coulomb_friction").unwrap();
        rig.effects.push(to_table(friction, 0, rig.coordinate, &[0.3], None));
        let trial = simulate(&rig, 1, "bench").unwrap().recording;
        let closed_loop = LoopModel::new(&rig, std::slice::from_ref(&trial));
        let trials = [trial];
        let recorded = Recorded::new(&rig, &trials, &closed_loop, &NOISE, 0.02);
        for departure in departures(&rig, &trials, &recorded) {
            let [known, added] = departure.rig.effects.as_slice() else { panic!("{:?}", departure.rig.effects) };
            assert_eq!(known.name, "coulomb_friction");
            assert_ne!(added.name, "coulomb_friction");
        }
    }
}
