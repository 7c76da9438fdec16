//! What one law of the drive is worth beside another: likelihood, share, and whether the gain is there throughout.

use super::candidates::is_likelier;
use super::criteria::{
    BLOCK_ROWS, BLOCK_S, LEAST_FREE_SHAPE_PART, LEAST_PART_OF_ALL, LEAST_PART_OF_EFFORT, LEAST_SHARE, LEAST_THROUGHOUT,
    MOST_LEFT_OF_MOVED, MOST_OF_THE_REST, NOISE_POWER_KNOWN_TO,
};
use super::fit::Fit;
use super::selection::Search;
use super::trial::DriveTrial;
use crate::diagnose::evidence::share_beyond_noise;
use crate::diagnose::model_comparison::{block_gains, clarke, vuong};

/// What a larger model has over a smaller one.
#[derive(Debug, Clone, Copy)]
pub struct Worth {
    /// Share of the unexplained power that it takes.
    pub share: f64,
    /// What it takes, N or N m in root mean square.
    pub taken: f64,
    /// The same over all that the nominal law leaves.
    pub part_of_all: f64,
    /// Whether the gain is there throughout: the larger of Vuong's and Clarke's statistic over blocks.
    pub throughout: f64,
}

impl Worth {
    /// Whether a term takes enough of what is left, and of all or of the rest; `is_free` where its shape is, `is_of_interest` where the rest is no
    /// negligible part of the effort.
    fn is_of_size(&self, is_free: bool, is_of_interest: bool) -> bool {
        let least_part = if is_free { LEAST_FREE_SHAPE_PART } else { LEAST_PART_OF_ALL };
        let takes_the_rest = self.share > MOST_OF_THE_REST && is_of_interest;
        self.share > LEAST_SHARE && (self.part_of_all > least_part || takes_the_rest)
    }
}

impl Search<'_> {
    /// Unexplained force of a fit in the common band, N or N m.
    #[must_use]
    pub fn unexplained(&self, fit: &Fit) -> f64 {
        (2.0 * self.data.unexplained_density(&fit.model, &fit.noise) * self.band_hz).sqrt()
    }

    /// What `more` has over `less`.
    #[must_use]
    pub fn worth(&self, more: &Fit, less: &Fit) -> Worth {
        let power = |fit: &Fit| self.unexplained(fit).powi(2);
        let taken = (power(less) - power(more)).max(0.0);
        let all = self.unexplained(&self.nominal).min(self.scales.effort);
        let blocks = self.block_gains(more, less);
        Worth {
            share: share_taken(power(less), power(more), 2.0 * self.effort_noise_density * self.band_hz),
            taken: taken.sqrt(),
            part_of_all: taken.sqrt() / all.max(f64::MIN_POSITIVE),
            throughout: vuong(&blocks).max(clarke(&blocks)),
        }
    }

    /// What `more` has over `less` in each block of a trial, by the trial's own rate; a trial that is shorter is one block.
    fn block_gains(&self, more: &Fit, less: &Fit) -> Vec<f64> {
        let rows = [more, less].map(|fit| fit.row_log_likelihoods(&self.data));
        let mut from = 0;
        let of_trial = |(trial, count): (&DriveTrial, usize)| {
            let block = ((BLOCK_S / trial.period_s).value() as usize).max(BLOCK_ROWS).min(count);
            let own = from..from + count;
            from += count;
            block_gains(&rows[0][own.clone()], &rows[1][own], block.max(1))
        };
        self.data.trials.iter().zip(self.data.scored_rows()).flat_map(of_trial).collect()
    }

    /// Whether `more` is worth its terms.
    #[must_use]
    pub fn is_worth(&self, more: &Fit, less: &Fit) -> bool {
        let shapes = |fit: &Fit| fit.model.terms.iter().filter(|term| term.has_free_shape(&self.scales)).count();
        let is_free = shapes(more) > shapes(less);
        let worth = self.worth(more, less);
        let is_of_interest = self.unexplained(less) > LEAST_PART_OF_EFFORT * self.scales.effort;
        self.explains_rows(more, less)
            && is_likelier(more, less)
            && (worth.is_of_size(is_free, is_of_interest) || self.is_worth_as_a_line(more, less))
            && worth.taken > LEAST_PART_OF_EFFORT * self.scales.effort
            && worth.throughout > LEAST_THROUGHOUT
    }

    /// Whether `more` explains rows at all: a law that leaves more than the whole effort follows the encoder's rows instead. Where hands
    /// or a weight move more than the effort does, a rigid law does that leaves by one more term less than half of what `less` leaves; one
    /// with a link can always follow.
    fn explains_rows(&self, more: &Fit, less: &Fit) -> bool {
        let is_one_more = more.model.told_terms() == less.model.told_terms() + 1;
        let most = if more.model.has_link() || !is_one_more {
            0.0
        } else {
            (MOST_LEFT_OF_MOVED * self.unexplained(less)).value()
        };
        self.unexplained(more) < self.scales.effort.max(most)
    }
}

/// What a law takes, `left - held`, over what is left beyond the white `noise` of the recorded effort, which is not known better than
/// [`NOISE_POWER_KNOWN_TO`]. Where more noise was recorded than the law leaves, a controller commanded it: it moved the drive, and none of it is left.
#[must_use]
pub fn share_taken(left: f64, held: f64, noise: f64) -> f64 {
    let known_to = NOISE_POWER_KNOWN_TO.value();
    let is_commanded = noise > (1.0 + known_to) * held;
    share_beyond_noise(left, held, if is_commanded { 0.0 } else { noise.min(held) }, known_to)
}

#[cfg(test)]
mod tests {
    use super::super::term::Term;
    use super::super::testing::{TestDrive, search_over, with_dry_friction};
    use super::*;

    #[test]
    fn a_term_of_whatever_shape_is_told_that_takes_most_of_the_rest() {
        let is_told = |share: f64, part_of_all: f64, is_free: bool, is_of_interest: bool| {
            Worth { share, taken: 1.0, part_of_all, throughout: 10.0 }.is_of_size(is_free, is_of_interest)
        };
        // The exponent of grease beside dry friction, and a cogging of a robot's axis.
        assert!(is_told(0.91, 0.185, true, true) && !is_told(0.64, 0.193, true, true));
        // Friction beside a link; the same where nobody asks what is left.
        assert!(is_told(0.9, 0.05, false, true) && !is_told(0.9, 0.05, false, false));
        assert!(
            is_told(0.3, 0.15, false, false) && !is_told(0.3, 0.15, true, false) && !is_told(0.2, 0.9, false, true)
        );
    }

    /// A trial of 0.4 s at 1 kHz and one at an eighth of that: one block, and one for each half second; and no block holds rows of both.
    #[test]
    fn each_trial_is_cut_into_blocks_by_its_own_rate() {
        let drive = TestDrive { coulomb: 0.4, ..TestDrive::PLAIN };
        let slow = drive.trial(8.0, 7);
        let every = |values: &[f64]| values.iter().step_by(8).copied().collect::<Vec<f64>>();
        let slow =
            DriveTrial::new("slow".into(), every(&slow.time), &every(&slow.position), every(&slow.effort), None, 1);
        let trials = [drive.trial(0.4, 6), slow];
        let search = search_over(&trials, &drive);
        let rubs = with_dry_friction(&search);
        let gains = search.block_gains(&rubs, &search.nominal);
        // Rows from which a filter settles are not scored: less than a block.
        assert!((15..=17).contains(&gains.len()), "{}", gains.len());
        let scored: Vec<usize> = search.data.scored_rows().collect();
        let rows = [&rubs, &search.nominal].map(|fit| fit.row_log_likelihoods(&search.data));
        let first: f64 = rows[0][..scored[0]].iter().zip(&rows[1][..scored[0]]).map(|(more, less)| more - less).sum();
        assert!((gains[0] - first).abs() < 1e-9 * first.abs(), "{} {first}", gains[0]);
    }

    /// Dry friction of 60 mN and of 3 mN: unexplained they are 9 mN and 0.8 mN over 20 Hz, 0.0044 and 0.0004 of an effort of 2 N.
    #[test]
    fn a_term_that_takes_next_to_nothing_of_the_effort_is_not_worth_telling() {
        let is_told = |coulomb: f64| {
            let drive = TestDrive { coulomb, encoder: 1e-8, ..TestDrive::PLAIN };
            let trials = [drive.trial(6.0, 6), drive.trial(6.0, 7)];
            let search = search_over(&trials, &drive);
            let mut start = search.nominal.clone();
            start.model.terms.push(Term::Coulomb);
            start.values.push(coulomb);
            let fit = search.polished(&start);
            search.is_worth(&fit, &search.nominal)
        };
        assert!(is_told(0.06) && !is_told(0.003));
    }

    /// By hand, in squares of one unit.
    #[test]
    fn a_term_takes_its_share_of_what_is_left_beyond_the_noise_of_the_effort() {
        // Of 50 beyond a noise of 100 it takes 40; with no noise it would be 40 of 150.
        assert!((share_taken(150.0, 110.0, 100.0) - 40.0 / 50.0).abs() < 1e-12);
        assert!((share_taken(150.0, 110.0, 0.0) - 40.0 / 150.0).abs() < 1e-12);
        // The noise is not known better than 44 of it.
        assert!((share_taken(110.0, 101.0, 100.0) - 9.0 / 44.0).abs() < 1e-12);
        // What the controller commands moves the drive and is not left.
        assert!((share_taken(12.0, 10.0, 1000.0) - 2.0 / 12.0).abs() < 1e-12);
        // Of noise that is told a little too large, all that is left is noise.
        assert!((share_taken(12.0, 10.0, 14.0) - 2.0 / 4.4).abs() < 1e-12);
        assert_eq!(share_taken(10.0, 11.0, 0.0), 0.0);
    }
}
