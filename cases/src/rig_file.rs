//! The rig file of a case: nominal values, and nothing that betrays the rest.

use crate::nominal::{NominalParameters, PdGains};
use crate::scale::{Scale, Unit};
use crate::sensors::Sensors;

/// What a rig file says.
#[derive(Debug, Clone, Copy)]
pub struct RigFile {
    /// Size and coordinate.
    pub scale: Scale,
    /// Values as stated, at the size of a bench.
    pub stated: NominalParameters,
    /// Whether there is a drive to speak of.
    pub drive: bool,
    /// The controller, where it is stated.
    pub control: Option<PdGains>,
    /// The sensors, where they are stated.
    pub sensors: Option<Sensors>,
    /// Whether their noise is stated too.
    pub noise: bool,
}

impl RigFile {
    /// The file's text.
    #[must_use]
    pub fn text(&self) -> String {
        let rotary = self.scale.rotary;
        let coordinate = if rotary { "rotary" } else { "linear" };
        let mut text = format!("[rig]\nname = \"a rig\"\ncoordinate = \"{coordinate}\"\n");
        let key = |linear: &'static str, turned: &'static str| if rotary { turned } else { linear };
        let line = |name: &str, value: f64, unit: Unit| format!("{name} = {}\n", number(self.scale.apply(value, unit)));
        let NominalParameters { mass, viscous, stiffness, damping, surface, bilateral } = self.stated;
        if self.drive {
            text += "\n[drive]\n";
            text += &line(key("mass_kg", "inertia_kg_m2"), mass, Unit::Mass);
            text += &line(key("viscous_n_s_m", "viscous_n_m_s_rad"), viscous, Unit::Damping);
        }
        text += "\n[contact]\nmodel = \"kelvin_voigt\"\n";
        text += &line(key("surface_m", "surface_rad"), surface, Unit::Length);
        text += &line(key("stiffness_n_m", "stiffness_n_m_rad"), stiffness, Unit::Stiffness);
        text += &line(key("damping_n_s_m", "damping_n_m_s_rad"), damping, Unit::Damping);
        text += &format!("bilateral = {bilateral}\n");
        if let Some(sensors) = self.sensors {
            text += "\n[sensors]\n";
            text += &line(key("position_resolution_m", "position_resolution_rad"), sensors.position_step, Unit::Length);
            text += &line(key("force_resolution_n", "torque_resolution_n_m"), sensors.force_step, Unit::Force);
            if self.noise {
                text += &line(key("force_noise_n", "torque_noise_n_m"), sensors.force_noise, Unit::Force);
            }
        }
        if let Some(control) = self.control.filter(|_| self.drive) {
            text += "\n[control]\n";
            text += &line(key("proportional_n_m", "proportional_n_m_rad"), control.proportional, Unit::Stiffness);
            text += &line(key("derivative_n_s_m", "derivative_n_m_s_rad"), control.derivative, Unit::Damping);
            text += &format!("derivative_filter_hz = {:?}\nrate_hz = 1000.0\n", control.filter_hz);
        }
        text
    }
}

/// Seven digits, as TOML writes a float.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.6e}").parse().unwrap_or(value);
    format!("{rounded:?}")
}
