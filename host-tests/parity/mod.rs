//! Every law in single precision against the double-precision reference, on simulated and on recorded contacts.
//!
//! Both sides read the very same rows. An error is judged against the larger of two tolerances. The flat one is a share
//! of the contact's own K and B, set by method. The other grows where the rows say little: rounding each force by its
//! last digit moves K by `eps F / x` and B by `eps F / v` (rms), and normal equations magnify that by one over the
//! independence of the columns.

mod adaptive;
mod block;
mod chain;
mod descent;
mod recursive;

use crate::recordings;
use crate::reference::{self, RegressionRow, Theta};
use crate::simulator::Trial;
use crate::tolerance::Ledger;
use palpate::{FrontEnd, FrontEndConfig, FrontEndState, Impedance, Observation, Sample};

const EPS: f64 = f32::EPSILON as f64;

/// One trial as the laws see it.
struct Case {
    name: String,
    samples: Vec<Sample>,
    front_end: FrontEndConfig,
    contacts: Vec<Vec<Observation>>,
}

impl Case {
    fn new(name: String, samples: Vec<Sample>, config: FrontEndConfig) -> Self {
        let front_end = FrontEnd::new(config).expect("sound settings");
        let mut state = FrontEndState::default();
        let mut contacts = vec![Vec::new()];
        for &sample in &samples {
            let reading = front_end.update(&mut state, sample).expect("a good sample");
            match (reading.contact, contacts.last_mut()) {
                (true, Some(contact)) if !reading.restarted => contact.push(reading.observation),
                (false, Some(contact)) if !contact.is_empty() => contacts.push(Vec::new()),
                _ => {}
            }
        }
        contacts.retain(|contact| contact.len() >= 50);
        assert!(!contacts.is_empty(), "{name}: no contact");
        Self { name, samples, front_end: config, contacts }
    }

    /// Five environments, three seeds.
    fn simulated() -> Vec<Self> {
        let trials = Trial::environments().into_iter().flat_map(|trial| [1, 2, 3].map(|seed| (trial.clone(), seed)));
        trials
            .map(|(trial, seed)| {
                Self::new(format!("{} #{seed}", trial.name), trial.samples(seed), FrontEndConfig::BENCH)
            })
            .collect()
    }

    fn recorded() -> Vec<Self> {
        recordings::all().into_iter().map(|r| Self::new(r.name.to_owned(), r.samples, r.front_end)).collect()
    }
}

/// How far rounding may move K and B over `rows`.
fn rounding(rows: &[RegressionRow]) -> Theta {
    let rms = |pick: fn(&RegressionRow) -> f64| {
        (rows.iter().map(|r| pick(r).powi(2)).sum::<f64>() / rows.len() as f64).sqrt()
    };
    let rho = reference::independence(rows);
    Theta::new(1.0 / rms(|r| r.x), 1.0 / rms(|r| r.v)) * (EPS * rms(|r| r.force) / rho)
}

/// The same where K alone is solved for, and B is what it was.
fn rounding_of_stiffness(rows: &[RegressionRow]) -> Theta {
    let sum = |pick: fn(&RegressionRow) -> f64| rows.iter().map(|r| pick(r).powi(2)).sum::<f64>();
    Theta::new(EPS * (sum(|r| r.force) / sum(|r| r.x)).sqrt(), f64::MIN_POSITIVE)
}

/// Columns in line up to the library's default floor; or a rate below the library's default floor, less than a thousandth
/// of the bench's full scale, which is what is left in the filter of a tool that stands.
fn silent_about_damping(rows: &[RegressionRow]) -> bool {
    let energy = rows.iter().map(|row| row.v * row.v).sum::<f64>() / rows.len() as f64;
    energy.sqrt() < 1.1e-4 || reference::independence(rows) < 1.1e-4
}

/// The errors of one method on one kind of trial.
struct Parity {
    method: &'static str,
    flat: Theta,
    /// Multiple of [`rounding`].
    growth: f64,
    errors: [Ledger; 2],
}

impl Parity {
    fn new(method: &'static str, flat: [f64; 2], growth: f64) -> Self {
        Self { method, flat: flat.into(), growth, errors: Default::default() }
    }

    /// Compares all of one contact: library, reference and what [`rounding`] gives, at each checkpoint.
    fn contact(&mut self, case: &str, checkpoints: &[(Impedance, Theta, Theta)]) {
        let scale = [0, 1].map(|axis| median(checkpoints.iter().map(|c| c.1[axis].abs()).collect()));
        for (at, (got, want, rounding)) in checkpoints.iter().enumerate() {
            let got = reference::theta(*got);
            for axis in [0, 1] {
                let tolerance = (self.flat[axis] * scale[axis]).max(self.growth * rounding[axis]);
                let what = || format!("{} on {case}, checkpoint {at}, {}", self.method, ["K", "B"][axis]);
                self.errors[axis].compare(&what(), got[axis], want[axis], scale[axis], tolerance);
            }
        }
    }

    fn conclude(&self, kind: &str, at_least: usize) {
        for (name, ledger) in ["K", "B"].iter().zip(&self.errors) {
            ledger.conclude(&format!("{} {name}, {kind}", self.method), at_least);
        }
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Runs `experiment` on simulated and on recorded contacts, each with a ledger of its own.
fn on_all(new: impl Fn(&str) -> Parity, every: usize, experiment: impl Fn(&mut Parity, &str, &[Observation])) {
    for (kind, cases) in [("simulated", Case::simulated()), ("recorded", Case::recorded())] {
        let mut parity = new(kind);
        let mut observations = 0;
        for case in &cases {
            for contact in &case.contacts {
                observations += contact.len();
                experiment(&mut parity, &case.name, contact);
            }
        }
        if !cases.is_empty() {
            parity.conclude(kind, observations / every / 2);
        }
    }
}
