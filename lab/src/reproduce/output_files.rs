//! The numbers as files beside the page.

use std::path::Path;

use anyhow::{Context as _, Result};

use super::Results;
use super::measure::MeanAndDeviation;
use super::paper::{METHODS, RMSE_BY_CONTACT, RMSE_BY_WINDOW, STD_BY_WINDOW, WINDOWS};
use super::paper_contact::PaperContact;
use crate::outfile::OutFile;

/// Every output, opened before the long run.
pub struct OutputFiles {
    page: OutFile,
    csv: Vec<(&'static str, OutFile)>,
    figures: Vec<OutFile>,
    rigs: Vec<OutFile>,
}

const TABLES: [&str; 6] = ["tables.csv", "rates.csv", "claims.csv", "better.csv", "models.csv", "force.csv"];

/// Numbers of the figures.
pub const FIGURES: std::ops::RangeInclusive<usize> = 2..=16;

impl OutputFiles {
    /// Opens them in `folder`, which is made where there is none.
    ///
    /// # Errors
    /// The folder cannot be made, or a file not be written.
    pub fn open(folder: &Path) -> Result<Self> {
        let rigs = folder.join("rigs");
        std::fs::create_dir_all(&rigs).with_context(|| format!("cannot make {}", rigs.display()))?;
        let csv = TABLES.map(|name| Ok((name, OutFile::create(&folder.join(name))?)));
        Ok(Self {
            page: OutFile::create(&folder.join("reproduce.html"))?,
            csv: csv.into_iter().collect::<Result<_>>()?,
            figures: FIGURES
                .map(|number| Ok(OutFile::create(&folder.join(format!("figure-{number:02}.svg")))?))
                .collect::<Result<_>>()?,
            rigs: all_rigs().map(|(name, _)| Ok(OutFile::create(&rigs.join(name))?)).collect::<Result<_>>()?,
        })
    }

    /// Writes everything.
    ///
    /// # Errors
    /// A place cannot be written any more.
    pub fn write(mut self, results: &Results) -> Result<()> {
        let written = super::page::write(results, &mut self.page);
        written.map_err(|error| self.page.fault(&error))?;
        self.page.commit()?;
        for (name, mut file) in self.csv {
            let text = table(name, results)?;
            put(&mut file, &text)?;
            file.commit()?;
        }
        let all = results.figures.iter().chain(&results.better_figures).chain(&results.force_figures);
        for (mut file, figure) in self.figures.into_iter().zip(all) {
            put(&mut file, &figure.plot.file(&format!("Figure {}. {}", figure.number, figure.title)))?;
            file.commit()?;
        }
        for (mut file, (_, text)) in self.rigs.into_iter().zip(all_rigs()) {
            put(&mut file, text)?;
            file.commit()?;
        }
        Ok(())
    }
}

fn put(file: &mut OutFile, text: &str) -> Result<()> {
    use std::io::Write as _;
    let written = file.write_all(text.as_bytes());
    Ok(written.map_err(|error| file.fault(&error))?)
}

/// Names and texts of the rig files.
pub fn all_rigs() -> impl Iterator<Item = (&'static str, &'static str)> {
    PaperContact::PAPER.into_iter().chain([PaperContact::Steps]).map(PaperContact::file)
}

fn table(name: &str, results: &Results) -> Result<String> {
    let rows: Vec<Vec<String>> = match name {
        "tables.csv" => tables(results),
        "rates.csv" => rates(results),
        "claims.csv" => claims(results),
        "better.csv" => better(results),
        "models.csv" => models(results),
        _ => force(results),
    };
    let mut csv = csv::Writer::from_writer(Vec::new());
    for row in rows {
        csv.write_record(row)?;
    }
    Ok(String::from_utf8(csv.into_inner()?)?)
}

fn words(values: &[&str]) -> Vec<String> {
    values.iter().map(|value| (*value).to_owned()).collect()
}

fn both(spread: &MeanAndDeviation) -> [String; 2] {
    [spread.mean.to_string(), spread.deviation.to_string()]
}

fn or_empty(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

fn tables(results: &Results) -> Vec<Vec<String>> {
    let mut rows = vec![words(&["reading", "table", "method", "contact", "window", "mean", "deviation", "paper"])];
    for study in &results.studies {
        let mut line =
            |table: &str, method: usize, contact: &str, window: u16, value: &MeanAndDeviation, paper: Option<f64>| {
                let [mean, deviation] = both(value);
                let head = [study.reading.name, table, METHODS[method], contact].map(str::to_owned);
                rows.push(head.into_iter().chain([window.to_string(), mean, deviation, or_empty(paper)]).collect());
            };
        for (method, cells) in study.by_contact.iter().enumerate() {
            for (at, cell) in cells.iter().enumerate() {
                line("I", method, PaperContact::PAPER[at].name(), 300, &cell.rmse, Some(RMSE_BY_CONTACT[method][at]));
                line("convergence, s", method, PaperContact::PAPER[at].name(), 300, &cell.converged, None);
            }
        }
        for (at, (cells, window)) in study.by_window.iter().zip(WINDOWS).enumerate() {
            for (method, cell) in cells.iter().enumerate() {
                let own = |table: &[Option<[f64; 2]>; 4]| match (table[method], at) {
                    (Some([short, _]), 0) => Some(short),
                    (Some([_, long]), at) if at + 1 == WINDOWS.len() => Some(long),
                    _ => None,
                };
                line("II", method, "soft", window, &cell.rmse, own(&RMSE_BY_WINDOW));
                line("III", method, "soft", window, &cell.deviation, own(&STD_BY_WINDOW));
            }
        }
    }
    rows
}

fn rates(results: &Results) -> Vec<Vec<String>> {
    let mut rows = vec![words(&[
        "method",
        "window",
        "instructions_mean",
        "instructions_worst",
        "cycles_lo",
        "cycles_hi",
        "updates_per_s_lo",
        "updates_per_s_hi",
        "paper_updates_per_s",
    ])];
    rows.extend(results.rate_table.iter().map(|rate| {
        let window = rate.window.map_or_else(String::new, |window| window.to_string());
        let numbers = rate.instructions.iter().map(f64::to_string).chain(rate.cycles.iter().map(u32::to_string));
        let numbers = numbers.chain(rate.per_second.iter().map(f64::to_string)).chain([or_empty(rate.paper)]);
        [rate.method.clone(), window].into_iter().chain(numbers).collect()
    }));
    rows
}

fn claims(results: &Results) -> Vec<Vec<String>> {
    let mut rows = vec![words(&["claim", "place", "paper", "reading", "found", "holds"])];
    for claim in &results.claims {
        rows.extend(claim.findings.iter().map(|f| {
            let holds = f.holds.to_string();
            words(&[claim.words, claim.place, &claim.paper, f.reading, &f.found, &holds])
        }));
    }
    rows
}

fn better(results: &Results) -> Vec<Vec<String>> {
    let measures = [
        "onset_ms",
        "jump_up_ms",
        "jump_down_ms",
        "std_k_percent",
        "bias_k_percent",
        "bias_b_percent",
        "rmse_percent",
        "covered_k_percent",
        "covered_b_percent",
    ];
    let head = measures.iter().flat_map(|name| [(*name).to_owned(), format!("{name}_deviation")]);
    let mut rows: Vec<Vec<String>> = vec![["method".to_owned()].into_iter().chain(head).collect()];
    rows.extend(results.better.iter().map(|r| {
        let values = [
            &r.onset,
            &r.up,
            &r.down,
            &r.deviation,
            &r.bias_stiffness,
            &r.bias_damping,
            &r.rmse,
            &r.covered_stiffness,
            &r.covered_damping,
        ];
        [r.name()].into_iter().chain(values.into_iter().flat_map(both)).collect()
    }));
    rows
}

fn models(results: &Results) -> Vec<Vec<String>> {
    let mut rows =
        vec![words(&["contact", "regressor", "parameter", "unit", "truth", "mean", "deviation", "half_width"])];
    for case in &results.models {
        rows.extend(case.parameters.iter().map(|p| {
            let [mean, deviation] = both(&p.found);
            let head = [case.name, case.regressor, p.symbol, p.unit].map(str::to_owned);
            head.into_iter().chain([p.truth.to_string(), mean, deviation, p.half_width.to_string()]).collect()
        }));
    }
    rows
}

fn force(results: &Results) -> Vec<Vec<String>> {
    let measures = ["settled_up_ms", "settled_down_ms", "peak_up_percent", "peak_down_percent", "rms_percent"];
    let head = measures.iter().flat_map(|name| [(*name).to_owned(), format!("{name}_deviation")]);
    let mut rows: Vec<Vec<String>> =
        vec![["stiffness_from".to_owned()].into_iter().chain(head).chain(["swinging_flights".to_owned()]).collect()];
    rows.extend(results.force.iter().map(|r| {
        let values = [&r.settled_up, &r.settled_down, &r.peak_up, &r.peak_down, &r.rms];
        let numbers = values.into_iter().flat_map(both);
        [r.source.name()].into_iter().chain(numbers).chain([r.unstable.to_string()]).collect()
    }));
    rows
}
