//! From the channels of a file to a [`Recording`], by the names in the rig file.

use super::columns::{self, Role};
use super::data_file::{Channel, Content};
use super::{Recording, Scope, computed_effort};
use crate::error::InputError;
use crate::rig::Rig;

/// What `scope` holds of the recording that `rig` finds in `channels`; `place` names the file, `name` the trial.
///
/// Channels with a clock of their own are brought onto that of the position by straight lines between their values, over the time
/// that all of them cover.
///
/// # Errors
/// As [`Recording::read`].
pub fn recording(
    channels: &[Channel],
    place: &str,
    name: String,
    rig: &Rig,
    scope: Scope,
) -> Result<Recording, InputError> {
    let names: Vec<&str> = channels.iter().map(|channel| channel.name.as_str()).collect();
    let has_clocks = channels.iter().any(|channel| channel.clock.is_some()) && rig.columns.time.is_none();
    let found = columns::find(&names, rig, place, has_clocks)?;
    let series =
        found.iter().map(|(role, at)| Series::of(place, *role, &channels[*at])).collect::<Result<Vec<_>, _>>()?;
    let recording = if has_clocks { resampled(place, series)? } else { aligned(place, series)? };
    let recording = Recording { name, ..into_recording(recording, rig, scope) };
    increasing(place, &recording.time)?;
    Ok(recording)
}

/// A channel with its role.
struct Series<'a> {
    role: Role,
    name: &'a str,
    values: &'a [f64],
    clock: Option<&'a [f64]>,
}

impl<'a> Series<'a> {
    fn of(place: &str, role: Role, channel: &'a Channel) -> Result<Self, InputError> {
        let place = || format!("{place}: column {}", channel.name);
        let values = match &channel.content {
            Content::Numbers(values) => values,
            Content::Other(what) => return Err(InputError::new(place(), what, "one number an instant")),
        };
        if let Some(row) = values.iter().position(|value| !value.is_finite()) {
            let found = if values[row].is_nan() { "no number".to_owned() } else { values[row].to_string() };
            return Err(InputError::new(format!("{}, value {}", place(), row + 1), found, "a finite number"));
        }
        Ok(Self { role, name: &channel.name, values, clock: channel.clock.as_deref() })
    }
}

/// Columns of one clock, which is one of them.
fn aligned(place: &str, series: Vec<Series<'_>>) -> Result<Vec<(Role, Vec<f64>)>, InputError> {
    let rows = series.iter().find(|series| series.role == Role::Time).map_or(0, |time| time.values.len());
    for series in &series {
        if series.values.len() != rows {
            let found = format!("{} values", series.values.len());
            return Err(InputError::new(
                format!("{place}: column {}", series.name),
                found,
                format!("{rows}, as many as times"),
            ));
        }
    }
    Ok(series.into_iter().map(|series| (series.role, series.values.to_vec())).collect())
}

/// Channels with clocks of their own, at the instants of the position.
fn resampled(place: &str, series: Vec<Series<'_>>) -> Result<Vec<(Role, Vec<f64>)>, InputError> {
    let mut clocks = Vec::new();
    for series in &series {
        match series.clock {
            Some(clock) if clock.len() >= 2 => clocks.push(clock),
            clock => {
                let found = format!("{} values with an instant", clock.map_or(0, <[f64]>::len));
                return Err(InputError::new(format!("{place}: column {}", series.name), found, "at least two"));
            }
        }
    }
    let position =
        series.iter().find(|series| series.role == Role::Position).and_then(|series| series.clock).unwrap_or_default();
    let start = clocks.iter().map(|clock| clock[0]).fold(f64::NEG_INFINITY, f64::max);
    let end = clocks.iter().map(|clock| clock[clock.len() - 1]).fold(f64::INFINITY, f64::min);
    let time: Vec<f64> = position.iter().copied().filter(|instant| (start..=end).contains(instant)).collect();
    if time.len() < 2 {
        let spans: Vec<String> = series
            .iter()
            .filter_map(|series| {
                Some(format!("{} from {:.3} to {:.3} s", series.name, series.clock?.first()?, series.clock?.last()?))
            })
            .collect();
        return Err(InputError::new(place, spans.join(", "), "channels that cover a time in common"));
    }
    let on_position = |series: Series<'_>| {
        let clock = series.clock.unwrap_or_default();
        (series.role, interpolated(clock, series.values, &time))
    };
    let mut channels: Vec<_> = series.into_iter().map(on_position).collect();
    channels.push((Role::Time, time));
    Ok(channels)
}

/// `values` at `wanted`, which lies within `clock`; both increase.
pub(crate) fn interpolated(clock: &[f64], values: &[f64], wanted: &[f64]) -> Vec<f64> {
    let at = |instant: &f64| {
        let after = clock.partition_point(|time| time < instant);
        if clock.get(after) == Some(instant) {
            return values[after];
        }
        let after = after.clamp(1, clock.len() - 1);
        let share = (instant - clock[after - 1]) / (clock[after] - clock[after - 1]);
        values[after - 1] + share * (values[after] - values[after - 1])
    };
    wanted.iter().map(at).collect()
}

fn increasing(place: &str, time: &[f64]) -> Result<(), InputError> {
    if time.len() < 2 {
        return Err(InputError::new(place, format!("{} instants", time.len()), "at least two"));
    }
    match time.windows(2).position(|pair| pair[1] <= pair[0]) {
        None => Ok(()),
        Some(row) => {
            let found = format!("{} after {}", time[row + 1], time[row]);
            Err(InputError::new(format!("{place}: time, value {}", row + 2), found, "time that strictly increases"))
        }
    }
}

/// The channels of `scope` in their places, and the effort from the motor's input or the control law where the rig says how.
pub fn into_recording(channels: Vec<(Role, Vec<f64>)>, rig: &Rig, scope: Scope) -> Recording {
    let mut recording = Recording::default();
    let mut input = None;
    for (role, values) in channels.into_iter().filter(|(role, _)| scope.holds(*role)) {
        match role {
            Role::Time => recording.time = values,
            Role::Position => recording.position = values,
            Role::Velocity => recording.velocity = Some(values),
            Role::Force => recording.force = Some(values),
            Role::Effort => recording.effort = Some(values),
            Role::Reference => recording.reference = Some(values),
            Role::Load => recording.load = Some(values),
            Role::MotorInput => input = Some(values),
        }
    }
    if scope.holds(Role::Effort)
        && recording.effort.is_none()
        && let Some(law) = &rig.effort
    {
        recording.effort = computed_effort::effort(law, rig, &recording, input.as_deref());
    }
    recording
}
