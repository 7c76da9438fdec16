//! What an MJCF file says of a joint: the element, its actuator, values that come from default classes.

use roxmltree::{Document, Node};

use crate::error::InputError;
use crate::rig::{Coordinate, nearest};

/// A MuJoCo model with the joint in question.
pub struct MjcfModel<'a> {
    /// Names the file in errors.
    pub place: String,
    /// `<mujoco>`.
    pub root: Node<'a, 'a>,
    /// The joint.
    pub joint: Node<'a, 'a>,
    /// Its name.
    pub name: String,
}

/// Elements of `<actuator>` that push a joint directly by their control.
pub const FORCE_ACTUATORS: [&str; 2] = ["motor", "general"];

impl<'a> MjcfModel<'a> {
    /// The joint `name` of `document`.
    ///
    /// # Errors
    /// No MJCF, no such joint, or one of the other coordinate.
    pub fn of(
        place: String,
        document: &'a Document<'a>,
        name: &str,
        coordinate: Coordinate,
    ) -> Result<Self, InputError> {
        let root = document.root_element();
        if !root.has_tag_name("mujoco") {
            return Err(InputError::new(&place, format!("<{}>", root.tag_name().name()), "a MuJoCo model, <mujoco>"));
        }
        let bodies =
            || root.children().filter(|node| node.has_tag_name("worldbody")).flat_map(|node| node.descendants());
        let joints: Vec<_> = bodies().filter(|node| node.has_tag_name("joint")).collect();
        let Some(joint) = joints.iter().find(|joint| joint.attribute("name") == Some(name)).copied() else {
            let names: Vec<&str> = joints.iter().filter_map(|joint| joint.attribute("name")).collect();
            let included = root.descendants().any(|node| node.has_tag_name("include"));
            let found = match names[..] {
                [] => "no joint with a name".to_owned(),
                _ => format!("only the joints {}", names.join(", ")),
            };
            let near = nearest(name, &names).map_or_else(String::new, |near| format!(" (perhaps {near} is meant)"));
            let advice = if included {
                "; files that the model includes are not searched: export into the one that holds the joint"
            } else {
                ""
            };
            return Err(InputError::new(
                format!("{place}: joint {name}"),
                found,
                format!("a joint of this name{near}{advice}"),
            ));
        };
        let model = Self { place, root, joint, name: name.to_owned() };
        let kind = model.resolved(joint, "type").unwrap_or("hinge");
        let wanted = if coordinate == Coordinate::Rotary { "hinge" } else { "slide" };
        if kind != wanted {
            let expected = format!("a {wanted} joint, as the rig's coordinate is {}", coordinate.name());
            return Err(InputError::new(model.at(joint), format!("a {kind} joint"), expected));
        }
        Ok(model)
    }

    /// File, line and name of an element.
    pub fn at(&self, node: Node<'_, '_>) -> String {
        let row = node.document().text_pos_at(node.range().start).row;
        let name = node.attribute("name").map_or_else(String::new, |name| format!(" {name}"));
        format!("{}:{row}: {}{name}", self.place, node.tag_name().name())
    }

    /// An attribute of `node`, by itself or from its default class.
    pub fn resolved(&self, node: Node<'a, 'a>, attribute: &str) -> Option<&'a str> {
        node.attribute(attribute).or_else(|| {
            let inherited = || node.ancestors().skip(1).find_map(|body| body.attribute("childclass"));
            let class = node.attribute("class").or_else(inherited);
            let tops = || self.root.children().filter(|child| child.has_tag_name("default"));
            let named = |class: &str| {
                tops()
                    .flat_map(|top| top.descendants())
                    .find(|node| node.has_tag_name("default") && node.attribute("class") == Some(class))
            };
            let start = class.and_then(named).or_else(|| tops().next())?;
            let values = |default: Node<'a, 'a>| default.children().find(|child| child.tag_name() == node.tag_name());
            start
                .ancestors()
                .take_while(|ancestor| ancestor.has_tag_name("default"))
                .find_map(|default| values(default)?.attribute(attribute))
        })
    }

    /// The first number of an attribute of the joint, zero where it has none.
    pub fn joint_number(&self, attribute: &str) -> f64 {
        let text = self.resolved(self.joint, attribute).unwrap_or("0");
        text.split_whitespace().next().and_then(|number| number.parse().ok()).unwrap_or(0.0)
    }

    /// The actuator that pushes the joint, `wanted` where the user names one.
    ///
    /// # Errors
    /// None, or several and none is named.
    pub fn actuator(&self, wanted: Option<&str>) -> Result<Node<'a, 'a>, InputError> {
        let all = || self.root.children().filter(|node| node.has_tag_name("actuator")).flat_map(|node| node.children());
        let pushes = |node: &Node<'a, 'a>| {
            node.attribute("joint") == Some(&self.name) && node.attribute("input") != Some("none")
        };
        let found: Vec<_> = all()
            .filter(pushes)
            .filter(|node| wanted.is_none_or(|name| node.attribute("name") == Some(name)))
            .collect();
        match found[..] {
            [only] => Ok(only),
            [] => {
                let found = wanted.map_or_else(|| "none".to_owned(), |name| format!("none named {name}"));
                Err(InputError::new(
                    format!("{}: actuator of joint {}", self.place, self.name),
                    found,
                    "one actuator with this joint",
                ))
            }
            _ => {
                let names: Vec<&str> = found.iter().filter_map(|node| node.attribute("name")).collect();
                let place = format!("{}: actuator of joint {}", self.place, self.name);
                Err(InputError::new(
                    place,
                    format!("several: {}", names.join(", ")),
                    "the name of one of them in --actuator",
                ))
            }
        }
    }

    /// The sensor named `wanted`.
    ///
    /// # Errors
    /// None is named, or the model has none of this name.
    pub fn sensor(&self, wanted: Option<&str>) -> Result<Node<'a, 'a>, InputError> {
        let all: Vec<_> = self
            .root
            .children()
            .filter(|node| node.has_tag_name("sensor"))
            .flat_map(|node| node.children())
            .filter(Node::is_element)
            .collect();
        let names: Vec<&str> = all.iter().filter_map(|node| node.attribute("name")).collect();
        let place = format!("{}: sensor", self.place);
        let Some(wanted) = wanted else {
            return Err(InputError::new(
                place,
                "no --sensor",
                format!("the name of the force sensor, one of {}", names.join(", ")),
            ));
        };
        let found = all.iter().find(|node| node.attribute("name") == Some(wanted)).copied();
        found.ok_or_else(|| {
            InputError::new(
                format!("{place} {wanted}"),
                format!("only the sensors {}", names.join(", ")),
                "a sensor of this name",
            )
        })
    }

    /// Seconds of a step.
    pub fn timestep(&self) -> f64 {
        let options = self.root.children().filter(|node| node.has_tag_name("option"));
        options.filter_map(|option| option.attribute("timestep")?.parse().ok()).next_back().unwrap_or(0.002)
    }

    /// Radians in the unit in which the file gives angles.
    pub fn angle_unit(&self) -> f64 {
        let compilers = self.root.children().filter(|node| node.has_tag_name("compiler"));
        let is_radian = compilers.filter_map(|compiler| compiler.attribute("angle")).next_back() == Some("radian");
        if is_radian { 1.0 } else { 1.0_f64.to_radians() }
    }
}
