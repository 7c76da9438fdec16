//! A diagnosis of every kind.

use crate::signal::{Size, maps, trace};
use palpate_lab::diagnose::report::diagnosis::*;

pub const CHECKED: [&str; 8] = [
    "hunt_crossley_damping",
    "coulomb_friction",
    "quadratic_damping",
    "nonlinear_stiffness",
    "adhesion",
    "force_lag",
    "mains_hum",
    "stribeck_friction",
];

const BENCH: Size = Size { depth: 9e-3, force: 4.0, rows: 6000, rate: 1000.0, lacks: [1.0, 0.9, 0.0] };

pub fn explained() -> (Diagnosis, PlotData) {
    let answer = Diagnosis {
        summary: "The damping grows with depth and the drive drags; the simulation knows neither.".into(),
        physics: vec![crossley(), coulomb()],
        alternatives: vec![Alternative {
            physics: vec!["quadratic_damping".into()],
            channel: "force",
            held_out_gain: 0.93,
            separated_by: "press at one speed to 3 mm and to 9 mm: only damping that grows with depth tells them apart"
                .into(),
        }],
        locations: vec![
            location("force", "trial-1.csv", [2.61, 2.95], Phase::Onset, 0.82, "x 0-2 mm, v > 0.1 m/s"),
            location("effort", "trial-2.csv", [0.5, 1.75], Phase::Free, 0.41, "|v| < 0.01 m/s"),
            location("force", "trial-2.csv", [3.0, 3.2], Phase::Unloading, 0.06, ""),
        ],
        fit: goodness("force", [0.41, 0.305, 0.0452, 0.044], 0.97),
        channels: vec![
            goodness("force", [0.41, 0.305, 0.0452, 0.044], 0.97),
            goodness("effort", [3.1, 2.2, 0.062, 0.06], 0.995),
        ],
        nominal: vec![
            nominal("stiffness_n_m", "N/m", 300.0, 318.4, 2.3),
            nominal("damping_n_s_m", "N s/m", 5.0, 5.02, 0.11),
            nominal("mass_kg", "kg", 0.8, 0.811, 0.004),
        ],
        findings: vec![
            Finding {
                code: "clipped_force",
                grave: true,
                place: "trial-2.csv".into(),
                text:
                    "The force sits at its end for 0.4 s: those samples say nothing. Use a sensor that reaches further."
                        .into(),
            },
            Finding {
                code: "coarse_position",
                grave: false,
                place: String::new(),
                text: "Position is rounded to 0.1 mm.".into(),
            },
        ],
        ..bare(Verdict::Explained)
    };
    let traces = ["trial-1.csv", "trial-2.csv"].iter().enumerate();
    let traces: Vec<Trace> =
        traces.flat_map(|(n, name)| ["force", "effort"].map(|c| trace(&BENCH, name, c, 2 * n as u64))).collect();
    let mut all = maps(&BENCH, "force", "m", 46.0, 1.1);
    all.extend(maps(&BENCH, "effort", "m", 1300.0, 1.4));
    let pictures = PlotData {
        evidence: vec![state_plot(&traces[0], "m"), state_plot(&traces[1], "m/s")],
        traces,
        run: Some(run()),
        maps: all,
        experiment: Some(experiment(9e-3)),
        ..blank("bench A")
    };
    (answer, pictures)
}

pub fn no_mismatch() -> (Diagnosis, PlotData) {
    let size = Size { lacks: [0.0; 3], ..BENCH };
    let answer = Diagnosis {
        summary: "The simulation agrees with the recordings as far as the sensors can tell.".into(),
        fit: goodness("force", [0.0443, 0.0441, 0.0441, 0.044], 0.0),
        channels: vec![goodness("force", [0.0443, 0.0441, 0.0441, 0.044], 0.0)],
        nominal: vec![nominal("stiffness_n_m", "N/m", 300.0, 300.4, 2.3)],
        ..bare(Verdict::NoMismatch)
    };
    let pictures = PlotData {
        traces: vec![trace(&size, "trial-1.csv", "force", 1)],
        maps: maps(&size, "force", "m", 1.1, 1.1),
        ..blank("bench A")
    };
    (answer, pictures)
}

pub fn parameters() -> (Diagnosis, PlotData) {
    let size = Size { lacks: [0.7, 0.0, 0.0], ..BENCH };
    let answer = Diagnosis {
        summary: "The contact is stiffer than the rig file says; nothing else is missing.".into(),
        fit: goodness("force", [0.61, 0.0449, 0.0449, 0.044], 0.0),
        channels: vec![goodness("force", [0.61, 0.0449, 0.0449, 0.044], 0.0)],
        nominal: vec![
            nominal("stiffness_n_m", "N/m", 300.0, 412.0, 2.3),
            nominal("damping_n_s_m", "N s/m", 5.0, 4.9, 0.3),
        ],
        locations: vec![location("force", "trial-1.csv", [0.0, 5.99], Phase::Loading, 0.7, "x 4-9 mm")],
        ..bare(Verdict::Parameters)
    };
    let pictures = PlotData { traces: vec![trace(&size, "trial-1.csv", "force", 1)], ..blank("bench A") };
    (answer, pictures)
}

pub fn unknown() -> (Diagnosis, PlotData) {
    let size = Size { lacks: [1.0, 0.9, 0.9], ..BENCH };
    let physics = Physics {
        name: "unknown".into(),
        acts_in: "contact",
        channel: "force",
        statement: "The force differs while the tool draws back, and no known effect does so.".into(),
        equation: String::new(),
        evidence: Evidence { held_out_gain: 0.0, p_value: 0.002 },
        parameters: Vec::new(),
        on_drive: None,
    };
    let answer = Diagnosis {
        summary: "Something that is not in the list acts while the tool draws back.".into(),
        physics: vec![physics],
        locations: vec![location(
            "force",
            "trial-1.csv",
            [3.2, 3.7],
            Phase::Unloading,
            0.74,
            "x 3-9 mm, v < -0.02 m/s",
        )],
        fit: goodness("force", [0.41, 0.305, 0.305, 0.044], 0.0),
        channels: vec![goodness("force", [0.41, 0.305, 0.305, 0.044], 0.0)],
        ..bare(Verdict::Unknown)
    };
    let pictures = PlotData {
        traces: vec![trace(&size, "trial-1.csv", "force", 1)],
        maps: maps(&size, "force", "m", 46.0, 46.0),
        ..blank("bench A")
    };
    (answer, pictures)
}

/// A microscope's lever that turns: nanonewton metres over microradians.
pub fn nano() -> (Diagnosis, PlotData) {
    let size = Size { depth: 4e-6, force: 3e-9, lacks: [1.0, 0.8, 0.1], ..BENCH };
    let (mut answer, _) = explained();
    answer.verdict = Verdict::PartlyExplained;
    answer.physics.truncate(1);
    answer.physics[0].parameters = vec![
        value("alpha", 3.21e-7, "N m s/rad^2", 0.04e-7),
        value("offset", -1.2e-9, "N m", 0.3e-9),
        value("moved_mass", 2.5e-12, "kg m^2", 0.2e-12),
    ];
    answer.alternatives.clear();
    answer.locations.truncate(1);
    let mut fit = goodness("force", [4.1e-10, 3.1e-10, 0.8e-10, 0.44e-10], 0.91);
    fit.unit = "N m";
    answer.channels = vec![fit.clone()];
    answer.fit = fit;
    answer.findings.clear();
    answer.nominal = vec![
        nominal("stiffness_n_m_rad", "N m/rad", 7e-4, 7.3e-4, 0.05e-4),
        nominal("inertia_kg_m2", "kg m^2", 2.0e-12, 2.1e-12, 0.3e-12),
    ];
    let pictures = PlotData {
        position_unit: "rad",
        force_unit: "N m",
        traces: vec![trace(&size, "trial-1.csv", "force", 4)],
        maps: maps(&size, "force", "rad", 46.0, 3.0),
        ..blank("lever")
    };
    (answer, pictures)
}

fn bare(verdict: Verdict) -> Diagnosis {
    Diagnosis {
        schema: "palpate.diagnosis/1",
        verdict,
        summary: String::new(),
        physics: Vec::new(),
        alternatives: Vec::new(),
        locations: Vec::new(),
        fit: goodness("force", [1.0; 4], 0.0),
        channels: Vec::new(),
        nominal: Vec::new(),
        correlations: Vec::new(),
        checked: CHECKED.to_vec(),
        findings: Vec::new(),
    }
}

fn blank(rig: &str) -> PlotData {
    PlotData {
        rig: rig.into(),
        position_unit: "m",
        force_unit: "N",
        traces: Vec::new(),
        maps: Vec::new(),
        evidence: Vec::new(),
        run: None,
        experiment: None,
    }
}

fn crossley() -> Physics {
    Physics {
        name: "hunt_crossley_damping".into(),
        acts_in: "contact",
        channel: "force",
        statement: "The deeper the tool is, the more the contact damps".into(),
        equation: "F = K x + B v + alpha x v".into(),
        evidence: Evidence { held_out_gain: 0.94, p_value: 0.0002 },
        parameters: vec![value("alpha", 812.3, "N s/m^2", 14.0)],
        on_drive: Some("x v".into()),
    }
}

fn coulomb() -> Physics {
    let lopsided = Value { name: "backward_level".into(), value: 1.12, unit: "N".into(), ci95: [0.81, 1.21] };
    Physics {
        name: "coulomb_friction".into(),
        acts_in: "drive",
        channel: "effort",
        statement: "The drive drags with the same force at every speed".into(),
        equation: "m a + b v + forward_level where v > 0, - backward_level where v < 0, = effort - F; at rest it holds up to either".into(),
        evidence: Evidence { held_out_gain: 0.995, p_value: 0.004 },
        parameters: vec![value("forward_level", 1.43, "N", 0.05), lopsided],
        on_drive: None,
    }
}

pub fn value(name: &str, value: f64, unit: &str, half_width: f64) -> Value {
    Value { name: name.into(), value, unit: unit.into(), ci95: [value - half_width, value + half_width] }
}

fn nominal(name: &str, unit: &str, given: f64, fitted: f64, half_width: f64) -> Nominal {
    Nominal { name: name.into(), unit: unit.into(), given, fitted, ci95: [fitted - half_width, fitted + half_width] }
}

fn goodness(channel: &'static str, [as_given, refitted, improved, noise_floor]: [f64; 4], share: f64) -> FitQuality {
    let (unit, held_out, band_hz) = ("N", true, 120.0);
    FitQuality {
        channel,
        unit,
        noise_floor,
        as_given,
        refitted,
        improved,
        learned: None,
        held_out,
        explained_share: share,
        band_hz,
    }
}

fn location(
    channel: &'static str,
    trial: &str,
    [start_s, end_s]: [f64; 2],
    phase: Phase,
    share: f64,
    states: &str,
) -> Location {
    Location { channel, trial: trial.into(), start_s, end_s, phase, share, states: states.into() }
}

/// Force over depth of a trace, with what `learned` makes of it where there is one.
fn state_plot(trace: &Trace, unit: &'static str) -> StatePlot {
    let end = trace.time.last().copied().expect("rows");
    StatePlot {
        channel: trace.channel,
        trial: trace.trial.clone(),
        stretch_s: [0.25 * end, 0.4 * end],
        drawn_s: [0.0, end],
        along: if trace.channel == "force" { "depth" } else { "speed" },
        unit,
        ordinate: if trace.channel == "force" { "force" } else { "effort beside inertia" },
        ordinate_unit: "N",
        state: trace.depth.clone(),
        measured: trace.measured.clone(),
        as_given: trace.as_given.clone(),
        refitted: trace.refitted.clone(),
        improved: trace.improved.clone(),
        learned: trace.learned.clone(),
    }
}

fn run() -> Run {
    Run {
        date: "2026-01-02T03:04:05Z".into(),
        version: "0.1.0",
        command: "palpate diagnose --rig bench.toml trial-1.csv trial-2.csv --seed 1".into(),
        seed: 1,
        inputs: vec![("bench.toml".into(), "ab".repeat(32))],
        replay_page: Some("replay.html".into()),
    }
}

fn experiment(depth: f64) -> Experiment {
    let time: Vec<f64> = (0..8000).map(|row| f64::from(row) * 1e-3).collect();
    let reference = time.iter().map(|t| depth * (0.2 + 0.8 * (t / 4.0).floor()) * (3.0 * t).sin()).collect();
    Experiment { text: "Press to 2 mm and then to 9 mm at the same speed: damping that grows with depth shows only in the second half.".into(), time, reference }
}
