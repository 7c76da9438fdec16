//! Which column of a file plays which role.

use crate::error::InputError;
use crate::rig::{Columns, Rig, Word, nearest};

/// What a column means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    Time,
    Position,
    Velocity,
    Force,
    Effort,
    Reference,
    Load,
    /// Current, voltage or duty, from which the rig's `[effort]` computes the effort.
    MotorInput,
}

impl Role {
    pub const ALL: [Self; 7] =
        [Self::Time, Self::Position, Self::Velocity, Self::Force, Self::Effort, Self::Reference, Self::Load];

    /// The column's name where the rig file gives none.
    pub fn default_name(self) -> Word {
        match self {
            Self::Time => Word::same("t_s"),
            Self::Position => Word::new("position_m", "position_rad"),
            Self::Velocity => Word::new("velocity_m_s", "velocity_rad_s"),
            Self::Force => Word::new("force_N", "torque_Nm"),
            Self::Effort => Word::new("effort_N", "effort_Nm"),
            Self::Reference => Word::new("reference_m", "reference_rad"),
            Self::Load => Word::new("load_N", "load_Nm"),
            Self::MotorInput => Word::same("current_A"),
        }
    }

    /// The column's name in a recording of `rig`.
    pub fn name(self, rig: &Rig) -> &str {
        self.given(&rig.columns).unwrap_or(rig.coordinate.pick(self.default_name()))
    }

    fn given(self, columns: &Columns) -> Option<&str> {
        match self {
            Self::Time => &columns.time,
            Self::Position => &columns.position,
            Self::Velocity => &columns.velocity,
            Self::Force => &columns.force,
            Self::Effort => &columns.effort,
            Self::Reference => &columns.reference,
            Self::Load => &columns.load,
            // Named in [effort].
            Self::MotorInput => &None,
        }
        .as_deref()
    }
}

/// A role, and the index of its column in the file.
pub type Found = (Role, usize);

/// Finds the columns that `rig` speaks of in `header`. `place` is the file and line of the header; `has_clocks`: the columns bring
/// their instants with them, and none holds the time.
pub fn find(header: &[&str], rig: &Rig, place: &str, has_clocks: bool) -> Result<Vec<Found>, InputError> {
    let mut found = Vec::new();
    for role in Role::ALL {
        if role == Role::Time && has_clocks {
            continue;
        }
        if let Some(column) = column(role, header, rig, place)? {
            found.push((role, column));
        }
    }
    let has = |wanted| found.iter().any(|(role, _)| *role == wanted);
    if let Some(law) = rig.effort.as_ref().filter(|_| !has(Role::Effort)) {
        if let Some((_, name)) = law.input() {
            let at = header
                .iter()
                .position(|column| *column == name)
                .ok_or_else(|| missing(name, header, "[effort] in the rig file names it", place))?;
            found.push((Role::MotorInput, at));
        } else if !has(Role::Reference) {
            let source = "[effort] in the rig file computes the effort from it";
            return Err(missing(Role::Reference.name(rig), header, source, place));
        }
    } else if !has(Role::Force) && !has(Role::Effort) {
        let name = |role: Role| rig.coordinate.pick(role.default_name());
        let both = format!("{} or {} (or [columns] in the rig file)", name(Role::Force), name(Role::Effort));
        return Err(InputError::new(place, there(header), both));
    }
    Ok(found)
}

fn column(role: Role, header: &[&str], rig: &Rig, place: &str) -> Result<Option<usize>, InputError> {
    let given = role.given(&rig.columns);
    let word = role.default_name();
    let name = role.name(rig);
    // A column that the rig file gives to one role is not also taken for another by its default name.
    let taken = |name: &str| Role::ALL.iter().any(|other| *other != role && other.given(&rig.columns) == Some(name));
    let mut columns = (0..header.len()).filter(|&at| header[at] == name && (given.is_some() || !taken(name)));
    match (columns.next(), columns.next()) {
        (Some(first), Some(second)) => {
            let found = format!("it twice, as columns {} and {}", first + 1, second + 1);
            Err(InputError::new(format!("{place}: column {name}"), found, "one column of this name"))
        }
        (Some(only), None) => Ok(Some(only)),
        _ => {
            let foreign = rig.coordinate.other().pick(word);
            if given.is_none() && foreign != name && header.contains(&foreign) && !taken(foreign) {
                let found = format!("{foreign}, a column of a {} rig", rig.coordinate.other().name());
                let expected = format!("{name}, as the rig's coordinate is {}", rig.coordinate.name());
                return Err(InputError::new(format!("{place}: column {name}"), found, expected));
            }
            let optional = given.is_none() && !matches!(role, Role::Time | Role::Position);
            let source = if given.is_some() {
                "[columns] in the rig file names it"
            } else {
                "or its name in [columns] of the rig file"
            };
            if optional { Ok(None) } else { Err(missing(name, header, source, place)) }
        }
    }
}

fn missing(name: &str, header: &[&str], source: &str, place: &str) -> InputError {
    let expected = match nearest(name, header) {
        Some(near) => format!("{name} (perhaps {near} is meant; {source})"),
        None => format!("{name} ({source})"),
    };
    InputError::new(format!("{place}: column {name}"), there(header), expected)
}

fn there(header: &[&str]) -> String {
    match header {
        [only] if only.contains(';') || only.contains('\t') => {
            "one column only, with semicolons or tabs in its name: fields are separated by commas".to_owned()
        }
        _ => format!("only the columns {}", header.join(", ")),
    }
}
