//! The transmission between motor and tool: compliance and backlash.

use super::drive::Body;

/// A spring and damper between motor and tool that has a gap.
#[derive(Debug, Clone, Copy)]
pub struct Transmission {
    pub(crate) share: f64,
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    pub(crate) gap: f64,
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

    /// Combines two effects of the same transmission: the larger gap, the softer spring.
    fn join(&mut self, other: Self) {
        self.gap = self.gap.max(other.gap);
        if other.stiffness < self.stiffness {
            (self.stiffness, self.damping) = (other.stiffness, other.damping);
        }
    }

    /// Puts this transmission into `drive`, combined with what is there.
    pub(crate) fn add_to(self, drive: &mut super::drive::Drive) {
        match &mut drive.transmission {
            Some(other) => other.join(self),
            none => *none = Some(self),
        }
    }
}
