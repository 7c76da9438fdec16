//! What the estimators returned, method by method.

use palpate::{Estimate, Flags, Method, Rejection, Sample};
use palpate_drive::replay_format::UpdateResult;

use super::plan::Plan;
use crate::page;

/// Every estimate of every method that ran.
pub struct Trace {
    columns: Vec<(Method, Vec<Estimate>)>,
    rejections: Vec<Option<Rejection>>,
}

impl Trace {
    /// For `samples` samples.
    #[must_use]
    pub fn new(methods: &[Method], samples: usize) -> Self {
        let columns = methods.iter().map(|&method| (method, Vec::with_capacity(samples))).collect();
        Self { columns, rejections: Vec::with_capacity(samples) }
    }

    /// Takes the outcome of the next sample. A rejected one holds what was before it.
    pub fn take(&mut self, outcome: UpdateResult) {
        for (method, estimates) in &mut self.columns {
            let held = estimates.last().copied().unwrap_or(Estimate::NO_CONTACT);
            estimates.push(outcome.map_or(held, |all| all[*method as usize]));
        }
        self.rejections.push(outcome.err());
    }

    /// The estimates by method, in the order asked for.
    #[must_use]
    pub fn columns(&self) -> &[(Method, Vec<Estimate>)] {
        &self.columns
    }

    /// Why sample `k` was rejected, `None` where it was not.
    #[must_use]
    pub fn rejection(&self, k: usize) -> Option<Rejection> {
        self.rejections.get(k).copied().flatten()
    }

    /// The contact detection, sample by sample.
    #[must_use]
    pub fn contact(&self) -> Vec<bool> {
        let first = self.columns.first().map_or(&[][..], |(_, estimates)| estimates);
        first.iter().map(|estimate| !estimate.flags.contains(Flags::NO_CONTACT)).collect()
    }

    /// What a reader should know of the run.
    #[must_use]
    pub fn notices(&self, plan: &Plan) -> Vec<String> {
        let mut notices = Vec::new();
        let rejected = self.rejections.iter().flatten().count();
        if rejected > 0 {
            notices
                .push(format!("{rejected} samples were rejected as out of range; the estimates before them are held"));
        }
        let contact = self.contact().into_iter().filter(|touching| *touching).count();
        if contact == 0 {
            let on = plan.config.stream.front_end.contact_detector.on_force;
            notices.push(format!("no contact: no force above {on:.3e} while the tool was in the surface"));
            return notices;
        }
        let Some((_, first)) = self.columns.first() else { return notices };
        let restarts = first.iter().skip(1).filter(|estimate| estimate.flags.contains(Flags::RESTARTED)).count();
        if restarts > 0 {
            notices.push(format!(
                "{restarts} gaps in time, longer than the velocity filter can bridge: it began anew there"
            ));
        }
        let below_zero = |e: &Estimate| {
            e.impedance.stiffness + e.half_width.stiffness < 0.0 || e.impedance.damping + e.half_width.damping < 0.0
        };
        notices.extend(self.mostly(contact, below_zero).map(|names| {
            format!(
                "{names}: for most of the contact K or B is negative with its whole interval, which no spring and damper \
                 is: the contact has physics that this model leaves out"
            )
        }));
        notices.extend(self.mostly(contact, |e| e.flags.contains(Flags::DAMPING_UNCERTAIN)).map(|names| {
            format!(
                "{names}: for most of the contact B is not known to better than 30 %; the tool has to move more, or faster"
            )
        }));
        notices
    }

    /// The methods of which `holds` is true for more than half of `contact` samples, `None` where there are none.
    fn mostly(&self, contact: usize, holds: impl Fn(&Estimate) -> bool) -> Option<String> {
        let concerned =
            self.columns.iter().filter(|(_, estimates)| estimates.iter().filter(|e| holds(e)).count() * 2 > contact);
        let names: Vec<&str> = concerned.map(|(method, _)| method.name()).collect();
        (!names.is_empty()).then(|| names.join(", "))
    }

    /// The figures of each method, for the samples that were fed.
    #[must_use]
    pub fn summaries(&self, samples: &[Sample]) -> Vec<(Method, Option<page::Summary>)> {
        self.columns.iter().map(|(method, estimates)| (*method, summary(estimates, samples))).collect()
    }

    /// The traces as the page shows them, for the samples that were fed. The estimates of a method are dropped before the next
    /// method is converted: a long recording is not held twice.
    #[must_use]
    pub fn into_methods(self, samples: &[Sample]) -> Vec<page::Method> {
        self.columns
            .into_iter()
            .map(|(method, estimates)| {
                let column = |value: fn(&Estimate) -> f32| estimates.iter().map(value).collect();
                page::Method {
                    name: method.name(),
                    title: method.title(),
                    stiffness: column(|e| e.impedance.stiffness),
                    stiffness_half_width: column(|e| e.half_width.stiffness),
                    damping: column(|e| e.impedance.damping),
                    damping_half_width: column(|e| e.half_width.damping),
                    innovation: column(|e| e.innovation),
                    summary: summary(&estimates, samples),
                }
            })
            .collect()
    }
}

/// Medians over the samples in contact whose intervals are finite; `None` where there are none.
fn summary(estimates: &[Estimate], samples: &[Sample]) -> Option<page::Summary> {
    let touching = || estimates.iter().zip(samples).filter(|(e, _)| !e.flags.contains(Flags::NO_CONTACT));
    let known = |e: &Estimate| e.half_width.stiffness.is_finite() && e.half_width.damping.is_finite();
    let median_of = |value: fn(&Estimate) -> f32| median(touching().filter(|(e, _)| known(e)).map(|(e, _)| value(e)));
    let energy =
        |value: fn(&Estimate, &Sample) -> f32| -> f64 { touching().map(|(e, s)| f64::from(value(e, s)).powi(2)).sum() };
    Some(page::Summary {
        stiffness: median_of(|e| e.impedance.stiffness)?,
        stiffness_half_width: median_of(|e| e.half_width.stiffness)?,
        damping: median_of(|e| e.impedance.damping)?,
        damping_half_width: median_of(|e| e.half_width.damping)?,
        rmse_percent: 100.0 * (energy(|e, _| e.innovation) / energy(|_, s| s.force)).sqrt(),
    })
}

fn median(values: impl Iterator<Item = f32>) -> Option<f64> {
    let mut values: Vec<f32> = values.collect();
    let middle = values.len().checked_sub(1)? / 2;
    Some(f64::from(*values.select_nth_unstable_by(middle, f32::total_cmp).1))
}
