//! The shapes of the effects that others simulate: what is true of them is all that their simulator is told.

use rand::RngExt;

use crate::chance::Chance;
use crate::effect::actuator::{EffortLag, EffortSaturation};
use crate::effect::delay::{ChannelDelay, ToolInertia};
use crate::effect::elastic::Nonlinear;
use crate::effect::friction::{Coulomb, Slowing};
use crate::effect::gravity::GravityLoad;
use crate::effect::range::ForceSaturation;
use crate::effect::transmission::{Backlash, Compliance};
use crate::effect::{Parameter, Scene, Shape, Sizes, own_chance};
use crate::scale::Unit;

/// A shape with the name of its effect.
#[derive(Debug)]
pub struct Named {
    /// By the list, or of its own.
    pub name: &'static str,
    form: &'static str,
    shape: Box<dyn Shape + Send>,
}

impl Shape for Named {
    fn form(&self) -> &'static str {
        self.form
    }

    fn sizes(&self) -> Sizes {
        self.shape.sizes()
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        self.shape.parameters(size)
    }
}

/// The effect `name` with values at random; none where no simulator has it.
#[must_use]
pub fn draw(name: &'static str, scene: &Scene, chance: &Chance) -> Option<Named> {
    let chance = &mut own_chance(name, chance);
    let shape: Box<dyn Shape + Send> = match name {
        "nonlinear_stiffness" => Box::new(Nonlinear::power(scene, chance)),
        "hunt_crossley_damping" => Box::new(Dissipation { stiffness: scene.nominal.stiffness }),
        "environment_mass" => Box::new(Moved { unit: 0.05 * scene.nominal.mass }),
        "coulomb_friction" => Box::new(Coulomb::even(scene)),
        "stribeck_friction" => Box::new(Slowing::exponential(scene, chance)),
        "gravity_load" => Box::new(GravityLoad::constant(scene, chance)),
        "transmission_compliance" => Box::new(Compliance::draw(scene, chance)),
        "backlash" => Box::new(Backlash::draw(scene, chance)),
        "effort_saturation" => Box::new(EffortSaturation::draw(scene)),
        "effort_lag" => Box::new(EffortLag),
        "tool_inertia" => Box::new(ToolInertia { mass: scene.nominal.mass }),
        "channel_delay" => Box::new(ChannelDelay),
        "force_saturation" => Box::new(ForceSaturation::sharp(scene)),
        "soft_constraint" => Box::new(Soft::draw(scene, chance)),
        _ => return None,
    };
    // The law is as told, the way to stick or to meet the simulator's own.
    let form = match name {
        "coulomb_friction" => "the simulator's own dry friction",
        "stribeck_friction" => "the simulator's own dry friction, exponential",
        "backlash" => "two masses with a gap between the simulator's own stops",
        _ => shape.form(),
    };
    Some(Named { name, form, shape })
}

/// `hunt_crossley_damping`: `K p (1 + d v)`, alpha being K d.
#[derive(Debug)]
struct Dissipation {
    stiffness: f64,
}

impl Shape for Dissipation {
    fn form(&self) -> &'static str {
        "damping in proportion to depth, and no other"
    }

    fn sizes(&self) -> Sizes {
        // s/m: beyond thirty the contact of a slow tap is all damper.
        Sizes::new(1.0, 30.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("alpha", self.stiffness * size, Unit::DampingGradient)]
    }
}

/// `environment_mass`: a mass that is there from the first touch on.
#[derive(Debug)]
struct Moved {
    unit: f64,
}

impl Shape for Moved {
    fn form(&self) -> &'static str {
        "mass at once on touching"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(1.0, 40.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![Parameter::new("mass", size * self.unit, Unit::Mass)]
    }
}

/// `soft_constraint`: stiffness, damping and a moved mass that all rise with depth as MuJoCo's impedance does.
#[derive(Debug)]
struct Soft {
    impedance: f64,
    width: f64,
}

impl Soft {
    fn draw(scene: &Scene, chance: &mut Chance) -> Self {
        Self { impedance: chance.random_range(0.01..0.05), width: scene.depth * chance.random_range(0.5..1.2) }
    }
}

impl Shape for Soft {
    fn form(&self) -> &'static str {
        "MuJoCo's impedance over depth"
    }

    fn sizes(&self) -> Sizes {
        Sizes::new(0.1, 8.0)
    }

    fn parameters(&self, size: f64) -> Vec<Parameter> {
        vec![
            Parameter::new("impedance", self.impedance, Unit::One),
            Parameter::new("deep_impedance", self.impedance * (1.0 + size), Unit::One),
            Parameter::new("width", self.width, Unit::Length),
        ]
    }
}
