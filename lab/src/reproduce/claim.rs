//! What the paper claims, each as a comparison that is computed, and what it says against itself.

use super::paper::{METHODS, RATES, RMSE_BY_CONTACT, RMSE_BY_WINDOW, STD_BY_WINDOW};
use super::paper_tables::{Cell, Study};
use super::rates::{CLOCK_HZ, Source};

/// A claim under one reading.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The reading's name.
    pub reading: &'static str,
    /// The figures, in words.
    pub found: String,
    /// Whether it holds.
    pub holds: bool,
}

/// A claim.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    /// In one sentence.
    pub words: &'static str,
    /// Where it stands.
    pub place: &'static str,
    /// The paper's own figures for it.
    pub paper: String,
    /// Under each reading.
    pub findings: Vec<Finding>,
}

const EWRLS: usize = 0;
const SPRLS: usize = 1;
const BLS: usize = 2;
const BLMF: usize = 3;
const SOFT: usize = 0;
const VARYING: usize = 1;
const MEDIUM: usize = 2;

/// Figures and verdict of a claim from one study.
type Judge = fn(&Study) -> (String, bool);

struct Plan {
    words: &'static str,
    place: &'static str,
    paper: String,
    judge: Judge,
}

fn rmse(study: &Study, method: usize, contact: usize) -> f64 {
    study.by_contact[method][contact].rmse.mean
}

fn converged(study: &Study, method: usize, contact: usize) -> f64 {
    study.by_contact[method][contact].converged.mean
}

/// At the shortest and the longest window, on the soft contact.
fn ends(study: &Study, method: usize, value: fn(&Cell) -> f64) -> [f64; 2] {
    let at = |cells: Option<&[Cell; 4]>| cells.map_or(f64::NAN, |cells| value(&cells[method]));
    [at(study.by_window.first()), at(study.by_window.last())]
}

fn error(cell: &Cell) -> f64 {
    cell.rmse.mean
}

fn deviation(cell: &Cell) -> f64 {
    cell.deviation.mean
}

fn named(values: &[(usize, f64)], unit: &str, decimals: usize) -> String {
    let words: Vec<String> =
        values.iter().map(|(method, value)| format!("{} {value:.decimals$}", METHODS[*method])).collect();
    format!("{}{unit}", words.join(", "))
}

fn of_contact(contact: usize, methods: &[usize]) -> String {
    let words = methods.iter().map(|method| format!("{} {}", METHODS[*method], RMSE_BY_CONTACT[*method][contact]));
    format!("{} %", words.collect::<Vec<_>>().join(", "))
}

fn of_window(table: &[Option<[f64; 2]>; 4], methods: &[usize], unit: &str) -> String {
    let words = methods.iter().filter_map(|method| {
        table[*method].map(|[short, long]| format!("{} {short:.2} to {long:.2}{unit}", METHODS[*method]))
    });
    words.collect::<Vec<_>>().join(", ")
}

fn from_to(study: &Study, methods: &[usize], value: fn(&Cell) -> f64, unit: &str) -> String {
    let words = methods.iter().map(|method| {
        let [short, long] = ends(study, *method, value);
        format!("{} {short:.2} to {long:.2}{unit}", METHODS[*method])
    });
    words.collect::<Vec<_>>().join(", ")
}

fn plans() -> Vec<Plan> {
    vec![
        Plan {
            words: "BLS and BLMF know the soft contact in less than 0.3 s",
            place: "convergence",
            paper: "below 0.3 s".into(),
            judge: |s| {
                let times = [BLS, BLMF].map(|m| (m, converged(s, m, SOFT)));
                (named(&times, " s", 2), times.iter().all(|(_, t)| *t < 0.3))
            },
        },
        Plan {
            words: "EWRLS needs longer than both on every contact",
            place: "convergence",
            paper: "slowest of the four".into(),
            judge: |s| {
                let times = [EWRLS, BLS, BLMF].map(|m| (m, converged(s, m, SOFT)));
                let slower =
                    |contact| [BLS, BLMF].iter().all(|m| converged(s, EWRLS, contact) >= converged(s, *m, contact));
                (named(&times, " s on the soft one", 2), [SOFT, VARYING, MEDIUM].into_iter().all(slower))
            },
        },
        Plan {
            words: "EWRLS needs more than 1 s on the medium contact",
            place: "convergence",
            paper: "more than 1 s".into(),
            judge: |s| {
                let time = converged(s, EWRLS, MEDIUM);
                (named(&[(EWRLS, time)], " s", 2), time > 1.0)
            },
        },
        Plan {
            words: "yet its error there is below 7 %",
            place: "table I",
            paper: of_contact(MEDIUM, &[EWRLS]),
            judge: |s| {
                let error = rmse(s, EWRLS, MEDIUM);
                (named(&[(EWRLS, error)], " %", 2), error < 7.0)
            },
        },
        Plan {
            words: "The error of EWRLS grows with its memory",
            place: "table II",
            paper: of_window(&RMSE_BY_WINDOW, &[EWRLS], " %"),
            judge: |s| {
                let [short, long] = ends(s, EWRLS, error);
                (from_to(s, &[EWRLS], error, " %"), long > short)
            },
        },
        Plan {
            words: "The errors of BLS and BLMF fall with their window",
            place: "table II",
            paper: of_window(&RMSE_BY_WINDOW, &[BLS, BLMF], " %"),
            judge: |s| {
                let falls = |m| ends(s, m, error)[1] < ends(s, m, error)[0];
                (from_to(s, &[BLS, BLMF], error, " %"), falls(BLS) && falls(BLMF))
            },
        },
        Plan {
            words: "A longer memory makes K quieter, with every method that has one",
            place: "table III",
            paper: of_window(&STD_BY_WINDOW, &[EWRLS, BLS, BLMF], " N/m"),
            judge: |s| {
                let falls = |m: &usize| ends(s, *m, deviation)[1] < ends(s, *m, deviation)[0];
                (from_to(s, &[EWRLS, BLS, BLMF], deviation, " N/m"), [EWRLS, BLS, BLMF].iter().all(falls))
            },
        },
        Plan {
            words: "At a window of 50 EWRLS is quieter than BLMF, and BLMF quieter than BLS",
            place: "table III",
            paper: of_window(&STD_BY_WINDOW, &[EWRLS, BLMF, BLS], " N/m"),
            judge: |s| {
                let [a, b, c] = [EWRLS, BLMF, BLS].map(|m| (m, ends(s, m, deviation)[0]));
                (named(&[a, b, c], " N/m", 1), a.1 < b.1 && b.1 < c.1)
            },
        },
        Plan {
            words: "SPRLS is worse than EWRLS on the soft and the time-varying contact",
            place: "table I",
            paper: format!("{}; {}", of_contact(SOFT, &[SPRLS, EWRLS]), of_contact(VARYING, &[SPRLS, EWRLS])),
            judge: |s| {
                let pairs = [SOFT, VARYING].map(|c| [(SPRLS, rmse(s, SPRLS, c)), (EWRLS, rmse(s, EWRLS, c))]);
                let words = pairs.map(|pair| named(&pair, " %", 2)).join("; ");
                (words, pairs.iter().all(|[a, b]| a.1 > b.1))
            },
        },
        Plan {
            words: "and better than EWRLS on the medium one",
            place: "table I",
            paper: of_contact(MEDIUM, &[SPRLS, EWRLS]),
            judge: |s| {
                let pair = [SPRLS, EWRLS].map(|m| (m, rmse(s, m, MEDIUM)));
                (named(&pair, " %", 2), pair[0].1 < pair[1].1)
            },
        },
        Plan {
            words: "BLS and BLMF beat both recursive methods on every contact",
            place: "table I",
            paper: "every one".into(),
            judge: |s| {
                let beats = |c: usize| {
                    let block = rmse(s, BLS, c).max(rmse(s, BLMF, c));
                    block < rmse(s, EWRLS, c).min(rmse(s, SPRLS, c))
                };
                let won = [SOFT, VARYING, MEDIUM].into_iter().filter(|c| beats(*c)).count();
                (format!("on {won} of 3"), won == 3)
            },
        },
        Plan {
            words: "BLMF has the least error on the soft contact",
            place: "table I",
            paper: of_contact(SOFT, &[BLMF, BLS]),
            judge: |s| {
                let pair = [BLMF, BLS].map(|m| (m, rmse(s, m, SOFT)));
                (named(&pair, " %", 2), pair[0].1 < pair[1].1)
            },
        },
        Plan {
            words: "BLS has the least error on the time-varying contact",
            place: "table I",
            paper: of_contact(VARYING, &[BLS, BLMF]),
            judge: |s| {
                let pair = [BLS, BLMF].map(|m| (m, rmse(s, m, VARYING)));
                let least = METHODS.iter().enumerate().all(|(m, _)| pair[0].1 <= rmse(s, m, VARYING));
                (named(&pair, " %", 2), least)
            },
        },
        Plan {
            words: "BLMF has well below the error of BLS on the medium contact",
            place: "table I",
            paper: of_contact(MEDIUM, &[BLMF, BLS]),
            judge: |s| {
                let pair = [BLMF, BLS].map(|m| (m, rmse(s, m, MEDIUM)));
                (named(&pair, " %", 2), pair[0].1 < 0.8 * pair[1].1)
            },
        },
        Plan {
            words: "The stiffer the contact, the less the error of BLS and BLMF",
            place: "table I",
            paper: format!("{} on the medium one", of_contact(MEDIUM, &[BLS, BLMF])),
            judge: |s| {
                let falls = |m: usize| rmse(s, m, MEDIUM) < rmse(s, m, SOFT);
                (named(&[BLS, BLMF].map(|m| (m, rmse(s, m, MEDIUM))), " %", 2), falls(BLS) && falls(BLMF))
            },
        },
    ]
}

/// Every claim on the tables, under every reading of `studies`.
pub fn of_tables(studies: &[Study]) -> Vec<Claim> {
    let claims = plans().into_iter().map(|plan| Claim {
        words: plan.words,
        place: plan.place,
        paper: plan.paper,
        findings: studies
            .iter()
            .map(|study| {
                let (found, holds) = (plan.judge)(study);
                Finding { reading: study.reading.name, found, holds }
            })
            .collect(),
    });
    claims.collect()
}

/// Claims on the rates, of the device.
pub fn of_rates(source: &Source) -> Vec<Claim> {
    let rate = |update: &str, window| {
        source.cost(update, window).map_or(f64::NAN, |cost| CLOCK_HZ / f64::from(cost.worst_cycles_hi.max(1)))
    };
    let device = |found: String, holds: bool| vec![Finding { reading: "on the device", found, holds }];
    let (ewrls, bls, blmf) = (rate("ewrls", None), rate("bls", Some(300)), rate("blmf", Some(300)));
    let short = rate("blmf", Some(10));
    let paper = |method: &str, window: Option<u16>| {
        RATES.iter().find(|(name, of, _)| *name == method && *of == window).map_or(f64::NAN, |(.., rate)| *rate)
    };
    let khz = |rate: f64| format!("{:.1} kHz", rate / 1e3);
    let order = format!("EWRLS {}, BLS {}, BLMF {}", khz(ewrls), khz(bls), khz(blmf));
    let paper_order =
        format!("EWRLS {}, BLS {}, BLMF {}", khz(5e3), khz(paper("BLS", Some(300))), khz(paper("BLMF", Some(300))));
    vec![
        Claim {
            words: "EWRLS updates faster than BLS, and BLS faster than BLMF",
            place: "table IV",
            paper: paper_order,
            findings: device(order, ewrls > bls && bls > blmf),
        },
        Claim {
            words: "The rate of BLMF falls with its window, by a factor of twelve from 10 to 300 samples",
            place: "table IV",
            paper: format!("{} to {}", khz(paper("BLMF", Some(10))), khz(paper("BLMF", Some(300)))),
            findings: device(format!("{} to {}", khz(short), khz(blmf)), short > 4.0 * blmf),
        },
        Claim {
            words: "BLMF on 300 samples is too slow for a loop of 1 kHz",
            place: "table IV",
            paper: khz(paper("BLMF", Some(300))),
            findings: device(khz(blmf), blmf < 1e3),
        },
    ]
}

/// What the paper says against itself, in its own figures alone.
pub fn inconsistencies() -> Vec<String> {
    let mut words = Vec::new();
    for (method, name) in METHODS.iter().enumerate() {
        let (one, other) = (RMSE_BY_CONTACT[method][SOFT], RMSE_BY_WINDOW[method].map(|[_, long]| long));
        if let Some(other) = other.filter(|other| (other - one).abs() > 0.005) {
            words.push(format!(
                "{name} on the soft contact with a window of 300 has an error of {one} % in table I and of {other} % in table II."
            ));
        }
    }
    let ewrls = RMSE_BY_CONTACT[EWRLS][MEDIUM];
    // While nothing is known the innovation is the force: T seconds of that in 15 s are at least 100 sqrt(T/3/15) per cent where the
    // estimate comes in straight.
    let least = 100.0 * (1.0_f64 / 3.0 / 15.0).sqrt();
    if ewrls < least {
        words.push(format!(
            "EWRLS is said to need more than 1 s on the medium contact and to have an error of {ewrls} % there; an estimate that comes in \
             along a straight line in 1 of 15 s leaves {least:.1} %."
        ));
    }
    words.push(
        "The recordings are said to be down-sampled by 10, to 100 Hz. A window of 300 is then 3 s long, and nothing that needs a full \
         window can converge in 0.3 s, as is claimed of BLS and BLMF."
            .into(),
    );
    words
}

/// How far the tables of a study are from the paper's: the mean size of the logarithm of found over paper, as a factor. 1 is the paper.
pub fn distance(study: &Study) -> f64 {
    let contacts = (0..4).flat_map(|m| (0..3).map(move |c| (m, c)));
    let by_contact = contacts.map(|(m, c)| (rmse(study, m, c), RMSE_BY_CONTACT[m][c]));
    let by_window = |table: &'static [Option<[f64; 2]>; 4], value: fn(&Cell) -> f64| {
        (0..4).filter_map(move |m| table[m].map(|paper| (ends(study, m, value), paper)))
    };
    let windows = by_window(&RMSE_BY_WINDOW, error).chain(by_window(&STD_BY_WINDOW, deviation));
    let pairs = by_contact.chain(windows.flat_map(|(found, paper)| [(found[0], paper[0]), (found[1], paper[1])]));
    let logs: Vec<f64> = pairs.map(|(found, paper)| (found / paper).ln().abs()).collect();
    (logs.iter().sum::<f64>() / logs.len() as f64).exp()
}
