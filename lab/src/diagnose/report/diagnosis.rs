//! The diagnosis as data: what the JSON holds, word for word, and what the page draws.

use schemars::JsonSchema;
use serde::Serialize;

pub use crate::diagnose::check::Finding;
pub use crate::diagnose::experiment::Experiment;
pub use crate::diagnose::phase::Phase;
pub use crate::diagnose::verdict::Verdict;

/// The diagnosis, in the layout of `palpate.diagnosis/1`.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Diagnosis {
    /// "palpate.diagnosis/1".
    pub schema: &'static str,
    /// What came out.
    pub verdict: Verdict,
    /// One sentence that a mechanic understands.
    pub summary: String,
    /// The physics left out, in order of evidence.
    pub physics: Vec<Physics>,
    /// What this data cannot tell from the answer.
    #[serde(rename = "rivals")]
    pub alternatives: Vec<Alternative>,
    /// Where simulation and recording differ.
    pub locations: Vec<Location>,
    /// How well the models fit, on data that no fit saw, in the channel that shows the named physics; of two or of none, in that with the larger mismatch.
    pub fit: FitQuality,
    /// The same of each channel.
    pub channels: Vec<FitQuality>,
    /// The nominal values, given and refitted.
    pub nominal: Vec<Nominal>,
    /// How the fitted values of each channel hang together.
    pub correlations: Vec<Correlations>,
    /// Every effect that was tried.
    pub checked: Vec<&'static str>,
    /// What the recordings themselves showed before anything was fitted, and what limits the answer.
    pub findings: Vec<Finding>,
}

/// Physics left out.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Physics {
    /// Name of the effect, or "unknown".
    pub name: String,
    /// "contact", "drive" or "sensor"; the channel where unknown.
    pub acts_in: &'static str,
    /// The channel that shows it: "force" or "effort".
    pub channel: &'static str,
    /// One plain sentence.
    pub statement: String,
    /// Law in the symbols of the parameters; empty where unknown.
    pub equation: String,
    /// Why one should believe it.
    pub evidence: Evidence,
    /// Its parameters.
    pub parameters: Vec<Value>,
    /// The library's regressor that carries it on the drive, where one does.
    pub on_drive: Option<String>,
}

/// Why one should believe it.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct Evidence {
    /// Of the power above the expected noise that the law leaves without it on rows that no fit saw, the share that it takes away.
    pub held_out_gain: f64,
    /// Probability that chance alone does as much somewhere among all effects: likelihood-ratio test, Bonferroni over all that are tried.
    pub p_value: f64,
}

/// A parameter and its interval.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Value {
    /// "alpha".
    pub name: String,
    /// Estimate.
    pub value: f64,
    /// "N s/m^2".
    pub unit: String,
    /// 95 % interval; `null` in the JSON where the recordings set no end.
    #[schemars(with = "[Option<f64>; 2]")]
    pub ci95: [f64; 2],
}

/// What this data cannot tell from the answer.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Alternative {
    /// Effects.
    pub physics: Vec<String>,
    /// The channel that they would explain: "force" or "effort".
    pub channel: &'static str,
    /// The measure of [`FitQuality::explained_share`]: of what refitted values leave above the expected noise, the share that it takes.
    pub held_out_gain: f64,
    /// The experiment that would separate them.
    pub separated_by: String,
}

/// Where simulation and recording differ.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Location {
    /// "force" or "effort".
    pub channel: &'static str,
    /// File name of the trial.
    pub trial: String,
    /// Since the first row of the trial, in its own time.
    pub start_s: f64,
    /// End of the stretch.
    pub end_s: f64,
    /// Phase of contact.
    pub phase: Phase,
    /// Share of its channel's energy above the expected noise that lies in this stretch.
    pub share: f64,
    /// "x 6-9 mm, v > 0.05 m/s".
    pub states: String,
}

/// How well the models fit, as root mean squares of the residual on data that no fit saw.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FitQuality {
    /// "force" or "effort".
    pub channel: &'static str,
    /// "N" or "N m".
    pub unit: &'static str,
    /// What the sensors leave.
    pub noise_floor: f64,
    /// The rig file as it stands, or the simulation handed over.
    pub as_given: f64,
    /// The same physics, values refitted.
    pub refitted: f64,
    /// With the named physics.
    pub improved: f64,
    /// With the named physics and what was learned beside it; left out where nothing was.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub learned: Option<f64>,
    /// Always true: nothing is quoted that was fitted.
    pub held_out: bool,
    /// Share of the energy above the expected noise, that refitted values leave, which the named physics takes away.
    pub explained_share: f64,
    /// Up to which frequency the channel was analysed, Hz.
    pub band_hz: f64,
}

/// A nominal value.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Nominal {
    /// Key of the rig file.
    pub name: String,
    /// "N/m".
    pub unit: String,
    /// In the rig file.
    pub given: f64,
    /// Refitted, with the named physics.
    pub fitted: f64,
    /// 95 % interval; `null` in the JSON where the recordings set no end.
    #[schemars(with = "[Option<f64>; 2]")]
    pub ci95: [f64; 2],
}

/// Correlations of the errors of fitted values: where two are nearly one, the recordings tell them only together.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Correlations {
    /// "force" or "effort".
    pub channel: &'static str,
    /// Keys of the rig file, and `effect.parameter`.
    pub parameters: Vec<String>,
    /// From -1 to 1, a row for each of `parameters`, by the curvature of the fit.
    pub matrix: Vec<Vec<f64>>,
}

/// What the page draws beside the answer.
#[derive(Debug, Clone, Default, Serialize, JsonSchema)]
pub struct PlotData {
    /// Name of the rig.
    pub rig: String,
    /// "m" or "rad".
    pub position_unit: &'static str,
    /// "N" or "N m".
    pub force_unit: &'static str,
    /// The measurement that shows the answer, one a channel, the channel of the answer first.
    pub evidence: Vec<StatePlot>,
    /// A trial and channel each.
    pub traces: Vec<Trace>,
    /// Shares of the energy above the expected noise: by phase, depth, speed, time and frequency, before and after.
    pub maps: Vec<BinnedResidual>,
    /// The reference to run next, where there are alternatives.
    pub experiment: Option<Experiment>,
    /// How the diagnosis was made; `None` where no command was given.
    pub run: Option<Run>,
}

/// Force over a state of the machine: depth of a contact, speed or position of a drive. All vectors are of equal length, but for
/// `learned`, which is empty where nothing was learned.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct StatePlot {
    /// "force" or "effort".
    pub channel: &'static str,
    /// File name of the trial.
    pub trial: String,
    /// The shortest stretch that holds most of what the answer gains, seconds since the first row of the trial.
    pub stretch_s: [f64; 2],
    /// The stretch that is drawn: of a contact the whole pass around `stretch_s`.
    pub drawn_s: [f64; 2],
    /// "depth", "speed", "position" or "time".
    pub along: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What is drawn over it: "force", or what of the effort is left to friction and load.
    pub ordinate: &'static str,
    /// "N" or "N m".
    pub ordinate_unit: &'static str,
    /// The state, row by row.
    pub state: Vec<f32>,
    /// As measured.
    pub measured: Vec<f32>,
    /// By the rig file as given, by refitted values, with the named effects, and with the learned element.
    pub as_given: Vec<f32>,
    /// See `as_given`.
    pub refitted: Vec<f32>,
    /// See `as_given`.
    pub improved: Vec<f32>,
    /// See `as_given`.
    pub learned: Vec<f32>,
}

/// How a diagnosis was made.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Run {
    /// UTC, as in RFC 3339.
    pub date: String,
    /// Of this tool.
    pub version: &'static str,
    /// The command line.
    pub command: String,
    /// Seed of what was drawn at random.
    pub seed: u64,
    /// Every input file with its SHA-256.
    pub inputs: Vec<(String, String)>,
    /// The page of a replay beside this one, where there is one.
    pub replay_page: Option<String>,
}

/// One channel of one trial over time. All vectors are of equal length.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Trace {
    /// File name.
    pub trial: String,
    /// "force" or "effort".
    pub channel: &'static str,
    /// Seconds.
    pub time: Vec<f64>,
    /// Position of the tool relative to the fitted surface.
    pub depth: Vec<f32>,
    /// As measured, smoothed.
    pub measured: Vec<f32>,
    /// By the rig file as given, or the simulation handed over.
    pub as_given: Vec<f32>,
    /// By the same physics, values refitted.
    pub refitted: Vec<f32>,
    /// With the named physics.
    pub improved: Vec<f32>,
    /// With the learned element; empty where nothing was learned.
    pub learned: Vec<f32>,
    /// Deviation of what the sensors leave at each moment.
    pub expected_noise: Vec<f32>,
    /// Whether a row was seen whole; others are drawn as a gap.
    pub valid: Vec<bool>,
}

/// Where the mismatch lies along one quantity.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BinnedResidual {
    /// "force" or "effort".
    pub channel: &'static str,
    /// "phase", "depth", "speed", "time", "frequency".
    pub along: &'static str,
    /// "m/s"; empty for the phase.
    pub unit: String,
    /// Label of each bin.
    pub labels: Vec<String>,
    /// Residual power over the expected noise's in the bin: one is noise. Refitted values.
    pub before: Vec<f64>,
    /// The same with the named physics.
    pub after: Vec<f64>,
    /// Share of the channel's energy above the expected noise that lies in the bin, before.
    pub share: Vec<f64>,
}
