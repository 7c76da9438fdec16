//! The paper's claims, and what it says against itself.

use maud::{Markup, html};

use super::super::Results;
use super::super::claim::{Claim, Finding};
use super::wide;

pub(super) fn section(results: &Results) -> Markup {
    let (tables, rates): (Vec<&Claim>, Vec<&Claim>) = results.claims.iter().partition(|claim| claim.findings.len() > 1);
    html! {
        section #claims aria-labelledby="claims-title" {
            h2 #claims-title { "The paper's claims, computed" }
            p { "Each claim is a comparison that was just computed, once for every reading. A claim that holds under one reading and not under another rests on what the paper leaves open." }
            (table(&tables))
            (table(&rates))
            h3 { "Where the paper disagrees with itself" }
            ul { @for words in &results.inconsistencies { li { (words) } } }
        }
    }
}

fn table(claims: &[&Claim]) -> Markup {
    let readings = claims.first().map(|claim| claim.findings.iter().map(|finding| finding.reading).collect::<Vec<_>>());
    let table = html! {
        table.claims {
            thead { tr { th scope="col" { "Claim" } @for reading in readings.unwrap_or_default() { th scope="col" { (reading) } } th scope="col" { "paper" } th scope="col" { "where" } } }
            tbody {
                @for claim in claims {
                    tr {
                        th scope="row" { (claim.words) }
                        @for finding in &claim.findings { (cell(finding)) }
                        td { (claim.paper) }
                        td { (claim.place) }
                    }
                }
            }
        }
    };
    wide("Claims", &table)
}

fn cell(finding: &Finding) -> Markup {
    html! {
        td class=(if finding.holds { "holds" } else { "fails" }) {
            (if finding.holds { "holds" } else { "does not hold" })
            small { (finding.found) }
        }
    }
}
