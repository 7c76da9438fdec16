//! Motion of the touched surface.

/// Where the surface is beyond its place.
#[derive(Debug, Clone, Copy)]
pub enum SurfacePath {
    /// To and fro.
    Sine {
        /// m
        amplitude: f64,
        /// rad/s
        rate: f64,
        /// rad
        phase: f64,
    },
    /// Away for good.
    Drift {
        /// m/s
        velocity: f64,
    },
}

impl SurfacePath {
    /// Shift and velocity at time `t`.
    #[must_use]
    pub fn at(self, t: f64) -> (f64, f64) {
        match self {
            Self::Sine { amplitude, rate, phase } => {
                let (sine, cosine) = (rate * t + phase).sin_cos();
                (amplitude * sine, amplitude * rate * cosine)
            }
            Self::Drift { velocity } => (velocity * t, velocity),
        }
    }
}
