//! Two bodies: the search for what gives, or plays, between motor and load.
//!
//! The likelihood has many maxima there, so it starts from several links and gaps, on a short stretch first.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::fit::Fit;
use super::law::Side;
use super::levenberg_marquardt::search_values;
use super::likelihood::Data;
use super::model::index;
use super::noise_search::search_noise;
use super::scales::Scales;
use super::term::Term;
use super::trial::DriveTrial;

/// Rows of the stretch on which starts are compared.
const STRETCH_ROWS: usize = 5000;

/// Frequencies of the link under all of the inertia that are tried, Hz; only those that the rows can follow. Of a play, whose likelihood has the more maxima, so many
/// of the fastest: a recording of few rows a second is of a large or a soft machine. Seen from the load there is a slowest: beyond flanks that are soft enough the
/// load goes its own way, and follows any rows.
const COMPLIANCE_HZ: [f64; 5] = [6.0, 15.0, 40.0, 100.0, 250.0];
const PLAY_HZ: [f64; 6] = [150.0, 60.0, 25.0, 8.0, 3.0, 1.0];
const FLANKS: usize = 3;
const SLOWEST_FROM_LOAD_HZ: f64 = 25.0;
const FASTEST_PER_ROW: f64 = 0.3;

/// The narrowest gap that is tried, in steps of the encoder, the factor to the next, and the widest, as a part of the travel.
const NARROWEST_GAP: f64 = 2.0;
const GAP_FACTOR: f64 = 1.25;
const WIDEST_GAP: f64 = 0.05;

/// So many gaps that follow each other are a band, of which the likeliest is searched from.
const GAPS_OF_BAND: usize = 6;

/// Damping ratios of a link's swing to begin with: a load that bounces in its play and one that stays where it strikes.
const PLAY_DAMPING: [f64; 3] = [0.05, 0.2, 0.8];
const COMPLIANCE_DAMPING: f64 = 0.05;

/// Density of the disturbance to begin with, over that of the law without the link. With that law's own, the filter follows every row
/// of the encoder whatever the link, and the likelihood has a maximum there; with a quiet one the link has to explain the motion.
/// Chosen; with all of it a play of 2 mm is a weak link in the test of `outcome`.
const QUIET: f64 = 1e-3;

/// That density of a play, and the share of the viscous friction on its load. With a disturbance of less than the strikes leave, and some
/// friction on the load, the likelihood has one maximum over the gap where it has dozens with a louder one, which lets the filter strike
/// at every row that suits it (seen on a gear of 24 mrad, between 1e-3 and 1e-4); a load that flies on is found from the other.
const PLAY_STARTS: [(f64, f64); 2] = [(QUIET, 0.0), (QUIETEST, 0.5)];
const QUIETEST: f64 = 1e-4;

/// Plays of each kind that are led on by steps before their slopes are searched along.
const LED: usize = 3;

/// Starts that are followed to their end, and the turns that takes.
const FOLLOWED: usize = 4;
const TURNS: usize = 4;
const STEPS: usize = 6;

/// The best weak link and the best play of each of `sides` beside the terms of `base`, still to be fitted in full: on a stretch the one side can be
/// likelier, and on all rows the other.
#[must_use]
pub fn found(data: &Data<'_>, base: &Fit, disturbance: &[Vec<f64>], sides: &[Side]) -> Vec<Fit> {
    let trials = [liveliest(data, disturbance)];
    let short = Data { trials: &trials, ..*data };
    sides.iter().flat_map(|side| found_on(&short, base, *side)).collect()
}

/// Those whose encoder is on `side`, on the stretch of `data`.
fn found_on(data: &Data<'_>, base: &Fit, side: Side) -> Vec<Fit> {
    let begun = led(data, starts(data, base, side));
    let mut fits: Vec<Fit> = begun.into_par_iter().map(|start| turn(data, start)).collect();
    fits.sort_by(|a, b| b.log_likelihood.total_cmp(&a.log_likelihood));
    fits.truncate(2 * FOLLOWED);
    let mut fits: Vec<Fit> = fits.into_par_iter().map(|fit| followed(data, fit)).collect();
    fits.sort_by(|a, b| b.log_likelihood.total_cmp(&a.log_likelihood));
    let closed = fits.iter().find_map(without_gap).map(|link| followed(data, link));
    fits.extend(closed);
    fits.sort_by(|a, b| b.log_likelihood.total_cmp(&a.log_likelihood));
    let mut best: Vec<Fit> = Vec::new();
    for fit in fits {
        let names = fit.model.names();
        if !fit.model.is_at_end(&fit.values) && best.iter().all(|other| other.model.names() != names) {
            best.push(fit);
        }
    }
    best
}

/// `starts`, and plays among them led on to the likeliest around each: the likeliest of the quietest, and the likeliest of all under the noise that suits each best.
fn led(data: &Data<'_>, starts: Vec<Fit>) -> Vec<Fit> {
    let plays: Vec<Fit> = starts.iter().filter(|fit| fit.model.has("backlash")).cloned().collect();
    let quietest = plays.iter().map(|fit| fit.noise.ln_disturbance).fold(f64::INFINITY, f64::min);
    let quiet = plays.iter().filter(|fit| fit.noise.ln_disturbance <= quietest).cloned().collect();
    let suited = plays.into_par_iter().map(|mut fit| {
        fit.log_likelihood = search_noise(data, &fit.model, &fit.values, &mut fit.noise);
        fit
    });
    let chosen = [likeliest(quiet), likeliest(suited.collect())].concat();
    let led: Vec<Fit> = chosen.into_par_iter().map(|play| likelier_around(data, &play)).collect();
    [starts, led].concat()
}

/// The [`LED`] likeliest of `plays`.
fn likeliest(mut plays: Vec<Fit>) -> Vec<Fit> {
    plays.sort_by(|a, b| b.log_likelihood.total_cmp(&a.log_likelihood));
    plays.truncate(LED);
    plays
}

/// `play` with no less of a disturbance than a search for one begins with, beside what `rigid` leaves: with none at all its load flies on from the
/// first strike that is wrong, and no step from there gains.
#[must_use]
pub fn roused(play: &Fit, rigid: &Fit) -> Fit {
    let mut fit = play.clone();
    fit.noise.ln_disturbance = fit.noise.ln_disturbance.max(rigid.noise.ln_disturbance + QUIETEST.ln());
    fit
}

fn turn(data: &Data<'_>, mut fit: Fit) -> Fit {
    fit.ended = search_values(data, &fit.model, &mut fit.values, &fit.noise, STEPS);
    fit.log_likelihood = search_noise(data, &fit.model, &fit.values, &mut fit.noise);
    fit
}

/// `fit` led on turn by turn, until one gains less than a nat.
fn followed(data: &Data<'_>, mut fit: Fit) -> Fit {
    for _ in 1..TURNS {
        let before = fit.log_likelihood;
        fit = turn(data, fit);
        if fit.log_likelihood - before < 1.0 {
            break;
        }
    }
    fit
}

/// The weak link that `fit`, whose last term is a play, is where the gap of that has closed: starts of a link alone can miss the swing and the
/// damping that those of a play come to, of which there are more. `None` where it plays.
fn without_gap(fit: &Fit) -> Option<Fit> {
    let last = fit.model.terms.len() - 1;
    let Term::Play(side) = fit.model.terms[last] else { return None };
    let gap = fit.model.values_of(last).start + GAP;
    let (value, range) = (fit.values[gap], &fit.model.ranges()[gap]);
    if !range.is_at_end(value) || value > range.low.midpoint(range.high) {
        return None;
    }
    let mut link = fit.clone();
    link.model.terms[last] = Term::Compliance(side);
    link.values.remove(gap);
    Some(link)
}

/// Where the gap stands among the values of a play, which a weak link lacks.
const GAP: usize = 3;

/// Steps of the search about a play: of the logarithms of inertia, viscous friction, stiffness, damping and gap, and of the load's shares
/// of inertia and friction; and the part of them at which it ends.
const STEPS_AROUND: [f64; 7] = [0.05, 0.3, 0.7, 0.7, 0.15, 0.1, 0.2];
const LEAST_STEP: f64 = 0.1;

/// Rounds of that search at most, two likelihoods each for every step, and the gain of one, nats, below which it takes shorter steps.
const MOST_ROUNDS: usize = 30;
const LEAST_GAIN: f64 = 1.0;

/// A likelier play near `play`, its last term, if there is one, its noise held: steps along each direction,
/// halved when none of them gains (generating set search: T. G. Kolda, R. M. Lewis, V. Torczon, *SIAM Review* 45, 2003, 385). The
/// likelihood has a corner wherever the sides strike at another row, and a search by its slope ends in the nearest.
#[must_use]
pub fn likelier_around(data: &Data<'_>, play: &Fit) -> Fit {
    let first = play.model.values_of(play.model.terms.len() - 1).start;
    let ranges = play.model.ranges();
    let moved = |from: &Fit, [inertia, viscous, stiffness, damping, gap, share, friction]: [f64; 7]| {
        let mut fit = from.clone();
        fit.values[index::INERTIA] *= inertia.exp();
        fit.values[index::VISCOUS] *= viscous.exp();
        let own = &mut fit.values[first..];
        own[0] *= stiffness.exp();
        own[1] *= (0.5 * stiffness + damping).exp();
        own[2] += share;
        own[3] *= gap.exp();
        own[4] += friction;
        fit.values.iter_mut().zip(&ranges).for_each(|(value, range)| *value = value.clamp(range.low, range.high));
        fit.log_likelihood = data.log_likelihood(&fit.model, &fit.values, &fit.noise).0;
        fit
    };
    let mut best = moved(play, [0.0; 7]);
    let mut part = 1.0;
    for _ in 0..MOST_ROUNDS {
        if part <= LEAST_STEP {
            break;
        }
        let tried = (0..2 * STEPS_AROUND.len()).into_par_iter().map(|at| {
            let mut along = [0.0; STEPS_AROUND.len()];
            along[at / 2] = if at % 2 == 0 { part } else { -part } * STEPS_AROUND[at / 2];
            moved(&best, along)
        });
        let tried: Vec<Fit> = tried.collect();
        let top = tried.into_iter().max_by(|a, b| a.log_likelihood.total_cmp(&b.log_likelihood));
        match top.filter(|top| top.log_likelihood > best.log_likelihood + LEAST_GAIN) {
            Some(top) => best = top,
            None => part *= 0.5,
        }
    }
    best
}

/// Every link and play to begin with, with the encoder on `side`.
fn starts(data: &Data<'_>, base: &Fit, side: Side) -> Vec<Fit> {
    let scales: &Scales = &base.model.scales;
    let is_slow_enough = |hz: &f64| hz * scales.period_s < FASTEST_PER_ROW;
    let mut all = Vec::new();
    for hz in COMPLIANCE_HZ.into_iter().filter(is_slow_enough) {
        let own = link(base, hz, COMPLIANCE_DAMPING).to_vec();
        all.push(begun(base, Term::Compliance(side), own.clone(), 1.0));
        all.push(begun(base, Term::Compliance(side), own, QUIET));
    }
    let is_fast_enough = |hz: &f64| side == Side::Motor || *hz >= SLOWEST_FROM_LOAD_HZ;
    let flanks: Vec<f64> = PLAY_HZ.into_iter().filter(is_slow_enough).filter(is_fast_enough).take(FLANKS).collect();
    if !flanks.is_empty() {
        let gaps: Vec<f64> = gaps(scales).collect();
        for (density, friction_share) in PLAY_STARTS {
            let likeliest = |band: &[f64]| likeliest_play(data, base, side, &flanks, band, density, friction_share);
            all.extend(gaps.par_chunks(GAPS_OF_BAND).filter_map(likeliest).collect::<Vec<_>>());
        }
    }
    all
}

/// The likeliest play of a band of gaps, as it begins.
fn likeliest_play(
    data: &Data<'_>,
    base: &Fit,
    side: Side,
    flanks: &[f64],
    band: &[f64],
    density: f64,
    friction_share: f64,
) -> Option<Fit> {
    let begun = |gap: f64, hz: f64, damping: f64| {
        let [stiffness, damping, share, _] = link(base, hz, damping);
        let own = vec![stiffness, damping, share, gap, friction_share];
        let mut fit = begun(base, Term::Play(side), own, density);
        fit.log_likelihood = data.log_likelihood(&fit.model, &fit.values, &fit.noise).0;
        fit
    };
    let of_gap = |gap: f64| flanks.iter().flat_map(move |hz| PLAY_DAMPING.map(|damping| begun(gap, *hz, damping)));
    let all = band.iter().flat_map(|gap| of_gap(*gap));
    all.max_by(|a, b| a.log_likelihood.total_cmp(&b.log_likelihood))
}

/// Stiffness, damping and shares of the load, of inertia and of viscous friction, of a link between two equal halves that swings at
/// `frequency_hz` under all of the inertia.
fn link(base: &Fit, frequency_hz: f64, damping_ratio: f64) -> [f64; 4] {
    let inertia = base.values[index::INERTIA];
    let swing = TAU * frequency_hz;
    [0.25 * inertia * swing * swing, 0.5 * damping_ratio * inertia * swing, 0.5, 0.0]
}

/// `base` with `term` and its `own` values, and its disturbance at `density` of what it was.
fn begun(base: &Fit, term: Term, own: Vec<f64>, density: f64) -> Fit {
    let mut fit = base.clone();
    fit.noise.ln_disturbance += density.ln();
    if density < 1.0 {
        // The delay that a rigid law needed stands for the link.
        fit.values[index::DELAY] = 0.0;
    }
    fit.values.extend(own);
    fit.model.terms.push(term);
    fit
}

/// Gaps to begin with, m or rad: a gap may be one step of the encoder or thousands.
fn gaps(scales: &Scales) -> impl Iterator<Item = f64> {
    let narrowest = NARROWEST_GAP * scales.resolution;
    let widest = (WIDEST_GAP * scales.travel).max(16.0 * narrowest);
    std::iter::successors(Some(narrowest), |gap| Some(gap * GAP_FACTOR)).take_while(move |gap| *gap <= widest)
}

/// The stretch of a trial in which the disturbance is largest.
#[must_use]
pub fn liveliest(data: &Data<'_>, disturbance: &[Vec<f64>]) -> DriveTrial {
    let mut best = (f64::NEG_INFINITY, 0, 0..0);
    for (at, (trial, force)) in data.trials.iter().zip(disturbance).enumerate() {
        let rows = trial.len().min(STRETCH_ROWS);
        let mut start = 0;
        while start + rows <= trial.len() {
            let stretch = start..start + rows;
            let power = force[stretch.clone()].iter().map(|force| force * force).sum::<f64>();
            if power > best.0 {
                best = (power, at, stretch);
            }
            start += rows.div_ceil(2).max(1);
        }
    }
    let (_, at, stretch) = best;
    data.trials[at].slice(stretch)
}

#[cfg(test)]
mod tests {
    use super::super::testing::fit_of;
    use super::*;

    /// A play that closed is a link of the same values; one of some width stays what it is, and so does one at the widest that is searched.
    #[test]
    fn a_play_whose_gap_has_closed_is_a_weak_link() {
        let play = |gap: f64| fit_of(&[Term::Coulomb, Term::Play(Side::Motor)], &[0.2, 500.0, 0.3, 0.4, gap, 0.6]);
        let range = {
            let fit = play(1e-4);
            fit.model.ranges()[fit.model.values_of(1).start + GAP]
        };
        let link = without_gap(&play(range.low)).expect("its gap has closed");
        assert_eq!(link.model.terms, [Term::Coulomb, Term::Compliance(Side::Motor)]);
        assert_eq!(link.values[link.model.values_of(1)], [500.0, 0.3, 0.4, 0.6]);
        assert_eq!(link.values.len(), link.model.ranges().len());
        assert!(without_gap(&play(1e-4)).is_none());
        assert!(without_gap(&play(range.high)).is_none());
        assert!(without_gap(&fit_of(&[Term::Compliance(Side::Motor)], &[500.0, 0.3, 0.4, 0.6])).is_none());
    }
}
