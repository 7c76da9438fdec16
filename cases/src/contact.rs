//! The touched surface: what it pushes back with, and what it remembers.

use crate::effect::adhesion::Neck;
use crate::effect::damping::{DepthDamping, Drag};
use crate::effect::elastic::{Bump, Elastic, Layer};
use crate::effect::hysteresis::Loop;
use crate::effect::lost_motion::Play;
use crate::effect::plasticity::Dent;
use crate::effect::pulse::{Heartbeat, Reflex};
use crate::effect::relaxation::Branch;
use crate::effect::softening::Change;
use crate::effect::surface::Motion;
use crate::effect::tissue::Tissue;
use crate::nominal::Nominal;

/// The contact's physics and its state at one instant.
#[derive(Debug, Clone)]
pub struct Contact {
    nominal: Nominal,
    /// Instead of the linear spring.
    pub elastic: Elastic,
    /// A second slope from a depth on.
    pub layer: Option<Layer>,
    /// A bump of negative stiffness.
    pub bump: Option<Bump>,
    /// Damping that grows with depth.
    pub depth_damping: Option<DepthDamping>,
    /// Damping that grows with speed.
    pub drag: Option<Drag>,
    /// Springs in series with dampers.
    pub branches: Vec<Branch>,
    /// A loop that no slowness closes.
    pub hysteresis: Option<Loop>,
    /// What the deepest contact leaves behind.
    pub dent: Option<Dent>,
    /// What holds the tool back on leaving.
    pub neck: Option<Neck>,
    /// Play between the position sensor and the surface.
    pub play: Option<Play>,
    /// Stiffness in time.
    pub change: Option<Change>,
    /// The surface moves by itself.
    pub motion: Option<Motion>,
    /// Mass that is moved along.
    pub tissue: Option<Tissue>,
    /// A pulsation of the force.
    pub heartbeat: Option<Heartbeat>,
    /// The surface answers a touch.
    pub reflex: Option<Reflex>,
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
    pub fn new(nominal: Nominal) -> Self {
        Self {
            nominal,
            elastic: Elastic::Linear,
            layer: None,
            bump: None,
            depth_damping: None,
            drag: None,
            branches: Vec::new(),
            hysteresis: None,
            dent: None,
            neck: None,
            play: None,
            change: None,
            motion: None,
            tissue: None,
            heartbeat: None,
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
        if let Some(motion) = &self.motion {
            let (shift, velocity) = motion.at(t);
            depth -= shift;
            self.surface_velocity = velocity;
        }
        if let Some(dent) = &mut self.dent {
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
        self.factor = self.change.as_ref().map_or(1.0, |change| change.at(t));
        self.beat = self.heartbeat.as_ref().map_or(0.0, |heart| heart.at(t))
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
        let (mass, inertial) = self.tissue.as_ref().map_or((0.0, 0.0), |tissue| tissue.at(self.depth, velocity));
        Reaction { force: self.spring() + self.damper(velocity) + inertial + self.beat, mass, least }
    }

    fn spring(&self) -> f64 {
        let mut force = self.elastic.force(self.nominal.stiffness, self.depth);
        if let Some(layer) = &self.layer {
            force += layer.force(self.depth);
        }
        if let Some(bump) = &self.bump {
            force += bump.force(self.depth);
        }
        force *= self.factor;
        force += self.branches.iter().map(Branch::force).sum::<f64>();
        force + self.hysteresis.as_ref().map_or(0.0, Loop::force)
    }

    fn damper(&self, velocity: f64) -> f64 {
        let mut damping = self.nominal.damping;
        if let Some(depth_damping) = &self.depth_damping {
            damping += depth_damping.at(self.depth);
        }
        damping * velocity + self.drag.as_ref().map_or(0.0, |drag| drag.force(velocity))
    }
}
