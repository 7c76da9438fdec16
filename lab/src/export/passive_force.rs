//! Forces on a joint that need no control: MuJoCo's DC motor without inputs and without an electric branch.

/// The element's common head. With a motor constant of zero only ripple and bristles act; the resistance must be above zero.
fn head(joint: &str, name: &str) -> String {
    format!("<dcmotor name=\"{joint}_{name}\" joint=\"{joint}\" input=\"none\" motorconst=\"0\" resistance=\"1\"")
}

/// A constant force, positive along the joint. A ripple of no poles is one.
pub fn constant(joint: &str, name: &str, force: f64) -> String {
    let phase = std::f64::consts::FRAC_PI_2.copysign(force);
    format!("{} cogging=\"{} 0 {phase}\"/>", head(joint, name), force.abs())
}

/// sine sin(k q) + cosine cos(k q), k in 1/m or 1/rad.
///
/// The motor's ripple has a whole number of poles, so the gear makes one turn of the motor of one wave; the force at the joint is that of
/// the motor times the gear.
pub fn wave(joint: &str, name: &str, k: f64, sine: f64, cosine: f64) -> String {
    let (amplitude, phase) = (sine.hypot(cosine) / k, cosine.atan2(sine));
    format!("{} gear=\"{k}\" cogging=\"{amplitude} 1 {phase}\"/>", head(joint, name))
}

/// LuGre's bristles with `coulomb` at speed, `breakaway` at rest and a Gaussian between them.
///
/// The bristles give a thousandth of the Stribeck speed times a second at most; their damping is critical for `inertia`.
pub fn bristles(joint: &str, name: &str, law: Bristles) -> String {
    let stiffness = law.breakaway / (BRISTLE_TRAVEL_S * law.stribeck_speed);
    let damping = 2.0 * (stiffness * law.inertia).sqrt();
    // Bristles that are damped more strongly than this push back on their own at the Stribeck speed.
    let damping = damping.min(law.breakaway / law.stribeck_speed);
    format!(
        "{} lugre=\"{stiffness} {damping} {} {} {}\"/>",
        head(joint, name),
        law.coulomb,
        law.breakaway,
        law.stribeck_speed
    )
}

/// Seconds at the Stribeck speed after which the bristles slide.
const BRISTLE_TRAVEL_S: f64 = 1e-3;

/// A friction law in numbers.
#[derive(Debug, Clone, Copy)]
pub struct Bristles {
    /// N or N m at speed.
    pub coulomb: f64,
    /// N or N m at rest.
    pub breakaway: f64,
    /// m/s or rad/s.
    pub stribeck_speed: f64,
    /// kg or kg m^2 that moves with the joint.
    pub inertia: f64,
}
