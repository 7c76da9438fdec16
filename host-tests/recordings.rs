//! Real recordings, where they are to be had.

use palpate::{ContactDetectorConfig, FrontEndConfig, Observation, Sample, Units, Velocity};
use std::path::PathBuf;

/// One recorded trial, ready for the front end.
#[derive(Debug, Clone)]
pub struct Recording {
    pub name: &'static str,
    pub samples: Vec<Sample>,
    pub front_end: FrontEndConfig,
}

/// How a file is to be read.
struct Source {
    file: &'static str,
    position: &'static str,
    period: f32,
    cutoff: f32,
}

const AFM: Source = Source { file: "", position: "tip_position_m", period: 1e-3, cutoff: 20.0 };
const TISSUE: Source = Source { file: "", position: "position_m", period: 0.1, cutoff: 2.0 };

const SOURCES: [Source; 5] = [
    Source { file: "afm_soft_contact/creep_polymergel.csv", ..AFM },
    Source { file: "afm_soft_contact/creep_brain.csv", ..AFM },
    Source { file: "afm_soft_contact/fd_cell_2016a.csv", period: 5e-4, cutoff: 40.0, ..AFM },
    Source { file: "tissue_indentation/s230515_P002_1.csv", ..TISSUE },
    Source { file: "tissue_indentation/meat_230327_FF1_1A.csv", ..TISSUE },
];

fn folder() -> PathBuf {
    std::env::var_os("PALPATE_RECORDINGS")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/recordings"), PathBuf::from)
}

/// All recordings that are there; prints which are not.
pub fn all() -> Vec<Recording> {
    let folder = folder();
    SOURCES
        .iter()
        .filter_map(|source| {
            let path = folder.join(source.file);
            if !path.exists() {
                println!("LEFT OUT: no recording {} here (PALPATE_RECORDINGS names the folder)", source.file);
                return None;
            }
            Some(prepare(source, &read(&path, source.position)))
        })
        .collect()
}

/// Time, position and force.
fn read(path: &std::path::Path, position: &str) -> Vec<[f64; 3]> {
    let mut reader = csv::Reader::from_path(path).expect("a readable recording");
    let header = reader.headers().expect("a header").clone();
    let column = |name: &str| header.iter().position(|h| h == name).expect("the named column");
    let columns = [column("t_s"), column(position), column("force_N")];
    reader
        .records()
        .map(|record| {
            let record = record.expect("a whole record");
            columns.map(|c| record[c].parse().expect("a number"))
        })
        .collect()
}

/// Baseline off, surface where the force first rises for good, thresholds and units by the recording's own size.
fn prepare(source: &Source, rows: &[[f64; 3]]) -> Recording {
    let quiet = &rows[..rows.len() / 20];
    let mean = quiet.iter().map(|r| r[2]).sum::<f64>() / quiet.len() as f64;
    let spread = (quiet.iter().map(|r| (r[2] - mean).powi(2)).sum::<f64>() / quiet.len() as f64).sqrt();
    let peak = rows.iter().map(|r| (r[2] - mean).abs()).fold(0.0, f64::max);
    let threshold = (5.0 * spread).max(0.01 * peak);
    let top = rows.iter().position(|r| r[2] - mean > 0.5 * peak).expect("a press");
    let onset = rows[..top].iter().rposition(|r| r[2] - mean < threshold).map_or(0, |before| before + 1);
    let surface = rows[onset][1];
    let deepest = rows.iter().map(|r| r[1] - surface).fold(0.0, f64::max);
    let fastest = rows.windows(20).map(|w| (w[19][1] - w[0][1]).abs() / (w[19][0] - w[0][0])).fold(0.0, f64::max);
    let range = Observation { penetration: deepest as f32, rate: fastest as f32, force: peak as f32 };
    Recording {
        name: source.file.split('/').next_back().expect("a file name"),
        samples: rows
            .iter()
            .map(|r| Sample { position: r[1] as f32, force: (r[2] - mean) as f32, elapsed: source.period })
            .collect(),
        front_end: FrontEndConfig {
            period: source.period,
            surface: surface as f32,
            cutoff: source.cutoff,
            velocity: Velocity::Matched,
            bilateral: false,
            contact_detector: ContactDetectorConfig {
                on_force: threshold as f32,
                off_force: (0.2 * threshold) as f32,
                off_samples: 5,
            },
            units: Units::for_range(range),
        },
    }
}
