//! Tables I to IV.

use maud::{Markup, html};

use super::super::Results;
use super::super::measure::MeanAndDeviation;
use super::super::paper::{METHODS, PC_HZ, RMSE_BY_CONTACT, RMSE_BY_WINDOW, STD_BY_WINDOW, WINDOWS};
use super::super::paper_contact::PaperContact;
use super::super::paper_tables::{Cell, Study};
use super::super::rates::CLOCK_HZ;
use super::{number, spread, wide};

pub(super) fn section(results: &Results) -> Markup {
    let shown = &results.studies[results.shown];
    html! {
        section #tables aria-labelledby="tables-title" {
            h2 #tables-title { "Tables I to IV" }
            p { "Means of five trials, samples read as: " strong { (shown.reading.name) } ". Below each figure, in grey, its spread and the paper's own; a dash where that is not at hand." }
            (by_contact(shown))
            (by_window(shown, "Table II. RMSE% on the soft contact, by window (for EWRLS: the horizon of its forgetting)", &RMSE_BY_WINDOW, |cell| cell.rmse))
            (by_window(shown, "Table III. Standard deviation of K on the soft contact, N/m, from 1 s after the touch on", &STD_BY_WINDOW, |cell| cell.deviation))
            (rates(results))
        }
    }
}

fn by_contact(study: &Study) -> Markup {
    let table = html! {
        table {
            caption { "Table I. RMSE% over the whole contact, window 300; below, without its first 0.3 s; and seconds until K stays within 10 %" }
            thead { tr { th scope="col" { "Method" } @for contact in PaperContact::PAPER { th scope="col" { (contact.name()) } th scope="col" { "after 0.3 s" } th scope="col" { "settled, s" } } } }
            tbody {
                @for (method, name) in METHODS.iter().enumerate() {
                    tr {
                        th scope="row" { (name) }
                        @for contact in 0..3 {
                            @let cell = &study.by_contact[method][contact];
                            td { (spread(&cell.rmse, 2)) small.of-paper { "paper " (RMSE_BY_CONTACT[method][contact]) } }
                            td { (number(cell.rmse_later.mean, 2)) }
                            td { (number(cell.converged.mean, 2)) }
                        }
                    }
                }
            }
        }
    };
    wide("Table I", &table)
}

fn by_window(
    study: &Study,
    caption: &str,
    paper: &[Option<[f64; 2]>; 4],
    value: fn(&Cell) -> MeanAndDeviation,
) -> Markup {
    let own = |method: usize, at: usize| -> Option<f64> {
        let [short, long] = paper[method]?;
        match at {
            0 => Some(short),
            _ if at + 1 == WINDOWS.len() => Some(long),
            _ => None,
        }
    };
    let table = html! {
        table {
            caption { (caption) }
            thead { tr { th scope="col" { "Method" } @for window in WINDOWS { th scope="col" { (window) } } } }
            tbody {
                @for method in (0..4).filter(|method| paper[*method].is_some()) {
                    tr {
                        th scope="row" { (METHODS[method]) }
                        @for (at, cells) in study.by_window.iter().enumerate() {
                            td { (spread(&value(&cells[method]), 2)) small.of-paper { "paper " @match own(method, at) { Some(figure) => (figure), None => "–" } } }
                        }
                    }
                }
            }
        }
    };
    wide(caption, &table)
}

fn rates(results: &Results) -> Markup {
    let table = html! {
        table {
            caption { "Table IV. Updates per second of the worst update on a Cortex-M4F at " (CLOCK_HZ / 1e6) " MHz: instructions counted, cycles modelled from them as a band. The paper: MATLAB on a PC of " (PC_HZ / 1e9) " GHz" }
            thead { tr { th scope="col" { "Method" } th scope="col" { "window" } th scope="col" { "instructions" small { "mean / worst" } } th scope="col" { "cycles, worst" } th scope="col" { "updates per second" } th scope="col" { "paper" } th scope="col" { "times the paper" small { "at 1/19 of its clock" } } } }
            tbody {
                @for rate in &results.rate_table {
                    tr {
                        th scope="row" { (rate.method) }
                        td { @match rate.window { Some(window) => (window), None => "–" } }
                        td { (number(rate.instructions[0], 0)) " / " (number(rate.instructions[1], 0)) }
                        td { (rate.cycles[0]) " to " (rate.cycles[1]) }
                        td { (kilo(rate.per_second[0])) " to " (kilo(rate.per_second[1])) }
                        td { @match rate.paper { Some(paper) => (kilo(paper)), None => "–" } }
                        td { @match rate.paper { Some(paper) => (number(rate.per_second[0] / paper, 0)), None => "–" } }
                    }
                }
            }
        }
    };
    html! { (wide("Table IV", &table)) p.fine { (results.rates.words) } }
}

fn kilo(rate: f64) -> String {
    if rate >= 1e4 {
        format!("{:.0} kHz", rate / 1e3)
    } else if rate >= 1e3 {
        format!("{:.1} kHz", rate / 1e3)
    } else {
        format!("{rate:.0} Hz")
    }
}
