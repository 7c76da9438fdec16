//! Where simulation and recording differ: in time, phase, depth, speed and frequency, above the expected noise of each moment.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::diagnosis::{BinnedResidual, Location, Phase};
use crate::diagnose::bootstrap::fitted_model::FittedModel;
use crate::diagnose::bootstrap::problem::IdentificationProblem;
use crate::diagnose::model::contact_phase;
use crate::diagnose::model::{Model, Residual};
use crate::diagnose::thresholds::residual_location::{BINS, MAX_LOCATIONS, MIN_LOCATION_SHARE};
use crate::page::quantity;
use crate::rig::Coordinate;

/// One channel of all trials: what is left of it, and all that a bin can be made by.
pub struct ChannelResiduals<'a> {
    problem: &'a IdentificationProblem,
    /// "force" or "effort".
    pub name: &'static str,
    effort: bool,
    /// Residual before, after, and its expected noise, row by row, a vector a trial.
    before: Vec<Vec<f64>>,
    after: Vec<Vec<f64>>,
    noise_model: Vec<Vec<f64>>,
    /// Residuals of a replicate.
    replicate: Vec<Vec<f64>>,
    phases: Vec<Vec<Phase>>,
    depths: Vec<Vec<f64>>,
}

impl<'a> ChannelResiduals<'a> {
    /// A channel of `problem` with `before` and `after` left by two models; `None` where it is not there.
    #[must_use]
    pub fn of(
        problem: &'a IdentificationProblem,
        fitted_model: &FittedModel,
        before: &[Residual],
        after: &[Residual],
        replicate: &[Residual],
        effort: bool,
    ) -> Option<Self> {
        let noise_model =
            if effort { fitted_model.whitener.effort.as_ref()? } else { fitted_model.whitener.force.as_ref()? };
        let pick = |residuals: &[Residual]| -> Vec<Vec<f64>> {
            residuals
                .iter()
                .map(|residual| if effort { residual.effort.clone() } else { residual.force.clone() })
                .collect()
        };
        let (model, values): (&Model, &[f64]) = (&fitted_model.model, &fitted_model.values);
        let trials = problem.sampler.trials.iter().enumerate();
        let (phases, depths) = trials
            .map(|(at, trial)| {
                let filtered = trial.filtered(effort);
                let phases = contact_phase::phases(model, values, at, filtered, fitted_model.excitation.speed);
                (phases, contact_phase::depths(model, values, at, filtered))
            })
            .unzip();
        Some(Self {
            problem,
            name: if effort { "effort" } else { "force" },
            effort,
            before: pick(before),
            after: pick(after),
            noise_model: noise_model.deviation.clone(),
            replicate: pick(replicate),
            phases,
            depths,
        })
    }

    /// Rows that were seen whole.
    fn rows(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.problem.sampler.trials.iter().enumerate().flat_map(|(trial, both)| {
            let valid = &both.filtered(self.effort).valid;
            (0..valid.len()).filter(|&at| valid[at]).map(move |at| (trial, at))
        })
    }

    fn above(&self, (trial, at): (usize, usize)) -> f64 {
        self.before[trial][at].powi(2) - self.noise_model[trial][at].powi(2)
    }

    /// Energy above the expected noise, the sum of every row's square less that of its expected noise.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.rows().map(|row| self.above(row)).sum::<f64>().max(0.0)
    }

    /// The places that hold most of the mismatch, by trial and phase; each with the stretch in which it is worst.
    #[must_use]
    pub fn locations(&self, coordinate: Coordinate) -> Vec<Location> {
        let total = self.energy();
        if total <= 0.0 {
            return Vec::new();
        }
        let mut found = Vec::new();
        for trial in 0..self.before.len() {
            for phase in contact_phase::ALL {
                let rows: Vec<usize> = self
                    .rows()
                    .filter(|&(t, at)| t == trial && self.phases[t][at] == phase)
                    .map(|(_, at)| at)
                    .collect();
                let share = rows.iter().map(|&at| self.above((trial, at))).sum::<f64>() / total;
                if share >= MIN_LOCATION_SHARE {
                    found.push(self.location(trial, phase, &rows, share.min(1.0), coordinate));
                }
            }
        }
        found.sort_by(|a, b| b.share.total_cmp(&a.share));
        found.truncate(MAX_LOCATIONS);
        found
    }

    fn location(&self, trial: usize, phase: Phase, rows: &[usize], share: f64, coordinate: Coordinate) -> Location {
        let stretches = rows.chunk_by(|a, b| b - a <= 2);
        let energy = |rows: &[usize]| rows.iter().map(|&at| self.above((trial, at))).sum::<f64>();
        let worst = stretches.max_by(|a, b| energy(a).total_cmp(&energy(b))).unwrap_or(rows);
        let filtered = self.problem.sampler.trials[trial].filtered(self.effort);
        let raw = &self.problem.sampler.uniform_trials[trial];
        let time = |at: Option<&usize>| at.map_or(0.0, |at| raw.origin + *at as f64 * filtered.step);
        Location {
            channel: self.name,
            trial: raw.name.clone(),
            start_s: time(worst.first()),
            end_s: time(worst.last()),
            phase,
            share,
            states: self.states(trial, rows, coordinate),
        }
    }

    /// Between which depths and speeds the middle four fifths of the energy lie.
    fn states(&self, trial: usize, rows: &[usize], coordinate: Coordinate) -> String {
        let filtered = self.problem.sampler.trials[trial].filtered(self.effort);
        let range = |pick: &dyn Fn(usize) -> f64| {
            let mut all: Vec<(f64, f64)> =
                rows.iter().map(|&at| (pick(at), self.above((trial, at)).max(0.0))).collect();
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            let total: f64 = all.iter().map(|(_, weight)| weight).sum();
            let at = |part: f64| {
                let mut sum = 0.0;
                let reached = all.iter().find(|(_, weight)| {
                    sum += weight;
                    sum >= part * total
                });
                reached.or(all.last()).map_or(0.0, |(value, _)| *value)
            };
            (at(0.1), at(0.9))
        };
        let (low, high) = range(&|at| self.depths[trial][at]);
        let (slow, fast) = range(&|at| filtered.velocity[at].abs());
        let (metre, speed) = (coordinate.position_unit(), coordinate.velocity_unit());
        format!("x {}, |v| {}", quantity::between(low, high, metre), quantity::between(slow, fast, speed))
    }

    /// The maps of the page.
    #[must_use]
    pub fn maps(&self, coordinate: Coordinate) -> Vec<BinnedResidual> {
        let mut maps = vec![self.by_phase()];
        let filtered_trials = |trial: usize| self.problem.sampler.trials[trial].filtered(self.effort);
        maps.push(self.along("depth", coordinate.position_unit(), &|trial, at| self.depths[trial][at]));
        maps.push(self.along("speed", coordinate.velocity_unit(), &|trial, at| filtered_trials(trial).velocity[at]));
        maps.push(self.along("time", "s", &|trial, at| at as f64 * filtered_trials(trial).step));
        maps.push(self.by_frequency());
        maps.retain(|map| map.labels.len() > 1);
        maps
    }

    fn by_phase(&self) -> BinnedResidual {
        let here: Vec<Phase> = contact_phase::ALL
            .into_iter()
            .filter(|phase| self.rows().any(|(trial, at)| self.phases[trial][at] == *phase))
            .collect();
        let labels = here.iter().map(|phase| contact_phase::word(*phase).to_owned()).collect();
        self.map("phase", "", labels, &|(trial, at)| here.iter().position(|phase| *phase == self.phases[trial][at]))
    }

    fn along(&self, along: &'static str, unit: &str, pick: &dyn Fn(usize, usize) -> f64) -> BinnedResidual {
        let all = self.rows().map(|(trial, at)| pick(trial, at));
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let width = (high - low) / BINS as f64;
        if width.is_nan() || width <= 0.0 {
            return self.map(along, unit, Vec::new(), &|_| None);
        }
        let (factor, prefixed) = quantity::prefixed_unit(low.abs().max(high.abs()), unit);
        let labels = (0..BINS).map(|bin| quantity::short((low + (bin as f64 + 0.5) * width) / factor)).collect();
        self.map(along, &prefixed, labels, &|(trial, at)| {
            Some((((pick(trial, at) - low) / width) as usize).min(BINS - 1))
        })
    }

    fn map(
        &self,
        along: &'static str,
        unit: &str,
        labels: Vec<String>,
        bin: &dyn Fn((usize, usize)) -> Option<usize>,
    ) -> BinnedResidual {
        let mut sums = vec![[0.0; 4]; labels.len()];
        for row in self.rows() {
            if let Some(sum) = bin(row).and_then(|bin| sums.get_mut(bin)) {
                let (trial, at) = row;
                sum[0] += self.before[trial][at].powi(2);
                sum[1] += self.after[trial][at].powi(2);
                sum[2] += self.noise_model[trial][at].powi(2);
                sum[3] += self.above(row);
            }
        }
        let total = self.energy().max(f64::MIN_POSITIVE);
        let over = |which: usize| sums.iter().map(|s| s[which] / s[2].max(f64::MIN_POSITIVE)).collect();
        BinnedResidual {
            channel: self.name,
            along,
            unit: unit.to_owned(),
            before: over(0),
            after: over(1),
            share: sums.iter().map(|s| (s[3] / total).clamp(0.0, 1.0)).collect(),
            labels,
        }
    }

    fn by_frequency(&self) -> BinnedResidual {
        let step = self.problem.sampler.trials.first().map_or(1.0, |trial| trial.filtered(self.effort).step);
        let longest = self.before.iter().map(Vec::len).max().unwrap_or(0);
        let highest = 0.4 / step;
        let lowest = (4.0 / (longest as f64 * step)).max(highest / 1000.0);
        let edges: Vec<f64> = crate::effects::geometric(lowest, highest, BINS + 1);
        let spectra =
            [&self.before, &self.after, &self.replicate].map(|residuals| self.spectrum(residuals, step, &edges));
        let [before, after, noise_model] = &spectra;
        let above: Vec<f64> =
            before.iter().zip(noise_model).map(|(before, noise_model)| (before - noise_model).max(0.0)).collect();
        let total = above.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let over = |power: &[f64]| power.iter().zip(noise_model).map(|(p, f)| p / f.max(f64::MIN_POSITIVE)).collect();
        BinnedResidual {
            channel: self.name,
            along: "frequency",
            unit: "Hz".to_owned(),
            labels: edges.windows(2).map(|pair| quantity::short((pair[0] * pair[1]).sqrt())).collect(),
            before: over(before),
            after: over(after),
            share: above.iter().map(|above| above / total).collect(),
        }
    }

    /// Power between each pair of edges; what was not seen whole counts as nothing.
    fn spectrum(&self, residuals: &[Vec<f64>], step: f64, edges: &[f64]) -> Vec<f64> {
        let mut power = vec![0.0; edges.len().saturating_sub(1)];
        for (trial, residual) in residuals.iter().enumerate() {
            let valid = &self.problem.sampler.trials[trial].filtered(self.effort).valid;
            let value = |(value, valid): (&f64, &bool)| Complex::new(if *valid { *value } else { 0.0 }, 0.0);
            let mut wave: Vec<Complex<f64>> = residual.iter().zip(valid).map(value).collect();
            let rows = wave.len();
            FftPlanner::new().plan_fft_forward(rows).process(&mut wave);
            for (at, line) in wave.iter().enumerate().take(rows / 2).skip(1) {
                let frequency = at as f64 / (rows as f64 * step);
                let bin = edges.partition_point(|edge| *edge <= frequency);
                if let Some(sum) = bin.checked_sub(1).and_then(|bin| power.get_mut(bin)) {
                    *sum += line.norm_sqr() / rows as f64;
                }
            }
        }
        power
    }
}
