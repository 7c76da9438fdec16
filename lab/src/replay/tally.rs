//! What is counted of a replay while it passes by: the figures of each method, and what a reader should know.

use palpate::{Estimate, Flags, Method};

use super::median::Median;
use super::run::Step;
use crate::page::Summary;

/// The counts of a replay. All rows are handed to it in order, until [`Tally::end_of_pass`] has had enough.
pub struct Tally {
    methods: Vec<MethodTally>,
    passes: usize,
    rows: usize,
    rejected: usize,
    contact: usize,
    restarts: usize,
}

struct MethodTally {
    method: Method,
    /// Over the contact, where both intervals are finite: K, its half-width, B, its half-width.
    medians: [Median; 4],
    /// Sum of squares of the innovation and the force over the contact.
    innovation_energy: f64,
    force_energy: f64,
    below_zero: usize,
    damping_uncertain: usize,
}

impl Tally {
    /// Medians need so many passes.
    const PASSES: usize = 2;

    /// Of `methods`, in the order of the estimates in each [`Step`].
    #[must_use]
    pub fn new(methods: &[Method]) -> Self {
        let methods = methods.iter().map(|method| MethodTally::new(*method)).collect();
        Self { methods, passes: 0, rows: 0, rejected: 0, contact: 0, restarts: 0 }
    }

    /// The next row.
    pub fn take(&mut self, step: &Step<'_>) {
        if self.passes == Self::PASSES {
            return;
        }
        if self.passes == 0 {
            self.count(step);
        }
        for (method, estimate) in self.methods.iter_mut().zip(step.estimates) {
            method.take_medians(estimate);
        }
    }

    fn count(&mut self, step: &Step<'_>) {
        // The filters begin with the first sample, which is no gap.
        let is_restart = step.estimates.first().is_some_and(|estimate| estimate.flags.contains(Flags::RESTARTED));
        self.restarts += usize::from(is_restart && self.rows > 0);
        self.rows += 1;
        self.rejected += usize::from(step.rejected);
        self.contact += usize::from(step.contact());
        for (method, estimate) in self.methods.iter_mut().zip(step.estimates) {
            method.count(estimate, step.sample.force);
        }
    }

    /// After the last row: whether all is counted, or all rows are needed once more.
    pub fn end_of_pass(&mut self) -> bool {
        self.methods.iter_mut().flat_map(|method| &mut method.medians).for_each(Median::end_of_pass);
        self.passes = (self.passes + 1).min(Self::PASSES);
        self.passes == Self::PASSES
    }

    /// The figures of each method; `None` where no interval was finite in contact.
    #[must_use]
    pub fn summaries(&self) -> Vec<(Method, Option<Summary>)> {
        self.methods.iter().map(|method| (method.method, method.summary())).collect()
    }

    /// What a reader should know of the run; `on_force` is the force from which there is contact.
    #[must_use]
    pub fn notices(&self, on_force: f32) -> Vec<String> {
        let mut notices = Vec::new();
        if self.rejected > 0 {
            let rejected = self.rejected;
            notices
                .push(format!("{rejected} samples were rejected as out of range; the estimates before them are held"));
        }
        if self.contact == 0 {
            notices.push(format!("no contact: no force above {on_force:.3e} while the tool was in the surface"));
            return notices;
        }
        if self.restarts > 0 {
            let restarts = self.restarts;
            notices.push(format!(
                "{restarts} gaps in time, longer than the velocity filter can bridge: it began anew there"
            ));
        }
        notices.extend(self.mostly(|method| method.below_zero).map(|names| {
            format!(
                "{names}: for most of the contact K or B is negative with its whole interval, which no spring and damper \
                 is: the contact has physics that this model leaves out"
            )
        }));
        notices.extend(self.mostly(|method| method.damping_uncertain).map(|names| {
            format!(
                "{names}: for most of the contact B is not known to better than 30 %; the tool has to move more, or faster"
            )
        }));
        notices
    }

    /// The methods of which `count` is more than half of the contact, `None` where there are none.
    fn mostly(&self, count: impl Fn(&MethodTally) -> usize) -> Option<String> {
        let concerned = self.methods.iter().filter(|method| count(method) * 2 > self.contact);
        let names: Vec<&str> = concerned.map(|method| method.method.name()).collect();
        (!names.is_empty()).then(|| names.join(", "))
    }
}

impl MethodTally {
    fn new(method: Method) -> Self {
        Self {
            method,
            medians: Default::default(),
            innovation_energy: 0.0,
            force_energy: 0.0,
            below_zero: 0,
            damping_uncertain: 0,
        }
    }

    fn count(&mut self, estimate: &Estimate, force: f32) {
        let (value, half_width) = (estimate.impedance, estimate.half_width);
        let is_below_zero = value.stiffness + half_width.stiffness < 0.0 || value.damping + half_width.damping < 0.0;
        self.below_zero += usize::from(is_below_zero);
        self.damping_uncertain += usize::from(estimate.flags.contains(Flags::DAMPING_UNCERTAIN));
        if !estimate.flags.contains(Flags::NO_CONTACT) {
            self.innovation_energy += f64::from(estimate.innovation).powi(2);
            self.force_energy += f64::from(force).powi(2);
        }
    }

    fn take_medians(&mut self, estimate: &Estimate) {
        let (value, half_width) = (estimate.impedance, estimate.half_width);
        let is_known = half_width.stiffness.is_finite() && half_width.damping.is_finite();
        if is_known && !estimate.flags.contains(Flags::NO_CONTACT) {
            let values = [value.stiffness, half_width.stiffness, value.damping, half_width.damping];
            self.medians.iter_mut().zip(values).for_each(|(median, value)| median.take(value));
        }
    }

    fn summary(&self) -> Option<Summary> {
        let [stiffness, stiffness_half_width, damping, damping_half_width] =
            self.medians.each_ref().map(|median| median.value().map(f64::from));
        Some(Summary {
            stiffness: stiffness?,
            stiffness_half_width: stiffness_half_width?,
            damping: damping?,
            damping_half_width: damping_half_width?,
            rmse_percent: 100.0 * (self.innovation_energy / self.force_energy).sqrt(),
        })
    }
}
