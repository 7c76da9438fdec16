//! Play between the position sensor and the surface.

/// Up to three gaps side by side, each flat while its flank has not been reached.
#[derive(Debug, Clone)]
pub struct PlayOperator {
    /// Half the gap of each, m.
    pub(crate) halves: [f64; 3],
    pub(crate) behind: [f64; 3],
}

impl PlayOperator {
    /// Where the touching end is when the sensor is at `position`, and which share of the velocity reaches it.
    pub fn follow(&mut self, position: f64) -> (f64, f64) {
        let (mut sum, mut engaged) = (0.0, 0.0);
        for (behind, half) in self.behind.iter_mut().zip(self.halves) {
            let pushed = behind.clamp(position - half, position + half);
            engaged += f64::from(pushed != *behind);
            *behind = pushed;
            sum += pushed;
        }
        (sum / 3.0, engaged / 3.0)
    }
}
