//! The force under control.

use maud::{Markup, html};

use super::super::Results;
use super::super::force_control::{ForceControlResult, SEEDS, StiffnessSource, TARGET_FORCE_N};
use super::{grid, spread, wide};
use crate::reproduce::estimator::Estimator;

pub(super) fn section(results: &Results) -> Markup {
    let table = html! {
        table.better {
            caption { "Mean ± spread of " (SEEDS) " flights. Peak: largest departure; rms: from the first jump to the end; both in % of the wanted " (TARGET_FORCE_N) " N" }
            thead { tr { th scope="col" { "K from" } th scope="col" { "back within 5 %, jump up, ms" } th scope="col" { "jump down, ms" } th scope="col" { "peak up, %" } th scope="col" { "peak down, %" } th scope="col" { "rms, %" } th scope="col" { "flights that swing" } } }
            tbody { @for row in &results.force { (line(row)) } }
        }
    };
    html! {
        section #force aria-labelledby="force-title" {
            h2 #force-title { "Why a fast estimate matters" }
            p {
                "An indirect adaptive controller holds a force. The drive keeps its controller of the position; above it, the commanded depth is what the wanted force needs by the estimated K, and a slow integral mends the rest. "
                "K jumps from 250 to 900 N/m, and back 5 s later. With the true K the force would be back as soon as the tool has moved; without any estimate only the integral is left. "
                (worse(results)) " A late estimate moves the tool when the integral has long mended the force."
            }
            (wide("Force control by each estimate", &table))
            (grid(&results.force_figures))
        }
    }
}

/// Which estimates leave more error than none.
fn worse(results: &Results) -> String {
    let none =
        results.force.iter().find(|row| row.source == StiffnessSource::Fixed).map_or(f64::NAN, |row| row.rms.mean);
    let worse: Vec<String> =
        results.force.iter().filter(|row| row.rms.mean > none).map(|row| row.source.name()).collect();
    match worse.as_slice() {
        [] => "Every estimate leaves less error than none.".into(),
        names => format!("Worse than no estimate at all, by the rms of the error: {}.", names.join(", ")),
    }
}

fn line(row: &ForceControlResult) -> Markup {
    html! {
        tr.best[matches!(row.source, StiffnessSource::Estimated(Estimator::Cusum, _))] {
            th scope="row" { (row.source.name()) }
            td { (spread(&row.settled_up, 0)) }
            td { (spread(&row.settled_down, 0)) }
            td { (spread(&row.peak_up, 0)) }
            td { (spread(&row.peak_down, 0)) }
            td { (spread(&row.rms, 1)) }
            td { (row.unstable) " of " (SEEDS) }
        }
    }
}
