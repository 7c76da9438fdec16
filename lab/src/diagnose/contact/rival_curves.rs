//! Names in whose place a free curve does far better.
//!
//! A name says on what a force depends, and by which law. A force that is missing for another reason can look like it: a click is told as layers, an air film
//! before the touch as adhesion, a valve that damps one way as a stiffness that fades. Where the law leaves little beyond the noise, so that it is told as if it
//! held, and a free curve of the place or of the speed in its place is likelier by the price of all values, the recordings say that it does not. This is the
//! comparison of a parametric law with a nonparametric one (W. Haerdle, E. Mammen, *Ann. Stat.* 21, 1993, 1926), as for a drive.

use super::broken_line::DepthProfile;
use super::criteria::{FAR_FROM_NOISE, LEAST_GAIN, LEAST_HELD_OUT_SHARE, LEAST_PART_OF_FORCE};
use super::crosstalk::directions;
use super::fit::Fit;
use super::free_curve::{Curve, columns, way_below};
use super::held_out::rms;
use super::learned_damping::with_damping;
use super::model::index;
use super::rest::Rest;
use super::search::Search;
use super::worth::free;
use crate::diagnose::evidence::NamedTerm;
use crate::diagnose::linalg::{dot, energy, solve};
use crate::effects::DAMPING_KNOTS;

/// Corners of the curves over the place that are tried.
const CORNERS: [usize; 4] = [4, 8, 12, 24];

/// Part of the depth before the surface over which a curve reaches: a magnet pulls from as far.
const BEFORE_SURFACE: f64 = 1.0;

/// A curve that does better than a name, or than the nominal law alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rival {
    /// The name; `None`: nothing is named.
    pub name: Option<&'static str>,
    /// What does better.
    pub curve: Curve,
    /// By how much, nats beyond the price of all values.
    pub gain: f64,
    /// Whether the name goes: the curve takes what the name leaves, and that is [`LEAST_HELD_OUT_SHARE`] or more of what the curve takes without it. Where it is less, the name
    /// stands for the most of it.
    pub is_refuted: bool,
}

/// A curve beside a law.
struct Beside {
    curve: Curve,
    /// Squares that are left, weighted.
    left: f64,
    /// With what each value has to earn, nats.
    price: f64,
    /// Whether the law with it is told as a law that holds.
    holds: bool,
}

impl Search<'_> {
    /// Whether `fit` leaves no more than [`FAR_FROM_NOISE`] times the noise's power, by the rows' weights and as it is told, in newtons, and so is told as a law that
    /// holds: of a real thing, far from the noise, no law leaves as little as a curve.
    pub(super) fn is_told_as_a_law(&self, fit: &Fit) -> bool {
        let data = &self.data;
        let left = rms(data, &data.residuals(&fit.model, &fit.values)) / data.expected_noise();
        Rest::of(data, fit).over_sensors <= FAR_FROM_NOISE && left * left <= FAR_FROM_NOISE
    }

    /// The curve that does better than one of the `named` terms of `fit`, with the place of that among the terms: the first that refutes one, or else the first. Where
    /// not even the law that is told `holds`, only curves count with which the law in the name's place does.
    pub(super) fn rival(&self, fit: &Fit, named: &[NamedTerm], holds: bool) -> Option<(usize, Rival)> {
        let each = named.iter().filter_map(|named| {
            let without = self.without(fit, named.at);
            let (beside, gain) = self.better_than(fit, &without, |beside| holds || beside.holds)?;
            let is_refuted = fit.energy - beside.left > (LEAST_HELD_OUT_SHARE * (without.energy - beside.left)).value();
            let name = Some(fit.model.terms[named.at].name());
            Some((named.at, Rival { name, curve: beside.curve, gain, is_refuted }))
        });
        let rivals: Vec<(usize, Rival)> = each.collect();
        rivals.iter().find(|(_, rival)| rival.is_refuted).or(rivals.first()).copied()
    }

    /// The first of the `named` terms of `fit` that is not worth [`LEAST_GAIN`] beside the `curve` in place of another; of a curve over the place none is looked for, as that
    /// holds every law of the place.
    pub(super) fn not_needed_beside(&self, curve: Curve, fit: &Fit, named: &[NamedTerm]) -> Option<usize> {
        let with = with_damping(&self.data, fit, curve)?;
        let rest = Rest::of(&self.data, &with);
        let is_needed = |at: usize| {
            let less = self.without(fit, at);
            with_damping(&self.data, &less, curve).is_some_and(|without| {
                let gain = (without.energy - with.energy) / (2.0 * rest.power * rest.correlated_rows);
                gain - self.price_of_value(&rest) * (free(fit) - free(&less)) as f64 > LEAST_GAIN.value()
            })
        };
        named.iter().map(|named| named.at).find(|at| !is_needed(*at))
    }

    /// The curve beside the nominal law that does better than that alone.
    pub(super) fn rival_of_nominal(&self) -> Option<Rival> {
        let (Beside { curve, .. }, gain) = self.better_than(&self.nominal, &self.nominal, |_| true)?;
        Some(Rival { name: None, curve, gain, is_refuted: false })
    }

    /// The best curve beside `law` that `may` do, and by how much it is likelier than `fit`, where that is more than [`LEAST_GAIN`], of a size that is told, and takes more than
    /// the errors of the motion are expected to leave.
    fn better_than(&self, fit: &Fit, law: &Fit, may: impl Fn(&Beside) -> bool) -> Option<(Beside, f64)> {
        let rest = Rest::of(&self.data, fit);
        let curves = self.with_curves(law, &rest).into_iter().filter(may);
        let best = curves.min_by(|a, b| a.price.total_cmp(&b.price))?;
        let gain = self.price(fit, &rest) - best.price;
        let taken = fit.energy - best.left;
        // A curve takes the errors of the motion as any law of the place does, and they show nothing.
        let is_of_size =
            self.part_of_force(taken) > LEAST_PART_OF_FORCE.value() && taken > self.data.expected_of_motion();
        (gain > LEAST_GAIN.value() && is_of_size).then_some((best, gain))
    }

    /// `law` with each curve beside it: over the place with its values refitted to first order, over the speed in full.
    fn with_curves(&self, law: &Fit, rest: &Rest) -> Vec<Beside> {
        let scale = 0.5 / (rest.power * rest.correlated_rows);
        let priced = |curve: Curve, left: f64, added: usize, holds: bool| {
            let price = scale * left + self.price_of_value(rest) * (free(law) + added) as f64;
            price.is_finite().then_some(Beside { curve, left, price, holds })
        };
        let by_speed = [Curve::Speed, Curve::SpeedTimesDepth].into_iter().filter_map(|curve| {
            let with = with_damping(&self.data, law, curve)?;
            // One of its knots is at rest, and adds nothing.
            priced(curve, with.energy, DAMPING_KNOTS - 1, self.is_told_as_a_law(&with))
        });
        let residual = self.data.weighted_residual(&law.model, &law.values);
        let beside = directions(&self.data, law, &residual);
        let by_place = self.over_the_place(law).into_iter().filter_map(|(curve, columns)| {
            let own: Vec<Vec<f64>> = columns.into_iter().filter(|column| energy(column) > 0.0).collect();
            let added = own.len();
            let all: Vec<(usize, Vec<f64>)> = beside.iter().cloned().chain(own).enumerate().collect();
            let found = solve(&all, &residual)?;
            let taken: f64 = all.iter().zip(&found).map(|((_, column), size)| size * dot(column, &residual)).sum();
            // To first order no law is fitted with it that could be told.
            priced(curve, energy(&residual) - taken, added, false)
        });
        by_speed.chain(by_place).collect()
    }

    /// The columns of each curve over the place, weighted.
    fn over_the_place(&self, law: &Fit) -> Vec<(Curve, Vec<Vec<f64>>)> {
        let Some(ends) = way_below(law, BEFORE_SURFACE) else { return Vec::new() };
        let surface = law.values[index::SURFACE];
        let residual = self.data.residuals(&law.model, &law.values);
        let profile = DepthProfile::of(self.data.trials, &residual, ends.map(|end| surface + end));
        let each = CORNERS.iter().flat_map(|count| {
            let corners = profile.corners(*count);
            [Curve::Place, Curve::PlaceAndDirection].map(|curve| (curve, columns(&self.data, law, curve, &corners)))
        });
        each.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::circumstances::Circumstances;
    use super::super::data::Data;
    use super::super::identification::identify;
    use super::super::nominal::nominal_fit;
    use super::super::outcome::Outcome;
    use super::super::testing::{FORCE_NOISE, TestContact};
    use super::*;
    use crate::diagnose::verdict::Verdict;

    /// What is found where `force` acts beside the plain contact, as a function of depth and velocity.
    fn found(force: impl Fn(f64, f64) -> f64) -> Outcome {
        let trials = || [1, 2].map(|seed| TestContact::PLAIN.trial_beside(seed, &force)).to_vec();
        identify(trials(), &trials(), &TestContact::nominal(), Circumstances::default(), &|_| {}).unwrap()
    }

    fn told(outcome: &Outcome) -> (Vec<&'static str>, Verdict, Vec<(&'static str, Curve)>) {
        let rivals = outcome.rivals.iter().filter(|rival| rival.is_refuted);
        let rivalled = rivals.filter_map(|rival| Some((rival.name?, rival.curve))).collect();
        (outcome.chosen.model.names(outcome.known_terms), outcome.verdict, rivalled)
    }

    /// A lid that clicks: the force dips at one depth, which layers follow roughly.
    #[test]
    fn a_click_is_no_layers() {
        let (names, verdict, rivalled) = told(&found(|x, _| -0.1 * (-((x - 4e-3) / 8e-4).powi(2)).exp()));
        assert_eq!((names, verdict), (vec![], Verdict::Unknown), "{rivalled:?}");
        assert_eq!(rivalled.last(), Some(&("layered_stiffness", Curve::Place)), "{rivalled:?}");
    }

    /// A valve that lets out more easily than in: another law of the speed.
    #[test]
    fn a_valve_that_damps_one_way_is_no_effect_of_the_list() {
        let (names, verdict, rivalled) = told(&found(|x, v| if x > 0.0 { 8.0 * v.max(0.0) } else { 0.0 }));
        assert_eq!((names, verdict), (vec![], Verdict::Unknown), "{rivalled:?}");
        assert!(!rivalled.is_empty() && rivalled.iter().all(|(_, curve)| *curve == Curve::Speed), "{rivalled:?}");
    }

    /// A damper that thins with the speed, in proportion to the depth: a loop follows it nearly, and leaves several times the noise, so that it is not told as a law; a
    /// curve over the speed is one, and what was named beside the loop, as Hunt-Crossley damping, is not needed beside that.
    #[test]
    fn a_damper_that_thins_with_the_speed_is_no_loop() {
        for (force, speed) in [(0.2, 0.02), (0.4, 0.005), (0.8, 0.03)] {
            let thins = |x: f64, v: f64| force * (x / 4e-3).max(0.0) * v / (speed + v.abs());
            let (names, verdict, rivalled) = told(&found(thins));
            assert_eq!((names, verdict), (vec![], Verdict::Unknown), "{force} N at {speed} m/s: {rivalled:?}");
            assert_eq!(rivalled, [("hysteresis", Curve::SpeedTimesDepth)], "{force} N at {speed} m/s");
        }
    }

    /// A click of one deviation of the sensor in a tenth of the way: the rows leave what the sensors are known to leave, and the curve is there.
    #[test]
    fn what_is_small_and_of_no_law_is_told_as_unknown() {
        let outcome = found(|x, _| -0.025 * (-((x - 4e-3) / 6e-4).powi(2)).exp());
        assert_eq!((outcome.chosen.model.names(outcome.known_terms), outcome.verdict), (vec![], Verdict::Unknown));
        assert_eq!(outcome.rivals.last().map(|rival| rival.curve), Some(Curve::Place), "{:?}", outcome.rivals);
    }

    /// The same click where the motion is known so badly that its errors are expected to leave a tenth of the noise's power: behind an encoder they repeat with the place.
    #[test]
    fn what_the_errors_of_the_motion_leave_is_no_curve() {
        let click = |x: f64, _: f64| -0.025 * (-((x - 4e-3) / 6e-4).powi(2)).exp();
        let trials = [1, 2].map(|seed| TestContact::PLAIN.trial_beside(seed, click));
        let nominal = nominal_fit(&Data::new(&trials), &TestContact::nominal());
        let rival = |part: f64, louder: f64| {
            let mut data = Data::new(&trials).weighed(&nominal);
            data.noise
                .iter_mut()
                .flatten()
                .for_each(|variance| *variance = louder * (*variance + part * FORCE_NOISE.powi(2)));
            data.noise_factor *= louder;
            let nominal = data.again(&nominal);
            let coarse = Data::new(&trials);
            let search = Search { nominal, data, coarse, circumstances: Circumstances::default() };
            search.rival_of_nominal().map(|rival| rival.curve)
        };
        assert_eq!([rival(0.0, 1.0), rival(0.1, 1.0)], [Some(Curve::Place), None]);
        // A sensor of twice the power has no worse a motion.
        assert_eq!(rival(0.0, 2.0), Some(Curve::Place));
    }

    /// Layers are there: no curve is likelier than they are.
    #[test]
    fn layers_stand_beside_any_curve() {
        let (names, verdict, rivalled) = told(&found(|x, _| 200.0 * (x - 4e-3).max(0.0)));
        assert_eq!((names, verdict, rivalled), (vec!["layered_stiffness"], Verdict::Explained, vec![]));
    }
}
