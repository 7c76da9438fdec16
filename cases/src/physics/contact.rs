//! The touched surface: what it pushes back with, and what it remembers.

use super::active_surface::{PulseForce, ReflexForce};
use super::adhesion::AdhesiveNeck;
use super::damping::{DepthDamping, SpeedDamping};
use super::environment_mass::EntrainedMass;
use super::hysteresis::HysteresisLoop;
use super::lost_motion::PlayOperator;
use super::plastic_set::ResidualIndent;
use super::stiffness::{ForceBump, Spring, StiffnessLayer};
use super::stress_relaxation::MaxwellBranch;
use super::surface_motion::SurfacePath;
use super::time_varying_stiffness::StiffnessFactor;
use crate::nominal::NominalParameters;

/// The contact's physics and its state at one instant.
#[derive(Debug, Clone)]
pub struct Contact {
    nominal: NominalParameters,
    /// Instead of the linear spring.
    pub spring: Spring,
    /// A second slope from a depth on.
    pub layer: Option<StiffnessLayer>,
    /// A bump of negative stiffness.
    pub bump: Option<ForceBump>,
    /// Damping that grows with depth.
    pub depth_damping: Option<DepthDamping>,
    /// Damping that grows with speed.
    pub speed_damping: Option<SpeedDamping>,
    /// Springs in series with dampers.
    pub branches: Vec<MaxwellBranch>,
    /// A loop that no slowness closes.
    pub hysteresis: Option<HysteresisLoop>,
    /// What the deepest contact leaves behind.
    pub indent: Option<ResidualIndent>,
    /// What holds the tool back on leaving.
    pub neck: Option<AdhesiveNeck>,
    /// Play between the position sensor and the surface.
    pub play: Option<PlayOperator>,
    /// Stiffness in time.
    pub stiffness_factor: Option<StiffnessFactor>,
    /// The surface moves by itself.
    pub surface_path: Option<SurfacePath>,
    /// Mass that is moved along.
    pub entrained_mass: Option<EntrainedMass>,
    /// A pulsation of the force.
    pub pulse: Option<PulseForce>,
    /// The surface answers a touch.
    pub reflex: Option<ReflexForce>,
    depth: f64,
    surface_velocity: f64,
    passed: f64,
    factor: f64,
    beat: f64,
}

/// What the surface answers to the tool: `force + mass a`, and not below `least`.
#[derive(Debug, Clone, Copy)]
pub struct Reaction {
    /// N
    pub force: f64,
    /// kg
    pub mass: f64,
    /// N
    pub least: f64,
}

impl Reaction {
    const NONE: Self = Self { force: 0.0, mass: 0.0, least: 0.0 };

    /// The force at acceleration `a`.
    #[must_use]
    pub fn at(&self, acceleration: f64) -> f64 {
        (self.force + self.mass * acceleration).max(self.least)
    }
}

impl Contact {
    /// A spring and a damper.
    #[must_use]
    pub fn new(nominal: NominalParameters) -> Self {
        Self {
            nominal,
            spring: Spring::Linear,
            layer: None,
            bump: None,
            depth_damping: None,
            speed_damping: None,
            branches: Vec::new(),
            hysteresis: None,
            indent: None,
            neck: None,
            play: None,
            stiffness_factor: None,
            surface_path: None,
            entrained_mass: None,
            pulse: None,
            reflex: None,
            depth: f64::NEG_INFINITY,
            surface_velocity: 0.0,
            passed: 1.0,
            factor: 1.0,
            beat: 0.0,
        }
    }

    /// Moves every memory on to time `t`, when the tool is at `position`, a step `dt` after the last call.
    pub fn advance(&mut self, position: f64, t: f64, dt: f64) {
        let mut depth = position - self.nominal.surface;
        if let Some(play) = &mut self.play {
            (depth, self.passed) = play.follow(depth);
        }
        if let Some(motion) = &self.surface_path {
            let (shift, velocity) = motion.at(t);
            depth -= shift;
            self.surface_velocity = velocity;
        }
        if let Some(dent) = &mut self.indent {
            depth -= dent.left_by(depth);
        }
        if let Some(neck) = &mut self.neck {
            neck.advance(depth, self.nominal.stiffness);
        }
        self.depth = depth;
        let pressed = if self.nominal.bilateral { depth } else { depth.max(0.0) };
        for branch in &mut self.branches {
            branch.advance(pressed, dt);
        }
        if let Some(hysteresis) = &mut self.hysteresis {
            hysteresis.advance(pressed);
        }
        self.factor = self.stiffness_factor.as_ref().map_or(1.0, |change| change.at(t));
        self.beat = self.pulse.as_ref().map_or(0.0, |heart| heart.at(t))
            + self.reflex.as_mut().map_or(0.0, |reflex| reflex.advance(depth > 0.0, dt));
    }

    /// What the tool at `velocity` feels.
    #[must_use]
    pub fn react(&self, velocity: f64) -> Reaction {
        let least = match &self.neck {
            _ if self.nominal.bilateral => f64::NEG_INFINITY,
            Some(neck) => neck.least(self.depth),
            None => 0.0,
        };
        if self.depth <= 0.0 && least == 0.0 {
            return Reaction::NONE;
        }
        let velocity = self.passed * velocity - self.surface_velocity;
        let (mass, inertial) =
            self.entrained_mass.as_ref().map_or((0.0, 0.0), |tissue| tissue.at(self.depth, velocity));
        Reaction { force: self.elastic_force() + self.damping_force(velocity) + inertial + self.beat, mass, least }
    }

    fn elastic_force(&self) -> f64 {
        let mut force = self.spring.force(self.nominal.stiffness, self.depth);
        if let Some(layer) = &self.layer {
            force += layer.force(self.depth);
        }
        if let Some(bump) = &self.bump {
            force += bump.force(self.depth);
        }
        force *= self.factor;
        force += self.branches.iter().map(MaxwellBranch::force).sum::<f64>();
        force + self.hysteresis.as_ref().map_or(0.0, HysteresisLoop::force)
    }

    fn damping_force(&self, velocity: f64) -> f64 {
        let mut damping = self.nominal.damping;
        if let Some(depth_damping) = &self.depth_damping {
            damping += depth_damping.at(self.depth);
        }
        damping * velocity + self.speed_damping.as_ref().map_or(0.0, |drag| drag.force(velocity))
    }
}
