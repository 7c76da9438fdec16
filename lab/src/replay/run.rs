//! A recording through the estimators, as often as it is asked for: nothing of what they return is kept.

use anyhow::Result;
use palpate::{BankEstimates, Estimate, EstimatorBank, Flags, Method, Sample};
use palpate_drive::replay_format::UpdateResult;

use super::{Place, Plan};
use crate::page;
use crate::qemu_bench::{QemuBench, QemuRun};
use crate::recording::Recording;
use crate::tools::Leave;

/// Runs the estimators at their place.
pub enum Runner {
    /// Here.
    Host,
    /// Under QEMU.
    QemuBench(QemuBench),
}

impl Runner {
    /// Sets up what the place needs.
    ///
    /// # Errors
    /// A tool is missing or the image does not build.
    pub fn prepare(place: Place) -> Result<Self> {
        Ok(match place {
            Place::Host => Self::Host,
            Place::Qemu => Self::QemuBench(QemuBench::prepare(Leave::Install)?),
        })
    }

    /// Readies `recording` to be gone through as `plan` says; `progress` receives from time to time how many samples are done.
    ///
    /// # Errors
    /// The device fails.
    pub fn start<'a>(&self, plan: &'a Plan, recording: &'a Recording, progress: impl Fn(u64)) -> Result<Run<'a>> {
        let device = match self {
            Self::Host => None,
            Self::QemuBench(device) => Some(device.start(&plan.config, plan.samples(recording), progress)?),
        };
        Ok(Run { plan, recording, device })
    }
}

/// A recording that can be gone through: on the host the estimators run anew each time, to the same bits; what the device returned
/// is in a file.
pub struct Run<'a> {
    plan: &'a Plan,
    recording: &'a Recording,
    device: Option<QemuRun>,
}

/// A row of a recording, with the estimates after it.
pub struct Step<'a> {
    /// Seconds.
    pub time: f64,
    /// What was fed.
    pub sample: Sample,
    /// The sample was rejected, and the estimates before it are held.
    pub rejected: bool,
    /// Of the methods that run, in the order asked for.
    pub estimates: &'a [Estimate],
}

impl Step<'_> {
    /// The contact detection, which all methods share.
    #[must_use]
    pub fn contact(&self) -> bool {
        self.estimates.first().is_some_and(|estimate| !estimate.flags.contains(Flags::NO_CONTACT))
    }
}

impl Run<'_> {
    /// Samples between two words of progress.
    const BLOCK: usize = 4096;

    /// Hands each row to `take`, in order; `progress` receives from time to time how many are done.
    ///
    /// # Errors
    /// The settings are out of range, the device fails, or `take` returns one.
    pub fn pass(&self, progress: impl Fn(u64), mut take: impl FnMut(&Step<'_>) -> Result<()>) -> Result<()> {
        let methods = &self.plan.methods;
        let mut held = vec![Estimate::NO_CONTACT; methods.len()];
        let mut rows = self.recording.time.iter().zip(self.plan.samples(self.recording)).enumerate();
        self.outcomes(|outcome| {
            let Some((row, (&time, sample))) = rows.next() else { return Ok(()) };
            if row % Self::BLOCK == 0 {
                progress(row as u64);
            }
            if let Ok(all) = &outcome {
                hold(&mut held, methods, all);
            }
            take(&Step { time, sample, rejected: outcome.is_err(), estimates: &held })
        })
    }

    /// Hands what each update returned to `take`, in order.
    ///
    /// # Errors
    /// As [`Run::pass`].
    pub fn outcomes(&self, mut take: impl FnMut(UpdateResult) -> Result<()>) -> Result<()> {
        match &self.device {
            None => {
                let mut bank = EstimatorBank::new(&self.plan.config)?;
                self.plan.samples(self.recording).try_for_each(|sample| take(bank.update(sample)))
            }
            Some(device) => device.each(take).map(|_counters| ()),
        }
    }
}

fn hold(held: &mut [Estimate], methods: &[Method], all: &BankEstimates) {
    held.iter_mut().zip(methods).for_each(|(held, method)| *held = all[*method as usize]);
}

/// The numbers of an estimate that the page draws, in the order of its columns.
pub fn drawn(estimate: &Estimate) -> [f32; page::ESTIMATE_COLUMNS] {
    let (value, half_width) = (estimate.impedance, estimate.half_width);
    [value.stiffness, half_width.stiffness, value.damping, half_width.damping, estimate.innovation]
}
