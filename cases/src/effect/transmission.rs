//! Two masses with something between them: `backlash`, `transmission_compliance`.

use rand::RngExt;

use super::{Acting, Parameter, Scene, Shape, Sizes};
use crate::chance::Chance;
use crate::drive::Body;
use crate::physics::Physics;
use crate::scale::Unit;

/// A spring and damper between motor and tool that has a gap.
#[derive(Debug, Clone, Copy)]
pub struct Transmission {
    share: f64,
    stiffness: f64,
    damping: f64,
    gap: f64,
}

impl Transmission {
    /// Which share of the mass and of the viscous friction is the tool's.
    #[must_use]
    pub fn tool_share(&self) -> f64 {
        self.share
    }

    /// N on the tool, the motor being `ahead` of it.
    #[must_use]
    pub fn force(&self, ahead: Body) -> f64 {
        let free = ahead.position.clamp(-0.5 * self.gap, 0.5 * self.gap);
        let squeezed = ahead.position - free;
        if self.gap == 0.0 {
            return self.stiffness * squeezed + self.damping * ahead.velocity;
        }
        if squeezed == 0.0 {
            return 0.0;
        }
        // Teeth push and never pull: the damper only brakes the meeting.
        let force = self.stiffness * squeezed + self.damping * ahead.velocity;
        if squeezed > 0.0 { force.max(0.0) } else { force.min(0.0) }
    }

    /// Adds what another effect says of the same transmission.
    fn join(&mut self, other: Self) {
        self.gap = self.gap.max(other.gap);
        if other.stiffness < self.stiffness {
            (self.stiffness, self.damping) = (other.stiffness, other.damping);
        }
    }

    fn put(self, physics: &mut Physics) {
        match &mut physics.drive.transmission {
            Some(other) => other.join(self),
            none => *none = Some(self),
        }
    }
}

/// Natural frequency of the stiffest transmission, rad/s: it has to be soft against the step of 20 kHz.
const STIFFEST: f64 = 6000.0;

/// What both effects draw.
#[derive(Debug)]
struct Cut {
    share: f64,
    /// Damping over stiffness, s: a stiff part rings for a shorter time.
    relaxation: f64,
    reduced: f64,
}

impl Cut {
    fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        let share = chance.random_range(0.2..0.4);
        Self {
            share,
            relaxation: chance.random_range(1.5e-4..4e-4),
            reduced: share * (1.0 - share) * scene.nominal.mass,
        }
    }

    fn tool_mass(&self) -> f64 {
        self.reduced / (1.0 - self.share)
    }

    fn transmission(&self, rate: f64, gap: f64) -> Transmission {
        let stiffness = self.reduced * rate * rate;
        Transmission { share: self.share, stiffness, damping: self.relaxation * stiffness, gap }
    }
}

/// `backlash`
#[derive(Debug)]
pub struct Backlash {
    cut: Cut,
    unit: f64,
}

impl Backlash {
    /// Between stiff teeth.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        Self { cut: Cut::draw(scene, chance), unit: 0.002 * scene.depth }
    }
}

impl Shape for Backlash {
    fn form(&self) -> &'static str {
        "two masses with a gap between stiff teeth"
    }

    fn sizes(&self) -> Sizes {
        // Less is lost between two steps of any encoder here.
        Sizes { smallest: 1.0, first: 1.0, largest: 150.0 }
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let gap = Parameter::new("gap", size * self.unit, Unit::Length);
        vec![gap, Parameter::new("tool_mass", self.cut.tool_mass(), Unit::Mass)]
    }
}

impl Acting for Backlash {
    fn put(&self, size: f64, physics: &mut Physics) {
        self.cut.transmission(STIFFEST, size * self.unit).put(physics);
    }
}

/// `transmission_compliance`
#[derive(Debug)]
pub struct Compliance {
    cut: Cut,
}

impl Compliance {
    /// Lightly damped.
    #[must_use]
    pub fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        Self { cut: Cut::draw(scene, chance) }
    }

    fn transmission(&self, size: f64) -> Transmission {
        self.cut.transmission(STIFFEST / size.sqrt(), 0.0)
    }
}

impl Shape for Compliance {
    fn form(&self) -> &'static str {
        "two masses with a spring between them"
    }

    fn sizes(&self) -> Sizes {
        // A link that rings above 120 Hz is as good as rigid to samples at 1 kHz.
        Sizes { smallest: 60.0, first: 150.0, largest: 2500.0 }
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        let transmission = self.transmission(size);
        vec![
            Parameter::new("stiffness", transmission.stiffness, Unit::Stiffness),
            Parameter::new("damping", transmission.damping, Unit::Damping),
            Parameter::new("tool_mass", self.cut.tool_mass(), Unit::Mass),
        ]
    }
}

impl Acting for Compliance {
    fn put(&self, size: f64, physics: &mut Physics) {
        self.transmission(size).put(physics);
    }
}
