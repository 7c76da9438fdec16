//! The figures: what is plotted, what to see, and the curves.

use anyhow::Result;
use palpate::Estimate;

use super::comparison;
use super::estimator::{Estimator, as_the_paper};
use super::force_control::{self, StiffnessSource, TARGET_FORCE_N};
use super::measure::{damping, stiffness};
use super::paper_contact::{PaperContact, PaperTrial};
use super::paper_tables::{PaperVariant, Trials};
use super::plot::{Curve, Plot};
use super::rates::Rate;

/// A figure.
#[derive(Debug, Clone)]
pub struct Figure {
    /// Number, and name of its file: "2".
    pub number: usize,
    /// Title.
    pub title: &'static str,
    /// What is plotted and what to see in it.
    pub words: String,
    /// The picture.
    pub plot: Plot,
}

/// Seconds by which a picture begins before the touch.
const LEAD_TIME_S: f64 = 0.3;

/// Traces of the paper's four on one trial of a contact.
struct Traces<'a> {
    contact: PaperContact,
    trial: &'a PaperTrial,
    time: Vec<f64>,
    begin: f64,
    runs: Vec<(String, Vec<Estimate>)>,
}

impl<'a> Traces<'a> {
    fn of(
        reading: &PaperVariant,
        contact: PaperContact,
        trials: &'a Trials,
        estimators: &[(String, Estimator)],
    ) -> Result<Self> {
        let at = PaperContact::PAPER.iter().position(|one| *one == contact).unwrap_or_default();
        let trial = &trials[at][0];
        let samples = trial.samples(reading.every);
        let config = as_the_paper(1e-3 * reading.every as f32);
        let time: Vec<f64> = trial.time.iter().copied().step_by(reading.every).collect();
        let runs = estimators.iter().map(|(name, e)| Ok((name.clone(), e.run(config, &samples)?)));
        let runs: Vec<_> = runs.collect::<Result<_>>()?;
        let begin = runs.first().map_or(0, |(_, estimates)| super::measure::contact(estimates).start);
        let begin = time.get(begin).copied().unwrap_or_default();
        Ok(Self { contact, trial, time, begin, runs })
    }

    fn curves(&self, value: fn(&[Estimate]) -> Vec<f64>) -> Vec<Curve> {
        let curve = |(at, (name, estimates)): (usize, &(String, Vec<Estimate>))| Curve {
            name: name.clone(),
            colour: at,
            dashed: false,
            points: self.time.iter().map(|t| t - self.begin).zip(value(estimates)).collect(),
        };
        self.runs.iter().enumerate().map(curve).collect()
    }

    fn plot(&self, up: &'static str, y: (f64, f64), until: f64, value: fn(&[Estimate]) -> Vec<f64>) -> Plot {
        plot("seconds since the touch", up, (-LEAD_TIME_S, until), y, self.curves(value))
    }
}

fn all_stiffness(estimates: &[Estimate]) -> Vec<f64> {
    stiffness(estimates).collect()
}

fn all_damping(estimates: &[Estimate]) -> Vec<f64> {
    damping(estimates).collect()
}

fn plot(across: &'static str, up: &'static str, x: (f64, f64), y: (f64, f64), curves: Vec<Curve>) -> Plot {
    Plot { across, up, x, y, logarithmic: (false, false), curves, marks: Vec::new(), dots: false }
}

fn curve(name: &str, colour: usize, points: impl IntoIterator<Item = (f64, f64)>) -> Curve {
    Curve { name: name.into(), colour, dashed: false, points: points.into_iter().collect() }
}

const NEWTON_PER_METRE: &str = "stiffness K, N/m";
const NEWTON_SECOND: &str = "damping B, N s/m";

/// Figures 2 to 12.
///
/// # Errors
/// None for the settings of a reading.
pub fn of_paper(reading: &PaperVariant, trials: &Trials, rates: &[Rate]) -> Result<Vec<Figure>> {
    let four: Vec<(String, Estimator)> = reading.estimators(300).into_iter().map(|e| (e.name(), e)).collect();
    let windows = [50, 100, 300].map(|w| (format!("window of {w}"), Estimator::Bls(w)));
    let soft = Traces::of(reading, PaperContact::Soft, trials, &four)?;
    let varying = Traces::of(reading, PaperContact::Varying, trials, &four)?;
    let medium = Traces::of(reading, PaperContact::Medium, trials, &four)?;
    let lengths = Traces::of(reading, PaperContact::Soft, trials, &windows)?;
    let figure = |number, title, words: &str, plot| Figure { number, title, words: words.into(), plot };
    Ok(vec![
        figure(
            2,
            "The motion: what was commanded and what the tool did",
            "The command (dashed) is a square pulse, smoothed, with a sine of 10 Hz on top (eq. 15); the tool follows it through the air and, from the touch on, falls short of it, for the foam pushes back. Depth counts from the surface; below zero the tool is in the air.",
            motion(&soft),
        ),
        figure(
            3,
            "The force that the sensor showed, and what BLS expected",
            "The force follows the sine. BLS expects each sample from those before it: where the two part, its K and B did not foresee the force. That gap, as a share of the force, is the RMSE of tables I and II.",
            expected(&soft),
        ),
        figure(
            4,
            "Soft contact: stiffness by the four methods",
            "Each method's K from the touch on. Look how soon each arrives, and how quiet it stays. EWRLS begins from a P(0) that believes in K = 0; the slow fall is the foam, which relaxes.",
            soft.plot(NEWTON_PER_METRE, (0.0, 500.0), 10.0, all_stiffness),
        ),
        figure(
            5,
            "Soft contact: damping by the four methods",
            &format!(
                "Each method's B; the bench holds {} N s/m. The paper low-passes the velocity alone, which delays it against the force: figure 13 shows what that does to B where nothing else disturbs it.",
                truth(PaperContact::Soft)[1]
            ),
            soft.plot(NEWTON_SECOND, (-5.0, 15.0), 10.0, all_damping),
        ),
        figure(
            6,
            "Soft contact: the first second",
            "The beginning of figure 4. The dotted line is at 0.3 s, within which the paper has BLS and BLMF converge.",
            with_mark(soft.plot(NEWTON_PER_METRE, (0.0, 500.0), 1.2, all_stiffness), 0.3, "0.3 s"),
        ),
        figure(
            7,
            "Soft contact: what a longer window buys",
            "K by BLS with windows of 50, 100 and 300 samples. A window shorter than the 10 Hz of the motion follows every swing of the foam's own stiffness; a longer one is quieter and later.",
            lengths.plot(NEWTON_PER_METRE, (0.0, 500.0), 5.0, all_stiffness),
        ),
        figure(
            8,
            "Time-varying contact: stiffness by the four methods",
            "Bubble wrap that gives way: its true K is dashed. What lags behind it is the memory.",
            with_truth(varying.plot(NEWTON_PER_METRE, (0.0, 700.0), 12.0, all_stiffness), wrap(&varying)?),
        ),
        figure(
            9,
            "Time-varying contact: damping by the four methods",
            &format!("Each method's B on the bubble wrap, which holds {} N s/m.", truth(PaperContact::Varying)[1]),
            varying.plot(NEWTON_SECOND, (-5.0, 15.0), 12.0, all_damping),
        ),
        figure(
            10,
            "Medium contact: stiffness by the four methods",
            "A pad (its true K dashed) that the tool hardly enters: a few millimetres say little against a P(0) that was chosen for soft things.",
            with_truth(
                medium.plot(NEWTON_PER_METRE, (0.0, 4000.0), 6.0, all_stiffness),
                level(truth(PaperContact::Medium)[0]),
            ),
        ),
        figure(
            11,
            "Medium contact: damping by the four methods",
            "Each method's B on the pad; the truth is dashed.",
            with_truth(
                medium.plot(NEWTON_SECOND, (-10.0, 30.0), 6.0, all_damping),
                level(truth(PaperContact::Medium)[1]),
            ),
        ),
        figure(
            12,
            "How many updates a second each method does",
            "The device at its worst update (dots, joined) against the paper's MATLAB on a PC with nineteen times the clock (the same colour, dashed). The line at 1 kHz is what a control loop asks for.",
            rates_plot(rates),
        ),
    ])
}

fn motion(soft: &Traces<'_>) -> Plot {
    let millimetres = |column: &[f64]| -> Vec<(f64, f64)> {
        soft.trial.time.iter().map(|t| t - soft.begin).zip(column.iter().map(|x| 1e3 * x)).collect()
    };
    let command = Curve { dashed: true, ..curve("commanded", 8, millimetres(&soft.trial.reference)) };
    let tool = curve("measured", 0, millimetres(&soft.trial.position));
    plot("seconds since the touch", "depth, mm", (-1.0, 1.5), (-20.0, 20.0), vec![command, tool])
}

fn expected(soft: &Traces<'_>) -> Plot {
    let measured = soft.trial.time.iter().zip(&soft.trial.force).map(|(t, f)| (t - soft.begin, *f));
    let bls = soft.runs.iter().find(|(name, _)| name == "BLS").map(|(_, estimates)| estimates.as_slice());
    let every = (soft.trial.time.len() / soft.time.len().max(1)).max(1);
    let forces = soft.trial.force.iter().step_by(every);
    let predicted = bls
        .unwrap_or_default()
        .iter()
        .zip(forces)
        .zip(&soft.time)
        .map(|((e, f), t)| (t - soft.begin, f - f64::from(e.innovation)));
    plot(
        "seconds since the touch",
        "force, N",
        (-0.1, 1.0),
        (-1.0, 6.0),
        vec![curve("measured", 8, measured), curve("expected by BLS", 2, predicted)],
    )
}

fn with_mark(mut plot: Plot, at: f64, word: &'static str) -> Plot {
    plot.marks.push((at, word));
    plot
}

fn with_truth(mut plot: Plot, points: Vec<(f64, f64)>) -> Plot {
    plot.curves.insert(0, Curve { name: "truth".into(), colour: 6, dashed: true, points });
    plot
}

fn level(value: f64) -> Vec<(f64, f64)> {
    vec![(0.0, value), (100.0, value)]
}

/// K and B of a rig file, at the surface and at the start; NaN where there is no contact.
fn truth(contact: PaperContact) -> [f64; 2] {
    let found = contact.rig().ok().and_then(|rig| rig.contact);
    found.map_or([f64::NAN; 2], |contact| [contact.stiffness, contact.damping])
}

/// K of the bubble wrap over time, as its rig file has it.
fn wrap(varying: &Traces<'_>) -> Result<Vec<(f64, f64)>> {
    let rig = varying.contact.rig()?;
    let settling = crate::effects::resolve_all(&rig, "the bubble wrap")?;
    let settling = settling.iter().find(|resolved| resolved.effect.spec().name == "time_varying_stiffness");
    let (change, time) = settling.map_or((0.0, 1.0), |resolved| (resolved.values[0], resolved.values[1]));
    let [stiffness, _] = truth(varying.contact);
    let course = |t: f64| stiffness * (1.0 + change * (1.0 - (-(t + varying.begin) / time).exp()));
    Ok((0..140).map(|k| f64::from(k) * 0.1).map(|t| (t, course(t))).collect())
}

fn rates_plot(rates: &[Rate]) -> Plot {
    let mut curves = Vec::new();
    for (colour, method) in super::paper::METHODS.iter().enumerate() {
        let own = || rates.iter().filter(|rate| rate.method == *method);
        let spread = |value: &dyn Fn(&Rate) -> Option<f64>| -> Vec<(f64, f64)> {
            let each = own().filter_map(|rate| Some((rate.window, value(rate)?)));
            // What has no window costs the same at any.
            each.flat_map(|(window, y)| match window {
                Some(window) => vec![(f64::from(window), y)],
                None => vec![(10.0, y), (300.0, y)],
            })
            .collect()
        };
        curves.push(curve(&format!("{method} on the device"), colour, spread(&|rate| Some(rate.per_second[0]))));
        let paper = spread(&|rate| rate.paper);
        if !paper.is_empty() {
            let name = format!("{method}, paper's PC");
            curves.push(Curve { name, colour, dashed: true, points: paper });
        }
    }
    curves.push(Curve { name: "1 kHz".into(), colour: 8, dashed: true, points: vec![(10.0, 1e3), (300.0, 1e3)] });
    let mut plot = plot("window, samples", "updates per second", (8.0, 400.0), (100.0, 1e6), curves);
    (plot.logarithmic, plot.dots) = ((true, true), true);
    plot
}

/// Figures 13 and on: what does better.
///
/// # Errors
/// None for these settings.
pub fn of_better(steps: &PaperTrial, flights: &[force_control::ForceControlResult]) -> Result<Vec<Figure>> {
    let shown = [
        ("EWRLS", Estimator::Ewrls { window: 300, covariance: 10.0 }, false),
        ("BLS 300", Estimator::Bls(300), false),
        ("matched, BLS 300", Estimator::Bls(300), true),
        ("matched, shrinking window", Estimator::Adaptive, true),
        ("matched, CUSUM-reset RLS", Estimator::Cusum, true),
    ];
    let samples = steps.samples(1);
    let mut runs = Vec::new();
    for ((name, estimator, is_matched), colour) in shown.into_iter().zip([0, 8, 2, 3, 1]) {
        runs.push((name, colour, estimator.run(comparison::front_end(is_matched), &samples)?));
    }
    let begin = runs.last().map_or(0, |(.., estimates)| super::measure::contact(estimates).start);
    let [up, _] = comparison::JUMPS;
    let around = |row: usize, value: fn(&[Estimate]) -> Vec<f64>| -> Vec<Curve> {
        let curve = |(name, at, estimates): &(&str, usize, Vec<Estimate>)| {
            let points = value(estimates).into_iter().enumerate().map(|(k, y)| (k as f64 - row as f64, y));
            curve(name, *at, points)
        };
        runs.iter().map(curve).collect()
    };
    let jump = vec![(-100.0, 250.0), (0.0, 250.0), (0.0, 900.0), (900.0, 900.0)];
    let damped =
        plot("milliseconds since the jump", NEWTON_SECOND, (-500.0, 3000.0), (0.0, 10.0), around(up, all_damping));
    let onset = plot(
        "milliseconds since the touch",
        NEWTON_PER_METRE,
        (-20.0, 400.0),
        (0.0, 500.0),
        around(begin, all_stiffness),
    );
    let stepped =
        plot("milliseconds since the jump", NEWTON_PER_METRE, (-50.0, 450.0), (0.0, 1100.0), around(up, all_stiffness));
    let figure = |number, title, words: &str, plot| Figure { number, title, words: words.into(), plot };
    Ok(vec![
        figure(
            13,
            "Damping, without the delay",
            "B around a jump of K at 0; the truth is dashed. Behind the paper's velocity filter B settles beside it, behind the matched filter on it.",
            with_truth(damped, vec![(-500.0, 5.0), (3000.0, 5.0)]),
        ),
        figure(
            14,
            "The touch: who knows K first",
            "K in the first 0.4 s of a contact; the truth is dashed.",
            with_truth(onset, vec![(0.0, 250.0), (400.0, 250.0)]),
        ),
        figure(
            15,
            "A jump of K from 250 to 900 N/m: who follows",
            "K around the jump; the truth is dashed. A window of 300 needs its 300 samples; a window that shrinks, and a recursion that begins again, need as long as it takes to be sure that something has changed.",
            with_truth(stepped, jump),
        ),
        figure(
            16,
            "Force under control when K jumps",
            "An adaptive controller holds 3 N by the K of an estimator while the true K jumps at 0. The force is its mean over one period of the dither. The sooner K is known, the sooner the force is back.",
            flights_plot(flights),
        ),
    ])
}

fn flights_plot(flights: &[force_control::ForceControlResult]) -> Plot {
    let [up, _] = comparison::JUMPS;
    let shown = |row: &&force_control::ForceControlResult| {
        !matches!(
            row.source,
            StiffnessSource::Estimated(Estimator::Sprls { .. } | Estimator::Blmf(_) | Estimator::Adaptive, _)
        )
    };
    let curve = |(at, row): (usize, &force_control::ForceControlResult)| {
        let points = row.flight.time.iter().zip(&row.flight.force).map(|(t, f)| (1e3 * t - up as f64, *f));
        curve(&row.source.name(), [8, 0, 1, 4, 6][at.min(4)], points)
    };
    let mut curves: Vec<Curve> = flights.iter().filter(shown).enumerate().map(curve).collect();
    let wanted = vec![(-300.0, TARGET_FORCE_N), (2000.0, TARGET_FORCE_N)];
    curves.insert(0, Curve { name: "wanted".into(), colour: 7, dashed: true, points: wanted });
    plot("milliseconds since the jump", "force, N", (-300.0, 2000.0), (0.0, 6.5), curves)
}
