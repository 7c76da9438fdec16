//! A trajectory that the host gives: followed under position control at the tick, within limits that are checked here, on the
//! drive itself, and ended with zero effort by whatever goes wrong.
//!
//! The host prepares a run ([`TrajectoryConfig`]), fills the queue with references, one a tick, starts it, and keeps the queue
//! from running dry. effort = proportional e + derivative de/dt, e = reference - depth, de/dt behind a first-order low-pass; it
//! never leaves the limit of the effort. Once a run has ended, for whatever reason, the effort is zero until the next start.

use crate::cycle::Report;
use crate::trajectory_config::TrajectoryConfig;
use crate::trajectory_status::{StopReason, TrajectoryState, TrajectoryStatus};
use crate::{Faults, TICK_HZ};
use palpate::Sample;
use palpate::error::ConfigError;
use palpate::math::{larger, smaller};

/// Ticks between two readings of which a speed is taken.
const SPEED_TICKS: usize = 16;

/// Most references of one request.
pub const POINTS: usize = 32;

/// Follows a trajectory, tick by tick.
#[derive(Debug, Clone)]
pub struct TrajectoryFollower {
    config: Option<TrajectoryConfig>,
    status: TrajectoryStatus,
    /// Last error, and its rate behind the low-pass.
    error: Option<f32>,
    rate: f32,
    /// The depths at the last references, a ring: that of reference n at n modulo its length.
    depths: [f32; SPEED_TICKS],
}

impl Default for TrajectoryFollower {
    fn default() -> Self {
        Self::new()
    }
}

impl TrajectoryFollower {
    /// Nothing prepared.
    pub const fn new() -> Self {
        let status = TrajectoryStatus { state: TrajectoryState::Idle, played: 0 };
        Self { config: None, status, error: None, rate: 0.0, depths: [0.0; SPEED_TICKS] }
    }

    /// Prepares a run. One that goes on is ended by it.
    ///
    /// # Errors
    /// As [`TrajectoryConfig::check`]; then nothing is prepared.
    pub fn prepare(&mut self, config: TrajectoryConfig) -> Result<(), ConfigError> {
        *self = Self::new();
        config.check()?;
        self.config = Some(config);
        self.status.state = TrajectoryState::Prepared;
        Ok(())
    }

    /// Starts what was prepared; nothing happens where nothing is, or a run has ended.
    pub fn start(&mut self) {
        if self.status.state == TrajectoryState::Prepared {
            self.status.state = TrajectoryState::Running;
        }
    }

    /// Ends a run for `reason`: the effort is zero from this tick on.
    pub fn stop(&mut self, reason: StopReason) {
        if matches!(self.status.state, TrajectoryState::Running | TrajectoryState::Prepared) {
            self.status.state = TrajectoryState::Stopped(reason);
        }
    }

    /// Whether a reference is taken at this tick.
    pub fn is_running(&self) -> bool {
        self.status.state == TrajectoryState::Running
    }

    /// Where it stands.
    pub fn status(&self) -> TrajectoryStatus {
        self.status
    }

    /// Ends a run whose host has been silent for `ticks`.
    pub fn check_silence(&mut self, ticks: u32) {
        if self.config.is_some_and(|config| ticks > u32::from(config.timeout)) {
            self.stop(StopReason::Silence);
        }
    }

    /// The effort for the tick of `report`, `reference` being taken from the queue, m from the surface: zero unless a run goes on.
    pub fn update(&mut self, report: &Report, reference: Option<f32>) -> f32 {
        let Some(config) = self.config.filter(|_| self.is_running()) else { return 0.0 };
        match self.follow(&config, report, reference) {
            Ok(effort) => effort,
            Err(reason) => {
                self.stop(reason);
                0.0
            }
        }
    }

    fn follow(
        &mut self,
        config: &TrajectoryConfig,
        report: &Report,
        reference: Option<f32>,
    ) -> Result<f32, StopReason> {
        let sample = report.sample.filter(|_| report.faults.difference(Faults::OVERRUN).is_empty());
        let sample = sample.ok_or(StopReason::Fault)?;
        self.check(config, sample)?;
        if self.status.played >= config.length {
            self.status.state = TrajectoryState::Finished;
            return Ok(0.0);
        }
        let reference = reference.ok_or(StopReason::Underrun)?;
        if !reference.is_finite() {
            return Err(StopReason::Reference);
        }
        self.status.played += 1;
        let error = reference - sample.position;
        let difference = (error - self.error.unwrap_or(error)) * f32::from(TICK_HZ);
        self.error = Some(error);
        self.rate += config.pass * (difference - self.rate);
        let wanted = config.proportional * error + config.derivative * self.rate;
        if wanted.is_finite() {
            Ok(larger(smaller(wanted, config.effort), -config.effort))
        } else {
            Err(StopReason::Reference)
        }
    }

    /// Whether `sample` keeps the limits.
    fn check(&mut self, config: &TrajectoryConfig, sample: Sample) -> Result<(), StopReason> {
        let [least, greatest] = config.depth;
        if !(least..=greatest).contains(&sample.position) {
            return Err(StopReason::Depth);
        }
        // Comparisons that a value that is no number fails.
        if sample.force.is_nan() || sample.force.abs() > config.force {
            return Err(StopReason::Force);
        }
        let played = self.status.played as usize;
        let Some(oldest) = self.depths.get_mut(played % SPEED_TICKS) else { return Err(StopReason::Fault) };
        let before = core::mem::replace(oldest, sample.position);
        let way = (sample.position - before).abs() * f32::from(TICK_HZ) / SPEED_TICKS as f32;
        let is_full = played >= SPEED_TICKS;
        if is_full && (way.is_nan() || way > config.speed) { Err(StopReason::Speed) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::{Input, Validity};
    use palpate::Estimate;
    use std::vec::Vec;

    const CONFIG: TrajectoryConfig = TrajectoryConfig {
        depth: [-0.02, 0.02],
        speed: 0.2,
        force: 5.0,
        effort: 3.0,
        proportional: 500.0,
        derivative: 10.0,
        pass: 0.5,
        length: 200,
        timeout: 100,
    };

    fn report(position: f32, force: f32) -> Report {
        Report {
            tick: 0,
            input: Input::NOTHING,
            sample: Some(Sample { position, force, elapsed: 1e-3 }),
            faults: Faults::empty(),
            validity: Validity::Live,
            restarted: false,
            revision: 0,
            estimate: Estimate::UNKNOWN,
            zero: 0.0,
            effort: 0.0,
        }
    }

    fn running() -> TrajectoryFollower {
        let mut follower = TrajectoryFollower::new();
        follower.prepare(CONFIG).unwrap();
        follower.start();
        follower
    }

    /// Efforts of 50 ticks at rest at 1 mm, `change` at tick 30, and why it ended.
    fn run(change: impl Fn(&mut Report, &mut Option<f32>)) -> (Vec<f32>, TrajectoryState) {
        let mut follower = running();
        let efforts = (0..50)
            .map(|tick| {
                let (mut report, mut reference) = (report(0.001, 0.3), Some(0.002));
                if tick == 30 {
                    change(&mut report, &mut reference);
                }
                follower.update(&report, reference)
            })
            .collect();
        (efforts, follower.status().state)
    }

    #[test]
    fn it_pushes_towards_the_reference_within_the_limit_of_the_effort() {
        let mut follower = running();
        assert!((follower.update(&report(0.001, 0.0), Some(0.002)) - 0.5).abs() < 1e-4);
        assert_eq!(follower.update(&report(0.001, 0.0), Some(10.0)), 3.0);
        assert_eq!(follower.update(&report(0.001, 0.0), Some(-10.0)), -3.0);
    }

    #[test]
    fn whatever_goes_wrong_ends_it_in_zero_effort_for_good() {
        let (efforts, state) = run(|_, _| {});
        assert!(efforts.iter().all(|effort| *effort > 0.0) && state == TrajectoryState::Running);
        let stopped = |change: fn(&mut Report, &mut Option<f32>), reason: StopReason| {
            let (efforts, state) = run(change);
            assert!(efforts[..30].iter().all(|effort| *effort > 0.0), "{reason:?}");
            assert!(efforts[30..].iter().all(|effort| *effort == 0.0), "{reason:?}: {efforts:?}");
            assert_eq!(state, TrajectoryState::Stopped(reason));
        };
        fn sample(position: f32, force: f32) -> Option<Sample> {
            Some(Sample { position, force, elapsed: 1e-3 })
        }
        stopped(|report, _| report.sample = sample(0.021, 0.0), StopReason::Depth);
        stopped(|report, _| report.sample = sample(f32::NAN, 0.0), StopReason::Depth);
        stopped(|report, _| report.sample = sample(0.001, -5.1), StopReason::Force);
        stopped(|report, _| report.sample = sample(0.001, f32::NAN), StopReason::Force);
        // 5 mm within 16 ticks are 0.31 m/s.
        stopped(|report, _| report.sample = sample(0.006, 0.0), StopReason::Speed);
        stopped(|report, _| report.sample = None, StopReason::Fault);
        stopped(|report, _| report.faults = Faults::LINK_GONE, StopReason::Fault);
        stopped(|_, reference| *reference = None, StopReason::Underrun);
        stopped(|_, reference| *reference = Some(f32::NAN), StopReason::Reference);
    }

    #[test]
    fn the_rate_of_the_error_passes_a_low_pass_and_starts_at_zero() {
        let config = TrajectoryConfig { effort: 1e9, proportional: 1.0, derivative: 1.0, pass: 0.25, ..CONFIG };
        let mut follower = TrajectoryFollower::new();
        follower.prepare(config).unwrap();
        follower.start();
        // Errors 1, 3, 3 and 2 m, a millisecond apart: rates 0, 2000, 0 and -1000 m/s before the filter.
        let efforts = [1.0, 3.0, 3.0, 2.0].map(|reference| follower.update(&report(0.0, 0.0), Some(reference)));
        assert_eq!(efforts, [1.0, 3.0 + 500.0, 3.0 + 375.0, 2.0 + 31.25]);
    }

    #[test]
    fn the_force_may_be_its_limit_either_way() {
        for force in [5.0, -5.0] {
            let mut follower = running();
            follower.update(&report(0.001, force), Some(0.002));
            assert!(follower.is_running(), "{force}");
        }
    }

    /// The speed is the way of the last 16 ticks over their time, wherever in its ring of depths a movement begins.
    #[test]
    fn the_speed_is_a_mean_over_sixteen_ticks_at_every_place_of_its_ring() {
        // A step of 2^-9 m in 16 ticks is 0.1220703125 m/s, exactly.
        let (rest, small, speed) = (1.0 / 256.0, 1.0 / 512.0, 1_000.0 / 512.0 / 16.0);
        let step = |at: usize, far: f32, config: TrajectoryConfig| {
            let mut follower = TrajectoryFollower::new();
            follower.prepare(config).unwrap();
            follower.start();
            // At rest, a step at tick `at` and the way back 10 ticks later: 16 ticks on, neither may be seen any more.
            (0..at + 40).find(|&tick| {
                let position = if (at..at + 10).contains(&tick) { far } else { 0.0 };
                follower.update(&report(rest + position, 0.0), Some(0.0));
                !follower.is_running()
            })
        };
        let config = TrajectoryConfig { speed, ..CONFIG };
        for at in 16..50 {
            assert_eq!(step(at, small, config), None, "just the limit, at {at}");
            assert_eq!(step(at, -small, config), None, "just the limit, back, at {at}");
            assert_eq!(step(at, small * 1.01, config), Some(at), "at {at}");
            assert_eq!(step(at, -small * 1.01, config), Some(at), "back, at {at}");
        }
        // A quarter of the limit a tick from rest is the whole limit after four ticks, and beyond it after five.
        for at in 16..50_usize {
            let mut follower = TrajectoryFollower::new();
            follower.prepare(config).unwrap();
            follower.start();
            let ended = (0..at + 20).find(|&tick| {
                let gone = (tick + 1).saturating_sub(at) as f32;
                follower.update(&report(rest + gone * small / 4.0, 0.0), Some(0.0));
                !follower.is_running()
            });
            assert_eq!(ended, Some(at + 4), "from {at}");
        }
        // Before sixteen ticks have passed there is no mean.
        assert_eq!(step(8, small * 4.0, config), Some(16), "the first tick with one");
    }

    #[test]
    fn a_silent_host_ends_it_and_only_a_new_preparation_begins_anew() {
        let mut follower = running();
        follower.check_silence(100);
        assert!(follower.is_running());
        follower.check_silence(101);
        assert_eq!(follower.status().state, TrajectoryState::Stopped(StopReason::Silence));
        follower.start();
        assert_eq!(follower.update(&report(0.001, 0.0), Some(0.002)), 0.0);
        follower.prepare(CONFIG).unwrap();
        assert_eq!(follower.update(&report(0.001, 0.0), Some(0.002)), 0.0);
        follower.start();
        assert!(follower.update(&report(0.001, 0.0), Some(0.002)) > 0.0);
    }

    #[test]
    fn it_ends_behind_its_last_reference() {
        let mut follower = running();
        for _ in 0..200 {
            assert!(follower.update(&report(0.001, 0.0), Some(0.002)) > 0.0);
        }
        assert_eq!(follower.update(&report(0.001, 0.0), Some(0.002)), 0.0);
        assert_eq!(follower.status(), TrajectoryStatus { state: TrajectoryState::Finished, played: 200 });
    }

    #[test]
    fn a_configuration_that_cannot_be_prepares_nothing() {
        let mut follower = running();
        assert!(follower.prepare(TrajectoryConfig { effort: f32::NAN, ..CONFIG }).is_err());
        follower.start();
        assert_eq!(follower.status().state, TrajectoryState::Idle);
        for wrong in [
            TrajectoryConfig { depth: [0.0, 0.0], ..CONFIG },
            TrajectoryConfig { depth: [f32::NEG_INFINITY, 0.0], ..CONFIG },
            TrajectoryConfig { depth: [0.0, f32::INFINITY], ..CONFIG },
            TrajectoryConfig { pass: 0.0, ..CONFIG },
            TrajectoryConfig { timeout: 0, ..CONFIG },
            TrajectoryConfig { length: 0, ..CONFIG },
        ] {
            assert!(wrong.check().is_err(), "{wrong:?}");
        }
    }
}
