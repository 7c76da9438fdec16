//! A rig file to begin with: columns by their names, values to be replaced.

use std::path::Path;

use crate::recording::data_file::{Channel, Content, DataFile};

/// What the words of a channel's name say that it is, the best first.
const WORDS: [(&str, &[&str]); 7] = [
    ("time", &["t_s", "time", "times", "t", "timestamp", "time_s", "sec", "seconds"]),
    ("position", &["position", "position_m", "position_rad", "pos", "q", "qpos", "x", "angle", "theta", "p"]),
    ("velocity", &["velocity", "velocity_m_s", "velocity_rad_s", "vel", "dq", "qd", "qvel", "qdot", "v", "omega"]),
    (
        "effort",
        &[
            "effort",
            "effort_n",
            "effort_nm",
            "tau",
            "motor_torque",
            "u",
            "command_torque",
            "actuatorfrc",
            "motor",
            "ctrl",
        ],
    ),
    ("force", &["force", "force_n", "torque_nm", "torque", "fz", "f", "contact_force", "ft_z", "touch"]),
    ("reference", &["reference", "reference_m", "reference_rad", "ref", "setpoint", "q_ref", "desired", "cmd"]),
    ("load", &["load", "load_n", "load_nm", "gravity", "inverse_dynamics"]),
];

/// Names of columns that a rig file need not state.
const DEFAULTS: [&str; 12] = [
    "t_s",
    "position_m",
    "position_rad",
    "velocity_m_s",
    "velocity_rad_s",
    "force_N",
    "torque_Nm",
    "effort_N",
    "effort_Nm",
    "reference_m",
    "reference_rad",
    "load_N",
];

/// The column that holds the time: named like it, and increasing.
pub fn time_column(file: &DataFile) -> Option<(&str, &[f64])> {
    let increases = |values: &[f64]| values.len() > 1 && values.windows(2).all(|pair| pair[1] > pair[0]);
    let numbers = |channel| numbers(channel).filter(|_| file.channels.iter().all(|channel| channel.clock.is_none()));
    let named = best(file, "time").and_then(|channel| Some((channel.name.as_str(), numbers(channel)?)));
    named.filter(|(_, values)| increases(values))
}

/// The text of a rig file for `file`, read from `path`.
pub fn text(file: &DataFile, path: &Path) -> String {
    let is_rotary = is_rotary(file);
    let name = path.file_stem().map_or_else(|| "rig".to_owned(), |name| name.to_string_lossy().into_owned());
    let quoted = |text: &str| toml::Value::from(text).to_string();
    let coordinate = if is_rotary { "rotary" } else { "linear" };
    let mut text = format!(
        "# Begun by `palpate look --rig-template`. Numbers are placeholders: state your simulation's, wrong ones are refitted.\n\n\
         [rig]\nname = {}\ncoordinate = \"{coordinate}\"\n\n[columns]\n",
        quoted(&name)
    );
    let has_clocks = file.channels.iter().any(|channel| channel.clock.is_some());
    let mut taken: Vec<&str> = Vec::new();
    for (role, _) in WORDS {
        if role == "time" && has_clocks {
            text += "# time: every channel has a clock of its own\n";
            continue;
        }
        match best(file, role).filter(|channel| !taken.contains(&channel.name.as_str())) {
            Some(channel) => {
                taken.push(&channel.name);
                let comment = if DEFAULTS.contains(&channel.name.as_str()) { "   # the default" } else { "" };
                text += &format!("{role} = {}{comment}\n", quoted(&channel.name));
            }
            None => text += &format!("# {role} = \"...\"\n"),
        }
    }
    let others: Vec<&str> =
        file.channels.iter().map(|channel| channel.name.as_str()).filter(|name| !taken.contains(name)).collect();
    if !others.is_empty() {
        text += &format!("# not used: {}\n", others.join(", "));
    }
    let found = |role| best(file, role).is_some_and(|channel| taken.contains(&channel.name.as_str()));
    text + &tables(is_rotary, found("effort"), found("force"))
}

/// `[drive]` and `[contact]`, as comments where the channel that they need was not found.
fn tables(is_rotary: bool, has_effort: bool, has_force: bool) -> String {
    let drive = if is_rotary {
        "[drive]\ninertia_kg_m2 = 0.1\nviscous_n_m_s_rad = 0.1\n"
    } else {
        "[drive]\nmass_kg = 1.0\nviscous_n_s_m = 1.0\n"
    };
    let contact = if is_rotary {
        "[contact]\nsurface_rad = 0.0\nstiffness_n_m_rad = 10.0\ndamping_n_m_s_rad = 0.1\n"
    } else {
        "[contact]\nsurface_m = 0.0\nstiffness_n_m = 300.0\ndamping_n_s_m = 5.0\n"
    };
    let table = |text: &str, is_there: bool| match is_there {
        true => format!("\n{text}"),
        false => text.lines().fold("\n".to_owned(), |text, line| text + "# " + line + "\n"),
    };
    table(drive, has_effort || !has_force) + &table(contact, has_force)
}

fn numbers(channel: &Channel) -> Option<&[f64]> {
    match &channel.content {
        Content::Numbers(values) => Some(values),
        Content::Other(_) => None,
    }
}

/// The channel of numbers whose name says most clearly that it is `role`.
fn best<'a>(file: &'a DataFile, role: &str) -> Option<&'a Channel> {
    let (_, words) = WORDS.iter().find(|(name, _)| *name == role)?;
    let rank = |channel: &Channel| {
        let name = channel.name.to_lowercase();
        // Of a topic or an array, the field: `/joint_states:elbow.position` is a position.
        let field = name.rsplit([':', '.', '/']).next().unwrap_or(&name).to_owned();
        let field = field.split('[').next().unwrap_or(&field).to_owned();
        let is_axis = name.contains(".force.") || name.contains(":force.");
        let exact = words.iter().position(|word| *word == name || *word == field);
        let vector = (role == "force" && is_axis && field == "z").then_some(words.len());
        let part = words.iter().position(|word| word.len() > 2 && field.contains(word)).map(|at| 2 * words.len() + at);
        exact.filter(|_| !(is_axis || name.contains("torque."))).or(vector).or(part)
    };
    let candidates = file.channels.iter().filter(|channel| numbers(channel).is_some());
    candidates
        .filter_map(|channel| Some((rank(channel)?, channel)))
        .min_by_key(|(rank, _)| *rank)
        .map(|(_, channel)| channel)
}

/// Radians or torques in a name, and no metres; a topic of joints is taken for one of turning joints.
fn is_rotary(file: &DataFile) -> bool {
    let names: Vec<String> = file.channels.iter().map(|channel| channel.name.to_lowercase()).collect();
    let has = |words: &[&str]| names.iter().any(|name| words.iter().any(|word| name.contains(word)));
    !has(&["position_m", "_mm", "force_n"]) && has(&["_rad", "_nm", "torque_", "angle", "theta", "joint"])
}
