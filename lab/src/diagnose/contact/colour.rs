//! How loud a sensor's noise is that remembers from row to row, as behind a filter: by what a law leaves level by level of a wavelet transform.
//!
//! A sensor's noise is stated, or estimated, from row to row; what remembers is louder below. At each level its power is a median's, which
//! a few events do not move (I. M. Johnstone and B. W. Silverman, *J. R. Statist. Soc. B* 59, 1997), of what is left beside position,
//! velocity and acceleration at that level (incoherent power: J. S. Bendat and A. G. Piersol, *Random Data*, 2010): the least of what is found
//! in free motion and in contact, slow and fast, because noise is there whatever the tool does, and a law's misfit is not. From the level on at
//! which the law's own force is louder than what is left, a misfit could be all of it: contact is not asked, and free motion, in which no law of
//! the contact has a force, is. Where nothing is left to be asked the noise is taken to go on as above; in free motion it is no less than what
//! is left there over the longest stretches of which there are enough: details of a slow memory are longer than free motion is.

use super::beside_motion::{MotionRow, without_motion};
use super::criteria::LEAST_PART_OF_COEFFICIENTS;
use super::fit::Fit;
use super::free_motion::{free_power, has_free_motion};
use super::trial::ContactTrial;
use crate::diagnose::median::median;

/// Low-pass filter of four vanishing moments (I. Daubechies, *Comm. Pure Appl. Math.* 41, 1988).
const FILTER: [f64; 8] = [
    0.230_377_813_308_855_2,
    0.714_846_570_552_541_5,
    0.630_880_767_929_590_4,
    -0.027_983_769_416_983_85,
    -0.187_034_811_718_881_1,
    0.030_841_381_835_986_96,
    0.032_883_011_666_982_95,
    -0.010_597_401_784_997_28,
];

/// Median of the size of a normal variable of deviation one.
const NORMAL_MEDIAN: f64 = 0.674_489_75;

/// Coefficients that a median is taken of at the least: a deviation is known to an eighth then.
const LEAST_COUNT: usize = 80;

/// Residual, law's force, position, velocity and acceleration, the first two over the row's own deviation.
const COLUMNS: usize = 5;

/// Mean square of the noise behind what `fit` leaves over the `noise` that is stated of each row; at least one.
#[must_use]
pub fn noise_power(trials: &[ContactTrial], fit: &Fit, noise: &[Vec<f64>], residual: &[Vec<f64>]) -> f64 {
    let mut pyramids: Vec<Pyramid> = (0..trials.len())
        .map(|number| Pyramid::of(&trials[number], fit, number, &noise[number], &residual[number]))
        .collect();
    let has_free_motion = has_free_motion(trials, fit);
    let (mut power, mut share, mut last) = (0.0, 1.0, 1.0);
    loop {
        let details: Vec<Detail> = pyramids.iter_mut().flat_map(|pyramid| pyramid.descend(has_free_motion)).collect();
        let Some(level) = power_of_level(&details, has_free_motion) else { break };
        share *= 0.5;
        power += share * level;
        last = level;
    }
    let free = if has_free_motion { free_power(trials, fit, noise, residual) } else { 0.0 };
    (power + share * last).max(free).max(1.0)
}

/// One trial's columns at a level, and what the tool does at each of its rows.
struct Pyramid {
    columns: [Vec<f64>; COLUMNS],
    groups: Vec<usize>,
    /// Rows in contact before each row, and before the end.
    in_contact_before: Vec<usize>,
    level: u32,
}

/// The coefficients of one instant, and what the tool does there.
struct Detail {
    row: MotionRow,
    law: f64,
    group: usize,
}

/// Groups of details in free motion and in contact, slow and fast.
const FREE: [usize; 2] = [0, 1];
const IN_CONTACT: [usize; 2] = [2, 3];

impl Pyramid {
    fn of(trial: &ContactTrial, fit: &Fit, number: usize, noise: &[f64], residual: &[f64]) -> Self {
        let surface = fit.model.surface(&fit.values, number);
        let is_inside = |row: usize| fit.model.bilateral || trial.position[row] > surface;
        // Half of the rows of either kind are slow.
        let usual = |inside: bool| {
            let rows = (0..trial.len()).filter(|row| is_inside(*row) == inside);
            median(rows.map(|row| trial.velocity[row].abs())).unwrap_or(0.0)
        };
        let usual = [usual(false), usual(true)];
        let group = |row: usize| {
            let inside = usize::from(is_inside(row));
            2 * inside + usize::from(trial.velocity[row].abs() > usual[inside])
        };
        let over = |row: usize, value: f64| if noise[row].is_finite() { value / noise[row].sqrt() } else { 0.0 };
        let rows = || 0..trial.len();
        Self {
            columns: [
                rows().map(|row| over(row, residual[row])).collect(),
                rows().map(|row| over(row, trial.force[row] - residual[row])).collect(),
                trial.position.clone(),
                trial.velocity.clone(),
                trial.acceleration.clone(),
            ],
            groups: rows().map(group).collect(),
            in_contact_before: rows().fold(vec![0], |mut before, row| {
                before.push(before[row] + usize::from(is_inside(row)));
                before
            }),
            level: 0,
        }
    }

    /// What the tool does over `reach` rows from `first` on, whose middle is `middle`: a detail that reaches into contact anywhere holds what
    /// the law leaves there.
    fn group(&self, first: usize, middle: usize, reach: usize) -> usize {
        let last = (first + reach + 1).min(self.in_contact_before.len() - 1);
        let is_free = self.in_contact_before[last] == self.in_contact_before[first.min(last)];
        2 * usize::from(!is_free) + self.groups[middle] % 2
    }

    /// The details of the next level; what is left are the means. Where the tool is free before the surface, a detail is of free motion that
    /// lies in it as a whole, else what it is in its middle.
    fn descend(&mut self, has_free_motion: bool) -> Vec<Detail> {
        let count = (self.columns[0].len() + 2).saturating_sub(FILTER.len()) / 2;
        let reach = FILTER.len() as f64 - 1.0;
        let detail = |column: &Vec<f64>, at: usize| -> f64 {
            let taps = FILTER.iter().rev().enumerate().zip(&column[2 * at..]);
            taps.map(|((tap, weight), value)| if tap % 2 == 0 { weight * value } else { -weight * value }).sum()
        };
        self.level += 1;
        let wide = f64::from(2u32.pow(self.level));
        let middle = |at: usize| ((wide * at as f64 + 0.5 * reach * (wide - 1.0)) as usize).min(self.groups.len() - 1);
        let details = (0..count).map(|at| {
            let [left, law, motion @ ..]: [f64; COLUMNS] =
                std::array::from_fn(|column| detail(&self.columns[column], at));
            let group = match has_free_motion {
                true => self.group(wide as usize * at, middle(at), (reach * (wide - 1.0)) as usize),
                false => self.groups[middle(at)],
            };
            Detail { row: MotionRow { left, motion }, law, group }
        });
        let details = details.collect();
        for column in &mut self.columns {
            let mean = |at: usize| FILTER.iter().zip(&column[2 * at..]).map(|(weight, value)| weight * value).sum();
            *column = (0..count).map(mean).collect();
        }
        details
    }
}

/// Power of the noise at a level; `None` where nothing tells it. A misfit that is louder than the law at some speed may be all that is left
/// at another: in contact the noise is asked where the law hides it neither slow nor fast. In free motion no law hides anything; where there is
/// some, but too short for this level, contact alone does not tell noise from a misfit.
fn power_of_level(details: &[Detail], has_free_motion: bool) -> Option<f64> {
    let own = |group: usize| -> Vec<&Detail> { details.iter().filter(|detail| detail.group == group).collect() };
    let asked = |group: &usize| own(*group).len() as f64 >= LEAST_PART_OF_COEFFICIENTS * details.len() as f64;
    let of_all = |groups: &[usize]| -> Option<Vec<f64>> {
        groups.iter().copied().filter(asked).map(|group| power_of(&own(group))).collect()
    };
    if !has_free_motion {
        return of_all(&[FREE, IN_CONTACT].concat())?.into_iter().min_by(f64::total_cmp);
    }
    let free: Vec<f64> = FREE.into_iter().filter(asked).filter_map(|group| power_of(&own(group))).collect();
    let least = free.into_iter().min_by(f64::total_cmp)?;
    Some(of_all(&IN_CONTACT).unwrap_or_default().into_iter().fold(least, f64::min))
}

/// Power of what is left in `details` beside the motion's part of it; `None` where they are too few, or the law's force hides it.
fn power_of(details: &[&Detail]) -> Option<f64> {
    if details.len() < LEAST_COUNT {
        return None;
    }
    let rows: Vec<MotionRow> = details.iter().map(|detail| detail.row).collect();
    let law = median(details.iter().map(|detail| detail.law.abs()))?;
    let left = median(without_motion(&rows).into_iter().map(f64::abs))?;
    (law < left).then(|| (left / NORMAL_MEDIAN).powi(2))
}

#[cfg(test)]
mod tests {
    use super::super::data::Data;
    use super::super::fit::Effort;
    use super::super::nominal::nominal_fit;
    use super::super::testing::{FORCE_NOISE, TestContact};
    use super::*;

    /// `contact` with noise beside the sensor's white one, of deviation `size` and a memory of one row.
    fn with_memory(contact: &TestContact, size: f64, seed: u64) -> ContactTrial {
        contact.remembering(1.0, size, seed)
    }

    /// What is found behind the nominal law's residual of two trials, over what is stated.
    fn power_behind(trials: &[ContactTrial]) -> f64 {
        let data = Data::new(trials);
        let nominal = nominal_fit(&data, &TestContact::nominal());
        let nominal = data.fit(&nominal.model, &nominal.values, Effort::FULL);
        let residual = data.residuals(&nominal.model, &nominal.values);
        noise_power(trials, &nominal, &data.noise, &residual)
    }

    #[test]
    fn noise_that_remembers_is_as_loud_as_it_is() {
        for seed in [1, 3, 5] {
            let size = 3.0 * FORCE_NOISE;
            let trials = [seed, seed + 1].map(|seed| with_memory(&TestContact::PLAIN, size, seed));
            // Ten of the sensor's own power. The least of four deviations, each known to an eighth where coefficients are fewest, is a tenth too
            // small, and the noise is still a little quieter where the law hides it than below.
            let power = power_behind(&trials);
            assert!((7.0..11.0).contains(&power), "{power}");
        }
    }

    /// Five rows of memory, and free motion in pieces shorter than what details of that memory need: the whole power is ten of the sensor's.
    #[test]
    fn a_memory_longer_than_the_details_of_free_motion_is_heard_in_it() {
        let trials = [1, 2].map(|seed| TestContact::PLAIN.remembering(5.0, 3.0 * FORCE_NOISE, seed));
        let power = power_behind(&trials);
        assert!((7.0..12.0).contains(&power), "{power}");
        // A neck that pulls near the surface, and the bend of a spring, are no noise: white noise stays what it is.
        let neck = |x: f64| if x < 0.0 { -10.0 * FORCE_NOISE * (1.0 + x / 5e-4).max(0.0) } else { 0.0 };
        let power = power_behind(&[1, 2].map(|seed| TestContact::PLAIN.trial_with(seed, neck)));
        assert!((1.0..1.3).contains(&power), "{power}");
    }

    /// A level at which the law's force is a hundred times what is left in contact: free motion, with twice the stated deviation, is asked alone.
    #[test]
    fn noise_that_the_law_hides_in_contact_is_heard_in_free_motion() {
        let detail = |at: usize, group: usize, law: f64| {
            let left = if at.is_multiple_of(2) { 2.0 * NORMAL_MEDIAN } else { -2.0 * NORMAL_MEDIAN };
            Detail { row: MotionRow { left, motion: [0.0; 3] }, law, group }
        };
        let in_contact = |law: f64| (0..100).map(move |at| detail(at, 2, law));
        let level = |law: f64, free: usize, has_free_motion: bool| {
            let details: Vec<_> = (0..free).map(|at| detail(at, 0, 0.0)).chain(in_contact(law)).collect();
            power_of_level(&details, has_free_motion)
        };
        assert!((level(200.0, 100, true).unwrap() - 4.0).abs() < 1e-12);
        assert_eq!(level(200.0, 0, false), None);
        // What is left in contact is noise where it never leaves, and may be a misfit where free motion is too short to tell.
        assert!((level(0.0, 0, false).unwrap() - 4.0).abs() < 1e-12);
        assert_eq!(level(0.0, 10, true), None);
    }

    #[test]
    fn white_noise_is_as_stated_and_a_misfit_of_the_law_is_none() {
        let white = power_behind(&[1, 2].map(|seed| TestContact::PLAIN.trial(seed)));
        assert!((1.0..1.1).contains(&white), "{white}");
        // Ten times the sensor's noise is left: by the bend of the spring, and by what relaxes.
        for contact in
            [TestContact { exponent: 1.8, ..TestContact::PLAIN }, TestContact { fading: 1.5, ..TestContact::PLAIN }]
        {
            let power = power_behind(&[1, 2].map(|seed| contact.trial(seed)));
            assert!((1.0..1.3).contains(&power), "{power}");
        }
    }
}
