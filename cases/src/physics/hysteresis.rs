//! Rate-independent hysteresis.

/// Jenkin elements of the Iwan model.
pub(crate) const IWAN_ELEMENTS: usize = 8;

/// A force that depends on the way, not on its speed.
#[derive(Debug, Clone)]
pub enum HysteresisLoop {
    /// Bouc-Wen: `z' = (1 - |z|^n (1 + sign(z p'))/2) p'/d`, force `H z`.
    BoucWen {
        /// H, N
        height: f64,
        /// d, m
        distance: f64,
        /// n
        sharpness: f64,
        /// z
        state: f64,
        /// p of the last step
        last: f64,
    },
    /// Iwan model: Jenkin elements in parallel, each slipping at a distance of its own.
    Iwan {
        /// Force of each when it slips, N.
        share: f64,
        /// Reach of each, m.
        reach: [f64; IWAN_ELEMENTS],
        /// Stretch of each, m.
        stretch: [f64; IWAN_ELEMENTS],
        /// p of the last step
        last: f64,
    },
}

impl HysteresisLoop {
    /// Moves on to depth `p`; a surface that is left forgets.
    pub fn advance(&mut self, p: f64) {
        match self {
            Self::BoucWen { distance, sharpness, state, last, .. } => {
                let moved = (p - *last) / *distance;
                *last = p;
                let into = if moved * *state > 0.0 { state.abs().powf(*sharpness) } else { 0.0 };
                *state = if p == 0.0 { 0.0 } else { (*state + moved * (1.0 - into)).clamp(-1.0, 1.0) };
            }
            Self::Iwan { reach, stretch, last, .. } => {
                let moved = p - *last;
                *last = p;
                for (stretch, reach) in stretch.iter_mut().zip(reach) {
                    *stretch = if p == 0.0 { 0.0 } else { (*stretch + moved).clamp(-*reach, *reach) };
                }
            }
        }
    }

    /// N
    #[must_use]
    pub fn force(&self) -> f64 {
        match self {
            Self::BoucWen { height, state, .. } => height * state,
            Self::Iwan { share, reach, stretch, .. } => {
                share * stretch.iter().zip(reach).map(|(stretch, reach)| stretch / reach).sum::<f64>()
            }
        }
    }
}
