//! Sizes of the recordings, which searches start from and limits are stated in.

use super::criteria::NOTABLE_POWER;
use super::trial::ContactTrial;
use crate::diagnose::ends::ends;
use crate::effects::ExcitationStats;

/// Sizes of the recordings.
#[derive(Debug, Clone, PartialEq)]
pub struct Scales {
    /// Greatest depth below the surface, m or rad.
    pub depth: f64,
    /// Root mean square of the speed in contact.
    pub speed: f64,
    /// Range of the force.
    pub force: f64,
    /// Greatest reading of the force either way, less what its noise adds at the most: what no range of the sensor lies below.
    pub reached_force: f64,
    /// Least and greatest position.
    pub positions: [f64; 2],
    /// Longest trial, s.
    pub duration_s: f64,
    /// Usual time between rows, s.
    pub step_s: f64,
    /// Usual time between recorded rows, s.
    pub source_step_s: f64,
    /// Step of the encoder.
    pub resolution: f64,
    /// Stiffness that is expected: that of the rig file.
    pub given_stiffness: f64,
    /// Whether positions are angles.
    pub is_rotary: bool,
}

impl Scales {
    /// Stiffness of the size of force over depth.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        (self.force / self.depth.max(f64::MIN_POSITIVE)).max(f64::MIN_POSITIVE)
    }

    /// All the way between the ends.
    #[must_use]
    pub fn travel(&self) -> f64 {
        self.positions[1] - self.positions[0]
    }

    /// Of `trials` whose surface lies at `surface`.
    #[must_use]
    pub fn of(trials: &[ContactTrial], surface: f64, bilateral: bool, given_stiffness: f64, is_rotary: bool) -> Self {
        let range = |pick: &dyn Fn(&ContactTrial) -> &Vec<f64>| {
            ends(trials.iter().flat_map(|trial| pick(trial).iter().copied()))
        };
        let positions = range(&|trial| &trial.position);
        let forces = range(&|trial| &trial.force);
        let travel = positions[1] - positions[0];
        let depth =
            if bilateral { (positions[1] - surface).max(surface - positions[0]) } else { positions[1] - surface };
        let touching = |trial: &ContactTrial, row: usize| bilateral || trial.position[row] > surface;
        let (mut sum, mut count) = (0.0, 0usize);
        for trial in trials {
            for row in (0..trial.len()).filter(|row| touching(trial, *row)) {
                sum += trial.velocity[row].powi(2);
                count += 1;
            }
        }
        let duration_s = trials.iter().map(ContactTrial::duration_s).fold(0.0, f64::max);
        let speed = (sum / count.max(1) as f64).sqrt();
        Self {
            depth: depth.clamp(1e-2 * travel, 2.0 * travel.max(f64::MIN_POSITIVE)),
            speed: if speed > 0.0 { speed } else { travel / duration_s },
            force: (forces[1] - forces[0]).max(f64::MIN_POSITIVE),
            reached_force: trials.iter().map(reached_force).fold(0.0, f64::max),
            positions,
            duration_s,
            step_s: trials.first().map_or(1.0, |trial| trial.step_s),
            source_step_s: trials.first().map_or(1.0, |trial| trial.source_step_s),
            resolution: trials.iter().map(|trial| trial.figures.position.resolution).fold(0.0, f64::max),
            given_stiffness,
            is_rotary,
        }
    }

    /// The same as effects ask for it, of `trials` under a stiffness and a surface.
    #[must_use]
    pub fn excitation(
        &self,
        trials: &[ContactTrial],
        stiffness: f64,
        surface: f64,
        bilateral: bool,
    ) -> ExcitationStats {
        let passes = |trial: &ContactTrial| Passes::of(trial, surface, bilateral, 0.2 * self.depth);
        let all: Vec<Passes> = trials.iter().map(passes).collect();
        let squares = trials.iter().flat_map(|trial| &trial.acceleration).map(|value| value * value).sum::<f64>();
        let rows: usize = trials.iter().map(ContactTrial::len).sum();
        let force = trials.iter().flat_map(|trial| &trial.force).fold(0.0f64, |most, force| most.max(force.abs()));
        let pull = ExcitationStats::greatest_pull(trials.iter().flat_map(|trial| &trial.force));
        let heights = trials.iter().flat_map(|trial| trial.position.iter().map(|position| surface - position));
        let forces = trials.iter().flat_map(|trial| trial.force.iter().copied());
        ExcitationStats {
            depth: self.depth,
            speed: self.speed,
            acceleration: (squares / rows.max(1) as f64).sqrt(),
            force,
            pull,
            half_pull_height: ExcitationStats::half_pull_height(pull, forces.zip(heights)),
            effort: 0.0,
            travel: (self.positions[0], self.positions[1]),
            duration: self.duration_s,
            step: self.step_s,
            sample: self.source_step_s,
            stiffness: stiffness.max(1e-3 * self.stiffness()),
            inertia: 0.0,
            visits: all.iter().map(|passes| passes.visits).sum(),
            releases: all.iter().map(|passes| passes.releases).sum(),
            way_back: all.iter().map(|passes| passes.way_back).fold(0.0, f64::max),
            free_span: all.iter().map(|passes| passes.free_span).fold(0.0, f64::max),
            longest_contact: all.iter().map(|passes| passes.longest_contact).fold(0.0, f64::max),
            has_force: true,
            has_effort: false,
            is_rotary: self.is_rotary,
            is_bilateral: bilateral,
        }
    }
}

/// The greatest of `n` normal errors is sqrt(2 ln n) deviations (R. A. Fisher, L. H. C. Tippett, *Proc. Camb. Phil. Soc.* 24, 1928, 180),
/// and the deviation is known to within [`NOTABLE_POWER`].
fn reached_force(trial: &ContactTrial) -> f64 {
    let greatest = trial.force.iter().fold(0.0f64, |most, force| most.max(force.abs()));
    greatest - (2.0 * (trial.len() as f64).ln() * NOTABLE_POWER * trial.force_variance).value().sqrt()
}

/// How a trial went in and out.
struct Passes {
    /// Ways inwards of some depth.
    visits: usize,
    /// Moments at which the contact ends.
    releases: usize,
    /// Farthest way back out, of all the way in.
    way_back: f64,
    /// Share of the rows from the first without contact to the last.
    free_span: f64,
    /// Share of the rows in the longest stretch without a free moment.
    longest_contact: f64,
}

impl Passes {
    fn of(trial: &ContactTrial, surface: f64, bilateral: bool, least: f64) -> Self {
        let depth = |position: f64| if bilateral { position } else { position.max(surface) };
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut deepest, mut shallowest, mut back) = (f64::NEG_INFINITY, f64::INFINITY, 0.0f64);
        let (mut visits, mut inward) = (0, false);
        for position in trial.position.iter().map(|position| depth(*position)) {
            (deepest, shallowest) = (deepest.max(position), shallowest.min(position));
            back = back.max(deepest - position);
            if inward {
                high = high.max(position);
                if position < high - least {
                    (inward, low) = (false, position);
                }
            } else {
                low = low.min(position);
                if position > low + least {
                    (inward, high) = (true, position);
                    visits += 1;
                }
            }
        }
        let inside = |position: f64| !bilateral && position > surface;
        let releases = trial.position.windows(2).filter(|pair| inside(pair[0]) && !inside(pair[1])).count();
        let free = |position: &f64| !bilateral && *position <= surface;
        let (first, last) = (trial.position.iter().position(free), trial.position.iter().rposition(free));
        let free_rows = first.zip(last).map_or(0, |(first, last)| last - first);
        let longest = trial.position.split(free).map(<[f64]>::len).max().unwrap_or(0);
        let span = deepest - shallowest;
        Self {
            visits,
            releases,
            way_back: if span > 0.0 { back / span } else { 0.0 },
            free_span: free_rows as f64 / trial.len().max(1) as f64,
            longest_contact: longest as f64 / trial.len().max(1) as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha12Rng;
    use rand_distr::{Distribution as _, Normal};

    use super::super::testing::{FORCE_NOISE, TestContact};
    use super::*;

    #[test]
    fn noise_on_top_of_a_clipped_force_is_no_force_that_was_reached() {
        let noise = Normal::new(0.0, FORCE_NOISE).unwrap();
        for seed in 0..20 {
            let mut random = ChaCha12Rng::seed_from_u64(seed);
            let mut recording = TestContact::PLAIN.recording(1);
            // Clipped by the transducer, before what the amplifier adds.
            recording.force = Some(recording.time.iter().map(|_| 2.0 + noise.sample(&mut random)).collect());
            let reached = reached_force(&TestContact::seen(&recording));
            // The greatest of 3000 errors: 3.4 deviations, and 5 once in a thousand such trials.
            assert!(reached < 2.0 && reached > 2.0 - 3.0 * FORCE_NOISE, "seed {seed}: {reached}");
        }
    }
}
