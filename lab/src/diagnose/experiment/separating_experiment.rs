//! What tells one effect from another.

use crate::diagnose::term::Term;
use crate::effects::Place;
use crate::page::effect_name::effect_name;

/// Two effects and the motion, or the sensor, that separates them.
struct SeparatingExperiment {
    names: [&'static str; 2],
    by: &'static str,
}

const fn pair(one: &'static str, other: &'static str, by: &'static str) -> SeparatingExperiment {
    SeparatingExperiment { names: [one, other], by }
}

static SEPARATING_EXPERIMENTS: [SeparatingExperiment; 29] = [
    pair(
        "transmission_compliance",
        "stress_relaxation",
        "No motion separates a series cable from a Maxwell branch, for they are one law of force and position: record the \
         drive's effort while it moves freely, where only the cable shows, or measure the position on both sides of the cable.",
    ),
    pair(
        "force_gain",
        "load_dependent_friction",
        "Record the drive's effort while pressing slowly in and out at two forces: friction changes its sign with the \
         direction, a gain does not; from force and position alone no motion shows either.",
    ),
    pair(
        "stress_relaxation",
        "channel_delay",
        "Approach quickly and hold still: relaxation goes on in the hold, a delay is over at once; or move at two frequencies.",
    ),
    pair(
        "stress_relaxation",
        "force_lag",
        "Approach quickly and hold still for long: relaxation goes on, a lag of the sensor is over at once and shows in free space as well.",
    ),
    pair(
        "stress_relaxation",
        "plastic_set",
        "Touch, hold, leave for long and touch again: relaxation recovers, a dent stays where it is.",
    ),
    pair(
        "stress_relaxation",
        "time_varying_stiffness",
        "Repeat the first contact at the end: relaxation begins anew with each contact, a change over time goes on.",
    ),
    pair(
        "stress_relaxation",
        "hysteresis",
        "Move in contact at two frequencies: a dry loop stays as wide, relaxation does not.",
    ),
    pair(
        "channel_delay",
        "force_lag",
        "Move in contact at two frequencies far apart: a lag lowers the quick one, a delay only shifts it.",
    ),
    pair(
        "channel_delay",
        "environment_mass",
        "Move in contact at two frequencies, and quickly in free space: a delay lowers damping and adds a negative mass, which no mass in the environment is; the drive's effort shows it too.",
    ),
    pair(
        "channel_delay",
        "tool_inertia",
        "Accelerate quickly in free space: a mass beyond the sensor shows there, a delay has no force to shift.",
    ),
    pair(
        "tool_inertia",
        "environment_mass",
        "Accelerate quickly in free space: the tool's mass shows there, the environment's only in contact.",
    ),
    pair(
        "tool_inertia",
        "force_lag",
        "Accelerate quickly in free space: a mass beyond the sensor shows there, a lag has no force to hold back.",
    ),
    pair(
        "hunt_crossley_damping",
        "quadratic_damping",
        "Move equally fast at two depths, then at two speeds at one depth: the first grows with depth, the second with speed.",
    ),
    pair(
        "hunt_crossley_damping",
        "environment_mass",
        "Move at two depths with one frequency: Hunt-Crossley damping grows with depth, a mass does not care.",
    ),
    pair(
        "hunt_crossley_damping",
        "hysteresis",
        "Move in contact at two frequencies: a dry loop stays as wide, damping grows with the speed.",
    ),
    pair(
        "quadratic_damping",
        "hysteresis",
        "Move in contact at two speeds: a dry loop stays as wide, damping grows with the speed.",
    ),
    pair(
        "nonlinear_stiffness",
        "layered_stiffness",
        "Press slowly to several depths: a layer bends the line at one depth, a power law all along it.",
    ),
    pair(
        "nonlinear_stiffness",
        "plastic_set",
        "Press slowly to one depth twice: a dent makes the second time begin later, a power law repeats itself.",
    ),
    pair(
        "layered_stiffness",
        "force_saturation",
        "Press slowly deeper: a layer goes on rising at another slope, a sensor at its limit stays flat; the drive's effort goes on in both.",
    ),
    pair(
        "plastic_set",
        "time_varying_stiffness",
        "Repeat the first contact at the end: a dent keeps its depth, a drift goes on without being touched.",
    ),
    pair(
        "plastic_set",
        "hysteresis",
        "Reverse several times at one depth: a dry loop comes again each time, a dent only the first.",
    ),
    pair(
        "hysteresis",
        "lost_motion",
        "Reverse in contact by small and by large amounts: play is flat at each reversal, a dry loop is not.",
    ),
    pair(
        "force_bias",
        "gravity_load",
        "Rest in free space: a bias shows in the force reading, a weight in the drive's effort alone.",
    ),
    pair("force_bias", "force_drift", "Rest in free space early and late: a bias stays, a drift moves."),
    pair(
        "coulomb_friction",
        "stribeck_friction",
        "Reverse slowly in free space, and quickly: Stribeck friction falls with the first speed, Coulomb's does not.",
    ),
    pair(
        "coulomb_friction",
        "load_dependent_friction",
        "Reverse in free space and in contact at two forces: only friction under load grows with the force.",
    ),
    pair(
        "coulomb_friction",
        "gravity_load",
        "Record again with the machine turned over: a weight changes its sign with it, friction, as large both ways or not, does not. No motion of the machine as it \
         stands tells friction that differs by direction from friction beside a weight.",
    ),
    pair(
        "coulomb_friction",
        "backlash",
        "Reverse the effort in free space without haste: friction is there all the way, play only at the turn.",
    ),
    pair(
        "effort_lag",
        "transmission_compliance",
        "Move in free space at rising frequencies: a soft transmission resonates, a lag only fades.",
    ),
];

fn known(answer: &Term, rival: &Term) -> Option<&'static SeparatingExperiment> {
    let names = [answer.name(), rival.name()];
    SEPARATING_EXPERIMENTS
        .iter()
        .find(|pair| pair.names.iter().all(|name| names.contains(name)) && names[0] != names[1])
}

/// What would show `new` beside `answer`, which stays; `None` where the list knows no such pair.
#[must_use]
pub fn shown_beside(answer: &Term, new: &Term) -> Option<&'static str> {
    known(answer, new).map(|pair| pair.by)
}

/// One plain sentence: the motion that would separate `answer` from `rival`; where none does from force and position
/// alone, what does.
#[must_use]
pub fn separated_by(answer: &Term, rival: &Term) -> String {
    if let Some(pair) = known(answer, rival) {
        return pair.by.into();
    }
    if let Some(by) = gain(answer, rival).or_else(|| bias(answer, rival)) {
        return by.into();
    }
    let (one, other) = (answer.effect.spec(), rival.effect.spec());
    if one.name == other.name {
        return format!("Two laws of one effect: {} distinguishes them over a wider range.", one.excited_by);
    }
    if one.excited_by == other.excited_by {
        return format!(
            "Both show under {}: only a wider range of it, or another sensor, distinguishes them.",
            one.excited_by
        );
    }
    let [first, second] = [one.name, other.name].map(effect_name);
    format!("What shows {first}: {}. What shows {second}: {}.", one.excited_by, other.excited_by)
}

/// A gain beside an effect of the contact.
fn gain(answer: &Term, rival: &Term) -> Option<&'static str> {
    let contact = |term: &Term| term.effect.spec().place == Place::Contact;
    let one = |term: &Term, other: &Term| term.name() == "force_gain" && contact(other);
    (one(answer, rival) || one(rival, answer)).then_some(
        "A force gain is a scale of stiffness and damping, which no motion shows from force and position alone: record the \
         drive's effort in contact, or put a known weight on the sensor.",
    )
}

/// A bias beside an effect that moves the contact point.
fn bias(answer: &Term, rival: &Term) -> Option<&'static str> {
    let moves = |term: &Term| ["surface_motion", "lost_motion", "plastic_set", "adhesion"].contains(&term.name());
    let one = |term: &Term, other: &Term| term.name() == "force_bias" && moves(other);
    (one(answer, rival) || one(rival, answer)).then_some(
        "Rest in free space, where only a bias is left in the force: without free motion it is the place of the surface, and \
         a position offset is the contact point, which only a second sensor tells.",
    )
}
